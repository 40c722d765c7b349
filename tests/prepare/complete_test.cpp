// What complete() gives: a framed camera, a rig that lights what is seen, a material.
#include "prepare/complete.h"
#include "support/support.h"

#include "penumbra/light_model.h"
#include "penumbra/prepare.h"
#include "penumbra/scene.h"

#include <algorithm>
#include <cmath>

using namespace penumbra;

namespace {

Scene with_box(const Vec3& low, const Vec3& high) {
    Scene scene;
    Mesh mesh;
    for (unsigned i = 0; i < 8; ++i)
        mesh.positions.emplace_back(Vec3((i & 1U) != 0 ? high.x : low.x,
                                         (i & 2U) != 0 ? high.y : low.y,
                                         (i & 4U) != 0 ? high.z : low.z));
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 0}};
    scene.meshes.push_back(mesh);
    scene.instances.push_back({});
    return scene;
}

Scene with_sphere(const Vec3& center = Vec3(0), double radius = 1) {
    Scene scene;
    scene.spheres.push_back({.center = center, .radius = radius});
    return scene;
}

// Points spread over the unit sphere.
std::vector<Vec3> directions() {
    std::vector<Vec3> points;
    for (int i = 0; i < 2000; ++i) {
        const double y = 1 - (2 * i + 1) / 2000.0, ring = std::sqrt(1 - y * y), angle = i * 2.39996;
        points.emplace_back(ring * std::cos(angle), y, ring * std::sin(angle));
    }
    return points;
}

// The things' outline in points.
std::vector<Vec3> points_of(const Scene& scene) {
    std::vector<Vec3> points;
    for (const Mesh& mesh : scene.meshes)
        for (const Vec3f& p : mesh.positions) points.emplace_back(p);
    for (const Sphere& sphere : scene.spheres)
        for (const Vec3& d : directions()) points.push_back(sphere.center + d * sphere.radius);
    return points;
}

// How far the things reach, as fractions of half the picture: the largest |u|, |v|.
struct Reach {
    double left = 0, right = 0, bottom = 0, top = 0;
    bool in_front = true;
};

Reach reach_of(const Scene& scene, double aspect) {
    const View view =
        view_of(scene.cameras.at(scene.camera), int(std::lround(1200 * aspect)), 1200);
    Reach reach = {.left = 9, .right = -9, .bottom = 9, .top = -9};
    for (const Vec3& p : points_of(scene)) {
        const Vec3 d = p - view.location;
        const double depth = view.orthographic ? 1 : d.dot(view.direction);
        reach.in_front = reach.in_front && d.dot(view.direction) > 0;
        const double u = 2 * d.dot(view.right) / view.right.length2() / depth;
        const double v = 2 * d.dot(view.up) / view.up.length2() / depth;
        reach.left = std::min(reach.left, u), reach.right = std::max(reach.right, u);
        reach.bottom = std::min(reach.bottom, v), reach.top = std::max(reach.top, v);
    }
    return reach;
}

void check_framing(const Scene& scene, double aspect) {
    const Reach reach = reach_of(scene, aspect);
    CHECK(reach.in_front);
    const double widest = std::max(-reach.left, reach.right);
    const double tallest = std::max(-reach.bottom, reach.top);
    // A margin of 7 % of the picture at the nearest sides is 0.86 of its half.
    CHECK(std::max(widest, tallest) == Approx(0.86).margin(3e-3));
    CHECK(std::min(widest, tallest) <= 0.86 + 1e-3);
}

// Light on a white matt surface at `p` with normal `n`, without shadows.
double lit(const Scene& scene, const Vec3& p, const Vec3& n) {
    double sum = 0;
    for (const Light& light : scene.lights)
        for (const Source& source : virtual_sources(light))
            sum +=
                double(source.color.x) * std::max(0.0, n.dot((source.position - p).normalized()));
    return sum;
}

}  // namespace

TEST_CASE("A camera is framed so that the bounds fill the picture but for a margin") {
    for (const double aspect : {0.4, 1.0, 4.0 / 3, 3.0}) {
        for (Scene scene : {with_box({-1, -1, -1}, {1, 1, 1}), with_box({0, 0, 0}, {20, 1, 1}),
                            with_box({5, 0, 5}, {6, 30, 6}), with_box({-9, 1, -9}, {9, 1, 9}),
                            with_sphere({1000, 0, -50}, 0.01), with_sphere(Vec3(0), 1e5)}) {
            complete(scene, aspect);
            check_framing(scene, aspect);
        }
    }
}

TEST_CASE("The camera stands at the front, to the right and above") {
    Scene scene = with_sphere({3, 4, 5}, 2);
    complete(scene, 1);
    REQUIRE(scene.cameras.size() == 1);
    CHECK(scene.camera == 0);
    const Camera& camera = scene.cameras[0];
    CHECK(camera.position.x > 3);
    CHECK(camera.position.y > 4);
    CHECK(camera.position.z > 5);
    CHECK(camera.fov == Approx(radians(40)));
    CHECK(camera.side == Camera::Side::horizontal);
}

TEST_CASE("An orthographic or vertical camera is framed as well") {
    const Scene scene = with_box({0, 0, 0}, {4, 1, 2});
    for (const auto projection :
         {Camera::Projection::orthographic, Camera::Projection::perspective}) {
        for (const auto side : {Camera::Side::horizontal, Camera::Side::vertical}) {
            for (const double aspect : {0.5, 2.0}) {
                Scene framed = scene;
                Camera camera = default_camera();
                camera.projection = projection;
                camera.side = side;
                frame(camera, scene, aspect);
                framed.cameras = {camera};
                framed.camera = 0;
                check_framing(framed, aspect);
            }
        }
    }
}

