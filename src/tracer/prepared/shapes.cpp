#include "tracer/prepared/shapes.h"

#include "base/simd.h"
#include "tracer/accel/shaft.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

constexpr std::size_t block_size = 64;       // neighbouring rays that are looked at together
constexpr std::size_t few_spheres = 4;       // are tested without asking whether a block is near
constexpr std::size_t most_candidates = 24;  // of a block of rays, before each ray goes alone

// ---- dense loops over arrays: the tests of cross_sphere() and cross_plane() ---------------------

// Where a ray crosses a sphere whose centre lies at (x, y, z) from its start and `closest` along
// it.
struct SphereRoots {
    double near, far;
    bool crosses;
};

inline SphereRoots sphere_roots(double x, double y, double z, double closest, double radius2) {
    const double square = x * x + y * y + z * z;
    const double half2 = radius2 - square + closest * closest;
    const double half = std::sqrt(half2 > 0 ? half2 : 0);
    const bool away = (square >= radius2) & (closest < least_cosine);
    const bool crosses = (half2 > least_cosine) & !away;
    return {closest - half, closest + half, crosses};
}

// NOLINTBEGIN(readability-function-size): what GCC vectorises are loops over plain arrays
PENUMBRA_VECTORISED
void nearest_on_sphere(const Vec3& center, double radius2, Vec3View origin, Vec3View direction,
                       std::size_t count, Index object, double* __restrict t,
                       Index* __restrict objects) {
    const double cx = center.x, cy = center.y, cz = center.z;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = cx - origin.x[i], y = cy - origin.y[i], z = cz - origin.z[i];
        const double closest = x * direction.x[i] + y * direction.y[i] + z * direction.z[i];
        const SphereRoots roots = sphere_roots(x, y, z, closest, radius2);
        const double first = roots.near >= least_distance ? roots.near : roots.far;
        const bool crosses =
            roots.crosses & (first >= least_distance) & (first < greatest_depth) & (first < t[i]);
        t[i] = crosses ? first : t[i];
        objects[i] = crosses ? object : objects[i];
    }
}

PENUMBRA_VECTORISED
void nearest_on_plane(const Vec3& normal, double distance, Vec3View origin, Vec3View direction,
                      std::size_t count, Index object, double* __restrict t,
                      Index* __restrict objects) {
    const double nx = normal.x, ny = normal.y, nz = normal.z;
    for (std::size_t i = 0; i < count; ++i) {
        const double along = nx * direction.x[i] + ny * direction.y[i] + nz * direction.z[i];
        const double height = nx * origin.x[i] + ny * origin.y[i] + nz * origin.z[i];
        const double there = (distance - height) / along;
        const bool crosses = (std::abs(along) >= least_cosine) & (there >= least_distance) &
                             (there <= greatest_depth) & (there < t[i]);
        t[i] = crosses ? there : t[i];
        objects[i] = crosses ? object : objects[i];
    }
}

PENUMBRA_VECTORISED
void block_by_sphere(const Vec3& center, double radius2, Vec3View origin, Vec3View direction,
                     const double* __restrict distance, std::size_t count,
                     double* __restrict visible) {
    const double cx = center.x, cy = center.y, cz = center.z;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = cx - origin.x[i], y = cy - origin.y[i], z = cz - origin.z[i];
        const double closest = x * direction.x[i] + y * direction.y[i] + z * direction.z[i];
        const SphereRoots roots = sphere_roots(x, y, z, closest, radius2);
        const double end = std::min(distance[i] - shadow_margin, greatest_depth);
        const bool near_blocks = (roots.near > shadow_margin) & (roots.near < end);
        const bool far_blocks = (roots.far > shadow_margin) & (roots.far < end);
        visible[i] = roots.crosses & (near_blocks | far_blocks) ? 0 : visible[i];
    }
}

// NOLINTEND(readability-function-size)

void block_by_plane(const PreparedPlane& plane, Index self, const ShadowRays& rays,
                    const IndexRange& range, std::span<double> visible) {
    for (std::size_t i = range.first; i < range.last; ++i) {
        if (visible[i] == 0 || rays.object[i] == self) continue;
        const Crossings crossings = cross_plane(plane, rays.origin[i], rays.direction[i]);
        if (crossings.count > 0 && crossings.t[0] > shadow_margin &&
            crossings.t[0] < rays.distance[i] - shadow_margin)
            visible[i] = 0;
    }
}

// ---- groups of rays ----------------------------------------------------------------------------

// A ray by itself, up to a distance.
struct Segment {
    Vec3 origin, inverse;  // of the direction
    const double& end;

    bool touches(const Bounds& box) const {
        double enter = 0, leave = end;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (box.min[axis] - origin[axis]) * inverse[axis];
            const double b = (box.max[axis] - origin[axis]) * inverse[axis];
            // The order of the arguments lets NaN, of 0 x infinity, pass.
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return !(enter > leave);
    }
};

