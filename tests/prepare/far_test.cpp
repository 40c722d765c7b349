// Scenes far from the origin: the same pictures as near it.
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/prepare.h"
#include "penumbra/tracer.h"

#include <cmath>

using namespace penumbra;
using test::matte;

namespace {

// A waved sheet of 20 x 20 squares around `middle`, in coordinates that float32 has exactly, and
// what looks at it.
Scene waves(const Vec3& middle, bool by_vertices) {
    Scene scene = test::empty_scene();
    const Vec3 origin = by_vertices ? middle : Vec3(0);
    std::vector<Vec3f> positions;
    std::vector<std::array<Index, 3>> triangles;
    for (int row = 0; row <= 20; ++row)
        for (int column = 0; column <= 20; ++column)
            positions.emplace_back(
                Vec3((column - 10) / 4.0, (row - 10) / 4.0, (row + 2 * column) % 5 / 4.0) + origin);
    for (Index row = 0; row < 20; ++row)
        for (Index column = 0; column < 20; ++column) {
            const Index a = row * 21 + column;
            triangles.push_back({a, a + 1, a + 22});
            triangles.push_back({a, a + 22, a + 21});
        }
    test::add_mesh(scene, positions, triangles);
    scene.instances[0].transform.setTranslation(middle - origin);
    // No ray meets an edge, where either facet would be right.
    scene.cameras[0].position = middle + Vec3(0.013, 0.007, 10);
    scene.lights = {{.position = middle + Vec3(5, 5, 5)}, {.position = middle + Vec3(-9, 1, 2)}};
    return scene;
}

Image picture(const Scene& scene) {
    const RenderOptions options = {.width = 80, .height = 60};
    return render(normalise(scene, options), options);
}

}  // namespace

TEST_CASE("Far, a mesh looks as it does at the origin, placed by its vertices or its instance") {
    const Image near = picture(waves(Vec3(0), true));
    // 1 km; 150 km; a corner of EPSG:3857, where float32 still has quarters.
    for (const Vec3& middle :
         {Vec3(0, 0, 1000), Vec3(150000, -20, 150000), Vec3(1113194, 0, -4000000)}) {
        INFO("at " << middle.x << ' ' << middle.y << ' ' << middle.z);
        CHECK(test::share_off(picture(waves(middle, true)), near) < 0.002);
        CHECK(test::share_off(picture(waves(middle, false)), near) < 0.002);
    }
}

TEST_CASE("Far, vertices that a transform brings back to the origin are counted from near") {
    Scene scene = waves(Vec3(1113194, 0, -4000000), true);
    Scene near = waves(Vec3(0), true);
    near.meshes = scene.meshes;
    near.instances[0].transform.setTranslation(Vec3(-1113194, 0, 4000000));
    CHECK(test::share_off(picture(near), picture(waves(Vec3(0), true))) < 0.002);
    const NormalisedScene normalised = normalise(near, {});
    CHECK(std::abs(normalised.scene.meshes[0].positions[0].x) < 512);
    CHECK(std::abs(normalised.scene.instances[0].transform[3][0]) < 512);
}

TEST_CASE("Far, a mesh near its own origin keeps its vertices") {
    const Scene scene = waves(Vec3(3, 0, 0), true);
    const NormalisedScene normalised = normalise(scene, {});
    const float factor = float(normalised.factor);
    for (std::size_t i = 0; i < scene.meshes[0].positions.size(); ++i)
        REQUIRE(normalised.scene.meshes[0].positions[i] == scene.meshes[0].positions[i] * factor);
    CHECK(normalised.scene.instances[0].transform == Matrix());
}

TEST_CASE("Far, only facets that lie on one another are dropped") {
    for (const bool by_vertices : {true, false}) {
        // At 16,777,216 m neighbours in float32 are 2 m apart, and the sheet is 5 m wide.
        Scene scene = waves(by_vertices ? Vec3(150000, 0, 0) : Vec3(16777216, 0, 3), by_vertices);
        CHECK(drop_coincident_facets(scene) == 0);
        scene.meshes.push_back(scene.meshes[0]);
        scene.instances.push_back(scene.instances[0]);
        scene.instances[1].mesh = 1;
        CHECK(drop_coincident_facets(scene) == 800);
        CHECK(scene.meshes[1].triangles.size() == 800);
        CHECK(scene.meshes[0].triangles.empty());
    }
}