TEST_CASE("A scene that has a camera and lights keeps them as they are") {
    Scene scene = with_sphere();
    scene.cameras = {{.name = "first"}, {.name = "second"}};
    scene.lights = {{.name = "lamp"}};
    complete(scene, 1);
    CHECK(scene.cameras.size() == 2);
    CHECK(scene.camera == 0);
    CHECK(scene.lights.size() == 1);
    scene.camera = 1;
    complete(scene, 1);
    CHECK(scene.camera == 1);
}

TEST_CASE("What has no material gets the one called default") {
    Scene scene = with_box({0, 0, 0}, {1, 1, 1});
    scene.materials = {{.name = "red"}};
    scene.spheres = {{}, {.material = 0}};
    scene.planes = {{}};
    complete(scene, 1);
    REQUIRE(scene.materials.size() == 2);
    CHECK(scene.materials[1].name == "default");
    CHECK(scene.meshes[0].material == 1);
    CHECK(scene.spheres[0].material == 1);
    CHECK(scene.spheres[1].material == 0);
    CHECK(scene.planes[0].material == 1);
    CHECK(defects(scene).empty());
}

TEST_CASE("A material called default that is there is used") {
    Scene scene = with_sphere();
    scene.materials = {{.name = "default", .diffuse = 0.5F}};
    complete(scene, 1);
    CHECK(scene.materials.size() == 1);
    CHECK(scene.spheres[0].material == 0);
}

TEST_CASE("A full scene needs no material beside its own") {
    Scene scene = with_sphere();
    scene.materials = {{.name = "red"}};
    scene.spheres[0].material = 0;
    complete(scene, 1);
    CHECK(scene.materials.size() == 1);
}

TEST_CASE("The rig lights all that the camera sees and overexposes nothing") {
    for (const Vec3& from : {Vec3(0.6, 0.45, 1), Vec3(0, 0.1, -1), Vec3(-1, 0.2, 0),
                             Vec3(0.1, 1, 0.1), Vec3(0, -0.8, 1)}) {
        Scene scene = with_sphere({5, 1, 2}, 3);
        Camera camera;
        camera.direction = -from.normalized();
        camera.position = Vec3(5, 1, 2) + from.normalized() * 12;
        scene.cameras = {camera};
        complete(scene, 1.5);
        REQUIRE(scene.lights.size() == 3);
        double sum = 0, least = 1, most = 0;
        int seen = 0;
        for (const Vec3& n : directions()) {
            const Vec3 p = Vec3(5, 1, 2) + n * 3;
            const double light = lit(scene, p, n);
            most = std::max(most, light);
            if (n.dot((camera.position - p).normalized()) < 0.5) continue;  // grazed
            least = std::min(least, light);
            sum += light;
            ++seen;
        }
        CHECK(sum / seen > 0.4);
        CHECK(least > 0.05);
        CHECK(most > 0.7);
        CHECK(most < 0.95);
    }
}

TEST_CASE("The key light comes from the upper left of the picture and has a soft shadow") {
    Scene scene = with_sphere(Vec3(0), 2);
    complete(scene, 1);
    const Light& key = scene.lights.at(0);
    const View view = view_of(scene.cameras[0], 100, 100);
    CHECK(key.name == "key");
    CHECK(key.position.dot(view.right) < 0);
    CHECK(key.position.dot(view.up) > 0);
    CHECK(key.position.dot(view.direction) < 0);
    const double radius = bounds(scene).radius();
    CHECK(key.penumbra.layout == Penumbra::Layout::axes);
    CHECK(key.penumbra.delta > 0.02 * radius);
    CHECK(key.penumbra.delta < 0.08 * radius);
    CHECK(scene.lights.at(1).position.dot(view.right) > 0);
    CHECK(scene.lights.at(2).position.dot(view.direction) > 0);
    CHECK(scene.lights[1].penumbra.delta == 0);
}

TEST_CASE("The rig keeps in front of walls, floors and ceilings") {
    Scene scene = with_sphere();
    scene.planes = {{.point = {0, -1, 0}},
                    {.point = {0, 0, -2}, .normal = {0, 0, -3}},
                    {.point = {0, 2.5, 0}, .normal = {0, 1, 0}}};
    complete(scene, 1);
    for (const Light& light : scene.lights) {
        CHECK(light.position.y > -1);
        CHECK(light.position.y < 2.5);
        CHECK(light.position.z > -2);
    }
}

TEST_CASE("A camera inside of a room has its lights in the room") {
    Scene scene = with_box({-5, 0, -5}, {5, 3, 5});
    scene.cameras = {{.position = {3, 1.5, 3}, .direction = {-1, 0, -1}}};
    complete(scene, 1);
    for (const Light& light : scene.lights) {
        CHECK(std::abs(light.position.x) < 5);
        CHECK(std::abs(light.position.z) < 5);
        CHECK(light.position.y > 0);
        CHECK(light.position.y < 3);
    }
}

TEST_CASE("Without anything bounded the camera looks at the origin or at the first plane") {
    Scene nothing;
    complete(nothing, 1);
    CHECK(defects(nothing).empty());
    const Camera& camera = nothing.cameras.at(0);
    CHECK((camera.direction.normalized() + camera.position.normalized()).length() < 0.2);

    Scene floor;
    floor.planes = {{.point = {0, 10, 0}}};
    complete(floor, 1);
    CHECK(defects(floor).empty());
    CHECK(floor.cameras.at(0).position.y > 10);
    for (const Light& light : floor.lights) CHECK(light.position.y > 10);

    Scene flat = with_box({1, 2, 3}, {1, 2, 3});
    complete(flat, 1);
    CHECK(defects(flat).empty());
}
