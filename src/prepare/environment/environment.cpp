// Environment -> directional lights and a Sky.
#include "prepare/environment/cut.h"
#include "prepare/environment/floor.h"
#include "scene/defects.h"
#include "scene/surface/looks.h"
#include "scene/transforms.h"

#include "penumbra/prepare.h"
#include "penumbra/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace penumbra {

namespace {

// From -z to where the camera looks, about y. What looks straight up or down has its picture's top
// or bottom there.
Matrix heading(const Camera& camera) {
    const Vec3 forward = camera.direction.normalized();
    const bool steep = std::abs(forward.y) > 0.999;
    const Vec3 level = steep ? camera.up * (forward.y > 0 ? -1.0 : 1.0) : forward;
    return rotation_about(1, degrees(std::atan2(-level.x, -level.z)));
}

Vec3 turned(const Vec3& direction, const Matrix& rotation) {
    Vec3 result(0);
    rotation.multDirMatrix(direction, result);
    return result;
}

std::vector<Light> lights_of(const Environment& environment, const Matrix& rotation,
                             const std::vector<SkySource>& sources) {
    std::vector<Light> lights;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const auto& [toward, flux] = sources[i];
        const double strongest = std::max({flux.x, flux.y, flux.z});
        // Our diffuse term has no 1 / pi: it is part of the source.
        lights.push_back({.name = fmt::format("source {} of {} of environment {}", i + 1,
                                              sources.size(), environment.name),
                          .type = Light::Type::directional,
                          .direction = turned(-toward, rotation),
                          .color = Color(flux / strongest),
                          .intensity = environment.intensity * strongest / std::numbers::pi});
    }
    return lights;
}

// The lobe of cos^n has about the variance 1 / n in each direction, and variances add up; the light
// that it reflects in all stays.
void widen(float& specular, float& shininess, double spread) {
    if (shininess <= 0) return;
    const double n = shininess, wider = 1 / (1 / n + spread);
    specular = float(specular * (wider + 1) / (n + 1));
    shininess = float(wider);
}

void widen_lobes(Scene& scene, double spread) {
    each_look(scene.materials, [&](Material& m) {
        widen(m.specular, m.shininess, spread);
        if (m.coat) widen(m.coat->specular, m.coat->shininess, spread);
        if (m.specular_lobes)
            for (SpecularLobe& lobe : m.specular_lobes->lobes)
                widen(lobe.specular, lobe.shininess, spread);
    });
}

}  // namespace

Environment& set_environment(Scene& scene, Index texture, const std::string& name) {
    Environment& environment = scene.environment ? *scene.environment : scene.environment.emplace();
    environment.name = name;
    environment.texture = texture;
    environment.before_camera = false;
    return environment;
}

Environment& set_uniform_environment(Scene& scene, const Color& radiance) {
    Texture texture = {.name = "uniform", .srgb = false};
    texture.raster = {.width = 1, .height = 1, .channels = 3, .depth = Depth::f32};
    texture.raster.data.resize(sizeof radiance);
    std::memcpy(texture.raster.data.data(), &radiance.x, sizeof radiance);
    scene.textures.push_back(std::move(texture));
    return set_environment(scene, Index(scene.textures.size() - 1), "uniform");
}

void light_by_environment(Scene& scene) {
    if (!scene.environment) return;
    assert(environment_defects(scene).empty());
    Environment environment = *scene.environment;
    if (environment.stage == Environment::Stage::floor && give_floor(scene)) {
        scene.textures.push_back(over_floor(scene.textures[environment.texture]));
        environment.texture = Index(scene.textures.size() - 1);
    }
    scene.environment.reset();
    Matrix rotation = environment.rotation;
    if (environment.before_camera) rotation = heading(scene.cameras[scene.camera]) * rotation;
    std::vector<Light> lights;
    if (environment.sources > 0 && environment.intensity > 0) {
        const SkySources cut =
            sky_sources(sky_cells(scene.textures[environment.texture], environment.sources),
                        environment.sources);
        lights = lights_of(environment, rotation, cut.sources);
        widen_lobes(scene, cut.spread);
    }
    scene.lights.insert(scene.lights.end(), lights.begin(), lights.end());
    const Sky sky = {
        .texture = environment.texture, .gain = environment.intensity, .rotation = rotation};
    const bool staged = environment.stage != Environment::Stage::none;
    if (!environment.visible) {
        scene.mirror_sky = sky;
        if (staged && !scene.sky) scene.background = floor_radiance(lights);
        return;
    }
    scene.sky = sky;
    scene.mirror_sky.reset();
}

}  // namespace penumbra
