#include "surface.h"

#include "noise.h"
#include "normal_map.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

void Surfaces::resize(std::size_t capacity) {
    for (Vectors* vectors :
         {&position, &normal, &view, &mirrored, &facet_normal, &pigment, &tint, &own, &through})
        vectors->resize(capacity);
    diffuse.resize(capacity);
    coverage.resize(capacity);
    depth.resize(capacity);
    lobes.resize(capacity);
    object.resize(capacity);
    finish.resize(capacity);
    inside.resize(capacity);
}

namespace {

// What the geometry says of a point, before the material is asked.
struct Geometry {
    Vec3 normal = {}, facet_normal = {};
    Vec2 texcoord = {};
    Vec3 vertex_color = Vec3(1);
    double vertex_alpha = 1;
};

// Normals that are all but equal make a flat facet: POV-Ray then ignores them
// (source/backend/parser/parse.cpp of 3.7, Parse_Mesh2).
bool nearly_equal(const Vec3f& a, const Vec3f& b) {
    const Vec3 difference = Vec3(a) - Vec3(b);
    return difference.dot(difference) <= 1e-10;
}

Vec3 barycentric(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
    const Vec3 e1 = b - a, e2 = c - a, w = p - a;
    const double d11 = e1.dot(e1), d12 = e1.dot(e2), d22 = e2.dot(e2);
    const double w1 = w.dot(e1), w2 = w.dot(e2), scale = 1 / (d11 * d22 - d12 * d12);
    const double b1 = (d22 * w1 - d12 * w2) * scale, b2 = (d11 * w2 - d12 * w1) * scale;
    return {1 - b1 - b2, b1, b2};
}

Geometry on_facet(const World& world, const Hit& hit, const Vec3& point) {
    const PlacedMesh& placed = world.facets.placed(hit.object);
    const Mesh& mesh = *placed.mesh;
    const auto& [a, b, c] = mesh.triangles[hit.facet];
    const Vec3 weights = barycentric(Vec3(mesh.positions[a]), Vec3(mesh.positions[b]),
                                     Vec3(mesh.positions[c]), placed.point_to_mesh(point));
    const auto interpolate = [&](const auto& values) {
        return Vec3(values[a]) * weights.x + Vec3(values[b]) * weights.y +
               Vec3(values[c]) * weights.z;
    };
    const Material& material = world.scene.materials[mesh.material];
    Geometry g;
    const Vec3 flat = facet_plane(mesh, hit.facet).normal;
    g.facet_normal = placed.normal_to_world(flat).normalized();
    g.normal = g.facet_normal;
    if (placed.smooth && !(nearly_equal(mesh.normals[a], mesh.normals[b]) &&
                           nearly_equal(mesh.normals[a], mesh.normals[c])))
        g.normal = placed.normal_to_world(interpolate(mesh.normals)).normalized();
    const auto& map = material.normal_map;
    if (map && has_tangent_frames(mesh))
        g.normal = placed
                       .normal_to_world(perturbed_normal(*map, world.samplers[map->map.texture],
                                                         mesh, hit.facet, weights))
                       .normalized();
    if (!mesh.texcoords.empty())
        g.texcoord = Vec2(mesh.texcoords[a]) * weights.x + Vec2(mesh.texcoords[b]) * weights.y +
                     Vec2(mesh.texcoords[c]) * weights.z;
    Vec3 shares = weights;
    if (!mesh.alphas.empty() && material.coverage && !material.coverage->cutoff) {
        shares *= Vec3(mesh.alphas[a], mesh.alphas[b], mesh.alphas[c]);
        g.vertex_alpha = shares.x + shares.y + shares.z;
        if (g.vertex_alpha > 0) shares /= g.vertex_alpha;
    }
    if (!mesh.colors.empty())
        g.vertex_color = Vec3(mesh.colors[a]) * shares.x + Vec3(mesh.colors[b]) * shares.y +
                         Vec3(mesh.colors[c]) * shares.z;
    return g;
}

Geometry on_sphere(const Sphere& sphere, const Vec3& point, bool textured) {
    const Vec3 normal = (point - sphere.center) * (1 / sphere.radius);
    return {.normal = normal,
            .facet_normal = normal,
            .texcoord = textured ? sphere_texcoord(normal) : Vec2(0)};
}

Geometry on_plane(const PlaneFrame& frame, const Vec3& point) {
    const Vec3 offset = point - frame.origin;
    return {.normal = frame.normal,
            .facet_normal = frame.normal,
            .texcoord = {offset.dot(frame.u), offset.dot(frame.v)}};
}

bool odd_cell(const Checker& checker, const Vec3& point) {
    const Vec3 p = (point - checker.origin) * (1 / checker.size);
    const auto cell = [](double x) { return std::floor(x + 1e-10); };
    return (std::int64_t(cell(p.x) + cell(p.y) + cell(p.z)) & 1) != 0;
}

Geometry geometry_at(const World& world, const Hit& hit, const Vec3& point) {
    if (hit.object < world.first_sphere()) return on_facet(world, hit, point);
    if (hit.object >= world.first_plane()) return on_plane(world.plane(hit.object).frame, point);
    return on_sphere(world.sphere(hit.object), point, world.finish_of(hit.object).textured);
}

// The image at the mesh's texture coordinates `uv`.
Vec3 image_at(const World& world, const ImageMap& map, const Vec2& uv) {
    const Vec2 at = map_texcoord(map, uv);
    return Vec3(sample(world.samplers[map.texture], at.x, at.y));
}

// The pigment but for the vertex colour.
Vec3 base_at(const World& world, const Finish& finish, const Geometry& geometry, const Vec3& point,
             bool plane) {
    const Material& material = *finish.material;
    if (const auto* map = std::get_if<ImageMap>(&material.pattern)) {
        const Vec2 uv = plane ? geometry.texcoord * (1 / map->size) : geometry.texcoord;
        return image_at(world, *map, uv) * Vec3(material.color);
    }
    if (const auto* checker = std::get_if<Checker>(&material.pattern))
        return Vec3(checker->colors[odd_cell(*checker, point) ? 1 : 0]);
    if (const auto* noise = std::get_if<Noise>(&material.pattern)) {
        const double value = noise_value(*noise, point);
        return Vec3(noise->colors[0]) * (1 - value) + Vec3(noise->colors[1]) * value;
    }
    return Vec3(material.color);
}

bool takes_vertex_colors(const Material& material) {
    return std::holds_alternative<std::monostate>(material.pattern) ||
           std::holds_alternative<ImageMap>(material.pattern);
}

Vec3 pigment_of(const Finish& finish, const Vec3& base, const Geometry& geometry) {
    return takes_vertex_colors(*finish.material) ? base * geometry.vertex_color : base;
}

double coverage_at(const World& world, const Coverage& coverage, const Geometry& geometry) {
    const double there =
        coverage.map.texture == no_index ? 1 : image_at(world, coverage.map, geometry.texcoord).x;
    if (!coverage.cutoff) return there * geometry.vertex_alpha;
    return there >= cutoff_threshold(*coverage.cutoff) ? 1 : 0;
}

LobeMix lobes_at(const World& world, const Gloss& gloss, const Vec2& texcoord) {
    if (gloss.level.texture == no_index || gloss.lobes.size() < 2) return {};
    const double last = double(gloss.lobes.size() - 1);
    const double level = std::clamp(image_at(world, gloss.level, texcoord).x, 0.0, 1.0) * last;
    const double first = std::min(std::floor(level), last - 1);
    return {Index(first), level - first};
}

// What lies behind, seen through the surface: T of the surface itself, all of it in the gaps.
Vec3 through_at(const Finish& finish, const Vec3& pigment, double coverage) {
    const Vec3 tint = Vec3(1 - finish.transmission) + pigment * finish.transmission;
    return tint * ((1 - finish.opacity) * coverage) + Vec3(1 - coverage);
}

// The terms that Material's maps change over a mesh.
void apply_maps(const World& world, const Geometry& g, const Finish& finish, Surfaces& surfaces,
                std::size_t slot) {
    const Material& material = *finish.material;
    double coverage = 1;
    Vec3 emission = finish.emission;
    if (material.coverage) coverage = coverage_at(world, *material.coverage, g);
    if (material.emission_map) emission *= image_at(world, *material.emission_map, g.texcoord);
    if (material.gloss) {
        surfaces.lobes[slot] = lobes_at(world, *material.gloss, g.texcoord);
        if (material.gloss->color.texture != no_index)
            surfaces.tint.set(slot, image_at(world, material.gloss->color, g.texcoord));
    }
    surfaces.coverage[slot] = coverage;
    surfaces.own.set(slot, (surfaces.pigment[slot] * finish.ambient + emission) *
                               (finish.opacity * coverage));
    surfaces.diffuse[slot] = finish.diffuse * finish.opacity * coverage;
}

bool has_maps(const Material& m) { return m.coverage || m.emission_map || m.gloss; }

}  // namespace

