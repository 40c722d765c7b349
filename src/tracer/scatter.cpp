#include "tracer/scatter.h"

#include "tracer/direct_light.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

// POV-Ray keeps indices in float32 and divides two of them as such
// (source/backend/interior/interior.h of 3.7); that of the air is a double.
double ratio(double a, double b) { return double(float(a) / float(b)); }

// Crosses the surface of `object` and returns the ratio of indices outside / inside, as POV-Ray
// does (source/backend/render/trace.cpp of 3.7, ComputeRefraction): only leaving the object that
// was entered last bends the ray.
double cross_boundary(const PreparedScene& prepared, Media& media, MediumStack& inside,
                      Index object) {
    const auto index_of = [&](Index o) { return prepared.material_of(o).ior; };
    const double own = index_of(object);
    const bool in_air = inside.count() == 0;
    const Index around = in_air ? no_index : inside.last();
    if (media.toggle(inside, object)) return in_air ? 1 / own : ratio(index_of(around), own);
    if (around != object) return 1;
    return inside.count() == 0 ? own : ratio(own, index_of(inside.last()));
}

// The index of refraction behind the surface over that before it, as POV-Ray sees it when it asks
// for Fresnel's term (source/backend/render/trace.cpp of 3.7, ComputeRelativeIOR).
double relative_index(const PreparedScene& prepared, const MediumStack& inside, Index object) {
    const double own = prepared.material_of(object).ior;
    if (inside.count() == 0) return own;
    const double last = prepared.material_of(inside.last()).ior;
    if (!inside.contains(object)) return ratio(own, last);
    return inside.count() == 1 ? 1 / own : ratio(last, own);
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
Vec3 mirrored_share(const SurfacePoints& surfaces, std::size_t slot) {
    const PreparedMaterial& material = *surfaces.material[slot];
    const LobeMix& mix = surfaces.lobes[slot];
    Vec3 share = material.lobes[mix.first].reflection;
    if (mix.share > 0)
        share = share * (1 - mix.share) + material.lobes[mix.first + 1].reflection * mix.share;
    if (material.metallic > 0)
        share *= metallic_tint(material.metallic, -surfaces.view[slot].dot(surfaces.normal[slot]),
                               surfaces.tint[slot]);
    return share;
}

// Pushes the ray that goes on behind the surface. Returns whether it is reflected totally instead.
bool transmit(const PreparedScene& prepared, const SurfacePoints& surfaces, std::size_t slot,
              const Path& path, Onward onward) {
    const PreparedMaterial& material = *surfaces.material[slot];
    const Vec3 view = surfaces.view[slot], normal = surfaces.normal[slot];
    const Vec3 position = surfaces.position[slot];
    Vec3 left(1);  // of the light on its way inside of the object that is left or not entered
    if (material.absorbs && path.inside.contains(surfaces.object[slot]))
        for (int c = 0; c < 3; ++c)
            left[c] = std::exp(-material.absorption[c] * surfaces.depth[slot]);
    Path through = path;
    const double ratio =
        cross_boundary(prepared, onward.media, through.inside, surfaces.object[slot]);
    const double cosine = -view.dot(normal);
    const double rest = 1 + ratio * ratio * (cosine * cosine - 1);
    if (std::abs(ratio - 1) < least_cosine) {
        through.weight *= surfaces.transmittance[slot] * left;
        onward.next.push(position, view, through);
        return false;
    }
    if (rest >= 0) {
        through.weight *= surfaces.transmittance[slot] * left;
        ++through.level;
        const Vec3 bent = view * ratio + normal * (ratio * cosine - std::sqrt(rest));
        onward.next.push(position, bent.normalized(), through);
        return false;
    }
    // POV-Ray does not filter what is reflected totally; a gap in the coverage reflects as well.
    const double share = material.opacity < 1 ? 1 : 1 - surfaces.alpha[slot];
    Path back = path;
    ++back.level;
    back.mirrored = true;
    back.weight *= left * share;
    onward.next.push(position, surfaces.reflected[slot].normalized(), back);
    return true;
}

}  // namespace

void scatter(const PreparedScene& prepared, const SurfacePoints& surfaces, std::size_t slot,
             const Path& path, Onward onward) {
    if (path.level >= onward.max_depth) return;
    const PreparedMaterial& material = *surfaces.material[slot];
    const Vec3 position = surfaces.position[slot];
    const double alpha = surfaces.alpha[slot];
    bool total = false;  // internal reflection
    if ((!material.opaque || alpha == 0) && surfaces.transmittance[slot] != Vec3(0))
        total = transmit(prepared, surfaces, slot, path, onward);
    // Where the surface itself is opaque POV-Ray looks for no total reflection.
    if (!material.mirrors || alpha == 0 || (total && material.opacity < 1)) return;
    Vec3 share = mirrored_share(surfaces, slot) * alpha;
    if (material.fresnel)
        share *= fresnel_reflectance(relative_index(prepared, path.inside, surfaces.object[slot]),
                                     -surfaces.view[slot].dot(surfaces.normal[slot]));
    Path back = path;
    ++back.level;
    back.mirrored = true;
    back.weight *= share;
    onward.next.push(position, surfaces.reflected[slot].normalized(), back);
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

MediumStack media_at(const PreparedScene& prepared, const Vec3& eye, Media& media) {
    MediumStack inside;
    if (!prepared.bends) return inside;
    const Scene& scene = prepared.scene;
    // Where the eye is out of reach of all facets there are none.
    for (Index i = 0; i < prepared.first_sphere() && !prepared.facets->empty(); ++i)
        if (prepared.material_of(i).passes && encloses(prepared.facets->placed(i), eye))
            media.toggle(inside, i);
    for (std::size_t i = 0; i < scene.spheres.size(); ++i)
        if ((eye - scene.spheres[i].center).length() < scene.spheres[i].radius)
            media.toggle(inside, prepared.first_sphere() + Index(i));
    // The inside of a plane is the side that its normal points away from.
    for (std::size_t i = 0; i < prepared.planes.size(); ++i)
        if (prepared.planes[i].frame.normal.dot(eye) < prepared.planes[i].distance)
            media.toggle(inside, prepared.first_plane() + Index(i));
    return inside;
}

}  // namespace penumbra
