// Surfaces that lie on one another are parted, and nothing else is touched.
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/prepare.h"

#include <cmath>

using namespace penumbra;
using test::add_mesh;
using test::matte;

namespace {

// Radius 8: a sixteenth of what it becomes.
constexpr double layer = 2.5e-3 / 16;

// In the plane z = 0, its front towards +z.
void add_sheet(Scene& scene, float left, float bottom, float right, float top, Index material = 0) {
    test::add_quad(scene, {left, bottom, 0}, {right, bottom, 0}, {right, top, 0}, {left, top, 0},
                   material);
}

void add_box(Scene& scene, const Vec3f& low, const Vec3f& high, Index material = 0) {
    std::vector<Vec3f> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                             (i & 4) != 0 ? high.z : low.z);
    add_mesh(scene, corners,
             {{0, 2, 1},
              {1, 2, 3},
              {4, 5, 6},
              {5, 7, 6},
              {0, 1, 4},
              {1, 5, 4},
              {2, 6, 3},
              {3, 6, 7},
              {0, 4, 2},
              {2, 4, 6},
              {1, 3, 5},
              {3, 7, 5}},
             material);
}

Material colored(float red) {
    Material m = matte();
    m.color = Color(red, 0.5F, 0.5F);
    return m;
}

Material glazed() {
    Material m = matte();
    m.opacity = 0.5F;
    return m;
}

// A wall from -6 to 6: the scene's radius is 8.5, its factor 1.
Scene wall() {
    Scene scene = test::empty_scene();
    scene.materials = {matte(), colored(1), glazed(), colored(0.2F)};
    add_sheet(scene, -6, -6, 6, 6);
    return scene;
}

// How far the mesh of an instance lies before the plane z = 0; NaN where it is not flat.
double height(const Scene& scene, std::size_t instance) {
    const Instance& shown = scene.instances[instance];
    double first = 0;
    for (std::size_t i = 0; i < scene.meshes[shown.mesh].positions.size(); ++i) {
        const double z = (Vec3(scene.meshes[shown.mesh].positions[i]) * shown.transform).z;
        if (i == 0) first = z;
        if (std::abs(z - first) > 1e-6) return std::nan("");
    }
    return first;
}

bool same_positions(const Scene& a, const Scene& b) {
    if (a.meshes.size() != b.meshes.size()) return false;
    for (std::size_t i = 0; i < a.meshes.size(); ++i)
        if (a.meshes[i].positions != b.meshes[i].positions) return false;
    return true;
}

void check_untouched(const Scene& scene) {
    Scene after = scene;
    CHECK(part_surfaces(after).empty());
    CHECK(same_positions(scene, after));
}

}  // namespace

TEST_CASE("part_surfaces, lifts the later one off the earlier one, and says how far") {
    Scene scene = wall();
    add_sheet(scene, -1, -1, 2, 3, 1);
    const Losses losses = part_surfaces(scene);
    REQUIRE(losses.size() == 1);
    CHECK(losses[0].kind == Loss::approximated);
    CHECK(losses[0].count == 2);
    CHECK(losses[0].what.find("2 that lie in one plane with others are lifted off it by 0.00016") ==
          0);
    CHECK(height(scene, 0) == 0);
    CHECK(height(scene, 1) == Approx(layer));
}

TEST_CASE("part_surfaces, stacks layers in the order of the file, what is blended on top") {
    Scene scene = wall();
    add_sheet(scene, -1, -1, 2, 3, 2);  // blended
    add_sheet(scene, 0, 0, 3, 4, 1);
    add_sheet(scene, 1, 1, 4, 5, 3);
    add_sheet(scene, -5, -5, -3, -3, 3);  // beside the others
    part_surfaces(scene);
    CHECK(height(scene, 0) == 0);
    CHECK(height(scene, 1) == Approx(3 * layer));
    CHECK(height(scene, 2) == Approx(layer));
    CHECK(height(scene, 3) == Approx(2 * layer));
    CHECK(height(scene, 4) == Approx(layer));
}

