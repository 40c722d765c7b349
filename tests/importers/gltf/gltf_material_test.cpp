// Materials of glTF: colour, alpha, light of their own, relief, and what is lost.
#include "importers/gltf/gltf_materials.h"

#include "penumbra/light_model.h"

using namespace penumbra;
using test::Gltf;
using test::json;
using test::material_of;
using test::picture;
using test::read;
using test::with_material;

TEST_CASE("glTF materials, map the core factors") {
    const Material given = material_of({{"name", "brass"},
                                        {"emissiveFactor", {0.1, 0.2, 0.3}},
                                        {"pbrMetallicRoughness",
                                         {{"baseColorFactor", {0.5, 0.25, 0, 1}},
                                          {"metallicFactor", 0.5},
                                          {"roughnessFactor", 0.25}}}});
    Material expected;
    expected.color = Color(0.5F, 0.25F, 0);
    set_metallic_roughness(expected, 0.5F, 0.25F);
    CHECK(given.name == "brass");
    CHECK(given.color == expected.color);
    CHECK(given.ambient == Color(0.1F));
    CHECK(given.diffuse == expected.diffuse);
    CHECK(given.specular == expected.specular);
    CHECK(given.shininess == expected.shininess);
    CHECK(given.metallic == expected.metallic);
    CHECK(given.reflection == expected.reflection);
    CHECK(given.emission == Color(0.1F, 0.2F, 0.3F));
    CHECK(given.opacity == 1);
}

TEST_CASE("glTF materials, give a primitive without one the white metal of the specification") {
    const Scene scene = read(test::triangle()).scene;
    REQUIRE(scene.materials.size() == 1);
    CHECK(scene.meshes[0].material == 0);
    CHECK(scene.materials[0].name == "default");
    CHECK(scene.materials[0].color == Color(1));
    CHECK(scene.materials[0].metallic == 1);
}

TEST_CASE("glTF materials, are unnamed by their number and shared by their users") {
    Gltf gltf = with_material(json::object());
    gltf.root["meshes"][0]["primitives"].push_back(gltf.root["meshes"][0]["primitives"][0]);
    const Scene scene = read(gltf).scene;
    REQUIRE(scene.materials.size() == 1);
    CHECK(scene.materials[0].name == "material0");
}

TEST_CASE("glTF materials, clamp factors and say so") {
    const Imported imported =
        read(with_material({{"pbrMetallicRoughness", {{"metallicFactor", 1.5}}}}));
    CHECK(imported.scene.materials[0].metallic == 1);
    CHECK(imported.losses ==
          Losses{{Loss::approximated, "box.gltf#/materials/0/pbrMetallicRoughness/metallicFactor",
                  "1.5 is outside 0 to 1; 1.0 is used"}});
}

TEST_CASE("glTF materials, read the extensions that a Phong surface can show") {
    CHECK(material_of(
              {{"emissiveFactor", {1, 1, 1}},
               {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5}}}}}})
              .emission == Color(5));
    const json plastic = {{"metallicFactor", 0}};
    // ior 2: F0 = 1/9; half of it: 1/18.
    const Material diamond =
        material_of({{"pbrMetallicRoughness", plastic},
                     {"extensions",
                      {{"KHR_materials_ior", {{"ior", 2}}},
                       {"KHR_materials_specular", {{"specularFactor", 0.5}}}}}});
    CHECK(diamond.diffuse == Approx(1 - 1.0 / 18));
    const Material flat =
        material_of({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0, 1}}}},
                     {"extensions", {{"KHR_materials_unlit", json::object()}}}});
    CHECK(flat.ambient == Color(1));
    CHECK(flat.diffuse == 0);
    CHECK(flat.specular == 0);
    const Material glossy = material_of(
        {{"extensions",
          {{"KHR_materials_pbrSpecularGlossiness",
            {{"diffuseFactor", {0.5, 0.5, 0, 1}}, {"specularFactor", {0.2, 0.2, 0.2}}}}}}});
    CHECK(glossy.color == Color(0.5F, 0.5F, 0));
    CHECK(glossy.diffuse == Approx(0.8));
    CHECK(glossy.reflection.x == Approx(0.2));
}

