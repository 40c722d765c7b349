// One material on several primitives, of which each shows another part of its images.
#include "importers/gltf/gltf_materials.h"
#include "scene/surface/metallic_roughness.h"

using namespace penumbra;
using test::Gltf;
using test::json;

namespace {

// A facet that shows the image around u.
json facet(Gltf& gltf, float u) {
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::vector<float> texcoords = {u, 0.5F, u, 0.5F, u, 0.5F};
    return {{"attributes",
             {{"POSITION", gltf.accessor("VEC3", positions)},
              {"TEXCOORD_0", gltf.accessor("VEC2", texcoords)}}},
            {"material", 0}};
}

// Facets of one material whose image is `left` on the left and `right` on the right.
Imported worn(const json& material, const std::array<int, 3>& left, const std::array<int, 3>& right,
              const std::vector<float>& where) {
    Gltf gltf;
    json primitives = json::array();
    for (const float u : where) primitives.push_back(facet(gltf, u));
    gltf.show(primitives[0]);
    gltf.root["meshes"][0]["primitives"] = primitives;
    std::vector<int> samples;
    for (int i = 0; i < 8; ++i)
        for (const int sample : i < 4 ? left : right) samples.push_back(sample);
    gltf.add("textures", {{"source", gltf.add("images", test::pixels(3, samples))}});
    if (material.contains("extensions"))
        for (const auto& [extension, members] : material["extensions"].items())
            gltf.root["extensionsUsed"].push_back(extension);
    gltf.add("materials", material);
    return test::read(gltf);
}

const Material& on(const Imported& imported, std::size_t mesh) {
    return imported.scene.materials[imported.scene.meshes.at(mesh).material];
}

json coated() {
    return {{"extensions",
             {{"KHR_materials_transmission",
               {{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}}}}}}},
            {"alphaMode", "BLEND"},
            {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}, {"metallicFactor", 0}}}};
}

}  // namespace

TEST_CASE("glTF materials, are read for each primitive where that needs no mean") {
    const Imported imported = worn(coated(), {255, 0, 0}, {0, 0, 0}, {0.25F, 0.75F});
    for (const Loss& loss : imported.losses) CHECK(loss.what.find("mean") == std::string::npos);
    CHECK(on(imported, 0).opacity == 0);
    CHECK(on(imported, 1).opacity == 0.5F);

    // One that shows both values still has their mean.
    const Imported both = worn(coated(), {255, 0, 0}, {0, 0, 0}, {0.25F, 0.5F});
    CHECK(on(both, 0).opacity == 0);
    CHECK(on(both, 1).opacity == Approx(0.25));
    CHECK(std::ranges::any_of(both.losses, [](const Loss& loss) {
        return loss.what.find("is replaced by its mean") != std::string::npos;
    }));
}

TEST_CASE("glTF materials, are one for all primitives where all is exact") {
    json material = coated();
    material["alphaMode"] = "OPAQUE";
    const Imported imported = worn(material, {255, 0, 0}, {0, 0, 0}, {0.25F, 0.75F});
    CHECK(imported.scene.meshes.at(0).material == imported.scene.meshes.at(1).material);
}

TEST_CASE("glTF materials, are the same by an image of one value as by factors") {
    const json gold = {
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {1, 0.8, 0.3, 1}}, {"metallicRoughnessTexture", {{"index", 0}}}}}};
    const Imported imported = worn(gold, {0, 102, 255}, {0, 204, 0}, {0.25F, 0.75F});
    CHECK(imported.losses.empty());
    for (std::size_t i = 0; i < 2; ++i) {
        Material expected;
        expected.color = Color(1, 0.8F, 0.3F);
        set_metallic_roughness(expected, i == 0 ? 1 : 0, i == 0 ? 0.4F : 0.8F);
        CHECK(on(imported, i).specular == Approx(expected.specular));
        CHECK(on(imported, i).shininess == Approx(expected.shininess));
        CHECK_FALSE(on(imported, i).specular_lobes);
    }
    // What no facet shows does not count.
    const Imported unused = worn(gold, {0, 102, 255}, {0, 204, 0}, {0.25F});
    CHECK(on(unused, 0).specular == on(imported, 0).specular);
}

TEST_CASE("glTF volumes, are panes where their image of thickness is black") {
    json glass = {{"extensions",
                   {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                    {"KHR_materials_volume",
                     {{"thicknessFactor", 1}, {"thicknessTexture", {{"index", 0}}}}}}},
                  {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}}};
    const Imported apart = worn(glass, {0, 255, 0}, {0, 0, 0}, {0.25F, 0.75F});
    CHECK(apart.losses.empty());
    CHECK(on(apart, 0).ior == 1.5F);
    CHECK(on(apart, 1).ior == 1);
    const Imported mixed = worn(glass, {0, 255, 0}, {0, 0, 0}, {0.5F});
    REQUIRE(mixed.losses.size() == 1);
    CHECK(mixed.losses[0].what.find("thicknessTexture is taken as nowhere 0") == 0);
    CHECK(on(mixed, 0).ior == 1.5F);
}
