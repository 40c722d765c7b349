// Morph targets of glTF.
#include "importers/gltf/gltf_builder.h"

#include <cmath>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::read;

namespace {

// A triangle whose vertices, and its second vertex alone, can be moved.
struct Morphed {
    Gltf gltf = test::triangle();
    json& primitive = gltf.root["meshes"][0]["primitives"][0];

    Morphed() {
        const std::vector<float> all = {0, 0, 1, 0, 0, 1, 0, 0, 1},
                                 second = {0, 0, 0, 2, 0, 0, 0, 0, 0};
        primitive["targets"] = {{{"POSITION", gltf.accessor("VEC3", all)}},
                                {{"POSITION", gltf.accessor("VEC3", second)}}};
    }
    json& mesh() { return gltf.root["meshes"][0]; }
    Mesh read_mesh() const {
        const Imported imported = read(gltf);
        REQUIRE(imported.scene.meshes.size() == 1);
        return imported.scene.meshes[0];
    }
};

void check_near(const Vec3f& a, const Vec3f& b) {
    INFO(a << " is not " << b);
    CHECK((a - b).length() <= 1e-6F);
}

}  // namespace

TEST_CASE("glTF morph targets, move vertices by the weights of the mesh") {
    Morphed morphed;
    CHECK(morphed.read_mesh().positions == std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    morphed.mesh()["weights"] = {0.5, 0.25};
    CHECK(morphed.read_mesh().positions ==
          std::vector<Vec3f>{{0, 0, 0.5F}, {1.5F, 0, 0.5F}, {0, 1, 0.5F}});
}

TEST_CASE("glTF morph targets, obey the node before the mesh") {
    Morphed morphed;
    morphed.mesh()["weights"] = {0.5, 0.25};
    morphed.gltf.root["nodes"][0]["weights"] = {0, -1};
    CHECK(morphed.read_mesh().positions == std::vector<Vec3f>{{0, 0, 0}, {-1, 0, 0}, {0, 1, 0}});
}

TEST_CASE("glTF morph targets, share a mesh between nodes with the same weights only") {
    Morphed morphed;
    Gltf& gltf = morphed.gltf;
    gltf.root["nodes"] = {{{"mesh", 0}, {"weights", {1, 0}}},
                          {{"mesh", 0}, {"weights", {1, 0}}},
                          {{"mesh", 0}, {"weights", {0, 1}}}};
    gltf.root["scenes"][0]["nodes"] = {0, 1, 2};
    const Scene scene = read(gltf).scene;
    CHECK(scene.meshes.size() == 2);
    REQUIRE(scene.instances.size() == 3);
    CHECK(scene.instances[1].mesh == scene.instances[0].mesh);
    CHECK(scene.meshes[scene.instances[2].mesh].positions[1] == Vec3f(3, 0, 0));
}

TEST_CASE("glTF morph targets, turn normals and tangents and keep them unit") {
    Morphed morphed;
    Gltf& gltf = morphed.gltf;
    json& primitive = morphed.primitive;
    primitive["attributes"]["NORMAL"] =
        gltf.accessor("VEC3", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1});
    primitive["attributes"]["TANGENT"] =
        gltf.accessor("VEC4", std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1});
    primitive["attributes"]["TEXCOORD_0"] = gltf.accessor("VEC2", std::vector<float>(6, 0.5F));
    primitive["targets"][0]["NORMAL"] =
        gltf.accessor("VEC3", std::vector<float>{1, 0, 0, 0, 0, 0, 0, 0, 0});
    primitive["targets"][0]["TANGENT"] =
        gltf.accessor("VEC3", std::vector<float>{0, 0, -1, 0, 0, 0, 0, 0, 0});
    primitive["targets"][0]["TEXCOORD_0"] =
        gltf.accessor("VEC2", std::vector<float>{1, -2, 0, 0, 0, 0});
    gltf.root["textures"] = {json::object()};
    gltf.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
    primitive["material"] = 0;
    morphed.mesh()["weights"] = {1, 0};
    const Mesh mesh = morphed.read_mesh();
    const float h = std::sqrt(0.5F);
    REQUIRE(mesh.normals.size() == 3);
    check_near(mesh.normals[0], {h, 0, h});
    check_near(mesh.normals[1], {0, 0, 1});
    REQUIRE(mesh.tangents.size() == 3);
    check_near(mesh.tangents[0].direction, {h, 0, -h});
    check_near(mesh.tangents[1].direction, {1, 0, 0});
    CHECK(mesh.tangents[1].handedness == 1);
    CHECK(mesh.tangents[2].handedness == -1);
    REQUIRE(mesh.texcoords.size() == 3);
    CHECK(mesh.texcoords[0] == Vec2f(1.5F, 2.5F));  // 1 - (0.5 - 2)
}

