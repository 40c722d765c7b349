// Skins of glTF.
#include "importers/gltf/gltf_builder.h"

#include <cmath>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::read;

namespace {

// A triangle held by two joints: node 1 stands at x = 10, its child 2 is turned by 90 degrees about
// z. Vertices 0, 1 and 2 hang on joint 0, on joint 1, and on both in halves.
struct Skinned {
    Gltf gltf = test::triangle();
    json& primitive = gltf.root["meshes"][0]["primitives"][0];
    std::vector<std::uint8_t> joints = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
    std::vector<float> weights = {1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0};

    Skinned() {
        const double h = std::sqrt(0.5);
        // The mesh's own node is elsewhere; that has no meaning.
        gltf.root["nodes"][0].update({{"skin", 0}, {"translation", {0, 0, 7}}});
        gltf.add("nodes", {{"children", {2}}, {"translation", {10, 0, 0}}});
        gltf.add("nodes", {{"rotation", {0, 0, h, h}}});
        gltf.root["scenes"][0]["nodes"] = {0, 1};
        gltf.add("skins", {{"joints", {1, 2}}});
        bind();
    }
    void bind() {
        primitive["attributes"]["JOINTS_0"] = gltf.accessor("VEC4", joints);
        primitive["attributes"]["WEIGHTS_0"] = gltf.accessor("VEC4", weights);
    }
    // One matrix a joint, column-major.
    void set_inverse(const std::vector<float>& numbers) {
        gltf.root["skins"][0]["inverseBindMatrices"] = gltf.accessor("MAT4", numbers);
    }
};

std::vector<float> moved(std::vector<float> numbers, float x, float y, float z) {
    numbers.insert(numbers.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1});
    return numbers;
}

void check_near(const Vec3f& a, const Vec3f& b) {
    INFO(a << " is not " << b);
    CHECK((a - b).length() <= 1e-5F);
}

// With its vertices in the world.
Mesh posed_mesh(const Scene& scene) {
    REQUIRE(scene.instances.size() == 1);
    const Matrix& place = scene.instances[0].transform;
    const Vec3 move(place[3][0], place[3][1], place[3][2]);
    CHECK(place == Matrix().setTranslation(move));
    Mesh mesh = scene.meshes.at(scene.instances[0].mesh);
    for (Vec3f& p : mesh.positions) p = Vec3f(Vec3(p) + move);
    return mesh;
}

}  // namespace

TEST_CASE("glTF skins, carry vertices to where the joints are") {
    const Scene scene = read(Skinned().gltf).scene;
    const Mesh& mesh = posed_mesh(scene);
    check_near(mesh.positions[0], {10, 0, 0});
    check_near(mesh.positions[1], {10, 1, 0});  // (1, 0, 0) turned
    // The middle of (0, 1, 0) moved and of (-1, 0, 0), which is (0, 1, 0) turned, moved.
    check_near(mesh.positions[2], {9.5F, 0.5F, 0});
}

TEST_CASE("glTF skins, undo the bind pose first") {
    Skinned skinned;
    skinned.set_inverse(moved(moved({}, -1, 0, 0), 0, -1, 0));
    const Scene scene = read(skinned.gltf).scene;
    const Mesh& mesh = posed_mesh(scene);
    check_near(mesh.positions[0], {9, 0, 0});
    check_near(mesh.positions[1], {11, 1, 0});                  // (1, -1, 0) turned is (1, 1, 0)
    check_near(mesh.positions[2], {(9 + 10) / 2.0F, 0.5F, 0});  // (-1, 1, 0) and (0, 0, 0)
}

TEST_CASE("glTF skins, add up several sets of weights and make them one") {
    Skinned skinned;
    Gltf& gltf = skinned.gltf;
    // Normalised bytes that do not quite add up to 255, in two sets.
    skinned.primitive["attributes"]["WEIGHTS_0"] =
        gltf.accessor("VEC4", std::vector<std::uint8_t>{100, 0, 0, 0, 200, 0, 0, 0, 60, 0, 0, 0},
                      {{"normalized", true}});
    skinned.primitive["attributes"]["JOINTS_1"] =
        gltf.accessor("VEC4", std::vector<std::uint16_t>{1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0});
    skinned.primitive["attributes"]["WEIGHTS_1"] = gltf.accessor(
        "VEC4", std::vector<std::uint16_t>{0, 0, 0, 0, 0, 51400, 0, 0, 46260, 0, 0, 0},
        {{"normalized", true}});
    const Scene scene = read(gltf).scene;
    const Mesh& mesh = posed_mesh(scene);
    check_near(mesh.positions[0], {10, 0, 0});
    check_near(mesh.positions[1], {10, 1, 0});
    check_near(mesh.positions[2], {10 - 0.75F, 0.25F, 0});  // 60 to 180 of 255
}

