// Textures of glTF: how they are read and laid.
#include "importers/gltf/gltf_materials.h"

#include <cmath>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::picture;
using test::pixels;
using test::read;
using test::with_material;

namespace {

const json textured = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};

Index texture_of(const Material& material) {
    const auto* map = std::get_if<ImageMap>(&material.pattern);
    return map != nullptr ? map->texture : no_index;
}

}  // namespace

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
        CHECK(imported.scene.materials[0].color == Color(0.5F));
        REQUIRE(imported.losses.size() == 1);
        CHECK(imported.losses[0].place == "box.gltf#/textures/0");
        return imported.losses[0].what;
    };
    CHECK(loss_of({{"uri", "none.png"}}) ==
          "the texture is left out, grey stands for its colours: none.png: no such file");
    CHECK(loss_of({{"uri", "../../etc/passwd"}}) ==
          "the texture is left out, grey stands for its colours: the uri '../../etc/passwd' leads "
          "out of the model's folder");
    CHECK_THAT(loss_of({{"uri", "data:image/png;base64,AAAA"}}),
               Catch::Matchers::StartsWith("the texture is left out, grey stands"));
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
    const Scene scene = read(gltf).scene;
    CHECK(scene.meshes.at(0).texcoords == std::vector<Vec2f>{{0, 1}, {1, 1}, {0, 0}});
    const auto& t = std::get<ImageMap>(scene.materials[0].pattern).transform;
    const auto placed = [&](double u, double v) {
        return Vec2(t[0] * u + t[1] * v + t[2], t[3] * u + t[4] * v + t[5]);
    };
    // A quarter turn counter-clockwise as one sees the image: +u becomes up, and glTF's +v, which
    // is down, becomes +u.
    CHECK((placed(0, 1) - Vec2(0.5, 1)).length() < 1e-12);
    CHECK((placed(1, 1) - Vec2(0.5, 3)).length() < 1e-12);
    CHECK((placed(0, 0) - Vec2(3.5, 1)).length() < 1e-12);
}

TEST_CASE("glTF textures, are replaced by their mean where they cannot be laid") {
    Gltf gltf = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                               {"normalTexture", {{"index", 0}, {"texCoord", 1}}},
                               {"emissiveFactor", {1, 1, 1}},
                               {"emissiveTexture", {{"index", 0}, {"texCoord", 1}}}});
    gltf.add("images", picture({1, 0, 0}));
    gltf.add("textures", {{"source", 0}});
    const Imported apart = read(gltf);
    const std::string place = "box.gltf#/materials/0";
    CHECK(apart.losses == Losses{{Loss::approximated, place,
                                  "emissiveTexture is replaced by its mean: it has other "
                                  "texture coordinates than the first image"},
                                 {Loss::dropped, place,
                                  "normalTexture is ignored: it has other texture "
                                  "coordinates than the first image"}});
    const Material& alone = apart.scene.materials.at(apart.scene.meshes.at(0).material);
    CHECK(alone.emission.x == Approx(0.5));
    CHECK_FALSE(alone.normal_map);

    gltf.root["materials"][0] = textured;
    gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
        {"KHR_texture_transform", {{"scale", {0, 1}}}}};
    const Imported flat = read(gltf);
    CHECK(flat.losses == Losses{{Loss::approximated, place,
                                 "baseColorTexture is replaced by its mean: its "
                                 "KHR_texture_transform has no area"}});
    CHECK(flat.scene.materials[0].color.x == Approx(0.5));
    CHECK(texture_of(flat.scene.materials[0]) == no_index);
}

namespace {

// Two facets that share an edge; emission has texture coordinates of its own.
Imported with_two_sets(const std::vector<float>& first, const std::vector<float>& second) {
    Gltf gltf = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                               {"emissiveFactor", {1, 1, 1}},
                               {"emissiveTexture", {{"index", 0}, {"texCoord", 1}}}});
    gltf.add("images", picture({1, 0, 0}));
    gltf.add("textures", {{"source", 0}});
    json& primitive = gltf.root["meshes"][0]["primitives"][0];
    primitive["mode"] = 5;  // a strip
    primitive["attributes"] = {
        {"POSITION", gltf.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0})},
        {"TEXCOORD_0", gltf.accessor("VEC2", first)},
        {"TEXCOORD_1", gltf.accessor("VEC2", second)}};
    return read(gltf);
}

