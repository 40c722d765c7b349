// Metalness, roughness, reflectance and what lies over them.
#include "importers/gltf/gltf_materials.h"

#include "penumbra/light_model.h"

#include <algorithm>
#include <cmath>
#include <set>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::material_of;
using test::pixels;
using test::read;
using test::samples_of;
using test::with_material;

namespace {

// Image 0 is the metallic-roughness texture, image 1 the base colour's if it is given.
Gltf with_lobes(const json& lobe, const json& base = nullptr, json material = {}) {
    auto& pbr = material["pbrMetallicRoughness"];
    pbr["metallicRoughnessTexture"] = {{"index", 0}};
    if (!base.is_null()) pbr["baseColorTexture"] = {{"index", 1}};
    Gltf gltf = with_material(material);
    for (const json& image : {lobe, base})
        if (!image.is_null()) gltf.add("textures", {{"source", gltf.add("images", image)}});
    return gltf;
}

double linear(int code) { return double(srgb_to_linear(float(code) / 255.0F)); }

Losses lost(const std::string& what) {
    return {{Loss::approximated, "box.gltf#/materials/0", what}};
}

}  // namespace

TEST_CASE("glTF specular lobes, without metal leaves the base colour's image as it is") {
    // Roughness 0.2 and 0.6 in green, blue is 0.
    const Imported imported =
        read(with_lobes(pixels(3, {9, 51, 0, 9, 153, 0}), pixels(3, {1, 2, 3, 4, 5, 6})));
    CHECK(imported.losses == lost("metallic-roughness texture: mixed from 5 Phong lobes"));
    const Scene& scene = imported.scene;
    const Material& m = scene.materials[0];
    REQUIRE(m.specular_lobes);
    CHECK(samples_of(scene, std::get<ImageMap>(m.pattern).texture) ==
          std::vector<int>{1, 2, 3, 4, 5, 6});
    CHECK(m.metallic == 0);
    CHECK(m.diffuse == 0.96F);
    CHECK(m.specular_lobes->color.texture == no_index);
    CHECK(samples_of(scene, m.specular_lobes->level.texture) == std::vector<int>{0, 255});
    CHECK_FALSE(scene.textures[m.specular_lobes->level.texture].srgb);
    REQUIRE(m.specular_lobes->lobes.size() == 5);
    for (std::size_t i = 0; i < 5; ++i) {
        Material expected;
        set_metallic_roughness(expected, 0, 0.2F + 0.1F * float(i));
        CHECK(m.specular_lobes->lobes[i].specular == Approx(expected.specular));
        CHECK(m.specular_lobes->lobes[i].shininess == Approx(expected.shininess));
        CHECK(m.specular_lobes->lobes[i].reflection.x ==
              Approx(expected.reflection.x).margin(1e-7));
    }
}

TEST_CASE("glTF specular lobes, with metal is what the law gives for each texel") {
    // Left: a green dielectric of roughness 0.5. Middle and right: gold of roughness 0.2.
    const std::vector<int> colors = {0, 188, 0, 255, 188, 0, 255, 188, 0};
    const Imported imported =
        read(with_lobes(pixels(3, {0, 128, 0, 0, 51, 255, 0, 51, 255}), pixels(3, colors)));
    const Scene& scene = imported.scene;
    const Material& m = scene.materials[0];
    REQUIRE(m.specular_lobes);
    CHECK(m.color == Color(1));
    CHECK(m.diffuse == 1);
    CHECK(m.metallic == 1);
    CHECK(m.specular == 0);
    const auto reflected = samples_of(scene, m.specular_lobes->color.texture);
    const auto scattered = samples_of(scene, std::get<ImageMap>(m.pattern).texture);
    CHECK(scene.textures[m.specular_lobes->color.texture].srgb);
    CHECK(samples_of(scene, m.specular_lobes->level.texture) == std::vector<int>{255, 0, 0});
    const auto& lobes = m.specular_lobes->lobes;
    REQUIRE(lobes.size() == 5);
    for (std::size_t texel = 0; texel < 2; ++texel) {
        Material expected;
        for (int c = 0; c < 3; ++c)
            expected.color[c] = float(linear(colors[texel * 3 + std::size_t(c)]));
        set_metallic_roughness(expected, texel == 0 ? 0 : 1, texel == 0 ? 128 / 255.0F : 0.2F);
        const SpecularLobe& lobe = texel == 0 ? lobes.back() : lobes.front();
        CHECK(lobe.shininess == Approx(expected.shininess).epsilon(1e-5));
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t i = texel * 3 + c;
            const double tint = texel == 0 ? 1 : double(expected.color[int(c)]);
            // One code of 255 is up to 0.8 % of white.
            CHECK(linear(scattered[i]) ==
                  Approx(double(expected.diffuse * expected.color[int(c)])).margin(0.008));
            CHECK(linear(reflected[i]) * double(lobe.reflection.x) ==
                  Approx(double(expected.reflection[int(c)]) * tint).margin(0.004));
            if (texel == 1)
                CHECK(linear(reflected[i]) * double(lobe.specular) ==
                      Approx(double(expected.specular) * tint).margin(0.004));
        }
    }
}

