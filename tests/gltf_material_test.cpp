// Materials and textures of glTF.
#include "gltf_builder.h"

#include <cmath>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::read;

namespace {

// A triangle with texture coordinates and one material.
Gltf with_material(const json& material) {
    Gltf gltf = test::triangle();
    json& primitive = gltf.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] =
        gltf.accessor("VEC2", std::vector<float>{0, 0, 1, 0, 0, 0.25F});
    primitive["material"] = gltf.add("materials", material);
    return gltf;
}

Material material_of(const json& material) {
    return read(with_material(material)).scene.materials.at(0);
}

std::string data_uri(const std::vector<std::byte>& png) {
    return "data:image/png;base64," +
           test::base64({reinterpret_cast<const char*>(png.data()), png.size()});
}

// Two texels, the left one `left` and the right one black.
json picture(const Color& left) {
    Image image(2, 1);
    image.at(0, 0) = left;
    return {{"uri", data_uri(encode_png(image))}};
}

// The bytes of a 1 x 1 PNG with alpha.
json transparent_picture() {
    const test::TempDir folder;
    Raster raster = {.width = 1, .height = 1, .channels = 4, .data = {}};
    for (const int sample : {255, 0, 0, 128}) raster.data.push_back(std::byte(sample));
    save_raster(folder / "a.png", raster);
    return {{"uri", "data:image/png;base64," + test::base64(test::read(folder / "a.png"))}};
}

const json textured = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};

