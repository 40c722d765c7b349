// Instances and visibility of glTF nodes.
#include "importers/gltf/gltf_builder.h"

#include <cmath>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::read;

namespace {

Gltf instanced(const json& attributes) {
    Gltf gltf = test::triangle();
    gltf.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    gltf.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    gltf.root["nodes"][0].update(
        {{"translation", {0, 0, 100}},
         {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
    return gltf;
}

void check_near(const Vec3& a, const Vec3& b) {
    INFO(a << " is not " << b);
    CHECK((a - b).length() <= 1e-4);
}

}  // namespace

TEST_CASE("glTF instances, are placed in the space of their node") {
    Gltf gltf = instanced(json::object());
    json& attributes = gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes["TRANSLATION"] = gltf.accessor("VEC3", std::vector<float>{1, 0, 0, 0, 2, 0});
    attributes["ROTATION"] = gltf.accessor(
        "VEC4", std::vector<std::int8_t>{0, 0, 0, 127, 0, 0, 90, 90}, {{"normalized", true}});
    attributes["SCALE"] = gltf.accessor("VEC3", std::vector<float>{1, 1, 1, 3, 3, 3});
    const Scene scene = read(gltf).scene;
    CHECK(scene.meshes.size() == 1);
    REQUIRE(scene.instances.size() == 2);
    check_near(Vec3(1, 0, 0) * scene.instances[0].transform, {2, 0, 100});
    check_near(Vec3(1, 0, 0) * scene.instances[1].transform, {0, 5, 100});
}

TEST_CASE("glTF instances, must be as many for each attribute") {
    Gltf gltf = instanced({{"TRANSLATION", 1}, {"SCALE", 2}});
    gltf.accessor("VEC3", std::vector<float>(6, 1.0F));
    gltf.accessor("VEC3", std::vector<float>(9, 1.0F));
    const std::string place = "box.gltf#/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    CHECK(test::problem(gltf) ==
          place + "/TRANSLATION: has 2 instances, but another attribute has 3");
    gltf = instanced({{"ROTATION", 0}});
    CHECK(test::problem(gltf) ==
          place + "/ROTATION: accessor 0 has the wrong type, a VEC4 is needed");
    gltf = instanced({{"ROTATION", 7}});
    CHECK(test::problem(gltf) == place + "/ROTATION: is 7, but the file has 1 accessors");
    gltf = instanced(json::object());
    gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = json::object();
    CHECK(test::problem(gltf) ==
          "box.gltf#/nodes/0/extensions/EXT_mesh_gpu_instancing: has no 'attributes'");
}

TEST_CASE("glTF instances, of a skinned mesh are one") {
    Gltf gltf = instanced({{"TRANSLATION", 1}});
    gltf.accessor("VEC3", std::vector<float>(6, 1.0F));
    json& attributes = gltf.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = gltf.accessor("VEC4", std::vector<std::uint8_t>(12));
    attributes["WEIGHTS_0"] = gltf.accessor("VEC4", std::vector<float>(12, 0.25F));
    gltf.add("skins", {{"joints", {0}}});
    gltf.root["nodes"][0]["skin"] = 0;
    const Imported imported = read(gltf);
    CHECK(imported.scene.instances.size() == 1);
    CHECK(imported.losses ==
          Losses{{Loss::dropped, "box.gltf#/nodes/0/extensions/EXT_mesh_gpu_instancing",
                  "its mesh has a skin and is shown once"}});
}

TEST_CASE("glTF visibility, hides meshes and lights of a whole branch but no cameras") {
    Gltf gltf = test::triangle();
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    gltf.root["cameras"] = {
        // without zfar the view has no end
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    gltf.root["nodes"] = {
        {{"children", {1, 2, 3}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}},
        {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}},
        {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
        {{"camera", 0}}};
    const Scene scene = read(gltf).scene;
    CHECK(scene.instances.empty());
    CHECK(scene.lights.empty());
    CHECK(scene.cameras.size() == 1);
}
