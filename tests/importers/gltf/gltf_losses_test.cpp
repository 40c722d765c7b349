// What a glTF file says that a picture of Phong surfaces cannot hold is named, once, with a count.
#include "importers/gltf/gltf_builder.h"

#include <set>

using namespace penumbra;
using test::json;

namespace {

// A triangle that wants everything that is not carried over.
test::Gltf demanding() {
    test::Gltf gltf = test::triangle();
    json& primitive = gltf.root["meshes"][0]["primitives"][0];
    const std::vector<float> colors = {1, 0, 0, 0.5F, 0, 1, 0, 1, 0, 0, 1, 1};
    const int color = gltf.accessor("VEC4", colors);
    primitive["attributes"]["COLOR_0"] = color;
    primitive["attributes"]["COLOR_1"] = color;
    primitive["attributes"]["_TEMPERATURE"] = color;
    primitive["material"] =
        gltf.add("materials", {{"name", "velvet"},
                               {"alphaMode", "MASK"},
                               {"extensions",
                                {{"KHR_materials_sheen", {{"sheenColorFactor", {1, 1, 1}}}},
                                 {"KHR_materials_anisotropy", {{"anisotropyStrength", 1}}},
                                 {"KHR_materials_iridescence", {{"iridescenceFactor", 1}}},
                                 {"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}},
                                 {"VENDOR_sparkle", json::object()}}}});
    for (const int mode : {0, 0, 1}) {
        json other = primitive;
        other["mode"] = mode;
        gltf.show(other);
    }
    gltf.root["extensionsUsed"] = {"VENDOR_sparkle", "KHR_materials_sheen", "KHR_lights_punctual"};
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"range", 3}, {"spot", {{"outerConeAngle", 0.5}}}}};
    const int lamp = gltf.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    gltf.root["scenes"][0]["nodes"].push_back(lamp);
    return gltf;
}

}  // namespace

TEST_CASE("glTF losses, name everything that is not carried over once") {
    const Losses losses = test::read_content(demanding().text()).losses;
    std::set<std::string> told;
    std::string all;
    for (const Loss& loss : losses) {
        INFO(loss.place << ": " << loss.what);
        CHECK(told.insert(loss.place + loss.what).second);
        all += loss.what + '\n';
    }
    for (const char* thing :
         {"6 points are ignored (in 2 primitives)", "1 line is ignored", "COLOR_1", "alpha",
          "sheen", "anisotropy", "iridescence", "clearcoat is approximate", "VENDOR_sparkle",
          "its range is ignored", "the falloff of its cone"}) {
        INFO(all);
        CHECK(all.find(thing) != all.npos);
    }
}