TEST_CASE("part_surfaces, leaves what shares an edge, looks alike or lies apart") {
    Scene scene = wall();
    SECTION("an edge") { add_sheet(scene, 6, -6, 8, 6, 1); }
    SECTION("a part of an edge, but for rounding") { add_sheet(scene, 5.99999F, 1, 8, 2, 1); }
    SECTION("one colour") { add_sheet(scene, -1, -1, 2, 3); }
    SECTION("another plane") {
        add_sheet(scene, -1, -1, 2, 3, 1);
        scene.instances[1].transform[3][2] = 1e-3;
    }
    SECTION("another angle") {
        add_mesh(scene, {{-1, -1, -1}, {2, -1, -1}, {0, 3, 1}}, {{0, 1, 2}}, 1);
    }
    SECTION("nowhere") { add_mesh(scene, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}, 1); }
    check_untouched(scene);
}

TEST_CASE("part_surfaces, parts a sheet that is folded onto itself") {
    Scene scene = test::empty_scene();
    scene.materials = {matte(), colored(1), glazed(), colored(0.2F)};
    // The second half hangs on the edge from 1 to 2 and lies on the first.
    add_mesh(scene, {{-6, -6, 0}, {6, -6, 0}, {6, 6, 0}, {-6, 6, 0}, {0, -5, 0}, {0, 5, 0}},
             {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}});
    double side = -1;
    SECTION("of one colour") { return check_untouched(scene); }
    SECTION("of several colours, to the side that it faces") {
        scene.meshes[0].colors = {Color(1), Color(1), Color(0), Color(0), Color(1), Color(0)};
    }
    SECTION("onto its front") {
        scene.meshes[0].colors = {Color(1), Color(1), Color(0), Color(0), Color(1), Color(0)};
        for (std::size_t i = 2; i < 4; ++i)
            std::swap(scene.meshes[0].triangles[i][1], scene.meshes[0].triangles[i][2]);
        side = 1;
    }
    const Losses losses = part_surfaces(scene);
    REQUIRE(losses.size() == 1);
    CHECK(losses[0].count == 2);
    const Mesh& mesh = scene.meshes[0];
    CHECK(mesh.positions.size() == 10);
    CHECK(mesh.colors.size() == 10);
    for (std::size_t i = 0; i < 4; ++i)
        for (const Index corner : mesh.triangles[i])
            CHECK(double(mesh.positions[corner].z) == Approx(i < 2 ? 0 : side * layer));
}

TEST_CASE("part_surfaces, parts blended facets that a mesh has twice") {
    Scene scene = wall();
    scene.meshes[0].material = 2;
    auto& triangles = scene.meshes[0].triangles;
    triangles = {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}};
    Scene both_sides = scene;
    for (std::size_t i = 2; i < 4; ++i)
        std::swap(both_sides.meshes[0].triangles[i][1], both_sides.meshes[0].triangles[i][2]);
    check_untouched(both_sides);  // the two sides of a sheet
    CHECK(part_surfaces(scene).at(0).count == 2);
    REQUIRE(scene.meshes[0].positions.size() == 8);
    CHECK(double(scene.meshes[0].positions[scene.meshes[0].triangles[0][0]].z) == 0);
    CHECK(double(scene.meshes[0].positions[scene.meshes[0].triangles[3][0]].z) == Approx(layer));
}

TEST_CASE("part_surfaces, leaves bodies that touch and what stands on a plane") {
    Scene scene = test::empty_scene();
    scene.materials = {matte(), colored(1)};
    add_box(scene, {-6, 0, -6}, {6, 2, 6});
    add_box(scene, {-1, 2, -1}, {1, 5, 1}, 1);
    scene.planes = {{.name = "ground", .material = 1}};
    check_untouched(scene);
}

