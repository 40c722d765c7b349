// Facets that are not there from behind.
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/tracer.h"

using namespace penumbra;

namespace {

// A glowing red sheet across the view, with the back to the camera, before a green wall.
Scene with_back(Sides sides = Sides::front) {
    Scene scene = test::empty_scene();
    Material sheet = test::matte();
    sheet.color = {1, 0, 0};
    sheet.ambient = Color(1);
    sheet.diffuse = 0;
    sheet.specular = 1;
    sheet.reflection = Color(0.5F);
    sheet.sides = sides;
    scene.materials.push_back(sheet);
    Material wall = test::matte();
    wall.color = {0, 1, 0};
    wall.ambient = Color(1);
    scene.materials.push_back(wall);
    test::add_quad(scene, {-2, 2, 0}, {2, 2, 0}, {2, -2, 0}, {-2, -2, 0}, 1);
    scene.planes = {{"wall", {0, 0, -3}, {0, 0, 1}, 2}};
    return scene;
}

Color in_the_middle(const Scene& scene, int max_depth = 5) {
    RenderOptions options;
    options.width = options.height = 8;
    options.max_depth = max_depth;
    return render(test::as_is(scene), options).at(3, 4);
}

}  // namespace

TEST_CASE("A back, is not there: no colour, highlight or mirror") {
    Scene scene = with_back();
    scene.lights = {{.position = {0, 0, 20}}};
    scene.materials[2].diffuse = 0;
    CHECK(in_the_middle(scene) == Color(0, 1, 0));
    scene.materials[1].sides = Sides::both;
    CHECK(in_the_middle(scene).x >= 1);
}

TEST_CASE("A back, is the side of clockwise corners in the mesh's space, mirrored or not") {
    Scene scene = with_back();
    scene.instances[0].transform.setScale(Vec3(-1, 1, 1));
    CHECK(in_the_middle(scene) == Color(0, 1, 0));
    scene.instances[0].transform.setScale(Vec3(1, 1, -1));  // brings the other side to the front
    CHECK(in_the_middle(scene).x >= 1);
}

TEST_CASE("A back, adds no segment to the path but needs one") {
    CHECK(in_the_middle(with_back(), 2) == Color(0, 1, 0));
    CHECK(in_the_middle(with_back(), 1) == Color(0));
}

TEST_CASE("A back, of an opaque facet casts its shadow as its front does") {
    Scene scene = with_back();
    scene.cameras[0].position = {0, 0, -2};  // between both, towards the wall
    scene.materials[2].ambient = Color(0);
    scene.lights = {{.position = {0, 0, 20}}};
    CHECK(in_the_middle(scene) == Color(0));
    scene.materials[1].opacity = 0.25F;
    CHECK(in_the_middle(scene).y == Approx(0.75).margin(0.01));
    std::swap(scene.meshes[0].triangles[0][1], scene.meshes[0].triangles[0][2]);
    std::swap(scene.meshes[0].triangles[1][1], scene.meshes[0].triangles[1][2]);
    CHECK(in_the_middle(scene).y == Approx(0.75).margin(0.01));
}

TEST_CASE("A back, of a smooth facet shows where its normals lean away by more") {
    Scene scene = with_back();
    // The normals lean by 45 degrees; the ray meets their mean at right angles.
    scene.meshes[0].normals = {Vec3f(1, 1, -1).normalized(), Vec3f(-1, 1, -1).normalized(),
                               Vec3f(-1, -1, -1).normalized(), Vec3f(1, -1, -1).normalized()};
    CHECK(in_the_middle(scene) == Color(0, 1, 0));
    scene.meshes[0].normals = std::vector<Vec3f>(4, Vec3f(0.9F, 0, -0.43589F));
    scene.meshes[0].normals[3] = Vec3f(0.91F, 0, -0.41461F);
    CHECK(in_the_middle(scene).x >= 1);  // 26 degrees to the surface of the normals, which lean 64
}
