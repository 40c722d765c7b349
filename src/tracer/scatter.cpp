#include "tracer/scatter.h"

#include "tracer/mirrors.h"

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
                      Index medium) {
    const auto index_of = [&](Index o) { return prepared.material_in(o).ior; };
    const double own = index_of(medium);
    const bool in_air = inside.count() == 0;
    const Index around = in_air ? no_index : inside.last();
    if (media.toggle(inside, medium)) return in_air ? 1 / own : ratio(index_of(around), own);
    if (around != medium) return 1;
    return inside.count() == 0 ? own : ratio(own, index_of(inside.last()));
}

// The index of refraction behind the surface over that before it, as POV-Ray sees it when it asks
// for Fresnel's term (source/backend/render/trace.cpp of 3.7, ComputeRelativeIOR).
double relative_index(const PreparedScene& prepared, const MediumStack& inside, Index medium) {
    const double own = prepared.material_in(medium).ior;
    if (inside.count() == 0) return own;
    const double last = prepared.material_in(inside.last()).ior;
    if (!inside.contains(medium)) return ratio(own, last);
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

// The view mirrored by a displaced normal as POV-Ray does it (source/backend/render/trace.cpp of
// 3.7, ComputeReflection): what would go into the surface is mirrored once more, by the normal that
// was not displaced.
Vec3 mirrored_by(const Vec3& view, const Vec3& displaced, const Vec3& normal) {
    const Vec3 reflected = view - displaced * (2 * view.dot(displaced));
    const double depth = reflected.dot(normal);
    if (depth >= 0) return reflected;
    if (reflected.dot(displaced) < 0) return view - normal * (2 * view.dot(normal));
    return reflected - normal * (2 * depth);
}

// A surface point, the path that reached it, and where it goes on.
struct Meeting {
    const PreparedScene& prepared;
    const SurfacePoints& surfaces;
    std::size_t slot;
    const Path& path;
    Onward onward;

    const PreparedMaterial& material() const { return *surfaces.material[slot]; }
    Vec3 displaced(const Vec3& offset) const {
        return displaced_normal(prepared, surfaces.object[slot], surfaces.normal[slot], offset);
    }
    // The view mirrored by a displaced normal.
    Vec3 mirrored(const Vec3& by) const {
        return mirrored_by(surfaces.view[slot], by, surfaces.normal[slot]);
    }
};

// Pushes the ray that goes on behind the surface, bent by `normal`, and the part `share` of it.
// Returns whether it is reflected totally instead.
bool transmit(const Meeting& at, const Vec3& normal, double share = 1) {
    const auto& [prepared, surfaces, slot, path, onward] = at;
    const PreparedMaterial& material = at.material();
    const Vec3 view = surfaces.view[slot], position = surfaces.position[slot];
    const Index medium = prepared.medium_of(surfaces.object[slot], path.mirrored);
    Vec3 left(share);  // of the light on its way inside of the object that is left or not entered
    if (material.absorbs && path.inside.contains(medium))
        for (int c = 0; c < 3; ++c)
            left[c] *= std::exp(-material.absorption[c] * surfaces.depth[slot]);
    Path through = path;
    const double ratio = cross_boundary(prepared, onward.media, through.inside, medium);
    // A displaced normal may point away from the eye.
    const double facing = -view.dot(normal), cosine = std::abs(facing);
    const double rest = 1 + ratio * ratio * (cosine * cosine - 1);
    if (std::abs(ratio - 1) < least_cosine) {
        through.weight *= surfaces.transmittance[slot] * left;
        onward.next.push(position, view, through);
        return false;
    }
    if (rest >= 0) {
        through.weight *= surfaces.transmittance[slot] * left;
        ++through.level;
        const Vec3 to_eye = facing < 0 ? -normal : normal;
        const Vec3 bent = view * ratio + to_eye * (ratio * cosine - std::sqrt(rest));
        onward.next.push(position, bent.normalized(), through);
        return false;
    }
    // POV-Ray does not filter what is reflected totally; a hole of the alpha map reflects as well.
    const double there = material.opacity < 1 ? 1 : 1 - surfaces.alpha[slot];
    Path back = path;
    ++back.level;
    back.mirrored = true;
    back.weight *= left * there;
    onward.next.push(position, at.mirrored(normal).normalized(), back);
    return true;
}

void send_back(const Meeting& at, const Vec3& direction, const Vec3& share) {
    if (share == Vec3(0)) return;
    Path back = at.path;
    ++back.level;
    back.mirrored = true;
    back.weight *= share * at.surfaces.alpha[at.slot];
    at.onward.next.push(at.surfaces.position[at.slot], direction.normalized(), back);
}

// One mirror; `share` as by its material alone.
void reflect(const Meeting& at, const Vec3& normal, Vec3 share, const Vec3& direction) {
    const double cosine = -at.surfaces.view[at.slot].dot(normal);
    share *= tint_of_mirror(at.surfaces, at.slot, cosine);
    if (at.material().fresnel) {
        const Index medium = at.prepared.medium_of(at.surfaces.object[at.slot], at.path.mirrored);
        share *= fresnel_reflectance(relative_index(at.prepared, at.path.inside, medium), cosine);
    }
    send_back(at, direction, share);
}

// The mirrors of the coat.
void reflect_coat(const Meeting& at) {
    const PreparedCoat& coat = *at.material().coat;
    const Vec3 view = at.surfaces.view[at.slot], normal = at.surfaces.normal[at.slot];
    if (at.path.mirrored)
        return send_back(at, at.mirrored(normal), Vec3(coat_reflectance(coat, -view.dot(normal))));
    for (const Vec3& offset : coat.lobe.mirrors) {
        const Vec3 by = at.displaced(offset);
        send_back(at, at.mirrored(by),
                  Vec3(coat_reflectance(coat, -view.dot(by)) / double(coat.lobe.mirrors.size())));
    }
}

// Every virtual mirror of a lobe, which counts as much as `share`.
void reflect_by(const Meeting& at, const PreparedLobe& lobe, double share) {
    if (share == 0 || lobe.reflection == Vec3(0)) return;
    const Vec3 each = lobe.reflection * (share / double(lobe.mirrors.size()));
    for (const Vec3& offset : lobe.mirrors) {
        const Vec3 by = at.displaced(offset);
        reflect(at, by, each, at.mirrored(by));
    }
}

// Glass that blurs: each of its mirrors bends a part of the light and reflects it.
void frost(const Meeting& at) {
    const PreparedLobe& lobe = at.material().lobes[0];
    const double share = 1 / double(lobe.mirrors.size());
    for (const Vec3& offset : lobe.mirrors) {
        const Vec3 by = at.displaced(offset);
        if (!transmit(at, by, share)) reflect(at, by, lobe.reflection * share, at.mirrored(by));
    }
}

}  // namespace

