#include "surface.h"

#include "noise.h"

#include <cmath>

namespace penumbra {

void Surfaces::resize(std::size_t capacity) {
    for (Vectors* vectors : {&position, &normal, &view, &mirrored, &facet_normal, &pigment})
        vectors->resize(capacity);
    diffuse.resize(capacity);
    specular.resize(capacity);
    object.resize(capacity);
    finish.resize(capacity);
}

namespace {

// What the geometry says of a point, before the material is asked.
struct Geometry {
    Vec3 normal = {}, facet_normal = {};
    Vec2 texcoord = {};
    Vec3 vertex_color = Vec3(1);
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
    Geometry g;
    const Vec3 flat = facet_plane(mesh, hit.facet).normal;
    g.facet_normal = placed.normal_to_world(flat).normalized();
    g.normal = g.facet_normal;
    if (placed.smooth && !(nearly_equal(mesh.normals[a], mesh.normals[b]) &&
                           nearly_equal(mesh.normals[a], mesh.normals[c])))
        g.normal = placed.normal_to_world(interpolate(mesh.normals)).normalized();
    if (!mesh.texcoords.empty())
        g.texcoord = Vec2(mesh.texcoords[a]) * weights.x + Vec2(mesh.texcoords[b]) * weights.y +
                     Vec2(mesh.texcoords[c]) * weights.z;
    if (!mesh.colors.empty()) g.vertex_color = interpolate(mesh.colors);
    return g;
}

Geometry on_sphere(const Sphere& sphere, const Vec3& point) {
    const Vec3 normal = (point - sphere.center) * (1 / sphere.radius);
    return {.normal = normal, .texcoord = sphere_texcoord(normal)};
}

Geometry on_plane(const PlaneFrame& frame, const Vec3& point) {
    const Vec3 offset = point - frame.origin;
    return {.normal = frame.normal, .texcoord = {offset.dot(frame.u), offset.dot(frame.v)}};
}

bool odd_cell(const Checker& checker, const Vec3& point) {
    const Vec3 p = (point - checker.origin) * (1 / checker.size);
    const auto cell = [](double x) { return std::floor(x + 1e-10); };
    return (std::int64_t(cell(p.x) + cell(p.y) + cell(p.z)) & 1) != 0;
}

Vec3 pigment_at(const World& world, const Finish& finish, const Geometry& geometry,
                const Vec3& point, bool plane) {
    const Material& material = *finish.material;
    if (const auto* map = std::get_if<ImageMap>(&material.pattern)) {
        const Vec2 uv = plane ? geometry.texcoord * (1 / map->size) : geometry.texcoord;
        return Vec3(sample(world.samplers[map->texture], uv.x, uv.y)) * Vec3(material.color) *
               geometry.vertex_color;
    }
    if (const auto* checker = std::get_if<Checker>(&material.pattern))
        return Vec3(checker->colors[odd_cell(*checker, point) ? 1 : 0]);
    if (const auto* noise = std::get_if<Noise>(&material.pattern)) {
        const double value = noise_value(*noise, point);
        return Vec3(noise->colors[0]) * (1 - value) + Vec3(noise->colors[1]) * value;
    }
    return Vec3(material.color) * geometry.vertex_color;
}

}  // namespace

void find_surface(const World& world, const Vec3& origin, const Vec3& direction, const Hit& hit,
                  Surfaces& surfaces, std::size_t slot) {
    const Vec3 point = origin + direction * hit.t;
    const bool facet = hit.object < world.first_sphere(), plane = hit.object >= world.first_plane();
    Geometry g;
    if (facet)
        g = on_facet(world, hit, point);
    else if (plane)
        g = on_plane(world.planes[hit.object - world.first_plane()].frame, point);
    else
        g = on_sphere(world.scene.spheres[hit.object - world.first_sphere()], point);

    // Only the shading normal decides which side the eye is on: POV-Ray never asks the facet's.
    if (g.normal.dot(direction) > 0) g.normal = -g.normal;
    const Finish& finish = world.finish_of(hit.object);
    surfaces.position.set(slot, point);
    surfaces.normal.set(slot, g.normal);
    surfaces.view.set(slot, direction);
    surfaces.facet_normal.set(slot, g.facet_normal);
    surfaces.mirrored.set(slot, direction - g.normal * (2 * direction.dot(g.normal)));
    surfaces.pigment.set(slot, pigment_at(world, finish, g, point, plane));
    surfaces.diffuse[slot] = finish.diffuse * finish.opacity;
    surfaces.specular[slot] = finish.specular;
    surfaces.object[slot] = hit.object;
    surfaces.finish[slot] = &finish;
}

}  // namespace penumbra