TEST_CASE("glTF materials, blend or cut by the alpha of the base colour") {
    const auto opacity = [](const std::string& mode, double alpha) {
        return material_of({{"alphaMode", mode},
                            {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, alpha}}}}})
            .opacity;
    };
    CHECK(opacity("OPAQUE", 0.25) == 1);
    CHECK(opacity("BLEND", 0.25) == 0.25F);
    CHECK(opacity("MASK", 0.75) == 1);
    CHECK(opacity("MASK", 0.25) == 0);
}

TEST_CASE("glTF materials, name every feature that is left aside") {
    const json extensions = {{"KHR_materials_sheen", {{"sheenColorFactor", {1, 0, 0}}}},
                             {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}},
                             {"KHR_materials_iridescence", {{"iridescenceFactor", 1}}},
                             {"KHR_materials_dispersion", {{"dispersion", 0.1}}}};
    Gltf gltf = with_material({{"occlusionTexture", {{"index", 0}}}, {"extensions", extensions}});
    gltf.add("images", picture({1, 0.5F, 0}));
    gltf.add("textures", {{"source", 0}});
    for (const auto& [name, value] : extensions.items())
        gltf.root["extensionsUsed"].push_back(name);
    const std::string place = "box.gltf#/materials/0";
    CHECK(read(gltf).losses ==
          Losses{{Loss::approximated, place,
                  "sheen is approximate: its fibres scatter as a matte surface"},
                 {Loss::dropped, place,
                  "occlusionTexture is ignored: it would only dim indirect light"},
                 {Loss::dropped, place, "anisotropy is ignored"},
                 {Loss::dropped, place, "iridescence is ignored"},
                 {Loss::dropped, place, "dispersion is ignored"}});
    CHECK(material_of({{"extensions", {{"KHR_materials_iridescence", {{"iridescenceIor", 2}}}}}})
              .name == "material0");
}

TEST_CASE("glTF materials, wear sheen over what is opaque") {
    const json cloth = {{"KHR_materials_sheen",
                         {{"sheenColorFactor", {0.9, 0.5, 0}}, {"sheenRoughnessFactor", 0.4}}}};
    const Material m = material_of({{"extensions", cloth}});
    REQUIRE(m.sheen);
    CHECK(m.sheen->color == Color(0.9F, 0.5F, 0));
    CHECK(m.sheen->roughness == 0.4F);
    const json half = {{"alphaMode", "BLEND"},
                       {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}},
                       {"extensions", cloth}};
    const Imported seen_through = read(with_material(half));
    CHECK_FALSE(seen_through.scene.materials[0].sheen);
    CHECK(seen_through.losses ==
          Losses{{Loss::dropped, "box.gltf#/materials/0", "sheen is ignored"}});
}

TEST_CASE("glTF materials, say once what several of them lose") {
    const json turned = {
        {"extensions", {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}}}}};
    Gltf gltf = with_material(turned);
    for (int i = 0; i < 2; ++i) {
        json primitive = gltf.root["meshes"][0]["primitives"][0];
        primitive["material"] = gltf.add("materials", turned);
        gltf.root["meshes"][0]["primitives"].push_back(primitive);
    }
    CHECK(read(gltf).losses ==
          Losses{{Loss::dropped, "box.gltf#/materials/0", "anisotropy is ignored (3 times)", 3}});
    // Nothing is lost where the extension has no effect.
    CHECK(read(with_material({{"extensions", {{"KHR_materials_sheen", json::object()}}}}))
              .losses.empty());
}

