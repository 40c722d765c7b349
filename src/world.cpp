#include "world.h"

#include "blockers.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

PreparedLobe prepare(const Lobe& lobe) {
    // cos^N < 1e-9 changes no picture.
    return {.specular = std::max(0.0F, lobe.specular),
            .shininess = lobe.shininess,
            .highlight_end = lobe.shininess > 0 ? std::pow(1e-9, 1 / double(lobe.shininess)) : 0,
            .reflection = Vec3(lobe.reflection)};
}

Finish prepare(const Material& m, const Color& ambient_light) {
    Finish f = {.material = &m,
                .ambient = Vec3(m.ambient) * Vec3(ambient_light),
                .emission = Vec3(m.emission),
                .diffuse = std::max(0.0F, m.diffuse),
                .metallic = m.metallic,
                .opacity = m.opacity,
                .transmission = m.transmission,
                .ior = m.ior,
                .opaque = opaque(m),
                .absorbs = m.absorption.has_value() && !opaque(m),
                .fresnel = m.fresnel,
                .textured = std::holds_alternative<ImageMap>(m.pattern)};
    if (m.gloss)
        for (const Lobe& lobe : m.gloss->lobes) f.lobes.push_back(prepare(lobe));
    else
        f.lobes = {prepare(
            {.specular = m.specular, .shininess = m.shininess, .reflection = m.reflection})};
    for (const PreparedLobe& lobe : f.lobes) {
        f.shines |= lobe.specular > 0;
        f.mirrors |= lobe.reflection != Vec3(0);
    }
    if (m.absorption) f.absorption = fade_exponent(*m.absorption);
    return f;
}

PreparedSource prepare(const Source& s) {
    PreparedSource p = {.type = s.type,
                        .position = s.position,
                        .axis = (s.point_at - s.position).normalized(),
                        .color = Vec3(s.color),
                        .cos_inner = std::cos(s.inner),
                        .cos_outer = std::cos(s.outer)};
    if (s.attenuation) {
        p.fades = true;
        p.fade_distance = s.attenuation->distance;
        p.fade_power = s.attenuation->power;
    }
    return p;
}

Bounds surroundings_of(const World& world) {
    Bounds box;
    for (const BoxTree* tree : {&world.facet_boxes, &world.sphere_boxes}) {
        if (tree->nodes.empty()) continue;
        box.extend(tree->nodes[0].box.min);
        box.extend(tree->nodes[0].box.max);
    }
    if (box.empty()) return {.min = Vec3(-1), .max = Vec3(1)};
    const Vec3 center = box.center(), size = box.max - box.min + Vec3(1e-3);  // not flat
    return {.min = center - size, .max = center + size};
}

}  // namespace

World::World(const Scene& given)
    : scene(given), facets(given), facet_boxes(boxes_of_facets(given)),
      sphere_boxes(boxes_of_spheres(given)) {
    for (const Material& m : scene.materials) {
        finishes.push_back(prepare(m, scene.ambient));
        translucent |= !opaque(m);
    }
    for (const Texture& t : scene.textures) samplers.push_back(make_sampler(t));
    for (const Light& light : scene.lights) {
        SourceGroup& group = lights.emplace_back();
        for (const Source& source : virtual_sources(light)) {
            group.sources.push_back(prepare(source));
            group.box.extend(source.position);
        }
    }
    for (const Plane& plane : scene.planes) {
        const PlaneFrame frame = plane_frame(plane);
        planes.push_back({frame, frame.normal.dot(plane.point)});
    }
    for (SourceGroup& light : lights)
        for (const PreparedPlane& plane : planes) {
            Extent& extent = light.along.emplace_back(Extent{no_hit, -no_hit});
            for (const PreparedSource& source : light.sources) {
                const double along = plane.frame.normal.dot(source.position);
                extent.low = std::min(extent.low, along);
                extent.high = std::max(extent.high, along);
            }
        }
    surroundings = surroundings_of(*this);
    const Index objects = first_plane() + Index(planes.size());
    for (Index object = first_sphere(); object < objects; ++object)
        if (!finish_of(object).opaque) translucent_shapes.push_back(object);
}

Index World::material_of(Index object) const {
    if (object < first_sphere()) return scene.meshes[scene.instances[object].mesh].material;
    if (object < first_plane()) return scene.spheres[object - first_sphere()].material;
    return scene.planes[object - first_plane()].material;
}

}  // namespace penumbra
