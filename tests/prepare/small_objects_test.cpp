// What is too small for its scene is said.
#include "prepare/small_objects.h"
#include "prepare/surfaces/narrow_facets.h"
#include "prepare/surfaces/near_surfaces.h"
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/prepare.h"

using namespace penumbra;

namespace {

constexpr int width = 160, height = 120;

Losses losses_of(const Scene& scene) { return losses_by_size(scene, bounds(scene), width, height); }

Losses by_nearness(const Scene& scene) {
    return losses_by_nearness(scene, bounds(scene), width, height);
}

// Ground of that side, and a camera that sees one unit around the origin from near.
Scene ground(float side) {
    Scene scene = test::empty_scene();
    const float h = side / 2;
    test::add_mesh(scene, {{-h, 0, -h}, {h, 0, -h}, {h, 0, h}, {-h, 0, h}}, {{0, 2, 1}, {0, 3, 2}});
    scene.cameras[0].position = {0, 0.5, 2};
    return scene;
}

void add_plate(Scene& scene, const Vec3f& size) {
    std::vector<Vec3f> corners;
    for (unsigned i = 0; i < 8; ++i)
        corners.push_back(size * Vec3f(float(i & 1U), float(i >> 1U & 1U), float(i >> 2U & 1U)));
    test::add_mesh(scene, corners,
                   {{0, 1, 3},
                    {0, 3, 2},
                    {4, 7, 5},
                    {4, 6, 7},
                    {0, 4, 5},
                    {0, 5, 1},
                    {2, 3, 7},
                    {2, 7, 6},
                    {0, 2, 6},
                    {0, 6, 4},
                    {1, 5, 7},
                    {1, 7, 3}});
    scene.instances.back().name = "plate";
}

}  // namespace

TEST_CASE("Thin things in a large scene are a loss, which names the size") {
    Scene scene = ground(100000);
    CHECK(losses_of(scene).empty());  // the ground itself is flat
    add_plate(scene, {0.4F, 0.004F, 0.3F});
    const Losses losses = losses_of(scene);
    REQUIRE(losses.size() == 1);
    CHECK(losses[0].kind == Loss::approximated);
    CHECK(losses[0].count == 1);
    INFO(losses[0].what);
    CHECK(losses[0].what.find("1 of 2 objects is thinner than") == 0);
    CHECK(losses[0].what.find("'plate', of 0.004") != std::string::npos);

    Scene small = ground(1);
    add_plate(small, {0.4F, 0.004F, 0.3F});
    CHECK(losses_of(small).empty());
}

TEST_CASE("Sheets that float nearer to others than the tolerance are a loss, where it shows") {
    Scene scene = ground(20000);
    const auto add_card = [&](float height, Index material) {
        test::add_mesh(scene, {{-1, height, -1}, {1, height, -1}, {1, height, 1}, {-1, height, 1}},
                       {{0, 2, 1}, {0, 3, 2}}, material);
        scene.instances.back().name = "card";
    };
    Material glazed = test::matte();
    glazed.opacity = 0.5F;
    scene.materials = {test::matte(), glazed};
    const bool lets_light_pass = GENERATE(true, false);
    add_card(0.2F, lets_light_pass ? 1 : 0);
    CHECK(by_nearness(scene).empty());
    scene.meshes.pop_back();
    scene.instances.pop_back();
    add_card(0.03F, lets_light_pass ? 1 : 0);
    const Losses losses = by_nearness(scene);
    REQUIRE(losses.size() == 1);
    INFO(losses[0].what);
    CHECK(losses[0].count == 2);
    CHECK(losses[0].what.find("2 facets lie nearer to others than 0.064") == 0);
    CHECK(losses[0].what.find("the nearest is of 'card', 0.03 from") != std::string::npos);
    // From farther away the shadow that an opaque card loses is narrower than a pixel.
    scene.cameras[0].position = {0, 50, 200};
    CHECK(by_nearness(scene).empty() != lets_light_pass);
}

TEST_CASE("Thin parts of a mesh are a loss, whatever else is in the mesh") {
    Scene scene = ground(100000);
    add_plate(scene, {0.4F, 0.004F, 0.3F});
    // Two plates and a far box in one mesh.
    Mesh& plates = scene.meshes.back();
    const std::vector<Vec3f> corners = plates.positions;
    const auto triangles = plates.triangles;
    for (const Vec3f& move : {Vec3f(3, 0, 0), Vec3f(40000, 0, 0)}) {
        const auto first = Index(plates.positions.size());
        const float size = move.x > 3 ? 100 : 1;
        for (const Vec3f& corner : corners) plates.positions.push_back(corner * size + move);
        for (const auto& [a, b, c] : triangles)
            plates.triangles.push_back({first + a, first + b, first + c});
    }
    const Losses losses = losses_of(scene);
    REQUIRE(losses.size() == 1);
    CHECK(losses[0].count == 3);
    CHECK(losses[0].what.find("3 of 4 objects are thinner than 0.") == 0);
    CHECK(losses[0].what.ends_with("the thinnest is 'plate', of 0.004"));
}

TEST_CASE("An object that is turned is as thin as before") {
    Scene scene = ground(100000);
    add_plate(scene, {0.4F, 0.004F, 0.3F});
    scene.instances.back().transform.rotate(Vec3(0.5, 0.3, 0.8));
    REQUIRE(losses_of(scene).size() == 1);
}

TEST_CASE("Where all objects are smaller than a pixel, the farthest is named") {
    Scene scene = test::empty_scene();
    scene.spheres = {{.name = "a"},
                     {.name = "b", .center = {3, 0, 0}},
                     {.name = "lost", .center = {1e6, 0, 0}},
                     {.name = "c", .center = {0, 3, 0}}};
    scene.cameras.clear();
    complete(scene, double(width) / height);
    const Losses losses = losses_of(scene);
    REQUIRE(!losses.empty());
    INFO(losses.back().what);
    CHECK(losses.back().place == "camera");
    CHECK(losses.back().what.find("'lost' at (1e+06, 0, 0)") != std::string::npos);

    scene.spheres.erase(scene.spheres.begin() + 2);
    scene.cameras.clear();
    complete(scene, double(width) / height);
    CHECK(losses_of(scene).empty());
}

// Within half a metre of 20 km nothing is parted from what it lies on.
TEST_CASE("Facets too narrow to be parted are a loss where they can be seen") {
    const auto losses_of_sticker = [](float size, float distance) {
        Scene scene = ground(20000);
        test::add_quad(scene, {0, 0, 0.001F}, {size, 0, 0.001F}, {size, size, 0.001F},
                       {0, size, 0.001F});
        scene.instances.back().name = "sticker";
        scene.cameras[0].position = {0, 0.5, distance};
        return losses_by_narrowness(scene, bounds(scene), width, height);
    };
    const Losses losses = losses_of_sticker(0.4F, 2);
    REQUIRE(losses.size() == 1);
    CHECK(losses[0].kind == Loss::approximated);
    CHECK(losses[0].count == 2);
    CHECK(losses[0].what.find("2 facets that can be seen are narrower than 0.49") == 0);
    CHECK(losses[0].what.find("'sticker'") != std::string::npos);
    CHECK(losses_of_sticker(2, 2).empty());
    CHECK(losses_of_sticker(0.4F, 300).empty());  // less than a pixel
}
