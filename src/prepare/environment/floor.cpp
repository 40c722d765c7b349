// What an Environment's stage gives a scene: a floor that nobody sees the end of.
#include "prepare/environment/floor.h"

#include "base/memory.h"
#include "image/texels.h"
#include "prepare/environment/sky_cells.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace penumbra {

namespace {

constexpr float albedo = 0.6F;
constexpr double gap = 1e-3;  // between floor and things, in radii: nothing lies in it

// What falls from above on a level surface. The sources are as many as a studio has.
Vec3 irradiance(const Texture& around) {
    const SkyCells cells = sky_cells(around, 64);
    Vec3 sum(0);
    for (std::size_t i = 0; i < cells.flux.size(); ++i)
        if (const auto& [energy, vector] = cells.moments[i]; energy > 0)
            sum += cells.flux[i] * std::max(0.0, vector.y / energy);
    return sum;
}

// Within the box of all things the camera looks around in a room, and from below the floor would
// stand before them.
bool hides_nothing(const Scene& scene, const Bounds& box) {
    const Camera& camera = scene.cameras[scene.camera];
    const Vec3 eye = camera.position, size = box.max - box.min;
    const bool inside = eye.x > box.min.x && eye.x < box.max.x && eye.y < box.max.y &&
                        eye.z > box.min.z && eye.z < box.max.z;
    // A ray of an orthographic camera starts anywhere on its plane.
    const bool rises = camera.projection == Camera::Projection::orthographic &&
                       camera.direction.y > -1e-3 * camera.direction.length();
    return !inside && !rises && eye.y > box.min.y + 1e-2 * size.length();
}

}  // namespace

Color floor_radiance(const std::vector<Light>& lights) {
    Vec3 sum(0);
    for (const Light& light : lights)
        sum +=
            Vec3(light.color) * (light.intensity * std::max(0.0, -light.direction.normalized().y));
    return Color(sum * double(albedo));
}

Texture over_floor(const Texture& around) {
    const Raster& in = around.raster;
    const MemoryClaim claim(in.texels() * 3 * sizeof(float), "environment " + around.name);
    Texture out = around;
    out.name += " over its floor";
    out.srgb = false;
    out.raster.depth = Depth::f32;
    out.raster.channels = 3;
    out.raster.data.resize(in.texels() * 3 * sizeof(float));
    const Vec3 floor = irradiance(around) * (double(albedo) / std::numbers::pi);
    // Far away, towards the horizon, the room is darker than its middle.
    constexpr double all_floor = 0.15;
    const LinearSamples samples(in, around.srgb);
    for (int y = 0; y < in.height; ++y) {
        const double height = std::sin((0.5 - (y + 0.5) / in.height) * std::numbers::pi);
        const double part = std::clamp(-height / all_floor, 0.0, 1.0);
        const double share = part * part * (3 - 2 * part);
        for (int x = 0; x < in.width; ++x) {
            const std::size_t t = std::size_t(y) * std::size_t(in.width) + std::size_t(x);
            const Color color(Vec3(samples.color(t)) * (1 - share) + floor * share);
            std::memcpy(out.raster.data.data() + sizeof color * t, &color.x, sizeof color);
        }
    }
    return out;
}

bool give_floor(Scene& scene) {
    const Bounds box = bounds(scene);
    if (box.empty() || !(box.radius() > 0) || !scene.planes.empty() || !hides_nothing(scene, box))
        return false;
    scene.materials.push_back({.name = "studio floor",
                               .color = Color(albedo),
                               .ambient = Color(0),
                               .diffuse = 1,
                               .specular = 0});
    Vec3 point = box.center();
    point.y = box.min.y - gap * box.radius();
    scene.planes.push_back({.name = "studio floor",
                            .point = point,
                            .material = Index(scene.materials.size() - 1),
                            .backdrop = true,
                            .casts_shadow = false,
                            .in_mirrors = false});
    return true;
}

}  // namespace penumbra
