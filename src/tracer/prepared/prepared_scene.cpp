#include "tracer/prepared/prepared_scene.h"

#include "scene/surface/vertex_textures.h"
#include "tracer/prepared/scene_boxes.h"

#include "penumbra/light_model.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

PreparedLobe prepare(const SpecularLobe& lobe, int mirrors) {
    // cos^N < 1e-9 changes no picture.
    PreparedLobe prepared = {
        .specular = std::max(0.0F, lobe.specular),
        .shininess = lobe.shininess,
        .highlight_end = lobe.shininess > 0 ? std::pow(1e-9, 1 / double(lobe.shininess)) : 0,
        .reflection = Vec3(lobe.reflection)};
    prepared.mirrors.clear();
    for (const VirtualMirror& mirror : virtual_mirrors(lobe.roughness, mirrors))
        prepared.mirrors.push_back(mirror.offset);
    return prepared;
}

PreparedCoat prepare(const Coat& coat, bool opaque) {
    const SpecularLobe lobe = {.specular = coat.specular,
                               .shininess = coat.shininess,
                               .reflection = Color(coat.reflection),
                               .roughness = coat.roughness};
    return {.lobe = prepare(lobe, opaque ? coat.mirrors : 1),
            .grazing = coat.grazing,
            .takes_reflected = opaque && mirrors(coat)};
}

PreparedMaterial prepare(const Material& m, const Color& ambient_light) {
    PreparedMaterial f = {.source = &m,
                          .ambient = Vec3(m.ambient) * Vec3(ambient_light),
                          .emission = Vec3(m.emission),
                          .diffuse = std::max(0.0F, m.diffuse),
                          .metallic = m.metallic,
                          .highlight_metallic = m.specular_color ? 1 : double(m.metallic),
                          .opacity = m.opacity,
                          .transmission = m.transmission,
                          // An opaque surface has no inside, but for its Fresnel term.
                          .ior = opaque(m) && !m.fresnel ? 1 : m.ior,
                          .opaque = opaque(m),
                          .absorbs = m.absorption.has_value() && !opaque(m),
                          .fresnel = m.fresnel,
                          .passes = !opaque(m) || m.sides == Sides::front,
                          .textured = std::holds_alternative<ImageMap>(m.pattern)};
    f.blurs = blurs(m);
    f.frosts = frosts(m);
    f.conserves = takes_reflected(m);
    const int mirrors = f.blurs || f.frosts ? m.mirrors : 1;
    if (m.specular_lobes)
        for (const SpecularLobe& lobe : m.specular_lobes->lobes)
            f.lobes.push_back(prepare(lobe, mirrors));
    else
        f.lobes = {prepare({.specular = m.specular,
                            .shininess = m.shininess,
                            .reflection = m.reflection,
                            .roughness = m.roughness},
                           mirrors)};
    for (const PreparedLobe& lobe : f.lobes) {
        f.shines |= lobe.specular > 0;
        f.mirrors |= lobe.reflection != Vec3(0);
    }
    if (m.coat) {
        f.coat = prepare(*m.coat, m.opacity >= 1);
        f.shines |= m.coat->specular > 0;
    }
    if (covers(m)) f.sheen = {.cover = sheen_cover(*m.sheen), .tint = Vec3(sheen_tint(*m.sheen))};
    f.takes_reflected = f.conserves || f.sheen || (f.coat && f.coat->takes_reflected);
    f.backlit = m.diffuse_transmission != Color(0);
    if (m.blend)
        f.other = std::make_shared<PreparedMaterial>(prepare(m.blend->other[0], ambient_light));
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

Bounds surroundings_of(const BoxTree& facet_boxes, const BoxTree& sphere_boxes) {
    Bounds box;
    for (const BoxTree* tree : {&facet_boxes, &sphere_boxes}) {
        if (tree->nodes.empty()) continue;
        box.extend(tree->nodes[0].box.min);
        box.extend(tree->nodes[0].box.max);
    }
    if (box.empty()) return {.min = Vec3(-1), .max = Vec3(1)};
    const Vec3 center = box.center(), size = box.max - box.min + Vec3(1e-3);  // not flat
    return {.min = center - size, .max = center + size};
}

}  // namespace

std::vector<SourceGroup> source_groups(const std::vector<Light>& lights,
                                       const std::vector<PreparedPlane>& planes) {
    std::vector<SourceGroup> groups;
    for (const Light& light : lights) {
        SourceGroup& group = groups.emplace_back();
        for (const Source& source : virtual_sources(light)) {
            group.sources.push_back(prepare(source));
            group.box.extend(source.position);
        }
        for (const PreparedPlane& plane : planes) {
            Extent& extent = group.along.emplace_back(Extent{no_hit, -no_hit});
            for (const PreparedSource& source : group.sources) {
                const double along = plane.frame.normal.dot(source.position);
                extent.low = std::min(extent.low, along);
                extent.high = std::max(extent.high, along);
            }
        }
    }
    return groups;
}

PreparedScene::PreparedScene(const Scene& given, const PreparedScene* earlier, bool instances_move)
    : scene(given), facets(std::make_shared<FacetAccel>(
                        given, earlier ? earlier->facets.get() : nullptr, instances_move)),
      facet_boxes(earlier && facets->same_trees(*earlier->facets)
                      ? earlier->facet_boxes
                      : std::make_shared<BoxTree>(boxes_of_facets(given))),
      translucent_boxes(boxes_of_translucent_facets(given)), sphere_boxes(boxes_of_spheres(given)),
      surroundings(surroundings_of(*facet_boxes, sphere_boxes)) {
    for (const Material& m : scene.materials) {
        materials.push_back(prepare(m, scene.ambient));
        translucent |= !opaque(m);
        const PreparedMaterial& made = materials.back();
        backlit |= made.backlit || (made.other && made.other->backlit);
        blended |= made.other != nullptr;
        bends |= made.passes && (made.ior != 1 || made.absorbs);
    }
    for (const Mesh& mesh : scene.meshes) {
        const PreparedMaterial& material = materials[mesh.material];
        own_textures.push_back((material.blurs || material.frosts) &&
                               vertex_textures(mesh, *material.source).any());
    }
    for (const Texture& t : scene.textures) textures.emplace_back(t);
    for (const Plane& plane : scene.planes) {
        const PlaneFrame frame = plane_frame(plane);
        planes.push_back({frame, frame.normal.dot(plane.point)});
    }
    lights = source_groups(scene.lights, planes);
    for (Index object = first_sphere(); object < objects(); ++object)
        if (!material_of(object).opaque && casts_shadow(object))
            translucent_shapes.push_back(object);
}

}  // namespace penumbra
