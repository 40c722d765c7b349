// What a picture needs and its author left out: material, camera, lights.
#include "prepare/complete.h"

#include "scene/defects.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace penumbra {

namespace {

/// Of the picture, on each side.
constexpr double margin = 0.06;

/// What a camera sees, as vectors of length 1.
struct Basis {
    Vec3 right, up, forward;
};

Basis basis_of(const Camera& camera) {
    const Vec3 forward = camera.direction.normalized();
    const Vec3 right = forward.cross(camera.up).normalized();
    return {.right = right, .up = right.cross(forward), .forward = forward};
}

std::array<Vec3, 8> corners_of(const Bounds& box, const Basis& basis) {
    std::array<Vec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i) {
        const Vec3 p((i & 1U) != 0 ? box.max.x : box.min.x, (i & 2U) != 0 ? box.max.y : box.min.y,
                     (i & 4U) != 0 ? box.max.z : box.min.z);
        corners[i] = {p.dot(basis.right), p.dot(basis.up), p.dot(basis.forward)};
    }
    return corners;
}

// Where the sides of a wedge of half-width `slope` per depth touch the corners along `axis`:
// with its tip at depth z, the tip must lie in [low + slope z, high - slope z].
struct Wedge {
    double slope = 0, low = -1e300, high = 1e300;
    double deepest_tip() const { return (high - low) / (2 * slope); }
    double middle() const { return (low + high) / 2; }
};

Wedge wedge_around(const std::array<Vec3, 8>& corners, int axis, double slope) {
    Wedge wedge = {.slope = slope};
    for (const Vec3& p : corners) {
        wedge.low = std::max(wedge.low, p[axis] - slope * p.z);
        wedge.high = std::min(wedge.high, p[axis] + slope * p.z);
    }
    return wedge;
}

void frame_perspective(Camera& camera, const Bounds& box, double aspect) {
    const Basis basis = basis_of(camera);
    const auto corners = corners_of(box, basis);
    const bool horizontal = camera.side == Camera::Side::horizontal;
    const double slope = std::tan(camera.fov / 2) * (1 - 2 * margin);
    const Wedge across = wedge_around(corners, 0, horizontal ? slope : slope * aspect);
    const Wedge along = wedge_around(corners, 1, horizontal ? slope / aspect : slope);
    const double depth = std::min(across.deepest_tip(), along.deepest_tip());
    camera.position =
        basis.right * across.middle() + basis.up * along.middle() + basis.forward * depth;
}

void frame_orthographic(Camera& camera, const Bounds& box, double aspect) {
    const Basis basis = basis_of(camera);
    double width = 0, height = 0;
    for (const Vec3& p : corners_of(box, basis)) {
        const Vec3 c(box.center().dot(basis.right), box.center().dot(basis.up), 0);
        width = std::max(width, 2 * std::abs(p.x - c.x));
        height = std::max(height, 2 * std::abs(p.y - c.y));
    }
    const bool horizontal = camera.side == Camera::Side::horizontal;
    const double side = std::max(width, height * aspect) / (1 - 2 * margin);
    camera.extent = horizontal ? side : side / aspect;
    camera.position = box.center() - basis.forward * (4 * box.radius());
}

Bounds box_around(const Vec3& center, double half) {
    return {.min = center - Vec3(half), .max = center + Vec3(half)};
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
        frame(scene.cameras[0], stage(scene), aspect);
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

Bounds stage(const Scene& scene) {
    Bounds box = bounds(scene);
    if (!box.empty() && box.radius() > 0) return box;
    const Vec3 center = box.empty() ? Vec3(0) : box.center();
    if (!box.empty() || scene.planes.empty()) return box_around(center, 1);
    const Vec3 normal = scene.planes[0].normal.normalized();
    return box_around(scene.planes[0].point + normal * (normal.y < 0 ? -1 : 1), 1);
}

void frame(Camera& camera, const Bounds& box, double aspect) {
    assert(box.radius() > 0 && aspect > 0);
    if (camera.projection == Camera::Projection::orthographic)
        return frame_orthographic(camera, box, aspect);
    frame_perspective(camera, box, aspect);
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
