#include "scatter.h"

#include "lighting.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

void Generation::push(const Vec3& origin, const Vec3& direction, const Path& path) {
    const std::size_t i = rays.count++;
    if (i >= paths.size()) {
        const std::size_t capacity = std::max<std::size_t>(64, 2 * i);
        rays.origin.resize(capacity);
        rays.direction.resize(capacity);
        paths.resize(capacity);
    }
    rays.origin.set(i, origin);
    rays.direction.set(i, direction);
    paths[i] = path;
}

namespace {

void enter(Interiors& inside, Index object) {
    if (inside.count < inside.objects.size()) inside.objects[inside.count++] = object;
}

// Crosses the surface of `object` and returns the ratio of indices outside / inside, as POV-Ray
// does (source/backend/render/trace.cpp of 3.7, ComputeRefraction): only leaving the object that
// was entered last bends the ray.
double cross(const World& world, Interiors& inside, Index object) {
    const double own = world.finish_of(object).ior;
    const auto index_of = [&](std::uint32_t depth) {
        return depth == 0 ? 1.0 : world.finish_of(inside.objects[depth - 1]).ior;
    };
    const auto end = inside.objects.begin() + inside.count;
    const auto found = std::find(inside.objects.begin(), end, object);
    if (found == end) {
        const double ratio = index_of(inside.count) / own;
        enter(inside, object);
        return ratio;
    }
    const bool last = found + 1 == end;
    const double ratio = last ? own / index_of(inside.count - 1) : 1;
    std::copy(found + 1, end, found);
    --inside.count;
    return ratio;
}

}  // namespace

void scatter(const World& world, const Surfaces& surfaces, std::size_t slot, const Path& path,
             int max_depth, Generation& next) {
    const Finish& finish = *surfaces.finish[slot];
    const Vec3 view = surfaces.view[slot], normal = surfaces.normal[slot];
    const Vec3 position = surfaces.position[slot];
    const bool deeper = path.level < max_depth;
    if (!deeper) return;

    bool total = false;
    if (finish.opacity < 1) {
        Path through = path;
        const double ratio = cross(world, through.inside, surfaces.object[slot]);
        const double cosine = -view.dot(normal);
        const double rest = 1 + ratio * ratio * (cosine * cosine - 1);
        total = rest < 0;
        if (std::abs(ratio - 1) < least_cosine) {
            through.weight *= 1 - finish.opacity;
            next.push(position, view, through);
        } else if (!total) {
            through.weight *= 1 - finish.opacity;
            ++through.level;
            const Vec3 bent = view * ratio + normal * (ratio * cosine - std::sqrt(rest));
            next.push(position, bent.normalized(), through);
        } else {
            Path back = path;
            ++back.level;
            next.push(position, surfaces.mirrored[slot].normalized(), back);
        }
    }
    if (finish.mirrors && !total) {
        Path back = path;
        ++back.level;
        Vec3 share = finish.reflection;
        if (finish.metallic > 0)
            share *= metallic_tint(finish.metallic, -view.dot(normal), surfaces.pigment[slot]);
        back.weight *= share;
        next.push(position, surfaces.mirrored[slot].normalized(), back);
    }
}

Interiors interiors_at(const World& world, const Vec3& eye) {
    Interiors inside;
    if (!world.translucent) return inside;
    const Scene& scene = world.scene;
    for (std::size_t i = 0; i < scene.spheres.size(); ++i)
        if ((eye - scene.spheres[i].center).length() < scene.spheres[i].radius)
            enter(inside, world.first_sphere() + Index(i));
    // The inside of a plane is the side that its normal points away from.
    for (std::size_t i = 0; i < world.planes.size(); ++i)
        if (world.planes[i].frame.normal.dot(eye) < world.planes[i].distance)
            enter(inside, world.first_plane() + Index(i));
    return inside;
}

}  // namespace penumbra
