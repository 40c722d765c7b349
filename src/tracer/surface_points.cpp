#include "tracer/surface_points.h"

#include "scene/normal_map.h"
#include "scene/texture/noise.h"

#include "penumbra/light_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra {

void SurfacePoints::resize(std::size_t capacity) {
    for (Vec3Array* vectors : {&position, &normal, &view, &reflected, &facet_normal, &pigment,
                               &tint, &emitted, &transmittance, &from_behind, &kept, &next_kept})
        vectors->resize(capacity);
    diffuse.resize(capacity);
    alpha.resize(capacity);
    share.resize(capacity);
    depth.resize(capacity);
    lobes.resize(capacity);
    front.resize(capacity);
    object.resize(capacity);
    material.resize(capacity);
    inside.resize(capacity);
}

namespace {

// What the geometry says of a point, before the material is asked.
struct Geometry {
    Vec3 normal = {}, facet_normal = {};
    Vec3 front = {};  // the normal that tells the sides
    Vec2 texcoord = {};
    Vec3 vertex_color = Vec3(1);
    double vertex_alpha = 1;
};

Vec3 barycentric(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
    const Vec3 e1 = b - a, e2 = c - a, w = p - a;
    const double d11 = e1.dot(e1), d12 = e1.dot(e2), d22 = e2.dot(e2);
    const double w1 = w.dot(e1), w2 = w.dot(e2), scale = 1 / (d11 * d22 - d12 * d12);
    const double b1 = (d22 * w1 - d12 * w2) * scale, b2 = (d11 * w2 - d12 * w1) * scale;
    return {1 - b1 - b2, b1, b2};
}

Geometry on_facet(const PreparedScene& prepared, const Hit& hit, const Vec3& point) {
    const PlacedMesh& placed = prepared.facets->placed(hit.object);
    const Mesh& mesh = *placed.mesh;
    const auto& [a, b, c] = mesh.triangles[hit.facet];
    const Vec3 weights = barycentric(Vec3(mesh.positions[a]), Vec3(mesh.positions[b]),
                                     Vec3(mesh.positions[c]), placed.point_to_mesh(point));
    const auto interpolate = [&](const auto& values) {
        return Vec3(values[a]) * weights.x + Vec3(values[b]) * weights.y +
               Vec3(values[c]) * weights.z;
    };
    const Material& material = prepared.scene.materials[mesh.material];
    Geometry g;
    const Vec3 flat = facet_plane(mesh, hit.facet).normal;
    g.facet_normal = placed.normal_to_world(flat).normalized();
    g.normal = g.facet_normal;
    g.front = -g.facet_normal;  // POV-Ray's lies on the back
    if (placed.smooth && !flat_by_normals(mesh, mesh.triangles[hit.facet]))
        g.front = g.normal = placed.normal_to_world(interpolate(mesh.normals)).normalized();
    const auto& map = material.normal_map;
    if (map && has_tangent_frames(mesh))
        g.normal = placed
                       .normal_to_world(perturbed_normal(*map, prepared.textures[map->map.texture],
                                                         mesh, hit.facet, weights))
                       .normalized();
    if (!mesh.texcoords.empty())
        g.texcoord = Vec2(mesh.texcoords[a]) * weights.x + Vec2(mesh.texcoords[b]) * weights.y +
                     Vec2(mesh.texcoords[c]) * weights.z;
    Vec3 shares = weights;
    if (!mesh.alphas.empty() && material.alpha_map && !material.alpha_map->cutoff) {
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
            .front = normal,
            .texcoord = textured ? sphere_texcoord(normal) : Vec2(0)};
}

Geometry on_plane(const PlaneFrame& frame, const Vec3& point) {
    const Vec3 offset = point - frame.origin;
    return {.normal = frame.normal,
            .facet_normal = frame.normal,
            .front = frame.normal,
            .texcoord = {offset.dot(frame.u), offset.dot(frame.v)}};
}

bool odd_cell(const Checker& checker, const Vec3& point) {
    const Vec3 p = (point - checker.origin) * (1 / checker.size);
    const auto cell = [](double x) { return std::floor(x + 1e-10); };
    return (std::int64_t(cell(p.x) + cell(p.y) + cell(p.z)) & 1) != 0;
}

Geometry geometry_at(const PreparedScene& prepared, const Hit& hit, const Vec3& point) {
    if (hit.object < prepared.first_sphere()) return on_facet(prepared, hit, point);
    if (hit.object >= prepared.first_plane())
        return on_plane(prepared.plane(hit.object).frame, point);
    return on_sphere(prepared.sphere(hit.object), point, prepared.material_of(hit.object).textured);
}

// The image at the mesh's texture coordinates `uv`.
Vec3 image_at(const PreparedScene& prepared, const ImageMap& map, const Vec2& uv) {
    const Vec2 at = map_texcoord(map, uv);
    return Vec3(sample(prepared.textures[map.texture], at.x, at.y));
}

// The pigment but for the vertex colour.
Vec3 base_at(const PreparedScene& prepared, const PreparedMaterial& material,
             const Geometry& geometry, const Vec3& point, bool plane) {
    const Material& given = *material.source;
    if (const auto* map = std::get_if<ImageMap>(&given.pattern)) {
        const Vec2 uv = plane ? geometry.texcoord * (1 / map->size) : geometry.texcoord;
        return image_at(prepared, *map, uv) * Vec3(given.color);
    }
    if (const auto* checker = std::get_if<Checker>(&given.pattern))
        return Vec3(checker->colors[odd_cell(*checker, point) ? 1 : 0]);
    if (const auto* noise = std::get_if<Noise>(&given.pattern)) {
        const double value = noise_value(*noise, point);
        return Vec3(noise->colors[0]) * (1 - value) + Vec3(noise->colors[1]) * value;
    }
    return Vec3(given.color);
}

bool takes_vertex_colors(const Material& material) {
    return std::holds_alternative<std::monostate>(material.pattern) ||
           std::holds_alternative<ImageMap>(material.pattern);
}

Vec3 pigment_of(const PreparedMaterial& material, const Vec3& base, const Geometry& geometry) {
    return takes_vertex_colors(*material.source) ? base * geometry.vertex_color : base;
}

// What takes the place of P in the tint M of highlight and mirror.
Vec3 tint_of(const PreparedMaterial& material, const Vec3& base, const Vec3& pigment) {
    if (material.source->specular_color) return Vec3(*material.source->specular_color);
    return material.textured ? base : pigment;
}

double alpha_at(const PreparedScene& prepared, const AlphaMap& alpha_map,
                const Geometry& geometry) {
    const double there = alpha_map.map.texture == no_index
                             ? 1
                             : image_at(prepared, alpha_map.map, geometry.texcoord).x;
    if (!alpha_map.cutoff) return there * geometry.vertex_alpha;
    return there >= cutoff_threshold(*alpha_map.cutoff) ? 1 : 0;
}

LobeMix lobes_at(const PreparedScene& prepared, const SpecularLobes& specular_lobes,
                 const Vec2& texcoord) {
    if (specular_lobes.level.texture == no_index || specular_lobes.lobes.size() < 2) return {};
    const double last = double(specular_lobes.lobes.size() - 1);
    const double level =
        std::clamp(image_at(prepared, specular_lobes.level, texcoord).x, 0.0, 1.0) * last;
    const double first = std::min(std::floor(level), last - 1), between = level - first;
    if (specular_lobes.mixed) return {Index(first), between};
    const double share = lobe_share(between);
    return share < 1 ? LobeMix{Index(first), share} : LobeMix{Index(first) + 1, 0};
}

// What lies behind, seen through the surface: T of the surface itself, all of it in the gaps.
Vec3 through_at(const PreparedMaterial& material, const Vec3& pigment, double alpha) {
    const Vec3 tint = Vec3(1 - material.transmission) + pigment * material.transmission;
    return tint * ((1 - material.opacity) * alpha) + Vec3(1 - alpha);
}

// The terms that Material's maps change over a mesh.
void apply_maps(const PreparedScene& prepared, const Geometry& g, const PreparedMaterial& material,
                SurfacePoints& surfaces, std::size_t slot) {
    const Material& given = *material.source;
    double alpha = 1;
    Vec3 emission = material.emission;
    if (given.alpha_map) alpha = alpha_at(prepared, *given.alpha_map, g);
    if (given.emission_map) emission *= image_at(prepared, *given.emission_map, g.texcoord);
    if (given.specular_lobes) {
        surfaces.lobes[slot] = lobes_at(prepared, *given.specular_lobes, g.texcoord);
        if (given.specular_lobes->color.texture != no_index)
            surfaces.tint.set(slot, image_at(prepared, given.specular_lobes->color, g.texcoord));
    }
    surfaces.alpha[slot] = alpha;
    surfaces.emitted.set(
        slot, (surfaces.pigment[slot] * material.ambient * material.opacity + emission) * alpha);
    surfaces.diffuse[slot] = material.diffuse * material.opacity * alpha;
}

// The light from behind that is scattered to the eye, of a surface that is there by `alpha`.
Vec3 from_behind_at(const PreparedScene& prepared, const PreparedMaterial& material,
                    const Geometry& g, bool facet, double alpha) {
    const Material& given = *material.source;
    Vec3 share = Vec3(given.diffuse_transmission) * (material.opacity * alpha);
    if (facet && given.diffuse_transmission_map)
        share *= image_at(prepared, *given.diffuse_transmission_map, g.texcoord);
    return share;
}

// Does the ray meet a back that is not there?
bool meets_hidden_back(const PreparedScene& prepared, const Hit& hit, const Geometry& g,
                       const Vec3& direction) {
    if (hit.object >= prepared.first_sphere()) return false;
    const Backs& backs = prepared.facets->placed(hit.object).backs;
    if (!backs.hidden) return false;
    const double along = g.front.dot(direction);
    if (!(along > 0)) return false;
    return backs.from == 0 ||
           std::acos(std::max(-1.0, -along)) / std::numbers::pi >= double(backs.half_turns());
}

// A surface that is not there, as a hole of an AlphaMap.
void leave_out(const PreparedMaterial& material, SurfacePoints& surfaces, std::size_t slot) {
    for (Vec3Array* light :
         {&surfaces.pigment, &surfaces.tint, &surfaces.emitted, &surfaces.from_behind})
        light->set(slot, Vec3(0));
    surfaces.transmittance.set(slot, Vec3(1));
    surfaces.diffuse[slot] = surfaces.alpha[slot] = 0;
    surfaces.lobes[slot] = {};
    surfaces.material[slot] = &material;
}

bool has_maps(const Material& m) { return m.alpha_map || m.emission_map || m.specular_lobes; }

// Writes one look of the point.
void show(const PreparedScene& prepared, const PreparedMaterial& material, const Geometry& g,
          const Hit& hit, SurfacePoints& surfaces, std::size_t slot) {
    const bool facet = hit.object < prepared.first_sphere();
    const Vec3 point = surfaces.position[slot];
    const Vec3 base = base_at(prepared, material, g, point, hit.object >= prepared.first_plane());
    const Vec3 pigment = pigment_of(material, base, g);
    surfaces.pigment.set(slot, pigment);
    surfaces.tint.set(slot, tint_of(material, base, pigment));
    surfaces.emitted.set(slot, pigment * material.ambient * material.opacity + material.emission);
    surfaces.diffuse[slot] = material.diffuse * material.opacity;
    surfaces.alpha[slot] = 1;
    surfaces.lobes[slot] = {};
    surfaces.material[slot] = &material;
    if (facet && has_maps(*material.source)) apply_maps(prepared, g, material, surfaces, slot);
    if (material.backlit)
        surfaces.from_behind.set(
            slot, from_behind_at(prepared, material, g, facet, surfaces.alpha[slot]));
    if (!material.opaque)
        surfaces.transmittance.set(slot, through_at(material, pigment, surfaces.alpha[slot]));
}

// How much of a Blend's first look there is.
double share_at(const PreparedScene& prepared, const Blend& blend, const Geometry& g) {
    return std::clamp(image_at(prepared, blend.map, g.texcoord).x, 0.0, 1.0);
}

// Does a see-through surface let light through alike wherever it is met?
bool same_everywhere(const PreparedScene& prepared, const PreparedMaterial& material,
                     const Hit& hit) {
    const Material& given = *material.source;
    const bool plain = material.opacity < 1 && !given.alpha_map && !material.other &&
                       std::holds_alternative<std::monostate>(given.pattern);
    return plain && (hit.object >= prepared.first_sphere() ||
                     prepared.facets->placed(hit.object).mesh->colors.empty());
}

// The factor of light that crosses a surface of one look.
Vec3 light_through(const PreparedScene& prepared, const PreparedMaterial& material,
                   const Geometry& g, const Hit& hit, const Vec3& point) {
    const bool facet = hit.object < prepared.first_sphere();
    const std::optional<AlphaMap>& alpha_map = material.source->alpha_map;
    const double there = facet && alpha_map ? alpha_at(prepared, *alpha_map, g) : 1;
    if (material.opacity >= 1) return Vec3(1 - there);
    const Vec3 base = base_at(prepared, material, g, point, hit.object >= prepared.first_plane());
    return through_at(material, pigment_of(material, base, g), there);
}

}  // namespace