// Where the emission of a corner is looked up, as glTF counts.
Vec2 emission_at(const Scene& scene, const Mesh& mesh, std::size_t facet, std::size_t corner) {
    const auto& t = scene.materials.at(mesh.material).emission_map.value().transform;
    const Vec2 uv(mesh.texcoords.at(mesh.triangles.at(facet).at(corner)));
    return {t[0] * uv.x + t[1] * uv.y + t[2], 1 - (t[3] * uv.x + t[4] * uv.y + t[5])};
}

}  // namespace

TEST_CASE("glTF textures, on a second set of coordinates are laid by the first") {
    const std::vector<float> square = {0, 0, 1, 0, 0, 1, 1, 1};
    // Turned and shrunk as a whole: one material is enough.
    const Imported turned = with_two_sets(square, {0.5F, 0, 0.5F, 0.25F, 0, 0, 0, 0.25F});
    CHECK(turned.losses.empty());
    REQUIRE(turned.scene.meshes.size() == 1);
    const Mesh& whole = turned.scene.meshes[0];
    CHECK((emission_at(turned.scene, whole, 0, 1) - Vec2(0.5, 0.25)).length() < 1e-6);
    CHECK((emission_at(turned.scene, whole, 1, 1) - Vec2(0, 0.25)).length() < 1e-6);

    // Folded along the common edge: each facet has a material of its own.
    const Imported folded = with_two_sets(square, {0, 0, 1, 0, 0, 1, 0.5F, 0.25F});
    CHECK(folded.losses.empty());
    REQUIRE(folded.scene.meshes.size() == 2);
    CHECK(folded.scene.instances.size() == 2);
    CHECK(folded.scene.materials.size() == 2);
    CHECK(folded.scene.meshes[0].material != folded.scene.meshes[1].material);
    CHECK(folded.scene.meshes[1].positions.size() == 3);
    CHECK((emission_at(folded.scene, folded.scene.meshes[0], 0, 2) - Vec2(0, 1)).length() < 1e-6);
    std::size_t last = 0;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const Mesh& mesh = folded.scene.meshes[1];
        if (mesh.positions[mesh.triangles[0][corner]] == Vec3f(1, 1, 0)) last = corner;
    }
    CHECK((emission_at(folded.scene, folded.scene.meshes[1], 0, last) - Vec2(0.5, 0.25)).length() <
          1e-6);
}

TEST_CASE("glTF textures, on a second set that does not follow from the first take their mean") {
    const Imported apart = with_two_sets({0, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 1, 1, 1});
    CHECK(apart.losses == Losses{{Loss::approximated, "box.gltf#/materials/0",
                                  "emissiveTexture is replaced by its mean: it has other texture "
                                  "coordinates than the first image"}});
    CHECK(apart.scene.meshes.size() == 1);
}

TEST_CASE("glTF textures, of the first image decide about the coordinates") {
    Gltf gltf = with_material({{"normalTexture", {{"index", 0}, {"texCoord", 1}}}});
    gltf.add("images", picture({1, 0, 0}));
    gltf.add("textures", {{"source", 0}});
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        gltf.accessor("VEC2", std::vector<float>{0.5F, 0, 1, 0, 0, 1});
    const Imported imported = read(gltf);
    CHECK(imported.losses.empty());
    CHECK(imported.scene.meshes[0].texcoords.at(0) == Vec2f(0.5F, 1));
}

TEST_CASE("glTF textures, are left out where the mesh has no coordinates for them") {
    Gltf gltf = with_material(textured);
    gltf.add("images", picture({1, 0, 0}));
    gltf.add("textures", {{"source", 0}});
    gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 4;
    const Imported imported = read(gltf);
    const Mesh& mesh = imported.scene.meshes.at(0);
    CHECK(texture_of(imported.scene.materials.at(mesh.material)) == no_index);
    CHECK(imported.losses == Losses{{Loss::dropped, "box.gltf#/meshes/0/primitives/0",
                                     "it has no TEXCOORD_4; its texture is left out"}});
}