void find_surface(const World& world, const Vec3& origin, const Vec3& direction, const Hit& hit,
                  Surfaces& surfaces, std::size_t slot) {
    const Vec3 point = origin + direction * hit.t;
    Geometry g = geometry_at(world, hit, point);

    // Only the shading normal decides which side the eye is on: POV-Ray never asks the facet's.
    if (g.normal.dot(direction) > 0) g.normal = -g.normal;
    const Finish& finish = world.finish_of(hit.object);
    surfaces.position.set(slot, point);
    surfaces.normal.set(slot, g.normal);
    surfaces.view.set(slot, direction);
    surfaces.facet_normal.set(slot, g.facet_normal);
    surfaces.mirrored.set(slot, direction - g.normal * (2 * direction.dot(g.normal)));
    const Vec3 base = base_at(world, finish, g, point, hit.object >= world.first_plane());
    const Vec3 pigment = pigment_of(finish, base, g);
    surfaces.pigment.set(slot, pigment);
    surfaces.tint.set(slot, finish.textured ? base : pigment);
    surfaces.own.set(slot, (pigment * finish.ambient + finish.emission) * finish.opacity);
    surfaces.diffuse[slot] = finish.diffuse * finish.opacity;
    surfaces.coverage[slot] = 1;
    surfaces.depth[slot] = hit.t;
    surfaces.lobes[slot] = {};
    surfaces.object[slot] = hit.object;
    surfaces.finish[slot] = &finish;
    if (hit.object < world.first_sphere() && has_maps(*finish.material))
        apply_maps(world, g, finish, surfaces, slot);
    if (!finish.opaque)
        surfaces.through.set(slot, through_at(finish, pigment, surfaces.coverage[slot]));
}

Vec3 light_through(const World& world, const Vec3& origin, const Vec3& direction, const Hit& hit) {
    const Vec3 point = origin + direction * hit.t;
    const Geometry g = geometry_at(world, hit, point);
    const Finish& finish = world.finish_of(hit.object);
    const bool facet = hit.object < world.first_sphere();
    const std::optional<Coverage>& coverage = finish.material->coverage;
    const double there = facet && coverage ? coverage_at(world, *coverage, g) : 1;
    if (finish.opacity >= 1) return Vec3(1 - there);
    const Vec3 base = base_at(world, finish, g, point, hit.object >= world.first_plane());
    return through_at(finish, pigment_of(finish, base, g), there);
}

}  // namespace penumbra
