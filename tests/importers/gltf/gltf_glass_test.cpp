// Transmission, volume and variants.
#include "importers/gltf/gltf_materials.h"

#include <algorithm>
#include <cmath>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::material_of;
using test::pixels;
using test::read;
using test::samples_of;
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
    CHECK(same.sides == Sides::front);
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
    CHECK(frosted.scene.materials[0].roughness == 0.8F);
    CHECK(frosted.losses.empty());
    const Imported sheet =
        read(with_material(glass({{"KHR_materials_transmission", transmission}}, 1, 0.8)));
    CHECK(sheet.losses == Losses{{Loss::approximated, "box.gltf#/materials/0",
                                  "transmission is approximate: a rough "
                                  "surface is shown as clear"}});
    // Without transmission a volume has no effect.
    const Material solid = material_of(glass({{"KHR_materials_volume", volume}}));
    CHECK(solid.ior == 1);
    CHECK(solid.opacity == 1);
}

TEST_CASE("glTF glass, with thickness has the backs that light leaves through") {
    const Material body = material_of(glass({{"KHR_materials_transmission", transmission},
                                             {"KHR_materials_volume", {{"thicknessFactor", 1}}}}));
    CHECK(body.ior == 1.5F);
    CHECK(body.sides == Sides::both);
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

TEST_CASE("glTF glass, is mixed from a clear and a scattering look where an image says so") {
    Gltf gltf = with_material(
        glass({{"KHR_materials_transmission",
                {{"transmissionFactor", 0.8}, {"transmissionTexture", {{"index", 0}}}}},
               {"KHR_materials_volume", {{"thicknessFactor", 1}}}}));
    gltf.add("images", pixels(3, {0, 9, 9, 255, 99, 99}));
    gltf.add("textures", {{"source", 0}});
    const Imported imported = read(gltf);
    CHECK(imported.losses.empty());
    const Material& m = imported.scene.materials[0];
    REQUIRE(m.blend);
    CHECK(m.opacity == 0);
    CHECK(m.ior == 1.5F);
    CHECK(samples_of(imported.scene, m.blend->map.texture) == std::vector<int>{0, 204});
    CHECK(m.blend->other[0].opacity == 1);
    CHECK(m.blend->other[0].diffuse == Approx(0.96));
}

TEST_CASE("glTF glass, takes the mean of two images that vary in their own ways") {
    json material = glass({{"KHR_materials_transmission",
                            {{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}}}}}});
    material["pbrMetallicRoughness"]["metallicFactor"] = 1;
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 1}};
    Gltf gltf = with_material(material);
    gltf.add("images", pixels(3, {0, 9, 9, 255, 99, 99}));
    gltf.add("images", pixels(3, {0, 0, 255, 0, 0, 0}));
    gltf.add("textures", {{"source", 0}});
    gltf.add("textures", {{"source", 1}});
    const Imported imported = read(gltf);
    CHECK(imported.scene.materials[0].opacity == Approx(0.75));
    CHECK(imported.losses == Losses{{Loss::approximated, "box.gltf#/materials/0",
                                     "transmissionTexture is replaced by its mean over what the "
                                     "facets show"},
                                    {Loss::approximated, "box.gltf#/materials/0",
                                     "metallicRoughnessTexture is replaced by its mean over what "
                                     "the facets show: the surface is transparent"}});
}

