// One-sided facets that lie back to back, and what is said of backs that cannot be hidden.
#include "prepare/body.h"
#include "scene/sides.h"
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/prepare.h"
#include "penumbra/tracer.h"

#include <string>

using namespace penumbra;

namespace {

const std::vector<Vec3f> corners = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};

Index add_color(Scene& scene, const Color& color, Sides sides = Sides::front) {
    Material material = test::matte();
    material.color = color;
    material.ambient = Color(1);
    material.diffuse = 0;
    material.sides = sides;
    scene.materials.push_back(material);
    return Index(scene.materials.size() - 1);
}

// A red sheet towards the camera and a blue one away from it, in the same place.
Scene two_colors(Sides sides = Sides::front) {
    Scene scene = test::empty_scene();
    test::add_mesh(scene, corners, {{0, 1, 2}, {0, 2, 3}}, add_color(scene, {1, 0, 0}, sides));
    test::add_mesh(scene, corners, {{2, 1, 0}, {3, 2, 0}}, add_color(scene, {0, 0, 1}, sides));
    return scene;
}

Color in_the_middle(Scene scene) {
    RenderOptions options;
    options.width = options.height = 8;
    return render(normalise(std::move(scene), options), options).at(3, 4);
}

Scene seen_from_behind(Scene scene) {
    scene.cameras[0].position = {0, 0, -10};
    scene.cameras[0].direction = {0, 0, 1};
    return scene;
}

// A cube with normals that lean, as if it were a ball.
Scene smooth_cube() {
    Scene scene = test::empty_scene();
    scene.materials[0].sides = Sides::front;
    std::vector<Vec3f> positions;
    for (int i = 0; i < 8; ++i)
        positions.emplace_back(i & 1 ? 1.0F : -1.0F, i & 2 ? 1.0F : -1.0F, i & 4 ? 1.0F : -1.0F);
    test::add_mesh(scene, positions,
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
                    {3, 7, 5}});
    for (const Vec3f& p : positions) scene.meshes[0].normals.push_back(p.normalized());
    return scene;
}

}  // namespace

TEST_CASE("Facets back to back, each show their own side") {
    Scene scene = two_colors();
    CHECK(lift_back_to_back_facets(scene) == 4);
    CHECK(drop_coincident_facets(scene) == 0);
    CHECK(in_the_middle(scene) == Color(1, 0, 0));
    CHECK(in_the_middle(seen_from_behind(scene)) == Color(0, 0, 1));
}

TEST_CASE("Facets back to back, are moved by far less than a pixel") {
    Scene scene = two_colors();
    lift_back_to_back_facets(scene);
    const Bounds box = bounds(scene);
    CHECK(box.max.z > 1e-6);
    CHECK(box.max.z < 1e-5);
    CHECK(box.min.z == -box.max.z);
}

TEST_CASE("Facets back to back, may be of one mesh, mirrored, or shared") {
    Scene scene = two_colors();
    // What mirrors turns winding and front alike.
    scene.instances[0].transform.setScale(Vec3(-2, 2, 2));
    scene.instances[1].transform.setScale(Vec3(-2, 2, 2));
    scene.instances.push_back(scene.instances[0]);
    scene.instances.back().transform[3][0] = 30;
    CHECK(lift_back_to_back_facets(scene) == 4);
    CHECK(in_the_middle(scene) == Color(1, 0, 0));

    Scene mesh = test::empty_scene();
    test::add_mesh(mesh, corners, {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}},
                   add_color(mesh, {0, 1, 0}));
    CHECK(lift_back_to_back_facets(mesh) == 4);
    CHECK(in_the_middle(mesh) == Color(0, 1, 0));
    CHECK(in_the_middle(seen_from_behind(mesh)) == Color(0, 1, 0));
}

TEST_CASE("Facets back to back, are those that show opposite sides") {
    Scene both = two_colors(Sides::both);
    CHECK(lift_back_to_back_facets(both) == 0);
    Scene same = two_colors();
    same.meshes[1].triangles = same.meshes[0].triangles;
    CHECK(lift_back_to_back_facets(same) == 0);
    CHECK(drop_coincident_facets(same) == 2);
    Scene apart = two_colors();
    apart.instances[1].transform[3][2] = -0.01;
    CHECK(lift_back_to_back_facets(apart) == 0);
}

TEST_CASE("Facets that show both sides, are kept behind those that show one") {
    Scene scene = two_colors();
    scene.materials[scene.meshes[0].material].sides = Sides::both;
    CHECK(drop_coincident_facets(scene) == 0);
    CHECK(part_surfaces(scene).size() == 1);
    CHECK(in_the_middle(scene) == Color(1, 0, 0));
    CHECK(in_the_middle(seen_from_behind(scene)) == Color(0, 0, 1));
}

TEST_CASE("Shown backs, are named for each material") {
    Scene scene = smooth_cube();
    CHECK(shown_backs(scene).empty());  // closed
    scene.meshes[0].triangles.pop_back();
    const Losses losses = shown_backs(scene);
    REQUIRE(losses.size() == 1);
    CHECK(losses[0].place == "matte");
    CHECK(losses[0].what ==
          "its backs are shown where they are seen at less than 55 degrees: POV-Ray tells the "
          "sides of smooth facets by their normals");
    scene.materials[0].smooth = false;
    CHECK(shown_backs(scene).empty());
}

TEST_CASE("Bodies with vertex colours, show both sides where nobody sees their backs") {
    // A cube of which each facet has vertices of its own, with normals that lean by 3 degrees.
    const Scene cube = smooth_cube();
    Scene scene = cube;
    Mesh& mesh = scene.meshes[0];
    mesh = {.name = "cube", .material = 0};
    for (const auto& triangle : cube.meshes[0].triangles) {
        const auto corner = [&](std::size_t i) { return cube.meshes[0].positions[triangle[i]]; };
        const Vec3f front = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
        const auto first = Index(mesh.positions.size());
        for (std::size_t i = 0; i < 3; ++i) {
            mesh.positions.push_back(corner(i));
            mesh.normals.push_back((front + corner(i).normalized() * 0.06F).normalized());
            mesh.colors.emplace_back(1, float(i) / 2, 0);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    REQUIRE(backs(scene).at(0).hidden);
    const auto sides = [](Scene changed) {
        show_whole_bodies(changed);
        return changed.materials[changed.meshes[0].material].sides;
    };
    CHECK(sides(scene) == Sides::both);
    Scene inside = scene;
    inside.cameras[0].position = {0, 0, 0};
    CHECK(sides(inside) == Sides::front);
    mesh.triangles.pop_back();  // a hole, through which backs are seen
    CHECK(sides(scene) == Sides::front);
}

TEST_CASE("Shown backs, are named of bodies that are seen through or inside out") {
    Scene scene = smooth_cube();
    scene.materials[0].opacity = 0.5F;
    CHECK(shown_backs(scene).size() == 1);
    scene = smooth_cube();
    for (auto& [a, b, c] : scene.meshes[0].triangles) std::swap(b, c);
    for (Vec3f& n : scene.meshes[0].normals) n = -n;
    CHECK(shown_backs(scene).size() == 1);
}