TEST_CASE("glTF morph targets, change colours and clamp them") {
    Morphed morphed;
    Gltf& gltf = morphed.gltf;
    morphed.primitive["attributes"]["COLOR_0"] = gltf.accessor(
        "VEC4", std::vector<std::uint8_t>{255, 0, 51, 255, 0, 0, 0, 255, 0, 0, 0, 255},
        {{"normalized", true}});
    morphed.primitive["targets"][0]["COLOR_0"] =
        gltf.accessor("VEC3", std::vector<float>{1, 0.5F, 0, 0, 0, 0, 0, 0, -1});
    morphed.mesh()["weights"] = {1, 0};
    const Mesh mesh = morphed.read_mesh();
    REQUIRE(mesh.colors.size() == 3);
    check_near(mesh.colors[0], {1, 0.5F, 0.2F});
    check_near(mesh.colors[2], {0, 0, 0});
}

TEST_CASE("glTF morph targets, may be sparse without a base") {
    Morphed morphed;
    Gltf& gltf = morphed.gltf;
    const int indices = gltf.view(std::vector<std::uint8_t>{2});
    const int values = gltf.view(std::vector<float>{0, 0, 8});
    const int target =
        gltf.add("accessors", {{"componentType", 5126},
                               {"count", 3},
                               {"type", "VEC3"},
                               {"sparse",
                                {{"count", 1},
                                 {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                 {"values", {{"bufferView", values}}}}}});
    morphed.primitive["targets"][0]["POSITION"] = target;
    morphed.mesh()["weights"] = {0.5, 0};
    CHECK(morphed.read_mesh().positions == std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 4}});
}

TEST_CASE("glTF morph targets, may be quantised") {
    Morphed morphed;
    Gltf& gltf = morphed.gltf;
    gltf.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    morphed.primitive["targets"][0]["POSITION"] = gltf.accessor(
        "VEC3", std::vector<std::int8_t>{-127, 0, 0, 0, 0, 0, 0, 127, 0}, {{"normalized", true}});
    morphed.primitive["targets"][1]["POSITION"] =
        gltf.accessor("VEC3", std::vector<std::int16_t>{0, 0, 3, 0, 0, 0, 0, 0, 0});
    morphed.mesh()["weights"] = {0.5, 2};
    CHECK(morphed.read_mesh().positions ==
          std::vector<Vec3f>{{-0.5F, 0, 6}, {1, 0, 0}, {0, 1.5F, 0}});
    gltf.root.erase("extensionsUsed");
    CHECK(test::problem(gltf) == "box.gltf#/meshes/0/primitives/0/targets/0/POSITION: accessor 3 "
                                 "has the componentType 5120, which is not allowed here");
}

TEST_CASE("glTF morph targets, name a weight without a target") {
    Morphed morphed;
    morphed.mesh()["weights"] = {0, 0, 0};
    CHECK(read(morphed.gltf).losses.empty());
    morphed.mesh()["weights"] = {0, 0, 0.5};
    CHECK(read(morphed.gltf).losses ==
          Losses{{Loss::dropped, "box.gltf#/meshes/0/primitives/0",
                  "it has 2 morph targets for 3 weights; the others are ignored"}});
}

TEST_CASE("glTF morph targets, must fit the primitive") {
    Morphed morphed;
    Gltf& gltf = morphed.gltf;
    morphed.mesh()["weights"] = {1, 1};
    morphed.primitive["targets"][1]["POSITION"] =
        gltf.accessor("VEC3", std::vector<float>{0, 0, 0, 0, 0, 0});
    CHECK(test::problem(gltf) == "box.gltf#/meshes/0/primitives/0/targets/1/POSITION: has 2 "
                                 "elements, but POSITION has 3");
    morphed.primitive["targets"][1]["POSITION"] =
        gltf.accessor("VEC2", std::vector<float>{0, 0, 0, 0, 0, 0});
    CHECK(test::problem(gltf) == "box.gltf#/meshes/0/primitives/0/targets/1/POSITION: accessor 4 "
                                 "has the wrong type, a VEC3 is needed");
}