Index texture_of(const Material& material) {
    const auto* map = std::get_if<ImageMap>(&material.pattern);
    return map != nullptr ? map->texture : no_index;
}

}  // namespace

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
    CHECK(imported.losses == Losses{{"box.gltf#/materials/0/pbrMetallicRoughness/metallicFactor",
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
    Gltf gltf =
        with_material({{"emissiveFactor", {1, 1, 1}},
                       {"emissiveTexture", {{"index", 0}}},
                       {"normalTexture", {{"index", 0}}},
                       {"occlusionTexture", {{"index", 0}}},
                       {"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}}});
    gltf.add("images", picture({1, 0.5F, 0}));
    gltf.add("textures", {{"source", 0}});
    const Imported imported = read(gltf);
    const std::string place = "box.gltf#/materials/0";
    // Half of the texels are black; roughness is stored as sRGB's 188 of 255.
    CHECK(imported.losses == Losses{{place, "metallicRoughnessTexture is replaced by its mean: "
                                            "metallic 0.00, roughness 0.37"},
                                    {place, "emissiveTexture is replaced by its mean"},
                                    {place, "normalTexture is ignored"},
                                    {place, "occlusionTexture is ignored"}});
    const Material& material = imported.scene.materials[0];
    CHECK(material.metallic == 0);
    CHECK(material.emission.x == Approx(0.5));
    CHECK(material.emission.y == Approx(0.25).margin(0.005));
    CHECK(imported.scene.textures.empty());
}

TEST_CASE("glTF textures, are decoded, flipped and sampled as the file says") {
    Gltf gltf = with_material(textured);
    gltf.add("images", picture({1, 0, 0}));
    gltf.root["images"][0]["name"] = "stripe";
    gltf.add("samplers", {{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}});
    gltf.add("textures", {{"source", 0}, {"sampler", 0}});
    const Scene scene = read(gltf).scene;
    REQUIRE(scene.textures.size() == 1);
    const Texture& texture = scene.textures[0];
    CHECK(texture_of(scene.materials[0]) == 0);
    CHECK(texture.name == "stripe");
    CHECK(texture.raster.width == 2);
    CHECK(texture.raster.height == 1);
    CHECK(texture.raster.data.at(0) == std::byte(255));
    CHECK(texture.srgb);
    CHECK_FALSE(texture.bilinear);
    CHECK(texture.wrap_u == Wrap::clamp);
    CHECK(texture.wrap_v == Wrap::mirror);
    CHECK(scene.meshes[0].texcoords == std::vector<Vec2f>{{0, 1}, {1, 1}, {0, 0.75F}});

    gltf.root["textures"][0].erase("sampler");
    const Texture plain = read(gltf).scene.textures.at(0);
    CHECK(plain.bilinear);
    CHECK(plain.wrap_u == Wrap::repeat);
}

TEST_CASE("glTF textures, come from files and from buffer views") {
    Image image(1, 1);
    image.at(0, 0) = Color(1);
    const auto png = encode_png(image);
    Gltf gltf = with_material(textured);
    const int view = gltf.view(std::vector<std::byte>(png));
    gltf.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
    gltf.add("textures", {{"source", 0}});
    CHECK(test::read_content(gltf.glb(), "box.glb").scene.textures.size() == 1);

    test::TempDir folder;
    gltf.root["images"][0] = {{"uri", "two%20words.png"}};
    save_image(folder / "two words.png", image);
    const auto scene = read_gltf(test::write(folder / "box.gltf", gltf.text())).scene;
    CHECK(scene.textures.at(0).name == "two%20words");
}

TEST_CASE("glTF textures, are one for one image and sampling") {
    Gltf gltf = with_material(textured);
    gltf.add("images", picture({1, 0, 0}));
    gltf.add("samplers", {{"wrapS", 33071}});
    gltf.root["textures"] = {{{"source", 0}}, {{"source", 0}}, {{"source", 0}, {"sampler", 0}}};
    for (int i = 1; i < 3; ++i) {
        json primitive = gltf.root["meshes"][0]["primitives"][0];
        primitive["material"] = gltf.add("materials", textured);
        gltf.root["materials"][i]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = i;
        gltf.root["meshes"][0]["primitives"].push_back(primitive);
    }
    const Scene scene = read(gltf).scene;
    CHECK(scene.textures.size() == 2);
    CHECK(texture_of(scene.materials[0]) == texture_of(scene.materials[1]));
    CHECK(texture_of(scene.materials[0]) != texture_of(scene.materials[2]));
}

TEST_CASE("glTF textures, leave the plain colour where the image cannot be read") {
    const auto loss_of = [](const json& image) {
        Gltf gltf = with_material(textured);
        gltf.add("images", image);
        gltf.add("textures", {{"source", 0}});
        const Imported imported = read(gltf);
        CHECK(imported.scene.textures.empty());
        CHECK(texture_of(imported.scene.materials.at(0)) == no_index);
        REQUIRE(imported.losses.size() == 1);
        CHECK(imported.losses[0].place == "box.gltf#/textures/0");
        return imported.losses[0].what;
    };
    CHECK(loss_of({{"uri", "none.png"}}) == "the texture is left out: none.png: no such file");
    CHECK(loss_of({{"uri", "../../etc/passwd"}}) ==
          "the texture is left out: the uri '../../etc/passwd' leads out of the model's folder");
    CHECK_THAT(loss_of({{"uri", "data:image/png;base64,AAAA"}}),
               Catch::Matchers::StartsWith("the texture is left out: "));
}

TEST_CASE("glTF textures, are placed by KHR_texture_transform") {
    Gltf gltf = with_material(textured);
    gltf.add("images", picture({1, 0, 0}));
    gltf.add("textures", {{"source", 0}});
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        gltf.accessor("VEC2", std::vector<float>{0, 0, 1, 0, 0, 1});
    gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
        {"KHR_texture_transform",
         {{"offset", {0.5, 0}}, {"rotation", std::acos(0.0)}, {"scale", {2, 3}}, {"texCoord", 1}}}};
    const auto texcoords = read(gltf).scene.meshes.at(0).texcoords;
    REQUIRE(texcoords.size() == 3);
    // A quarter turn counter-clockwise as one sees the image: +u becomes up, and glTF's +v, which
    // is down, becomes +u.
    CHECK((texcoords[0] - Vec2f(0.5F, 1)).length() < 1e-6F);
    CHECK((texcoords[1] - Vec2f(0.5F, 3)).length() < 1e-6F);
    CHECK((texcoords[2] - Vec2f(3.5F, 1)).length() < 1e-6F);
}

TEST_CASE("glTF textures, are left out where the mesh has no coordinates for them") {
    Gltf gltf = with_material(textured);
    gltf.add("images", picture({1, 0, 0}));
    gltf.add("textures", {{"source", 0}});
    gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 4;
    const Imported imported = read(gltf);
    const Mesh& mesh = imported.scene.meshes.at(0);
    CHECK(texture_of(imported.scene.materials.at(mesh.material)) == no_index);
    CHECK(imported.losses == Losses{{"box.gltf#/meshes/0/primitives/0",
                                     "it has no TEXCOORD_4; its texture is left out"}});
}

TEST_CASE("glTF textures, name transparency that is not shown") {
    json material = textured;
    material["alphaMode"] = "BLEND";
    Gltf gltf = with_material(material);
    gltf.add("textures", {{"source", 0}});
    gltf.root["images"] = json::array({transparent_picture()});
    CHECK(read(gltf).losses == Losses{{"box.gltf#/materials/0",
                                       "the transparency in its base colour texture is ignored"}});
    gltf.root["images"] = json::array({picture({1, 0, 0})});
    CHECK(read(gltf).losses.empty());
}
