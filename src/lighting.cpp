#include "lighting.h"

#include "shapes.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

// Below this angle to its facet a shadow ray may find that facet again: float32 rounds the start
// point of a normalised scene by up to 1e-6, and shadow_margin is 1e-3.
constexpr double grazing_sine = 4e-3;

constexpr double least_light = 1e-10;  // POV-Ray skips a source whose light is weaker

// Direction, distance and cosine from every surface point to the source: plain loops over arrays.
void aim(const PreparedSource& source, const Surfaces& surfaces, LightWork& work) {
    const auto& [px, py, pz] = surfaces.position.axis;
    const auto& [nx, ny, nz] = surfaces.normal.axis;
    auto& [lx, ly, lz] = work.toward.axis;
    const std::size_t count = surfaces.count;
    if (source.type == Light::Type::directional) {
        for (std::size_t i = 0; i < count; ++i) {
            lx[i] = -source.axis.x;
            ly[i] = -source.axis.y;
            lz[i] = -source.axis.z;
            work.distance[i] = (px[i] - source.position.x) * source.axis.x +
                               (py[i] - source.position.y) * source.axis.y +
                               (pz[i] - source.position.z) * source.axis.z;
        }
    } else {
        for (std::size_t i = 0; i < count; ++i) {
            const double x = source.position.x - px[i], y = source.position.y - py[i],
                         z = source.position.z - pz[i];
            const double length = std::sqrt(x * x + y * y + z * z), scale = 1 / length;
            lx[i] = x * scale;
            ly[i] = y * scale;
            lz[i] = z * scale;
            work.distance[i] = length;
        }
    }
    for (std::size_t i = 0; i < count; ++i)
        work.cosine[i] = nx[i] * lx[i] + ny[i] * ly[i] + nz[i] * lz[i];
}

// f_a, and the falloff of a spot: POV-Ray's cubic smoothstep in the cosine.
double strength_of(const PreparedSource& source, double distance, const Vec3& toward) {
    double strength = 1;
    if (source.fades) {
        const double ratio = distance / source.fade_distance;
        const double power =
            source.fade_power == 2 ? ratio * ratio : std::pow(ratio, source.fade_power);
        strength = 2 / (1 + power);
    }
    if (source.type == Light::Type::spot) {
        const double cosine = -source.axis.dot(toward);
        if (cosine <= 0 || cosine <= source.cos_outer) return 0;
        if (cosine < source.cos_inner) {
            const double s = (cosine - source.cos_outer) / (source.cos_inner - source.cos_outer);
            strength *= s * s * (3 - 2 * s);
        }
    }
    return strength;
}

// Lists the surface points that the source lights unless something stands between.
void gather_lit(const PreparedSource& source, const Surfaces& surfaces, LightWork& work) {
    const double brightest = std::max({source.color.x, source.color.y, source.color.z});
    work.lit.clear();
    for (std::size_t i = 0; i < surfaces.count; ++i) {
        if (work.cosine[i] < least_cosine) continue;
        const Finish& finish = *surfaces.finish[i];
        if (finish.diffuse == 0 && finish.specular == 0) continue;
        work.strength[i] = strength_of(source, work.distance[i], work.toward[i]);
        if (brightest * work.strength[i] < least_light) continue;
        work.lit.push_back(i);
    }
}

void cast_shadow_rays(const World& world, const Surfaces& surfaces, LightWork& work) {
    ShadowRays& rays = work.shadows;
    rays.count = work.lit.size();
    for (std::size_t k = 0; k < rays.count; ++k) {
        const std::size_t i = work.lit[k];
        const Vec3 toward = work.toward[i], facet_normal = surfaces.facet_normal[i];
        rays.origin.set(k, surfaces.position[i]);
        rays.direction.set(k, toward);
        rays.distance[k] = work.distance[i];
        const bool on_facet = surfaces.object[i] < world.first_sphere();
        rays.grazing[k] = on_facet && std::abs(facet_normal.dot(toward)) < grazing_sine;
        work.visible[k] = 1;
    }
    const std::span<unsigned char> visible(work.visible.data(), rays.count);
    block_by_shapes(world, rays, visible);
    world.facets.block(rays, visible);
}

// What translucent surfaces leave of the light along a shadow ray: a factor for each crossing,
// except those within shadow_margin of the one before.
double filtered(const World& world, const Vec3& origin, const Vec3& toward, double distance) {
    double light = 1, from = shadow_margin;
    while (light > 0) {
        Hit hit = {.t = distance - shadow_margin};
        const bool shape = translucent_shape(world, origin, toward, from, hit);
        const bool facet = world.facets.translucent(origin, toward, from, hit.t, hit);
        if (!shape && !facet) break;
        light *= 1 - world.finish_of(hit.object).opacity;
        from = hit.t + shadow_margin;
    }
    return light;
}

Vec3 highlight(const Finish& finish, const Vec3& view, const Vec3& normal, const Vec3& toward,
               double cosine, const Vec3& pigment) {
    const Vec3 mirrored = view - normal * (2 * view.dot(normal));
    const double k = mirrored.dot(toward);
    if (k <= 0 || k < finish.highlight_end) return Vec3(0);
    const double amount = finish.specular * std::pow(k, finish.shininess);
    return finish.metallic > 0 ? metallic_tint(finish.metallic, cosine, pigment) * amount
                               : Vec3(amount);
}

void shade(const World& world, const PreparedSource& source, const Surfaces& surfaces,
           const LightWork& work, std::vector<Vec3>& radiance) {
    for (std::size_t k = 0; k < work.lit.size(); ++k) {
        if (work.visible[k] == 0) continue;
        const std::size_t i = work.lit[k];
        const Finish& finish = *surfaces.finish[i];
        const Vec3 toward = work.toward[i], pigment = surfaces.pigment[i];
        double strength = work.strength[i];
        if (world.translucent)
            strength *= filtered(world, surfaces.position[i], toward, work.distance[i]);
        const Vec3 light = source.color * strength;
        Vec3 sent = pigment * (finish.diffuse * work.cosine[i] * finish.opacity);
        if (finish.specular > 0)
            sent += highlight(finish, surfaces.view[i], surfaces.normal[i], toward, work.cosine[i],
                              pigment);
        radiance[i] += light * sent;
    }
}

}  // namespace

LightWork::LightWork(std::size_t capacity)
    : toward(capacity), distance(capacity), cosine(capacity), strength(capacity), shadows(capacity),
      visible(capacity) {
    lit.reserve(capacity);
}

Vec3 metallic_tint(double metallic, double cosine, const Vec3& pigment) {
    const double x = std::acos(std::clamp(cosine, -1.0, 1.0)) / (std::numbers::pi / 2);
    const double curve =
        std::clamp(0.014567225 / ((x - 1.12) * (x - 1.12)) - 0.011612903, 0.0, 1.0);
    return Vec3(1) + (pigment - Vec3(1)) * (metallic * (1 - curve));
}

void add_direct_light(const World& world, const Surfaces& surfaces, LightWork& work,
                      std::vector<Vec3>& radiance) {
    for (std::size_t i = 0; i < surfaces.count; ++i) {
        const Finish& finish = *surfaces.finish[i];
        radiance[i] += (surfaces.pigment[i] * finish.ambient + finish.emission) * finish.opacity;
    }
    for (const PreparedSource& source : world.sources) {
        aim(source, surfaces, work);
        gather_lit(source, surfaces, work);
        if (work.lit.empty()) continue;
        cast_shadow_rays(world, surfaces, work);
        shade(world, source, surfaces, work, radiance);
    }
}

}  // namespace penumbra