std::size_t find_surface_point(const PreparedScene& prepared, const Vec3& origin,
                               const Vec3& direction, const Hit& hit, SurfacePoints& surfaces,
                               std::size_t slot) {
    const Vec3 point = origin + direction * hit.t;
    Geometry g = geometry_at(prepared, hit, point);
    const bool hidden = meets_hidden_back(prepared, hit, g, direction);

    // Only the shading normal decides which side the eye is on: POV-Ray never asks the facet's.
    if (g.normal.dot(direction) > 0) g.normal = -g.normal;
    const PreparedMaterial& material = prepared.material_of(hit.object);
    const auto place = [&](std::size_t at) {
        surfaces.position.set(at, point);
        surfaces.normal.set(at, g.normal);
        surfaces.view.set(at, direction);
        surfaces.facet_normal.set(at, g.facet_normal);
        surfaces.reflected.set(at, direction - g.normal * (2 * direction.dot(g.normal)));
        surfaces.share[at] = 1;
        surfaces.depth[at] = hit.t;
        surfaces.front[at] = char(!(g.front.dot(direction) > 0));
        surfaces.object[at] = hit.object;
    };
    place(slot);
    if (hidden) {
        leave_out(material, surfaces, slot);
        return 1;
    }
    show(prepared, material, g, hit, surfaces, slot);
    if (!material.other || hit.object >= prepared.first_sphere()) return 1;
    place(slot + 1);
    show(prepared, *material.other, g, hit, surfaces, slot + 1);
    surfaces.inside[slot + 1] = surfaces.inside[slot];
    surfaces.share[slot] = share_at(prepared, *material.source->blend, g);
    surfaces.share[slot + 1] = 1 - surfaces.share[slot];
    return 2;
}

Vec3 light_through(const PreparedScene& prepared, const Vec3& origin, const Vec3& direction,
                   const Hit& hit) {
    const PreparedMaterial& material = prepared.material_of(hit.object);
    if (same_everywhere(prepared, material, hit))
        return through_at(material, Vec3(material.source->color), 1);
    const Vec3 point = origin + direction * hit.t;
    const Geometry g = geometry_at(prepared, hit, point);
    const Vec3 own = light_through(prepared, material, g, hit, point);
    if (!material.other || hit.object >= prepared.first_sphere()) return own;
    const double share = share_at(prepared, *material.source->blend, g);
    return own * share + light_through(prepared, *material.other, g, hit, point) * (1 - share);
}

}  // namespace penumbra