TEST_CASE("glTF skins, turn normals by the inverse transposed matrix") {
    Skinned skinned;
    Gltf& gltf = skinned.gltf;
    gltf.root["nodes"][2].update({{"rotation", {0, 0, 0, 1}}, {"scale", {-4, 1, 1}}});
    const float h = std::sqrt(0.5F);
    skinned.primitive["attributes"]["NORMAL"] =
        gltf.accessor("VEC3", std::vector<float>{h, h, 0, h, h, 0, 0, 0, 1});
    const Scene scene = read(gltf).scene;
    const Mesh& mesh = posed_mesh(scene);
    check_near(mesh.normals[0], {h, h, 0});
    check_near(mesh.normals[1], Vec3f(-0.25F, 1, 0).normalized());
}

TEST_CASE("glTF skins, come after morph targets") {
    Skinned skinned;
    Gltf& gltf = skinned.gltf;
    skinned.primitive["targets"] = {
        {{"POSITION", gltf.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 0, 0})}}};
    gltf.root["meshes"][0]["weights"] = {1};
    const Scene scene = read(gltf).scene;
    check_near(posed_mesh(scene).positions[1], {10, 2, 0});  // (2, 0, 0) turned
}

TEST_CASE("glTF skins, follow joints outside of the scene's visible part") {
    Skinned skinned;
    skinned.gltf.root["nodes"][1]["extensions"] = {{"KHR_node_visibility", {{"visible", false}}}};
    const Scene scene = read(skinned.gltf).scene;
    check_near(posed_mesh(scene).positions[0], {10, 0, 0});
}

TEST_CASE("glTF skins, keep the vertices' precision far from the origin") {
    Skinned skinned;
    skinned.gltf.root["nodes"][1]["translation"] = {3000000.3, 0, -20000000.7};
    const Scene scene = read(skinned.gltf).scene;
    REQUIRE(scene.instances.size() == 1);
    const Mesh& mesh = scene.meshes.at(scene.instances[0].mesh);
    const auto place = [&](std::size_t vertex) {
        return Vec3(mesh.positions[vertex]) * scene.instances[0].transform;
    };
    CHECK((place(0) - Vec3(3000000.3, 0, -20000000.7)).length() < 1e-5);
    CHECK((place(1) - Vec3(3000000.3, 1, -20000000.7)).length() < 1e-5);
    CHECK((place(2) - Vec3(2999999.8, 0.5, -20000000.7)).length() < 1e-5);
}

TEST_CASE("glTF skins, leave a primitive without joints at its node") {
    Skinned skinned;
    skinned.primitive["attributes"].erase("JOINTS_0");
    skinned.primitive["attributes"].erase("WEIGHTS_0");
    const Imported imported = read(skinned.gltf);
    CHECK(imported.scene.instances.at(0).transform.translation() == Vec3(0, 0, 7));
    CHECK(imported.losses ==
          Losses{{Loss::approximated, "box.gltf#/meshes/0/primitives/0",
                  "it has no joints and weights for skin 0; it stands where its node does"}});
}

TEST_CASE("glTF skins, name vertices without weights") {
    Skinned skinned;
    skinned.weights = std::vector<float>(12, 0.0F);
    skinned.bind();
    const Imported imported = read(skinned.gltf);
    check_near(posed_mesh(imported.scene).positions[1], {11, 0, 0});
    CHECK(imported.losses ==
          Losses{{Loss::approximated, "box.gltf#/meshes/0/primitives/0",
                  "3 of its vertices have no weights; they follow the first joint of skin 0"}});
}

TEST_CASE("glTF skins, must be whole") {
    const std::string primitive = "box.gltf#/meshes/0/primitives/0";
    {
        Skinned skinned;
        skinned.joints[4] = 2;
        skinned.bind();
        CHECK(test::problem(skinned.gltf) ==
              primitive +
                  "/attributes/JOINTS_0: vertex 1 has the joint 2, but its skin has 2 joints");
    }
    {
        Skinned skinned;
        skinned.primitive["attributes"].erase("WEIGHTS_0");
        CHECK(test::problem(skinned.gltf) ==
              primitive + "/attributes: has only one of JOINTS_0 and WEIGHTS_0");
    }
    {
        Skinned skinned;
        skinned.set_inverse(moved({}, 0, 0, 0));
        CHECK(test::problem(skinned.gltf) ==
              "box.gltf#/skins/0/inverseBindMatrices: accessor 3 has 1 matrices for 2 joints");
        skinned.gltf.root["skins"][0]["inverseBindMatrices"] = 0;
        CHECK(test::problem(skinned.gltf) ==
              "box.gltf#/skins/0/inverseBindMatrices: accessor 0 must hold MAT4 of floats");
        skinned.gltf.root["skins"][0]["joints"] = json::array();
        CHECK(test::problem(skinned.gltf) == "box.gltf#/skins/0/joints: is empty");
    }
    {
        Skinned skinned;
        skinned.gltf.root["nodes"][1]["translation"] = {3e38, 0, 0};
        skinned.set_inverse(moved(moved({}, 3e38F, 0, 0), 0, 0, 0));
        CHECK(test::problem(skinned.gltf) == primitive + ": skin 0 takes vertex 0 too far away");
    }
}
