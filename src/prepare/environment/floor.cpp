// What an Environment's stage gives a scene: a floor that nobody sees the end of.
#include "prepare/environment/floor.h"

#include "base/memory.h"
#include "prepare/environment/sky_cells.h"
#include "scene/texture/texture_lookup.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace penumbra {

namespace {

constexpr float albedo = 0.6F;
constexpr int least_rows = 64;  // of an image that is to show it
constexpr double gap = 1e-3;    // between floor and things, in radii: nothing lies in it

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
    const int width = std::max(around.raster.width, 2 * least_rows);
    const int height = std::max(around.raster.height, least_rows);
    Texture out = {.name = around.name + " over its floor", .srgb = false};
    out.raster = {.width = width, .height = height, .channels = 3, .depth = Depth::f32};
    const std::size_t size = out.raster.texels() * 3 * sizeof(float);
    const MemoryClaim claim(size, "environment " + around.name);
    out.raster.data.resize(size);
    const Vec3 floor = irradiance(around) * (double(albedo) / std::numbers::pi);
    // Far away, towards the horizon, the room is darker than its middle.
    constexpr double all_floor = 0.15;
    const TextureLookup lookup(around);
    const bool same_size = width == around.raster.width && height == around.raster.height;
    std::size_t texel = 0;
    std::byte* to = out.raster.data.data();
    for (int y = 0; y < height; ++y) {
        const double v = 1 - (y + 0.5) / height;
        const double part =
            std::clamp(std::sin((0.5 - v) * std::numbers::pi) / all_floor, 0.0, 1.0);
        const double share = part * part * (3 - 2 * part);
        for (int x = 0; x < width; ++x) {
            const Vec3 there(same_size ? lookup.samples.color(texel++)
                                       : sample(lookup, (x + 0.5) / width, v));
            const Color color(there * (1 - share) + floor * share);
            std::memcpy(to, &color.x, 3 * sizeof(float));
            to += 3 * sizeof(float);
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