TEST_CASE("glTF specular lobes, keeps the highlights of what most of the surface is") {
    // Three texels of plastic and one of metal, all of roughness 0.3.
    const auto shine = [](int plastic) {
        std::vector<int> lobe;
        for (int i = 0; i < 4; ++i)
            for (const int sample : {0, 77, i < plastic ? 0 : 255}) lobe.push_back(sample);
        const auto lobes =
            read(with_lobes(pixels(3, lobe))).scene.materials[0].specular_lobes->lobes;
        REQUIRE(lobes.size() == 1);
        return double(lobes[0].specular);
    };
    CHECK(shine(3) * 0.04 == Approx(1).epsilon(0.02));
    CHECK(shine(1) == Approx(1));
}

TEST_CASE("glTF specular lobes, that is the same everywhere needs no images") {
    json material = {{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}}};
    const Imported imported =
        read(with_lobes(pixels(3, {0, 204, 255, 77, 204, 255}), nullptr, material));
    CHECK(imported.losses.empty());
    const Material& m = imported.scene.materials[0];
    CHECK_FALSE(m.specular_lobes);
    Material expected;
    expected.color = Color(1);
    set_metallic_roughness(expected, 1, 0.4F);
    CHECK(m.specular == expected.specular);
    CHECK(m.shininess == Approx(expected.shininess));
    // A factor of 0 makes an image constant.
    material["pbrMetallicRoughness"] = {{"roughnessFactor", 0}, {"metallicFactor", 0}};
    CHECK_FALSE(read(with_lobes(pixels(3, {0, 9, 9, 0, 204, 255}), nullptr, material))
                    .scene.materials[0]
                    .specular_lobes);
}

TEST_CASE("glTF specular lobes, joins images of unequal size at the larger one") {
    const Imported imported =
        read(with_lobes(pixels(3, {0, 255, 0, 0, 255, 255}, 3), pixels(3, {255, 255, 255})));
    const Material& m = imported.scene.materials[0];
    REQUIRE(m.specular_lobes);
    const Raster& raster = imported.scene.textures.at(m.specular_lobes->color.texture).raster;
    CHECK(raster.width == 2);
    CHECK(raster.height == 3);
    // The other way round the metalness, 0 to 1 with repetition, is interpolated: 1/4, 1/4, 3/4,
    // 3/4 from the left.
    const Imported wide =
        read(with_lobes(pixels(3, {0, 255, 0, 0, 255, 255}), pixels(3, std::vector<int>(12, 0))));
    const auto reflected =
        samples_of(wide.scene, wide.scene.materials[0].specular_lobes->color.texture);
    REQUIRE(reflected.size() == 12);
    CHECK(linear(reflected[0]) == Approx(0.03).epsilon(0.03));
    CHECK(linear(reflected[3]) == Approx(0.03).epsilon(0.03));
    CHECK(linear(reflected[6]) == Approx(0.01).epsilon(0.1));
    CHECK(linear(reflected[9]) == Approx(0.01).epsilon(0.1));
}