Vec3 inverse_of(const Vec3& direction) {
    return {1 / direction.x, 1 / direction.y, 1 / direction.z};
}

void nearest_sphere(const PreparedScene& prepared, const Rays& rays, std::size_t i, Hits& hits) {
    const Vec3 origin = rays.origin[i], direction = rays.direction[i];
    const Segment segment = {origin, inverse_of(direction), hits.t[i]};
    visit_boxes(
        prepared.sphere_boxes, [&](const Bounds& box) { return segment.touches(box); },
        [&](Index object) {
            const Crossings crossings = cross_sphere(prepared.sphere(object), origin, direction);
            for (int k = 0; k < crossings.count; ++k) {
                const double t = crossings.t[std::size_t(k)];
                if (t >= least_distance && t < hits.t[i]) hits.set(i, {t, object, no_index});
            }
            return false;
        });
}

void nearest_spheres(const PreparedScene& prepared, const Rays& rays,
                     std::span<const Index> objects, std::size_t first, std::size_t last,
                     Hits& hits) {
    for (const Index object : objects) {
        const Sphere& sphere = prepared.sphere(object);
        nearest_on_sphere(sphere.center, sphere.radius * sphere.radius,
                          Vec3View(rays.origin, first), Vec3View(rays.direction, first),
                          last - first, object, hits.t.data() + first, hits.object.data() + first);
    }
}

void nearest_of_many(const PreparedScene& prepared, const Rays& rays, Hits& hits,
                     std::vector<Index>& candidates) {
    for (std::size_t first = 0; first < rays.count; first += block_size) {
        const std::size_t last = std::min(first + block_size, rays.count);
        const Beam beam = {.origins = box_around(rays.origin, {first, last}),
                           .directions = box_around(rays.direction, {first, last})};
        candidates.clear();
        const bool too_many = visit_boxes(
            prepared.sphere_boxes, [&](const Bounds& box) { return touches(beam, box); },
            [&](Index object) {
                candidates.push_back(object);
                return candidates.size() > most_candidates;
            });
        if (!too_many)
            nearest_spheres(prepared, rays, candidates, first, last, hits);
        else
            for (std::size_t i = first; i < last; ++i) nearest_sphere(prepared, rays, i, hits);
    }
}

}  // namespace

void closest_shapes(const PreparedScene& prepared, const Rays& rays, Hits& hits,
                    std::vector<Index>& scratch) {
    if (prepared.scene.spheres.size() > few_spheres) {
        nearest_of_many(prepared, rays, hits, scratch);
    } else {
        scratch.resize(prepared.scene.spheres.size());
        std::iota(scratch.begin(), scratch.end(), prepared.first_sphere());
        nearest_spheres(prepared, rays, scratch, 0, rays.count, hits);
    }
    for (std::size_t k = 0; k < prepared.planes.size(); ++k)
        if (prepared.scene.planes[k].in_mirrors) closest_on_plane(prepared, k, rays, hits);
}

void closest_on_plane(const PreparedScene& prepared, std::size_t k, const Rays& rays, Hits& hits) {
    const PreparedPlane& plane = prepared.planes[k];
    nearest_on_plane(plane.frame.normal, plane.distance, Vec3View(rays.origin),
                     Vec3View(rays.direction), rays.count, prepared.first_plane() + Index(k),
                     hits.t.data(), hits.object.data());
}

void block_by_shapes(const PreparedScene& prepared, std::span<const Index> objects,
                     const ShadowRays& rays, const IndexRange& range, std::span<double> visible) {
    for (const Index object : objects) {
        if (object >= prepared.first_plane()) {
            block_by_plane(prepared.plane(object), object, rays, range, visible);
            continue;
        }
        const Sphere& sphere = prepared.sphere(object);
        block_by_sphere(sphere.center, sphere.radius * sphere.radius, rays.origin.from(range.first),
                        rays.direction.from(range.first), rays.distance + range.first,
                        range.last - range.first, visible.data() + range.first);
    }
}

bool translucent_shape(const PreparedScene& prepared, const Vec3& origin, const Vec3& direction,
                       double nearest, Hit& hit) {
    bool found = false;
    const auto offer = [&](Index object, const Crossings& crossings) {
        for (int k = 0; k < crossings.count; ++k) {
            const double t = crossings.t[std::size_t(k)];
            if (!(t > nearest && t < hit.t)) continue;
            hit = {t, object, no_index};
            found = true;
        }
    };
    for (const Index object : prepared.translucent_shapes)
        offer(object, object >= prepared.first_plane()
                          ? cross_plane(prepared.plane(object), origin, direction)
                          : cross_sphere(prepared.sphere(object), origin, direction));
    return found;
}

}  // namespace penumbra
