// What a picture needs and its author left out: material, camera, lights.
#include "prepare/complete.h"

#include "scene/defects.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace penumbra {

namespace {

/// Of the picture, on each side.
constexpr double margin = 0.07;

/// What a camera sees, as vectors of length 1.
struct Basis {
    Vec3 right, up, forward;
};

Basis basis_of(const Camera& camera) {
    const Vec3 forward = camera.direction.normalized();
    const Vec3 right = forward.cross(camera.up).normalized();
    return {.right = right, .up = right.cross(forward), .forward = forward};
}

// Where the sides of a wedge of half-width `slope` per depth touch the things along an axis: with
// its tip at depth z, the tip must lie in [low + slope z, high - slope z].
struct Wedge {
    double slope = 0, low = -1e300, high = 1e300;
    double deepest_tip() const { return (high - low) / (2 * slope); }
    double middle() const { return (low + high) / 2; }
};

void frame_perspective(Camera& camera, const Scene& scene, double aspect) {
    const Basis basis = basis_of(camera);
    const bool horizontal = camera.side == Camera::Side::horizontal;
    const double slope = std::tan(camera.fov / 2) * (1 - 2 * margin);
    const double across = horizontal ? slope : slope * aspect;
    const double along = horizontal ? slope / aspect : slope;
    const auto [left, right, bottom, top] = reaches(
        scene,
        std::array{basis.right - basis.forward * across, -basis.right - basis.forward * across,
                   basis.up - basis.forward * along, -basis.up - basis.forward * along});
    const Wedge x = {.slope = across, .low = left, .high = -right};
    const Wedge y = {.slope = along, .low = bottom, .high = -top};
    const double depth = std::min(x.deepest_tip(), y.deepest_tip());
    camera.position = basis.right * x.middle() + basis.up * y.middle() + basis.forward * depth;
}

void frame_orthographic(Camera& camera, const Scene& scene, double aspect) {
    const Basis basis = basis_of(camera);
    const auto [right, left, top, bottom, far, near] =
        reaches(scene, std::array{basis.right, -basis.right, basis.up, -basis.up, basis.forward,
                                  -basis.forward});
    const bool horizontal = camera.side == Camera::Side::horizontal;
    const double side = std::max(right + left, (top + bottom) * aspect) / (1 - 2 * margin);
    camera.extent = horizontal ? side : side / aspect;
    const double away = std::max({right + left, top + bottom, far + near});
    camera.position = basis.right * ((right - left) / 2) + basis.up * ((top - bottom) / 2) -
                      basis.forward * (near + 2 * away);
}

Index default_material(Scene& scene) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (scene.materials[i].name == "default") return Index(i);
    scene.materials.push_back({.name = "default"});
    return Index(scene.materials.size() - 1);
}

template <class Things>
void give_material(Scene& scene, Things& things) {
    for (auto& thing : things)
        if (thing.material == no_index) thing.material = default_material(scene);
}

void give_camera(Scene& scene, double aspect) {
    if (scene.cameras.empty()) {
        scene.cameras.push_back(default_camera());
        frame(scene.cameras[0], scene, aspect);
    }
    if (scene.camera == no_index) scene.camera = 0;
}

// What the rig lights: the whole scene seen from outside, or what surrounds a camera inside of it.
struct Subject {
    Vec3 center;
    double radius = 1;  ///< sources stand at a few radii
    double delta = 0.1;
};

Subject subject_of(const Scene& scene, const Camera& camera) {
    const Bounds box = stage(scene);
    const Vec3 to_min = camera.position - box.min, to_max = box.max - camera.position;
    const double room = std::min({to_min.x, to_min.y, to_min.z, to_max.x, to_max.y, to_max.z});
    const bool inside = room > 0 && camera.projection == Camera::Projection::perspective;
    if (!inside)
        return {.center = box.center(), .radius = box.radius(), .delta = box.radius() / 25};
    // Everything stays nearer than the next wall.
    return {.center = camera.position, .radius = room / 6, .delta = room / 100};
}

// A plane between the subject and a source would keep it dark: the source moves before the plane.
Vec3 before_planes(const Scene& scene, const Vec3& center, const Vec3& position) {
    Vec3 ray = position - center;
    for (const Plane& plane : scene.planes) {
        const double distance = (plane.point - center).dot(plane.normal);
        const double step = ray.dot(plane.normal);
        if (distance * step > 0 && std::abs(step) >= std::abs(distance))
            ray *= 0.9 * distance / step;
    }
    return center + ray;
}

void give_lights(Scene& scene) {
    struct Post {
        const char* name;
        Vec3 offset;  ///< right, up, forward of the camera, in radii
        double intensity;
    };
    // Key light from the upper left, fill from the right, rim from behind: three-point lighting.
    // What faces all of them at once gets 0.9, so that no white surface is overexposed.
    const Post posts[] = {{"key", {-2.2, 2.6, -2.6}, 0.75},
                          {"fill", {2.6, 0, -3.0}, 0.3},
                          {"rim", {1.0, 2.8, 3.0}, 0.3}};
    const Camera& camera = scene.cameras[scene.camera];
    const Basis basis = basis_of(camera);
    const Subject subject = subject_of(scene, camera);
    for (const Post& post : posts) {
        const Vec3 offset =
            basis.right * post.offset.x + basis.up * post.offset.y + basis.forward * post.offset.z;
        Light light = {.name = post.name, .intensity = post.intensity};
        light.position =
            before_planes(scene, subject.center, subject.center + offset * subject.radius);
        if (light.name == "key") light.penumbra.delta = subject.delta;
        scene.lights.push_back(std::move(light));
    }
}

}  // namespace

Camera default_camera() {
    Camera camera;
    camera.name = "default";
    camera.direction = -Vec3(0.6, 0.45, 1).normalized();
    return camera;
}

void frame(Camera& camera, const Scene& scene, double aspect) {
    assert(aspect > 0);
    if (camera.projection == Camera::Projection::orthographic)
        return frame_orthographic(camera, scene, aspect);
    frame_perspective(camera, scene, aspect);
}

void complete(Scene& scene, double aspect) {
    assert(indices_in_range(scene) && aspect > 0);
    give_material(scene, scene.meshes);
    give_material(scene, scene.spheres);
    give_material(scene, scene.planes);
    give_camera(scene, aspect);
    assert(scene.camera < scene.cameras.size());
    if (scene.lights.empty() && !scene.environment) give_lights(scene);
}

}  // namespace penumbra