TEST_CASE("glTF specular lobes, is baked once for materials with the same images and factors") {
    Gltf gltf = with_lobes(pixels(3, {0, 204, 0, 0, 51, 255}), pixels(3, {255, 0, 0, 0, 0, 255}));
    for (int i = 0; i < 2; ++i) {
        json material = gltf.root["materials"][0];
        material["name"] = "copy";
        if (i == 1) material["pbrMetallicRoughness"]["roughnessFactor"] = 0.5;
        json primitive = gltf.root["meshes"][0]["primitives"][0];
        primitive["material"] = gltf.add("materials", material);
        gltf.root["meshes"][0]["primitives"].push_back(primitive);
    }
    const Scene scene = read(gltf).scene;
    CHECK(scene.textures.size() == 6);
    CHECK(scene.materials[0].specular_lobes->color == scene.materials[1].specular_lobes->color);
    CHECK(scene.materials[0].pattern.index() == scene.materials[1].pattern.index());
    CHECK(scene.materials[0].specular_lobes->level.texture !=
          scene.materials[2].specular_lobes->level.texture);
}

TEST_CASE("glTF specular lobes, takes the mean where its images cannot be joined or shown") {
    const json lobe = pixels(3, {0, 102, 0, 0, 102, 255});
    const std::string mean =
        "metallicRoughnessTexture is replaced by its mean over what the facets show: ";
    Gltf gltf = with_lobes(lobe, pixels(3, {255, 255, 255}));
    gltf.root["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"]["extensions"] = {
        {"KHR_texture_transform", {{"scale", {2, 2}}}}};
    const Imported apart = read(gltf);
    CHECK(apart.losses == lost(mean + "it is laid in another way than the base colour's"));
    Material expected;
    expected.color = Color(1);
    set_metallic_roughness(expected, 0.5F, 0.4F);
    CHECK(apart.scene.materials[0].metallic == Approx(expected.metallic));
    CHECK(apart.scene.materials[0].diffuse == Approx(expected.diffuse));

    const Imported clear = read(with_lobes(
        lobe, nullptr,
        {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}}}));
    CHECK(clear.losses == lost(mean + "the surface is transparent"));
    CHECK(clear.scene.materials[0].metallic == Approx(0.5));

    // Roughness alone has an image of its own and may be laid as it likes.
    gltf = with_lobes(pixels(3, {0, 102, 0, 0, 255, 0}), pixels(3, {255, 255, 255}));
    gltf.root["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"]["extensions"] = {
        {"KHR_texture_transform", {{"scale", {2, 2}}}}};
    const Imported level = read(gltf);
    REQUIRE(level.scene.materials[0].specular_lobes);
    CHECK(level.scene.materials[0].specular_lobes->level.transform ==
          std::array<double, 6>{2, 0, 0, 0, 2, -1});

    gltf.root["images"][0] = {{"uri", "none.png"}};
    const Material plain = read(gltf).scene.materials[0];
    CHECK_FALSE(plain.specular_lobes);
    CHECK(plain.metallic == 0);
}