TEST_CASE("part_surfaces, lifts what lies flat on a plane of the scene, whichever way it faces") {
    for (const float side : {1.0F, -1.0F}) {
        Scene scene = wall();
        scene.instances.clear();
        scene.meshes.clear();
        add_sheet(scene, -6 * side, -6, 6 * side, 6, 1);
        scene.planes = {{.name = "ground", .normal = {0, 0, 3}, .material = 0}};
        CHECK(part_surfaces(scene).size() == 1);
        CHECK(height(scene, 0) == Approx(layer));
    }
}

TEST_CASE("part_surfaces, lifts a sheet off the body that it lies on, whichever way it faces") {
    for (const float side : {1.0F, -1.0F}) {
        Scene scene = wall();
        scene.instances.clear();
        scene.meshes.clear();
        add_box(scene, {-6, -6, -3}, {6, 6, 0});
        add_sheet(scene, -1 * side, -1, 1 * side, 1, 1);
        CHECK(part_surfaces(scene).size() == 1);
        CHECK(height(scene, 1) == Approx(layer));
    }
}

TEST_CASE("part_surfaces, keeps what it lifts together") {
    Scene scene = test::empty_scene();
    scene.materials = {matte(), glazed()};
    add_box(scene, {-5, -5, -5}, {5, 5, 5});
    SECTION("a glaze all round") {
        add_box(scene, {-5, -5, -5}, {5, 5, 5}, 1);
        REQUIRE(part_surfaces(scene).size() == 1);
        for (const Vec3f& p : scene.meshes[1].positions)
            for (const float x : {p.x, p.y, p.z}) CHECK(std::abs(x) == Approx(5 + layer));
        CHECK(scene.meshes[0].positions[0] == Vec3f(-5));
    }
    SECTION("the sides of a body of which the top is lifted") {
        scene.materials.push_back(colored(1));
        add_box(scene, {-1, -1, -1}, {9, 1, 5}, 2);
        REQUIRE(part_surfaces(scene)[0].count == 2);
        for (const Vec3f& p : scene.meshes[1].positions)
            CHECK((p.z == -1 || p.z == Approx(5 + layer)));
    }
}

TEST_CASE("part_surfaces, moves neither a body nor the sheet that it stands on, in any order") {
    const bool sheet_first = GENERATE(true, false), one_sided = GENERATE(true, false);
    Scene scene = wall();
    add_box(scene, {-0.3F, -0.3F, 0}, {0.3F, 0.3F, 2}, 1);
    if (!sheet_first) std::swap(scene.instances[0], scene.instances[1]);
    if (one_sided)
        for (Material& m : scene.materials) m.sides = Sides::front;
    const Losses losses = part_surfaces(scene);
    REQUIRE(losses.size() == 1);
    CHECK(losses[0].count == 2);
    CHECK(losses[0].what.find("off it by 9.4e-06") != std::string::npos);
    for (const Vec3f& p : scene.meshes[0].positions) CHECK(p.z == 0);
    const Mesh& box = scene.meshes[1];
    // The bottom goes where the sheet does not hide what comes later.
    const double bottom = (sheet_first || one_sided ? -1 : 1) * layer * 0.06;
    for (std::size_t i = 0; i < box.triangles.size(); ++i)
        for (const Index corner : box.triangles[i]) {
            const double z = box.positions[corner].z;
            CHECK((i < 2 ? z == Approx(bottom) : z == 0 || z == 2));
        }
}

TEST_CASE("part_surfaces, leaves the largest sheet where it is, and keeps the order") {
    Scene scene = wall();
    add_sheet(scene, 0, 0, 0.6F, 0.5F, 1);
    add_sheet(scene, 0.3F, 0.2F, 0.9F, 0.7F, 3);
    std::swap(scene.instances[0], scene.instances[2]);  // the wall is the last one
    REQUIRE(part_surfaces(scene)[0].count == 4);
    CHECK(height(scene, 2) == 0);
    CHECK(height(scene, 1) == Approx(-layer));
    CHECK(height(scene, 0) == Approx(-2 * layer));
}