TEST_CASE("glTF materials, shine by an image of their own") {
    json material = {
        {"emissiveFactor", {1, 0.5, 0}},
        {"emissiveTexture", {{"index", 0}}},
        {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}};
    Gltf gltf = with_material(material);
    gltf.add("images", picture({1, 0.5F, 0}));
    gltf.add("textures", {{"source", 0}});
    const Imported opaque = read(gltf);
    CHECK(opaque.losses.empty());
    REQUIRE(opaque.scene.materials[0].emission_map);
    CHECK(opaque.scene.materials[0].emission == Color(4, 2, 0));
    CHECK(opaque.scene.textures.at(opaque.scene.materials[0].emission_map->texture).srgb);

    material["alphaMode"] = "BLEND";
    material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
    gltf.root["materials"][0] = material;
    const Imported faint = read(gltf);
    CHECK(faint.losses.empty());
    CHECK(faint.scene.materials[0].emission_map);
    CHECK(faint.scene.materials[0].emission == Color(2, 1, 0));  // alpha is how much is there

    material["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    material["alphaMode"] = "OPAQUE";
    gltf.root["materials"][0] = material;
    const Imported glass = read(gltf);
    CHECK(glass.losses.empty());
    CHECK(glass.scene.materials[0].emission_map);
    CHECK(glass.scene.materials[0].emission == Color(4, 2, 0));

    gltf.root["images"][0] = {{"uri", "none.png"}};
    CHECK(read(gltf).scene.materials[0].emission == Color(0));
}

TEST_CASE("glTF materials, have normal maps with their scale") {
    Gltf gltf = with_material({{"normalTexture", {{"index", 0}, {"scale", 0.5}}}});
    gltf.add("images", picture({1, 0.5F, 0}));
    gltf.add("textures", {{"source", 0}});
    const Imported imported = read(gltf);
    CHECK(imported.losses.empty());
    const auto& map = imported.scene.materials[0].normal_map;
    REQUIRE(map);
    CHECK(map->scale == 0.5F);
    CHECK_FALSE(imported.scene.textures.at(map->map.texture).srgb);
    CHECK(imported.scene.meshes[0].texcoords.size() == 3);
    gltf.root["materials"][0]["normalTexture"]["scale"] = 0;
    CHECK_FALSE(read(gltf).scene.materials[0].normal_map);
}

TEST_CASE("glTF materials, blend by the alpha of vertices") {
    const auto imported_with = [](const std::string& mode, const std::vector<float>& colors) {
        Gltf gltf = with_material({{"alphaMode", mode}, {"name", "veil"}});
        gltf.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
            gltf.accessor("VEC4", colors);
        return read(gltf);
    };
    const std::vector<float> fading = {1, 0, 0, 0.25F, 1, 0, 0, 0.5F, 1, 0, 0, 1};
    const Imported veil = imported_with("BLEND", fading);
    CHECK(veil.losses.empty());
    const Mesh& mesh = veil.scene.meshes.at(0);
    CHECK(mesh.alphas == std::vector<float>{0.25F, 0.5F, 1});
    REQUIRE(veil.scene.materials.size() == 1);
    CHECK(veil.scene.materials[0].name == "veil");
    REQUIRE(veil.scene.materials[0].alpha_map);
    CHECK(veil.scene.materials[0].alpha_map->map.texture == no_index);

    std::vector<float> colorful = fading;
    colorful[1] = 1;
    CHECK(imported_with("BLEND", colorful).losses.size() == 1);
    CHECK(imported_with("OPAQUE", fading).scene.meshes.at(0).alphas.empty());
    const std::vector<float> solid = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    CHECK_FALSE(imported_with("BLEND", solid).scene.materials.at(0).alpha_map);
    const Imported cut = imported_with("MASK", fading);
    CHECK(cut.scene.meshes.at(0).alphas.empty());
    CHECK(cut.losses == Losses{{Loss::dropped, "box.gltf#/meshes/0/primitives/0/attributes/COLOR_0",
                                "the vertices' alpha is ignored (alphaMode MASK)"}});
}

TEST_CASE("glTF materials, show the front alone unless they are double-sided") {
    CHECK(material_of(json::object()).sides == Sides::front);
    CHECK(material_of({{"doubleSided", false}}).sides == Sides::front);
    CHECK(material_of({{"doubleSided", true}}).sides == Sides::both);
    CHECK(read(test::triangle()).scene.materials.at(0).sides == Sides::front);
    const json unlit = {{"extensions", {{"KHR_materials_unlit", json::object()}}}};
    CHECK(material_of(unlit).sides == Sides::front);
}