TEST_CASE("glTF specular lobes, reads specular and glossiness") {
    const json glossy = {{"specularFactor", {1, 1, 1}},
                         {"glossinessFactor", 0.5},
                         {"diffuseFactor", {0.5, 0.5, 0.5, 1}},
                         {"specularGlossinessTexture", {{"index", 0}}}};
    Gltf gltf = with_material({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", glossy}}}});
    gltf.add("images", pixels(4, {188, 0, 0, 204, 0, 188, 0, 0}));
    gltf.add("textures", {{"source", 0}});
    const Imported imported = read(gltf);
    CHECK(imported.losses == lost("specular-glossiness texture: mixed from 5 Phong lobes"));
    const Material& m = imported.scene.materials[0];
    REQUIRE(m.specular_lobes);
    CHECK(samples_of(imported.scene, m.specular_lobes->color.texture) ==
          std::vector<int>{188, 0, 0, 0, 188, 0});
    // Roughness 1 - 0.5 x 0.8 = 0.6, and 1.
    CHECK(samples_of(imported.scene, m.specular_lobes->level.texture) == std::vector<int>{0, 255});
    CHECK(m.specular_lobes->lobes.back().shininess == 1);
    // 0.5 (1 - 0.5) in all channels, and what the lobe of a red metal leaves: 1 - 0.764 of 0.5.
    const auto scattered = samples_of(imported.scene, std::get<ImageMap>(m.pattern).texture);
    CHECK(linear(scattered[1]) == Approx(0.25).margin(0.004));
    CHECK(linear(scattered[0]) == Approx(0.25 + 0.5 * 0.236).margin(0.004));
}

TEST_CASE("glTF specular lobes, reads coloured and textured reflectance") {
    const auto with_specular = [](const json& specular) {
        Gltf gltf = with_material(
            {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
             {"extensions", {{"KHR_materials_specular", specular}}}});
        gltf.add("images", pixels(4, {255, 0, 0, 255, 0, 255, 0, 128}));
        gltf.add("textures", {{"source", 0}});
        return read(gltf);
    };
    const Imported tinted = with_specular({{"specularColorFactor", {2, 1, 0.5}}});
    CHECK(tinted.losses.empty());
    const Material& bronze = tinted.scene.materials[0];
    REQUIRE(bronze.specular_color);
    CHECK((bronze.reflection * *bronze.specular_color - Color(0.08F, 0.04F, 0.02F)).length() <
          1e-6F);
    CHECK(bronze.metallic == 1);
    CHECK(bronze.diffuse == Approx(0.92));

    const Imported strength = with_specular({{"specularTexture", {{"index", 0}}}});
    REQUIRE(strength.scene.materials[0].specular_lobes);
    const auto reflected =
        samples_of(strength.scene, strength.scene.materials[0].specular_lobes->color.texture);
    CHECK(linear(reflected[0]) == Approx(0.04).epsilon(0.02));
    CHECK(linear(reflected[3]) == Approx(0.02).epsilon(0.02));

    const Imported both = with_specular(
        {{"specularTexture", {{"index", 0}}}, {"specularColorTexture", {{"index", 0}}}});
    CHECK(both.losses ==
          Losses{{Loss::approximated, "box.gltf#/materials/0",
                  "specularTexture is replaced by its mean over what the facets show: there is a "
                  "specularColorTexture too"},
                 {Loss::approximated, "box.gltf#/materials/0",
                  "specular texture: mixed from 1 Phong lobe"}});
    const auto red = samples_of(both.scene, both.scene.materials[0].specular_lobes->color.texture);
    CHECK(linear(red[0]) == Approx(0.03).epsilon(0.02));
    CHECK(red[1] == 0);
}

TEST_CASE("glTF specular lobes, can have a clear coat") {
    const std::string what =
        "clearcoat is approximate: its mirror image is added, the stronger highlight stays, and it "
        "dims what is beneath as at normal incidence";
    const json coat = {{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}}}};
    const Imported imported = read(
        with_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.9}}},
                       {"extensions", coat}}));
    CHECK(imported.losses == lost(what));
    CHECK(imported.scene.materials[0].reflection == Color(0.02F));
    CHECK(imported.scene.materials[0].specular == 1);
    CHECK(imported.scene.materials[0].shininess == 10000);
    CHECK(imported.scene.materials[0].diffuse == Approx(0.96 * 0.98));

    // KHR_materials_clearcoat, emission: (1 - clearcoat x 0.04) of what glows beneath.
    CHECK(material_of({{"emissiveFactor", {0.5, 0.25, 0}}, {"extensions", coat}}).emission ==
          Color(0.5F * 0.98F, 0.25F * 0.98F, 0));

    Gltf gltf = with_lobes(pixels(3, {0, 204, 0, 0, 255, 0}), nullptr, {{"extensions", coat}});
    const Imported coated = read(gltf);
    for (const SpecularLobe& lobe : coated.scene.materials[0].specular_lobes->lobes)
        CHECK(lobe.reflection == Color(0.02F));
    gltf.root["materials"][0]["extensions"]["KHR_materials_clearcoat"] = {
        {"clearcoatFactor", 1}, {"clearcoatTexture", {{"index", 0}}}};  // red is 0
    CHECK(read(gltf).scene.materials[0].specular_lobes->lobes[0].reflection == Color(0));
}