TEST_CASE("part_surfaces, gives an instance a mesh of its own where others show it elsewhere") {
    Scene scene = wall();
    add_sheet(scene, -1, -1, 2, 3, 1);
    scene.instances.push_back(scene.instances[1]);
    scene.instances[2].transform[3][2] = 4;
    scene.instances.push_back(scene.instances[1]);
    scene.instances[3].transform[3][0] = -3.5;
    part_surfaces(scene);
    REQUIRE(scene.meshes.size() == 3);
    CHECK(scene.instances[2].mesh == 1);
    CHECK(scene.meshes[1].positions[0].z == 0);
    CHECK(scene.instances[1].mesh == 2);
    CHECK(scene.instances[3].mesh == 2);
    CHECK(height(scene, 3) == Approx(layer));
}

TEST_CASE("part_surfaces, finds two layers of one mesh, in all of its instances at once") {
    Scene scene = wall();
    scene.materials[0].color = Color(0.5F);
    scene.instances.clear();
    scene.meshes.clear();
    add_mesh(scene,
             {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {-1, -0.5F, 0}, {1, -0.5F, 0}, {0, 1.5F, 0}},
             {{0, 1, 2}, {3, 4, 5}});
    scene.meshes[0].colors.assign(6, Color(1));
    scene.meshes[0].colors[4] = Color(0);
    for (int i = 0; i < 3; ++i) {
        scene.instances.push_back(scene.instances[0]);
        scene.instances.back().transform.rotate(Vec3(0, i + 1, 0));
        scene.instances.back().transform[3][0] = 3 * i - 5;
    }
    CHECK(part_surfaces(scene)[0].count == 4);
    REQUIRE(scene.meshes.size() == 1);
    CHECK(scene.meshes[0].positions[0].z == 0);
    CHECK(scene.meshes[0].positions[5].z > float(layer) / 4);
}

TEST_CASE("part_surfaces, does so far from the origin, in any units, turned and mirrored") {
    for (const double scale : {0.01, 1.0, -300.0}) {
        Scene scene = wall();
        add_sheet(scene, -1, -1, 2, 3, 1);
        Matrix turned;
        turned.rotate(Vec3(0.3, 1.2, -0.4));
        Matrix scaled;
        scaled.setScale(Vec3(scale));
        for (Instance& i : scene.instances) i.transform = scaled * turned;
        test::move_by(scene, Vec3(1e5, -2e6, 3e5) * std::abs(scale));
        REQUIRE(part_surfaces(scene).size() == 1);
        const NormalisedScene normalised = normalise(scene, {});
        const auto place = [&](std::size_t i) {
            const Instance& instance = normalised.scene.instances[i];
            return Vec3(normalised.scene.meshes[instance.mesh].positions[0]) * instance.transform;
        };
        const Vec3 front = (Vec3(0, 0, 1) * turned) * (scale < 0 ? -1 : 1);
        CHECK((place(1) - place(0)).dot(front) > 1.2e-3);
        CHECK((place(1) - place(0)).dot(front) < 6e-3);
    }
}

TEST_CASE("part_surfaces, parts spheres and planes of the scene") {
    Scene scene = test::empty_scene();
    scene.materials = {matte(), glazed()};
    scene.spheres = {{.radius = 8, .material = 1},
                     {.radius = 8, .material = 0},
                     {.radius = 8, .material = 0},
                     {.radius = 7, .material = 0}};
    scene.planes = {{.normal = {0, 2, 0}, .material = 0},
                    {.point = {3, 0, 1}, .normal = {0, -1, 0}, .material = 1},
                    {.point = {0, 1, 0}, .material = 0}};
    const Losses losses = part_surfaces(scene);
    REQUIRE(losses.size() == 2);
    CHECK(losses[0].count == 1);
    CHECK(losses[1].count == 2);
    REQUIRE(scene.spheres.size() == 3);
    CHECK(scene.spheres[0].radius == Approx(8 + layer));
    CHECK(scene.spheres[1].radius == 8);
    CHECK(scene.planes[0].point.y == 0);
    CHECK(scene.planes[1].point.y == Approx(layer));
    CHECK(scene.planes[2].point.y == 1);
}