TEST_CASE("glTF glass, takes of an image what its facets show and not what lies beside it") {
    json material = glass({{"KHR_materials_transmission", {{"transmissionFactor", 1}}}});
    json& pbr = material["pbrMetallicRoughness"];
    pbr["metallicFactor"] = pbr["roughnessFactor"] = 1;
    pbr["metallicRoughnessTexture"] = {{"index", 0}};
    // u from `first` on, a quarter of the image: 2 of 8 texels.
    const auto at = [&](double first) {
        json laid = material;
        laid["pbrMetallicRoughness"]["metallicRoughnessTexture"]["extensions"] = {
            {"KHR_texture_transform", {{"scale", {0.25, 1}}, {"offset", {first, 0}}}}};
        Gltf gltf = with_material(laid);
        std::vector<int> samples;  // 4 of rough metal, 4 of clear glass
        for (int i = 0; i < 8; ++i)
            for (const int sample : {0, i < 4 ? 255 : 0, i < 4 ? 255 : 0})
                samples.push_back(sample);
        gltf.add("images", pixels(3, samples));
        gltf.add("textures", {{"source", 0}});
        return read(gltf);
    };
    const Imported clear = at(0.6);
    CHECK(clear.losses.empty());
    CHECK(clear.scene.materials[0].opacity == 0);
    CHECK(clear.scene.materials[0].metallic == 0);
    CHECK(clear.scene.materials[0].reflection.x == Approx(0.04));
    const Imported metal = at(0.1);
    CHECK(metal.losses.empty());
    CHECK(metal.scene.materials[0].opacity == 1);
    // Bilinear lookups right of a texel's middle show the next one: texels 3 to 5 of the image.
    const Imported edge = at(0.4375);
    REQUIRE(edge.losses.size() == 1);
    CHECK(edge.losses[0].what == "metallic-roughness texture: mixed from 8 Phong lobes");
    const Material& m = edge.scene.materials[0];
    REQUIRE(m.blend);
    CHECK(m.opacity == 0);
    CHECK(m.reflection.x == Approx(0.04));  // the clear part is smooth
    CHECK(samples_of(edge.scene, m.blend->map.texture) ==
          std::vector<int>{0, 0, 0, 0, 255, 255, 255, 255});
    CHECK(m.blend->other[0].specular_lobes);
    CHECK(m.blend->other[0].metallic == 1);
}

TEST_CASE("glTF glass, counts the facets of all meshes that wear it") {
    Gltf gltf = with_material(
        glass({{"KHR_materials_transmission",
                {{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}}}}}}));
    json other = gltf.root["meshes"][0]["primitives"][0];
    const auto wear = [&](const std::vector<float>& texcoords) {
        json primitive = other;
        primitive["attributes"]["TEXCOORD_0"] = gltf.accessor("VEC2", texcoords);
        return primitive;
    };
    gltf.root["meshes"][0]["primitives"][0] = wear({0.1F, 0, 0.2F, 0, 0.1F, 1});
    gltf.add("images", pixels(3, {0, 0, 0, 0, 0, 0, 255, 0, 0, 255, 0, 0}));
    gltf.add("samplers", {{"magFilter", 9728}});
    gltf.add("textures", {{"source", 0}, {"sampler", 0}});
    CHECK(read(gltf).scene.materials[0].opacity == 1);
    gltf.show(wear({0.3F, 0, 0.7F, 0, 0.7F, 1}));  // texels 1 and 2
    CHECK(read(gltf).scene.materials[0].blend);
    // A facet that has one texel's colour all over, and one that lies beyond the image.
    gltf.root["meshes"].erase(1);
    gltf.root["nodes"].erase(1);
    gltf.root["scenes"][0]["nodes"].erase(1);
    gltf.root["meshes"][0]["primitives"][0] = wear({1.9F, 3, 1.9F, 3, 1.9F, 3});
    CHECK(read(gltf).scene.materials[0].opacity == 0);
}

TEST_CASE("glTF glass, scatters light from behind in a colour of its own") {
    json paper = glass(
        {{"KHR_materials_diffuse_transmission",
          {{"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionColorFactor", {1, 0.2, 0.2}}}}},
        1, 1);
    const Imported imported = read(with_material(paper));
    CHECK(imported.losses.empty());
    const Material& m = imported.scene.materials[0];
    CHECK(m.diffuse == Approx(0.96 * 0.5));
    CHECK((m.diffuse_transmission - Color(0.48F, 0.096F, 0.096F)).length() < 1e-6F);
    CHECK(m.opacity == 1);
    paper["pbrMetallicRoughness"]["metallicFactor"] = 1;
    CHECK(material_of(paper).diffuse_transmission == Color(0));

    paper["pbrMetallicRoughness"]["metallicFactor"] = 0;
    json& given = paper["extensions"]["KHR_materials_diffuse_transmission"];
    given["diffuseTransmissionTexture"] = {{"index", 0}};
    given["diffuseTransmissionColorTexture"] = {{"index", 0}};
    Gltf gltf = with_material(paper);
    gltf.add("images", pixels(4, {255, 0, 0, 51, 0, 255, 0, 51}));
    gltf.add("textures", {{"source", 0}});
    const Material sheet = read(gltf).scene.materials[0];
    CHECK(sheet.diffuse == Approx(0.96 * 0.9));
    CHECK(sheet.diffuse_transmission.x == Approx(0.96 * 0.1));
    CHECK(sheet.diffuse_transmission_map);
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