TEST_CASE("glTF specular lobes, makes the same gold of all its spellings") {
    const json gold = {0.8, 0.6, 0.2};
    const auto dielectric = [&](double ior) {
        return material_of(
            {{"pbrMetallicRoughness",
              {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
             {"extensions",
              {{"KHR_materials_ior", {{"ior", ior}}},
               {"KHR_materials_specular", {{"specularColorFactor", gold}}}}}});
    };
    const Material metal = material_of({{"pbrMetallicRoughness",
                                         {{"baseColorFactor", {0.8, 0.6, 0.2, 1}},
                                          {"metallicFactor", 1},
                                          {"roughnessFactor", 0.5}}}});
    const Material glossy = material_of({{"extensions",
                                          {{"KHR_materials_pbrSpecularGlossiness",
                                            {{"diffuseFactor", {0, 0, 0, 1}},
                                             {"specularFactor", gold},
                                             {"glossinessFactor", 0.5}}}}}});
    const auto same = [&](const Material& m, double margin) {
        REQUIRE(m.specular_color);
        CHECK((*m.specular_color - metal.color).length() < float(margin));
        CHECK((m.color - metal.color).length() < float(margin));
        CHECK(m.metallic == 1);
        CHECK(m.diffuse == Approx(metal.diffuse).margin(margin));
        CHECK(m.specular == Approx(metal.specular).margin(margin));
        CHECK(m.shininess == metal.shininess);
        CHECK((m.reflection - metal.reflection).length() < float(margin));
    };
    same(dielectric(0), 1e-6);
    same(dielectric(1000), 0.005);  // which reflects 0.996
    same(glossy, 1e-6);
}

TEST_CASE("glTF specular lobes, tints an image of metalness and a coloured reflectance alike") {
    Gltf gltf = with_material(
        {{"pbrMetallicRoughness",
          {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
         {"extensions",
          {{"KHR_materials_ior", {{"ior", 0}}},
           {"KHR_materials_specular", {{"specularColorFactor", {0.8, 0.6, 0.2}}}}}}});
    gltf.add("images", pixels(3, {0, 0, 0, 255, 0, 0}));
    gltf.add("textures", {{"source", 0}});
    const Imported imported = read(gltf);
    const Material& m = imported.scene.materials[0];
    REQUIRE(m.specular_lobes);
    const auto reflected = samples_of(imported.scene, m.specular_lobes->color.texture);
    CHECK(linear(reflected[0]) == Approx(0.8).margin(0.01));
    // (1, 0, 0) (1 - 0.8), and what the lobe of a metal leaves: 1 - 2 x 0.25 / 2 of f0.
    const auto scattered = samples_of(imported.scene, std::get<ImageMap>(m.pattern).texture);
    CHECK(linear(scattered[1]) == Approx(0.6 * 0.75).margin(0.01));
    CHECK(linear(scattered[3]) == Approx(0.2 + 0.8 * 0.75).margin(0.01));
}

TEST_CASE("glTF specular lobes, keeps its images where several models form one scene") {
    json material = {{"alphaMode", "BLEND"},
                     {"emissiveFactor", {1, 1, 1}},
                     {"emissiveTexture", {{"index", 1}}},
                     {"normalTexture", {{"index", 0}}}};
    const Gltf gltf = with_lobes(pixels(3, {0, 204, 0, 0, 51, 255}),
                                 pixels(4, {255, 0, 0, 255, 0, 0, 255, 0}), material);
    const test::TempDir folder;
    const auto one = test::write(folder / "one.gltf", gltf.text());
    const auto two = test::write(folder / "two.gltf", gltf.text());
    const Scene scene = load_scene({one, two}, {.normal_maps = NormalMaps::pixel}).scene;
    const auto textures_of = [](const Material& m) {
        REQUIRE((m.emission_map && m.alpha_map && m.normal_map && m.specular_lobes));
        return std::vector<Index>{std::get<ImageMap>(m.pattern).texture,
                                  m.emission_map->texture,
                                  m.alpha_map->map.texture,
                                  m.normal_map->map.texture,
                                  m.specular_lobes->color.texture,
                                  m.specular_lobes->level.texture};
    };
    const auto first = textures_of(scene.materials.at(0));
    auto second = textures_of(scene.materials.at(1));
    for (Index& index : second) index -= Index(scene.textures.size() / 2);
    CHECK(first == second);
    CHECK(std::set<Index>(first.begin(), first.end()).size() == 6);
}
