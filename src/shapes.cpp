#include "shapes.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

Crossings cross_sphere(const Sphere& sphere, const Vec3& origin, const Vec3& direction) {
    const Vec3 to_center = sphere.center - origin;
    const double square = to_center.dot(to_center), radius2 = sphere.radius * sphere.radius;
    const double closest = to_center.dot(direction);
    if (square >= radius2 && closest < least_cosine) return {};
    const double half2 = radius2 - square + closest * closest;
    if (half2 <= least_cosine) return {};
    const double half = std::sqrt(half2);
    Crossings found;
    for (const double t : {closest - half, closest + half})
        if (t > least_depth && t < greatest_depth) found.t[std::size_t(found.count++)] = t;
    return found;
}

Crossings cross_plane(const PreparedPlane& plane, const Vec3& origin, const Vec3& direction) {
    const double along = plane.frame.normal.dot(direction);
    if (std::abs(along) < least_cosine) return {};
    const double t = (plane.distance - plane.frame.normal.dot(origin)) / along;
    if (!(t >= least_depth && t <= greatest_depth)) return {};
    return {1, {t, 0}};
}

namespace {

// Calls visit(object, crossings) for every sphere and plane along a ray.
template <class Visit>
void each_shape(const World& world, const Vec3& origin, const Vec3& direction, Visit visit) {
    Index object = world.first_sphere();
    for (const Sphere& sphere : world.scene.spheres)
        visit(object++, cross_sphere(sphere, origin, direction));
    for (const PreparedPlane& plane : world.planes)
        visit(object++, cross_plane(plane, origin, direction));
}

}  // namespace

void closest_shapes(const World& world, const Rays& rays, Hits& hits) {
    for (std::size_t i = 0; i < rays.count; ++i) {
        Hit& hit = hits[i];
        each_shape(world, rays.origin[i], rays.direction[i],
                   [&hit](Index object, const Crossings& crossings) {
                       for (int k = 0; k < crossings.count; ++k) {
                           const double t = crossings.t[std::size_t(k)];
                           if (t >= least_distance && t < hit.t) hit = {t, object, no_index};
                       }
                   });
    }
}

void block_by_shapes(const World& world, const ShadowRays& rays, std::span<unsigned char> visible) {
    const auto blocked = [](const Crossings& crossings, double end) {
        for (int k = 0; k < crossings.count; ++k)
            if (crossings.t[std::size_t(k)] > shadow_margin && crossings.t[std::size_t(k)] < end)
                return true;
        return false;
    };
    Index object = world.first_sphere();
    for (const Sphere& sphere : world.scene.spheres) {
        if (!world.finish_of(object++).opaque) continue;
        for (std::size_t i = 0; i < rays.count; ++i)
            if (visible[i] != 0 && blocked(cross_sphere(sphere, rays.origin[i], rays.direction[i]),
                                           rays.distance[i] - shadow_margin))
                visible[i] = 0;
    }
    for (const PreparedPlane& plane : world.planes) {
        const Index self = object++;
        if (!world.finish_of(self).opaque) continue;
        for (std::size_t i = 0; i < rays.count; ++i)
            // A ray never meets the plane again that it starts on.
            if (visible[i] != 0 && rays.object[i] != self &&
                blocked(cross_plane(plane, rays.origin[i], rays.direction[i]),
                        rays.distance[i] - shadow_margin))
                visible[i] = 0;
    }
}

bool translucent_shape(const World& world, const Vec3& origin, const Vec3& direction,
                       double nearest, Hit& hit) {
    bool found = false;
    each_shape(world, origin, direction, [&](Index object, const Crossings& crossings) {
        if (world.finish_of(object).opaque) return;
        for (int k = 0; k < crossings.count; ++k) {
            const double t = crossings.t[std::size_t(k)];
            if (!(t > nearest && t < hit.t)) continue;
            hit = {t, object, no_index};
            found = true;
        }
    });
    return found;
}

}  // namespace penumbra