void scatter(const PreparedScene& prepared, const SurfacePoints& surfaces, std::size_t slot,
             const Path& path, Onward onward) {
    if (path.level >= onward.max_depth) return;
    const PreparedMaterial& material = *surfaces.material[slot];
    const double alpha = surfaces.alpha[slot];
    const Meeting at = {prepared, surfaces, slot, path, onward};
    if (material.frosts && surfaces.front[slot] != 0 && alpha > 0 &&
        prepared.frosts(surfaces.object[slot]))
        return frost(at);
    bool total = false;  // internal reflection
    if ((!material.opaque || alpha == 0) && surfaces.transmittance[slot] != Vec3(0))
        total = transmit(at, surfaces.normal[slot]);
    // Where the surface itself is opaque POV-Ray looks for no total reflection.
    if (alpha == 0 || (total && material.opacity < 1)) return;
    if (material.coat) reflect_coat(at);
    if (!material.mirrors) return;
    const LobeMix& mix = surfaces.lobes[slot];
    if (!material.blurs || path.mirrored)
        return reflect(at, surfaces.normal[slot], reflection_of(material, mix),
                       surfaces.reflected[slot]);
    reflect_by(at, material.lobes[mix.first], 1 - mix.share);
    if (mix.share > 0) reflect_by(at, material.lobes[mix.first + 1], mix.share);
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
    const auto enter = [&](Index object) {
        media.toggle(inside, object);
        const Index twin = prepared.medium_of(object, true);
        if (twin != object) media.toggle(inside, twin);
    };
    // Where the eye is out of reach of all facets there are none. What rays may go on behind has an
    // interior in the export.
    for (Index i = 0; i < prepared.first_sphere() && !prepared.facets->empty(); ++i) {
        const PlacedMesh& placed = prepared.facets->placed(i);
        if ((!prepared.material_of(i).opaque || placed.backs.hidden) && encloses(placed, eye))
            enter(i);
    }
    for (std::size_t i = 0; i < scene.spheres.size(); ++i)
        if ((eye - scene.spheres[i].center).length() < scene.spheres[i].radius)
            enter(prepared.first_sphere() + Index(i));
    // The inside of a plane is the side that its normal points away from.
    for (std::size_t i = 0; i < prepared.planes.size(); ++i)
        if (prepared.planes[i].frame.normal.dot(eye) < prepared.planes[i].distance)
            enter(prepared.first_plane() + Index(i));
    return inside;
}

}  // namespace penumbra
