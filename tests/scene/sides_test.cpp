// What a mesh shows of the backs of its facets.
#include "scene/sides.h"
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/light_model.h"

#include <cmath>

using namespace penumbra;

namespace {

// A facet across z whose normals lean by `degrees` to the side.
Scene leaning(double angle) {
    Scene scene = test::empty_scene();
    scene.materials[0].sides = Sides::front;
    test::add_mesh(scene, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    const double a = radians(angle);
    const Vec3f side(float(std::sin(a)), 0, float(std::cos(a)));
    scene.meshes[0].normals = {side, {0, 0, 1}, {0, 0, 1}};
    return scene;
}

Backs only(const Scene& scene) { return backs(scene).at(0); }

}  // namespace

TEST_CASE("Backs, are shown unless the material says otherwise") {
    Scene scene = leaning(0);
    CHECK(only(scene).hidden);
    scene.materials[0].sides = Sides::both;
    CHECK_FALSE(only(scene).hidden);
}

TEST_CASE("Backs, of flat facets are hidden from every angle") {
    Scene scene = leaning(0);
    CHECK(only(scene).from == 0);
    scene = leaning(30);
    scene.materials[0].smooth = false;
    CHECK(only(scene).from == 0);
    scene = leaning(30);
    scene.meshes[0].normals = std::vector<Vec3f>(3, Vec3f(0.6F, 0, 0.8F));  // POV-Ray: flat
    CHECK(only(scene).from == 0);
}

TEST_CASE("Backs, of smooth facets are hidden beyond the angle by which normals lean") {
    CHECK(only(leaning(11.5)).from == 12);
    CHECK(only(leaning(45)).from == 45);
    CHECK(only(leaning(45)).half_turns() == 0.75F);
    CHECK_FALSE(only(leaning(91)).hidden);
}

TEST_CASE("Backs, ask the normals in the world where an instance bends angles") {
    Scene scene = leaning(45);
    scene.instances[0].transform.setScale(Vec3(3, 3, -3));
    CHECK(only(scene).from == 45);
    scene.instances[0].transform.setScale(Vec3(1, 1, 2));  // normals: 1 aside, 1/2 up
    CHECK(only(scene).from == 64);
}

TEST_CASE("Backs, do not mind slivers") {
    Scene scene = leaning(10);
    Mesh& mesh = scene.meshes[0];
    for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0.5F, 1e-5F, 1e-4F)}) {
        mesh.positions.push_back(p);
        mesh.normals.emplace_back(0.1F, 0, 1);
    }
    mesh.normals[3] = {0, 0, 1};
    mesh.triangles.push_back({3, 4, 5});
    CHECK(only(scene).from == 10);
}

TEST_CASE("Backs, of vertex colours are hidden while few normals lean") {
    Scene scene = leaning(8);
    scene.meshes[0].colors = {Color(1), Color(0.5F), Color(1)};
    CHECK(only(scene).hidden);
    CHECK(only(scene).from == 0);
    scene = leaning(20);
    scene.meshes[0].colors = {Color(1), Color(0.5F), Color(1)};
    CHECK_FALSE(only(scene).hidden);
}