namespace {

// A material whose base colour texture has these alphas, from left to right.
Imported with_alpha(const std::string& mode, const std::vector<int>& alphas, double factor = 1,
                    double cutoff = 0.5) {
    json material = {
        {"alphaMode", mode},
        {"alphaCutoff", cutoff},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {1, 1, 1, factor}}, {"baseColorTexture", {{"index", 0}}}}}};
    Gltf gltf = with_material(material);
    std::vector<int> samples;
    for (const int alpha : alphas)
        for (const int sample : {255, 0, 0, alpha}) samples.push_back(sample);
    gltf.add("images", pixels(4, samples));
    gltf.add("textures", {{"source", 0}});
    Imported imported = read(gltf);
    CHECK(imported.losses.empty());
    return imported;
}

}  // namespace

TEST_CASE("glTF textures, blend by the alpha of the base colour") {
    const Imported imported = with_alpha("BLEND", {0, 100, 255}, 0.5);
    const Material& material = imported.scene.materials[0];
    REQUIRE(material.alpha_map);
    CHECK(material.opacity == 1);
    CHECK_FALSE(material.alpha_map->cutoff);
    const Texture& alpha = imported.scene.textures.at(material.alpha_map->map.texture);
    CHECK_FALSE(alpha.srgb);
    CHECK(alpha.raster.channels == 1);
    CHECK(alpha.raster.data == std::vector<std::byte>{std::byte(0), std::byte(50), std::byte(128)});
    CHECK_FALSE(with_alpha("BLEND", {255, 255}).scene.materials[0].alpha_map);
    CHECK_FALSE(with_alpha("OPAQUE", {0, 255}).scene.materials[0].alpha_map);
    // The same everywhere: no image is needed.
    const Material even = with_alpha("BLEND", {51, 51}, 0.5).scene.materials[0];
    CHECK_FALSE(even.alpha_map);
    CHECK(even.opacity == Approx(0.1));
}

TEST_CASE("glTF textures, cut by the alpha of the base colour") {
    const Material cut = with_alpha("MASK", {0, 100, 255}, 0.5, 0.2).scene.materials[0];
    REQUIRE(cut.alpha_map);
    CHECK(*cut.alpha_map->cutoff == Approx(0.4));
    CHECK(cut.opacity == 1);
    const auto state = [](const Material& m) {
        return std::pair(m.alpha_map.has_value(), m.opacity);
    };
    CHECK(state(with_alpha("MASK", {100, 255}, 1, 0.25).scene.materials[0]) ==
          std::pair(false, 1.0F));
    CHECK(state(with_alpha("MASK", {0, 100}, 1, 0.75).scene.materials[0]) ==
          std::pair(false, 0.0F));
    CHECK(state(with_alpha("MASK", {0, 255}, 1, 0).scene.materials[0]) == std::pair(false, 1.0F));
    CHECK(state(with_alpha("MASK", {0, 255}, 1, 2).scene.materials[0]) == std::pair(false, 0.0F));
}

TEST_CASE("glTF textures, prefer WebP and do without what cannot be read") {
    Gltf gltf = with_material(textured);
    gltf.add("images", picture({1, 0, 0}));
    gltf.add("images", {{"uri", "none.webp"}, {"name", "new"}});
    gltf.add("textures", {{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}});
    const Imported fallback = read(gltf);
    CHECK(fallback.losses.empty());
    CHECK(fallback.scene.textures.size() == 1);
    gltf.root["images"][1] = picture({0, 1, 0});
    const Imported webp = read(gltf);
    CHECK(webp.scene.textures.at(0).raster.data.at(1) == std::byte(255));

    gltf.root["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 1}}}}}};
    gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"KHR_texture_basisu"};
    const Imported grey = read(gltf);
    CHECK(grey.losses == Losses{{Loss::dropped, "box.gltf#/textures/0",
                                 "the texture is left out, grey stands for its colours: "
                                 "KTX2 images (KHR_texture_basisu) cannot be read"}});
    CHECK(grey.scene.materials[0].color == Color(0.5F));
    // Some files name a KTX2 image without the extension.
    gltf.root["images"][1] = {
        {"uri", "data:image/ktx2;base64," + test::base64("\xabKTX 20\xbb\r\n\x1a\n 0123")}};
    gltf.root["textures"][0] = {{"source", 1}};
    CHECK(read(gltf).losses == grey.losses);
    gltf.root["textures"][0] = {{"source", 0},
                                {"extensions", {{"KHR_texture_basisu", {{"source", 1}}}}}};
    CHECK(read(gltf).losses.empty());
}
