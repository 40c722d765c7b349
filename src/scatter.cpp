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

// Crosses the surface of `object` and returns the ratio of indices outside / inside, as POV-Ray
// does (source/backend/render/trace.cpp of 3.7, ComputeRefraction): only leaving the object that
// was entered last bends the ray.
double cross(const World& world, Interiors& inside, Index object) {
    const double own = world.finish_of(object).ior;
    const auto index_of = [&](std::uint32_t depth) {
        return depth == 0 ? 1.0 : world.finish_of(inside.objects[depth - 1]).ior;
    };
    const bool last = inside.count > 0 && inside.objects[inside.count - 1] == object;
    const double around = index_of(inside.count);
    if (inside.toggle(object)) return around / own;
    return last ? own / index_of(inside.count) : 1;
}

// The index of refraction behind the surface over that before it, as POV-Ray sees it when it asks
// for Fresnel's term (source/backend/render/trace.cpp of 3.7, ComputeRelativeIOR).
double relative_index(const World& world, const Interiors& inside, Index object) {
    const double own = world.finish_of(object).ior;
    if (inside.count == 0) return own;
    const double last = world.finish_of(inside.objects[inside.count - 1]).ior;
    if (!inside.contains(object)) return own / last;
    return inside.count == 1 ? 1 / own : last / own;
}

// Fresnel's reflectance of unpolarised light that comes in at the angle of `cosine`.
double fresnel_reflectance(double index, double cosine) {
    const double square = index * index + cosine * cosine - 1;
    if (square <= 0) return 1;
    const double g = std::sqrt(square), sum = g + cosine, difference = g - cosine;
    const double a = difference / sum;
    const double b = (cosine * sum - 1) / (cosine * difference + 1);
    return std::clamp(0.5 * a * a * (1 + b * b), 0.0, 1.0);
}

// What the lobes of the surface point reflect, in its tint.
Vec3 mirrored_share(const Surfaces& surfaces, std::size_t slot) {
    const Finish& finish = *surfaces.finish[slot];
    const LobeMix& mix = surfaces.lobes[slot];
    Vec3 share = finish.lobes[mix.first].reflection;
    if (mix.share > 0)
        share = share * (1 - mix.share) + finish.lobes[mix.first + 1].reflection * mix.share;
    if (finish.metallic > 0)
        share *= metallic_tint(finish.metallic, -surfaces.view[slot].dot(surfaces.normal[slot]),
                               surfaces.tint[slot]);
    return share;
}

// Pushes the ray that goes on behind the surface. Returns whether it is reflected totally instead.
bool transmit(const World& world, const Surfaces& surfaces, std::size_t slot, const Path& path,
              Generation& next) {
    const Finish& finish = *surfaces.finish[slot];
    const Vec3 view = surfaces.view[slot], normal = surfaces.normal[slot];
    const Vec3 position = surfaces.position[slot];
    Vec3 left(1);  // of the light on its way inside of the object that is left or not entered
    if (finish.absorbs && path.inside.contains(surfaces.object[slot]))
        for (int c = 0; c < 3; ++c)
            left[c] = std::exp(-finish.absorption[c] * surfaces.depth[slot]);
    Path through = path;
    const double ratio = cross(world, through.inside, surfaces.object[slot]);
    const double cosine = -view.dot(normal);
    const double rest = 1 + ratio * ratio * (cosine * cosine - 1);
    if (std::abs(ratio - 1) < least_cosine) {
        through.weight *= surfaces.through[slot] * left;
        next.push(position, view, through);
        return false;
    }
    if (rest >= 0) {
        through.weight *= surfaces.through[slot] * left;
        ++through.level;
        const Vec3 bent = view * ratio + normal * (ratio * cosine - std::sqrt(rest));
        next.push(position, bent.normalized(), through);
        return false;
    }
    // POV-Ray does not filter what is reflected totally; a gap in the coverage reflects as well.
    const double share = finish.opacity < 1 ? 1 : 1 - surfaces.coverage[slot];
    Path back = path;
    ++back.level;
    back.weight *= left * share;
    next.push(position, surfaces.mirrored[slot].normalized(), back);
    return true;
}

}  // namespace

void scatter(const World& world, const Surfaces& surfaces, std::size_t slot, const Path& path,
             int max_depth, Generation& next) {
    if (path.level >= max_depth) return;
    const Finish& finish = *surfaces.finish[slot];
    const Vec3 position = surfaces.position[slot];
    const double coverage = surfaces.coverage[slot];
    bool total = false;  // internal reflection
    if (!finish.opaque && surfaces.through[slot] != Vec3(0))
        total = transmit(world, surfaces, slot, path, next);
    // Where the surface itself is opaque POV-Ray looks for no total reflection.
    if (!finish.mirrors || coverage == 0 || (total && finish.opacity < 1)) return;
    Vec3 share = mirrored_share(surfaces, slot) * coverage;
    if (finish.fresnel)
        share *= fresnel_reflectance(relative_index(world, path.inside, surfaces.object[slot]),
                                     -surfaces.view[slot].dot(surfaces.normal[slot]));
    Path back = path;
    ++back.level;
    back.weight *= share;
    next.push(position, surfaces.mirrored[slot].normalized(), back);
}

namespace {

// Does a ray from `eye` leave the mesh through one facet more than it enters? The ray goes along
// the inside_vector that the exporter writes: POV-Ray asks the same question.
bool encloses(const PlacedMesh& placed, const Vec3& eye) {
    const Vec3 start = placed.point_to_mesh(eye), ray = Vec3(0.1, 1, 0.05).normalized();
    const Mesh& mesh = *placed.mesh;
    bool odd = false;
    for (const auto& [a, b, c] : mesh.triangles) {
        // The ray's coordinates in the facet (Moeller and Trumbore 1997).
        const Vec3 origin(mesh.positions[a]);
        const Vec3 u = Vec3(mesh.positions[b]) - origin, v = Vec3(mesh.positions[c]) - origin;
        const Vec3 p = ray.cross(v), w = start - origin, q = w.cross(u);
        const double scale = 1 / u.dot(p), s = w.dot(p) * scale, t = ray.dot(q) * scale;
        if (s >= 0 && t >= 0 && s + t <= 1 && v.dot(q) * scale > 0) odd = !odd;
    }
    return odd;
}

}  // namespace

Interiors interiors_at(const World& world, const Vec3& eye) {
    Interiors inside;
    if (!world.translucent) return inside;
    const Scene& scene = world.scene;
    for (Index i = 0; i < world.first_sphere(); ++i)
        if (!world.finish_of(i).opaque && encloses(world.facets.placed(i), eye)) inside.toggle(i);
    for (std::size_t i = 0; i < scene.spheres.size(); ++i)
        if ((eye - scene.spheres[i].center).length() < scene.spheres[i].radius)
            inside.toggle(world.first_sphere() + Index(i));
    // The inside of a plane is the side that its normal points away from.
    for (std::size_t i = 0; i < world.planes.size(); ++i)
        if (world.planes[i].frame.normal.dot(eye) < world.planes[i].distance)
            inside.toggle(world.first_plane() + Index(i));
    return inside;
}

}  // namespace penumbra
