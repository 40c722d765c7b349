// Transmission, volume and variants.
#include "gltf_looks.h"

#include <algorithm>
#include <cmath>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::material_of;
using test::pixels;
using test::read;
using test::with_material;

namespace {

json glass(const json& extensions, double alpha = 1, double roughness = 0) {
    json material = {{"pbrMetallicRoughness",
                      {{"baseColorFactor", {0.5, 1, 0.5, alpha}},
                       {"metallicFactor", 0},
                       {"roughnessFactor", roughness}}},
                     {"alphaMode", alpha < 1 ? "BLEND" : "OPAQUE"},
                     {"extensions", extensions}};
    return material;
}

const json transmission = {{"transmissionFactor", 0.75}};

}  // namespace

TEST_CASE("glTF glass, without thickness lets light pass straight, tinted by its colour") {
    const Material pane = material_of(
        glass({{"KHR_materials_transmission", transmission}, {"KHR_materials_ior", {{"ior", 2}}}}));
    CHECK(pane.opacity == 0.25F);
    CHECK(pane.transmission == 1);
    CHECK(pane.ior == 1);
    CHECK_FALSE(pane.fresnel);
    CHECK(pane.reflection.x == Approx(1.0 / 9));
    CHECK_FALSE(pane.absorption);
    // KHR_materials_volume with a thickness of 0 says the same.
    const Material same = material_of(glass(
        {{"KHR_materials_transmission", transmission}, {"KHR_materials_volume", json::object()}}));
    CHECK(same.ior == 1);
}

TEST_CASE("glTF glass, with thickness bends, reflects and absorbs light") {
    const Material body = material_of(glass({{"KHR_materials_transmission", transmission},
                                             {"KHR_materials_ior", {{"ior", 1.3}}},
                                             {"KHR_materials_volume",
                                              {{"thicknessFactor", 1},
                                               {"attenuationDistance", 0.5},
                                               {"attenuationColor", {1, 0.5, 0}}}}}));
    CHECK(body.ior == 1.3F);
    CHECK(body.fresnel);
    CHECK((body.reflection - Color(1)).length() < 1e-6F);
    REQUIRE(body.absorption);
    CHECK(body.absorption->distance == 0.5);
    CHECK(body.absorption->color == Color(1, 0.5F, 1e-4F));
    // Half of the reflectance, and a surface too rough to mirror.
    const json volume = {{"thicknessFactor", 1}};
    CHECK(material_of(glass({{"KHR_materials_transmission", transmission},
                             {"KHR_materials_volume", volume},
                             {"KHR_materials_specular", {{"specularFactor", 0.5}}}}))
              .reflection.x == Approx(0.5));
    const Imported frosted = read(with_material(glass(
        {{"KHR_materials_transmission", transmission}, {"KHR_materials_volume", volume}}, 1, 0.8)));
    CHECK(frosted.scene.materials[0].reflection == Color(0));
    CHECK(frosted.losses == Losses{{"box.gltf#/materials/0", "transmission is approximate: a rough "
                                                             "surface is shown as clear"}});
    // Without transmission a volume has no effect.
    const Material solid = material_of(glass({{"KHR_materials_volume", volume}}));
    CHECK(solid.ior == 1);
    CHECK(solid.opacity == 1);
}

TEST_CASE("glTF glass, passes untinted what its alpha leaves out") {
    const Material m = material_of(glass({{"KHR_materials_transmission", transmission}}, 0.5));
    // Behind it: 1 - a + a t P.
    CHECK(m.opacity == Approx(0.125));
    const double p = 0.5, t = double(m.transmission);
    CHECK((1 - double(m.opacity)) * (1 - t + t * p) == Approx(0.5 + 0.5 * 0.75 * p));
}

TEST_CASE("glTF glass, of a metal lets nothing through") {
    json metal = glass({{"KHR_materials_transmission", transmission}});
    metal["pbrMetallicRoughness"]["metallicFactor"] = 1;
    CHECK(material_of(metal).opacity == 1);
    CHECK(material_of(metal).transmission == 0);
}

TEST_CASE("glTF glass, takes the mean of its textures") {
    Gltf gltf = with_material(
        glass({{"KHR_materials_transmission",
                {{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}}}}}}));
    gltf.add("images", pixels(3, {0, 9, 9, 255, 99, 99}));
    gltf.add("textures", {{"source", 0}});
    const Imported imported = read(gltf);
    CHECK(imported.scene.materials[0].opacity == Approx(0.5));
    CHECK(imported.losses ==
          Losses{{"box.gltf#/materials/0", "transmissionTexture is replaced by its mean"}});
}

namespace {

// Two materials and the variants "day" and "night"; by night the triangle has the second one.
Gltf with_variants() {
    Gltf gltf = with_material({{"name", "bright"}});
    gltf.add("materials", {{"name", "dark"}});
    gltf.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "day"}},
                                                                     {{"name", "night"}}};
    gltf.root["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", 1}, {"variants", {1}}}};
    gltf.root["extensionsUsed"] = {"KHR_materials_variants"};
    return gltf;
}

std::string material_by(const Gltf& gltf, const std::string& variant) {
    const test::TempDir folder;
    const Imported imported =
        read_gltf(test::write(folder / "box.gltf", gltf.text()), ModelOptions{.variant = variant});
    CHECK(imported.losses.empty());
    return imported.scene.materials.at(imported.scene.meshes.at(0).material).name;
}

}  // namespace

TEST_CASE("glTF variants, choose the materials") {
    CHECK(material_by(with_variants(), "") == "bright");
    CHECK(material_by(with_variants(), "day") == "bright");
    CHECK(material_by(with_variants(), "night") == "dark");
}

TEST_CASE("glTF variants, are listed where the name is wrong") {
    const auto problem = [](const Gltf& gltf) {
        const std::string text = test::message_of([&] { material_by(gltf, "noon"); });
        return text.substr(text.rfind('/') + 1);
    };
    CHECK(problem(with_variants()) ==
          "box.gltf: there is no variant 'noon': it has 'day', 'night'");
    CHECK(problem(test::triangle()) == "box.gltf: there is no variant 'noon': the file has none");
    try {
        material_by(with_variants(), "noon");
    } catch (const Error& error) {
        CHECK(error.failure == Failure::usage);
    }
}

TEST_CASE("glTF variants, refer to materials and variants that exist") {
    Gltf gltf = with_variants();
    auto& mapping = gltf.root["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]
                             ["mappings"][0];
    mapping["material"] = 7;
    CHECK(test::problem(gltf) ==
          "box.gltf#/meshes/0/primitives/0/extensions/KHR_materials_variants/"
          "mappings/0/material: is 7, but the file has 2 materials");
    mapping["material"] = 1;
    mapping["variants"][0] = 2;
    CHECK(test::problem(gltf) ==
          "box.gltf#/meshes/0/primitives/0/extensions/KHR_materials_variants/"
          "mappings/0/variants/0: is 2, but the file has 2 variants");
}
