// KHR_animation_pointer: any property of a glTF file at one instant.
#include "importers/gltf/gltf_builder.h"

#include <cmath>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::read;

namespace {

// A triangle with a material, a camera and a light, and properties that change over two seconds.
struct Pointed {
    Gltf gltf = test::triangle();

    Pointed() {
        gltf.root["animations"] = {{{"name", "glow"}}};
        gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"KHR_animation_pointer"};
        gltf.root["meshes"][0]["primitives"][0]["material"] = gltf.add("materials", json::object());
    }
    void point(const std::string& pointer, const std::string& type,
               const std::vector<float>& values) {
        json& animation = gltf.root["animations"][0];
        const int samplers = int(animation["samplers"].size());
        animation["samplers"].push_back(
            {{"input", gltf.accessor("SCALAR", std::vector<float>{0, 2})},
             {"output", gltf.accessor(type, values)}});
        animation["channels"].push_back(
            {{"sampler", samplers},
             {"target",
              {{"path", "pointer"},
               {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
    }
    json& material() { return gltf.root["materials"][0]; }
    Imported at(double time) const { return read(gltf, {.time = time}); }
    Material material_at(double time) const { return at(time).scene.materials.at(0); }
    Vec3 origin_at(double time) const {
        return at(time).scene.instances.at(0).transform.translation();
    }
};

}  // namespace

TEST_CASE("glTF pointers, change nothing unless an instant is asked for") {
    Pointed pointed;
    pointed.point("/nodes/0/translation", "VEC3", {0, 0, 0, 4, 0, 0});
    const Imported imported = read(pointed.gltf);
    CHECK(imported.scene.instances.at(0).transform == Matrix());
    CHECK(imported.losses.empty());
}

TEST_CASE("glTF pointers, move nodes as other animations do") {
    Pointed pointed;
    pointed.point("/nodes/0/translation", "VEC3", {0, 0, 0, 4, 0, 0});
    CHECK(pointed.origin_at(0.5) == Vec3(1, 0, 0));
    const float half = float(std::sqrt(0.5));
    pointed.point("/nodes/0/rotation", "VEC4", {0, 0, 0, 1, 0, 0, half, half});
    const Vec3 turned = Vec3(1, 0, 0) * pointed.at(1).scene.instances.at(0).transform;
    CHECK((turned - Vec3(2 + std::sqrt(0.5), std::sqrt(0.5), 0)).length() < 1e-6);
    CHECK(pointed.at(1).losses.empty());
}

TEST_CASE("glTF pointers, change materials") {
    Pointed pointed;
    pointed.material()["pbrMetallicRoughness"]["metallicFactor"] = 0;
    pointed.point("/materials/0/pbrMetallicRoughness/baseColorFactor", "VEC4",
                  {1, 0, 0, 1, 0, 0, 1, 1});
    pointed.point("/materials/0/emissiveFactor", "VEC3", {0, 0, 0, 1, 1, 0});
    CHECK(pointed.material_at(0).color == Color(1, 0, 0));
    CHECK(pointed.material_at(1).color == Color(0.5F, 0, 0.5F));
    CHECK(pointed.material_at(9).color == Color(0, 0, 1));
    CHECK(pointed.material_at(1).emission == Color(0.5F, 0.5F, 0));
    CHECK(pointed.at(1).losses.empty());
}

TEST_CASE("glTF pointers, make what has defaults") {
    Pointed pointed;
    pointed.point("/materials/0/pbrMetallicRoughness/metallicFactor", "SCALAR", {0, 0});
    CHECK(pointed.at(0).losses.empty());
    CHECK(pointed.material_at(0).metallic == 0);
}

TEST_CASE("glTF pointers, are held to the limits of what they change") {
    Pointed pointed;
    pointed.point("/materials/0/pbrMetallicRoughness/roughnessFactor", "SCALAR", {0, 4});
    CHECK(pointed.at(1).losses ==
          Losses{{Loss::approximated, "box.gltf#/materials/0/pbrMetallicRoughness/roughnessFactor",
                  "2.0 is outside 0 to 1; 1.0 is used"}});
}

TEST_CASE("glTF pointers, hide and show") {
    Pointed pointed;
    pointed.gltf.root["nodes"][0]["extensions"]["KHR_node_visibility"] = {{"visible", true}};
    pointed.point("/nodes/0/extensions/KHR_node_visibility/visible", "SCALAR", {0, 1});
    CHECK(pointed.at(1.9).scene.instances.empty());
    CHECK(pointed.at(2).scene.instances.size() == 1);
}

TEST_CASE("glTF pointers, change lights and cameras") {
    Pointed pointed;
    Gltf& gltf = pointed.gltf;
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}}};
    gltf.root["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 1}}}}};
    gltf.root["nodes"][0]["camera"] = 0;
    gltf.root["nodes"][0]["extensions"]["KHR_lights_punctual"] = {{"light", 0}};
    pointed.point("/cameras/0/perspective/yfov", "SCALAR", {0.5F, 1.5F});
    pointed.point("/extensions/KHR_lights_punctual/lights/0/color", "VEC3", {1, 1, 1, 0, 1, 0});
    pointed.point("/extensions/KHR_lights_punctual/lights/0/intensity", "SCALAR", {0, 4});
    const Scene scene = pointed.at(1).scene;
    CHECK(scene.cameras.at(0).fov == 1);
    CHECK(scene.lights.at(0).color == Color(0.5F, 1, 0.5F));
    CHECK(std::abs(scene.lights.at(0).intensity - 2 / std::acos(-1.0)) < 1e-9);
}

TEST_CASE("glTF pointers, morph, also by a single weight of a mesh") {
    Pointed pointed;
    Gltf& gltf = pointed.gltf;
    json& mesh = gltf.root["meshes"][0];
    for (int i = 0; i < 2; ++i)
        mesh["primitives"][0]["targets"].push_back(
            {{"POSITION", gltf.accessor("VEC3", std::vector<float>(9, i == 0 ? 1.0F : 10.0F))}});
    mesh["weights"] = {1, 0};
    pointed.point("/nodes/0/weights/1", "SCALAR", {0, 1});
    CHECK(pointed.at(1).scene.meshes.at(0).positions.at(0) == Vec3f(6));
    mesh.erase("weights");
    CHECK(pointed.at(1).scene.meshes.at(0).positions.at(0) == Vec3f(5));
}

TEST_CASE("glTF pointers, move images") {
    Pointed pointed;
    Gltf& gltf = pointed.gltf;
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        gltf.accessor("VEC2", std::vector<float>{0, 0, 1, 0, 0, 1});
    gltf.add("images", {{"uri", "data:image/x-portable-pixmap;base64," +
                                    test::base64("P6 1 1 255 \x80\x80\xff")}});
    gltf.add("textures", {{"source", 0}});
    pointed.material()["pbrMetallicRoughness"]["metallicFactor"] = 0;
    pointed.material()["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {1, 1}}}}}}};
    pointed.point("/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/"
                  "KHR_texture_transform/offset",
                  "VEC2", {0, 0, 1, 0});
    const Material material = pointed.material_at(1);
    const auto* image = std::get_if<ImageMap>(&material.pattern);
    REQUIRE(image != nullptr);
    CHECK(image->transform[2] == 0.5);
}

TEST_CASE("glTF pointers, name what they cannot follow") {
    Pointed pointed;
    pointed.point("/nodes/0/extras/mood", "SCALAR", {0, 1});
    pointed.point("/nodes/7/translation", "VEC3", {0, 0, 0, 1, 1, 1});
    pointed.point("/materials/0/normalTexture/scale", "SCALAR", {0, 1});
    pointed.point("/nodes/00/translation", "VEC3", {0, 0, 0, 1, 1, 1});
    json none = pointed.gltf.root["animations"][0]["channels"][0];
    none["target"].erase("extensions");
    pointed.gltf.root["animations"][0]["channels"].push_back(none);
    const std::string at = "box.gltf#/animations/0/channels/";
    CHECK(pointed.at(1).losses ==
          Losses{{Loss::dropped, at + "0",
                  "its animation of '/nodes/0/extras/mood' is ignored: it is no property that can "
                  "be animated here"},
                 {Loss::dropped, at + "1",
                  "its animation of '/nodes/7/translation' is ignored: the file has no such thing"},
                 {Loss::dropped, at + "2",
                  "its animation of '/materials/0/normalTexture/scale' is ignored: the file has no "
                  "such thing"},
                 {Loss::dropped, at + "3",
                  "its animation of '/nodes/00/translation' is ignored: it is no property that can "
                  "be animated here"},
                 {Loss::dropped, at + "4", "it has no pointer and is ignored"}});
}
