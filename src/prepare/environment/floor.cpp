// What an Environment's stage gives a scene: a floor that nobody sees the end of.
#include "prepare/environment/floor.h"

#include <algorithm>

namespace penumbra {

namespace {

constexpr float albedo = 0.6F;
constexpr double gap = 1e-3;  // between floor and things, in radii: nothing lies in it

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

void give_floor(Scene& scene) {
    const Bounds box = bounds(scene);
    if (box.empty() || !(box.radius() > 0) || !scene.planes.empty() || !hides_nothing(scene, box))
        return;
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
}

}  // namespace penumbra
