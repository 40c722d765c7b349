#include "importers/obj/mtl_files.h"

#include "penumbra/light_model.h"

using namespace penumbra;
using test::facet;
using test::Files;
using test::Lines;

TEST_CASE("Mtl, map_Kd lays an image over the surface") {
    const Files own;
    own.image("wood.png");
    const Imported imported = own.read("newmtl a\nKd 0.5 1 1\nmap_Kd wood.png\nmap_Ka wood.png\n");
    CHECK(own.lost(imported).empty());
    const Scene& scene = imported.scene;
    REQUIRE(scene.textures.size() == 1);
    CHECK(scene.textures[0].raster.width == 2);
    CHECK(scene.textures[0].srgb);
    CHECK(scene.textures[0].wrap_u == Wrap::repeat);
    CHECK(std::get<ImageMap>(scene.materials[0].pattern).texture == 0);
    CHECK(scene.materials[0].color == Color(0.5F, 1, 1));
    CHECK(scene.meshes[0].texcoords == std::vector<Vec2f>{{0, 0}, {1, 0}, {0, 1}});
    CHECK(own.material("newmtl a\nmap_Kd wood.png\n").color == Color(1));
    CHECK(own.material("newmtl a\nKd 0 0 0\nmap_Kd wood.png\n").color == Color(1));
    const Material constant = own.material("newmtl a\nKd 1 1 1\nmap_Kd wood.png\nillum 0\n");
    CHECK(constant.ambient == Color(1));
    CHECK(constant.emission == Color(0));
}

TEST_CASE("Mtl, texture names are found however they are written") {
    const Files own;
    own.image("tex/Light Wood 1.png");
    for (const std::string written :
         {"tex/Light Wood 1.png", ".\\TEX\\light wood 1.PNG", "\"tex/Light Wood 1.png\"",
          "-blendu on -mm 0 1 tex/Light Wood 1.png", "tex/Light Wood 1.png -s 1 1 1 -bm 1",
          "tex/Light Wood 1.png # best"})
        CHECK(own.read("newmtl a\nmap_Kd " + written + "\n").scene.textures.size() == 1);
    const Imported windows = own.read("newmtl a\nmap_Kd D:\\art\\wood.png\n");
    CHECK(own.lost(windows) == Lines{"a.mtl:2: material 'a': texture 'D:\\art\\wood.png' lies "
                                     "outside the model's folder; the plain colour is used"});
}

TEST_CASE("Mtl, names are relative to their library, then to the model") {
    const Files own;
    own.image("sub/here.png");
    own.image("there.png");
    test::write(own.path("sub/b.mtl"), "newmtl a\nmap_Kd here.png\n");
    CHECK(own.read("", "sub/b.mtl").scene.textures.size() == 1);
    test::write(own.path("sub/b.mtl"), "newmtl a\nmap_Kd there.png\n");
    CHECK(own.read("", "sub/b.mtl").scene.textures.size() == 1);
    test::write(own.path("sub/b.mtl"), "newmtl a\nmap_Kd ../there.png\n");
    CHECK(own.read("", "sub/b.mtl").scene.textures.size() == 1);
}

TEST_CASE("Mtl, texture options change wrapping and coordinates or are said") {
    const Files own;
    own.image("t.png");
    const Imported clamped = own.read("newmtl a\nmap_Kd -clamp on t.png\n");
    CHECK(clamped.scene.textures[0].wrap_u == Wrap::clamp);
    CHECK(clamped.scene.textures[0].wrap_v == Wrap::clamp);
    for (const std::string operands :
         {"-s 2 3 1 -o 0.5 0.25 t.png", "t.png -o 0.5 0.25 0 -s 2 3"}) {
        const Scene scene = own.read("newmtl a\nmap_Kd " + operands + "\n").scene;
        CHECK(std::get<ImageMap>(scene.materials[0].pattern).transform ==
              std::array<double, 6>{2, 0, 0.5, 0, 3, 0.25});
        CHECK(scene.meshes[0].texcoords == std::vector<Vec2f>{{0, 0}, {1, 0}, {0, 1}});
    }
    CHECK(own.losses("newmtl a\nmap_Kd -t 1 1 1 -s 0 1 -blendu on -imfchan r t.png\n") ==
          Lines{"a.mtl:2: material 'a': option -t of map_Kd is ignored",
                "a.mtl:2: material 'a': option -s of map_Kd is ignored",
                "a.mtl:2: material 'a': option -imfchan of map_Kd is ignored"});
    // 0.1 + 0.5 x 200 / 255, in the image's own encoding.
    const Imported ranged = own.read("newmtl a\nmap_Kd -mm 0.1 0.5 t.png\n");
    CHECK(own.lost(ranged).empty());
    CHECK(ranged.scene.textures.at(0).srgb);
    CHECK(ranged.scene.textures[0].raster.data[0] == std::byte(126));
}

TEST_CASE("Mtl, the same image is read once") {
    const Files own;
    own.image("t.png");
    test::write(
        own.path("a.mtl"),
        "newmtl a\nmap_Kd t.png\nnewmtl b\nmap_Kd T.png\nnewmtl c\nmap_Kd -clamp on t.png\n");
    test::write(own.path("m.obj"), "mtllib a.mtl\n" + facet +
                                       "usemtl a\nf 1/1 2/2 3/3\nusemtl b\n"
                                       "f 1/1 2/2 3/3\nusemtl c\nf 1/1 2/2 3/3\n");
    const Imported imported = read_obj(own.path("m.obj"));
    CHECK(imported.scene.textures.size() == 2);
    CHECK(std::get<ImageMap>(imported.scene.materials[1].pattern).texture == 0);
}

TEST_CASE("Mtl, an image that cannot be had leaves the plain colour") {
    const Files own;
    test::write(own.path("broken.png"), "not a picture");
    const auto check = [&](const std::string& name, const std::string& what) {
        const Imported imported = own.read("newmtl a\nKd 0.5 0 0\nmap_Kd " + name + "\n");
        CHECK(imported.scene.materials[0].color == Color(0.5F, 0, 0));
        CHECK(std::holds_alternative<std::monostate>(imported.scene.materials[0].pattern));
        REQUIRE(own.lost(imported).size() == 1);
        CHECK_THAT(own.lost(imported)[0], Catch::Matchers::StartsWith(what));
    };
    check("none.png", "a.mtl:3: material 'a': texture 'none.png' is not found; the plain colour");
    check("../up.png",
          "a.mtl:3: material 'a': texture '../up.png' lies outside the model's folder");
    check("broken.png", "a.mtl:3: material 'a': texture is ignored: broken.png: ");
    check(".", "a.mtl:3: material 'a': texture is ignored: .: is a folder");
    check("-s 1 1 1", "a.mtl:3: material 'a': texture without a file name is ignored");
}

TEST_CASE("Mtl, textured facets without texture coordinates are said") {
    const Files own;
    own.image("t.png");
    test::write(own.path("a.mtl"), "newmtl a\nmap_Kd t.png\n");
    test::write(own.path("m.obj"), "mtllib a.mtl\n" + facet + "usemtl a\nf 1/1 2/2 3/3\nf 1 2 3\n");
    const Imported imported = read_obj(own.path("m.obj"));
    CHECK(own.lost(imported) == Lines{"m.obj:10: facets of a textured material without texture "
                                      "coordinates take those of the image's lower left corner"});
    CHECK(imported.scene.meshes[0].texcoords.size() == imported.scene.meshes[0].positions.size());
}

namespace {

// A row of texels in the folder, `channels` samples each.
void save(const Files& own, const std::string& name, int channels,
          const std::vector<int>& samples) {
    Raster raster = {.width = int(samples.size()) / channels, .height = 1, .channels = channels};
    for (const int sample : samples) raster.data.push_back(std::byte(sample));
    save_raster(own.path(name), raster);
}

std::vector<int> samples_of(const Scene& scene, Index texture) {
    std::vector<int> result;
    for (const std::byte sample : scene.textures.at(texture).raster.data)
        result.push_back(std::to_integer<int>(sample));
    return result;
}

}  // namespace

TEST_CASE("Mtl, map_d and the alpha of map_Kd make holes") {
    const Files own;
    save(own, "grey.png", 1, {0, 128, 255});
    save(own, "rgba.png", 4, {255, 0, 0, 51, 0, 255, 0, 255});
    save(own, "solid.png", 4, {255, 0, 0, 255, 0, 255, 0, 255});
    save(own, "gone.png", 4, {255, 0, 0, 0, 0, 255, 0, 0});
    const auto alpha_map = [&](const std::string& text) {
        const Scene scene = own.read("newmtl a\n" + text).scene;
        const Material& m = scene.materials[0];
        if (!m.alpha_map) return std::vector<int>();
        CHECK(m.opacity == 1);
        CHECK_FALSE(m.alpha_map->cutoff);
        CHECK_FALSE(scene.textures[m.alpha_map->map.texture].srgb);
        CHECK(scene.textures[m.alpha_map->map.texture].raster.channels == 1);
        return samples_of(scene, m.alpha_map->map.texture);
    };
    CHECK(alpha_map("map_d grey.png\n") == std::vector<int>{0, 128, 255});
    CHECK(alpha_map("d 0.5\nmap_d grey.png\n") == std::vector<int>{0, 64, 128});
    CHECK(alpha_map("map_d -mm 1 -1 grey.png\n") == std::vector<int>{255, 127, 0});
    CHECK(alpha_map("map_d rgba.png\n") == std::vector<int>{51, 255});
    CHECK(alpha_map("map_d -imfchan g rgba.png\n") == std::vector<int>{0, 255});
    CHECK(alpha_map("map_Kd rgba.png\n") == std::vector<int>{51, 255});
    CHECK(alpha_map("map_Kd rgba.png\nmap_d grey.png\n") == std::vector<int>{0, 128, 255});
    CHECK(alpha_map("map_Kd solid.png\n").empty());
    CHECK(alpha_map("map_Kd gone.png\n").empty());
    CHECK(own.read("newmtl a\nmap_Kd gone.png\n").scene.materials[0].opacity == 1);
    CHECK(own.read("newmtl a\nmap_d solid.png\nd 0.5\n").scene.materials[0].opacity == 0.5F);
}

TEST_CASE("Mtl, map_Ke and norm become emission and normal maps") {
    const Files own;
    save(own, "t.png", 3, {255, 128, 0, 0, 128, 255});
    const Imported imported =
        own.read("newmtl a\nmap_Ke -s 2 2 t.png\nnorm -bm 0.5 t.png\nKe 0 0 0\n");
    CHECK(own.lost(imported).empty());
    const Scene& scene = imported.scene;
    const Material& m = scene.materials[0];
    REQUIRE(m.emission_map);
    REQUIRE(m.normal_map);
    CHECK(m.emission == Color(1));
    CHECK(m.emission_map->transform == std::array<double, 6>{2, 0, 0, 0, 2, 0});
    CHECK(scene.textures[m.emission_map->texture].srgb);
    CHECK_FALSE(scene.textures[m.normal_map->map.texture].srgb);
    CHECK(m.normal_map->scale == 0.5F);
    CHECK(own.material("newmtl a\nKe 0.5 0.25 1\nmap_Ke t.png\n").emission ==
          Color(0.5F, 0.25F, 1));

    const Imported glass = own.read("newmtl a\nd 0.5\nmap_Ke t.png\n");
    CHECK(glass.scene.materials[0].emission_map);
    CHECK(glass.scene.materials[0].emission == Color(0.5F));
    CHECK(own.lost(glass).empty());
    // illum 0 shines, by its own image too.
    const Material lamp = own.material("newmtl a\nKd 1 1 1\nillum 0\nmap_Ke t.png\n");
    CHECK(lamp.emission == Color(1));
    CHECK(lamp.ambient == Color(1));
}

TEST_CASE("Mtl, map_Ks tints highlight and mirror image") {
    const Files own;
    save(own, "t.png", 3, {255, 128, 0, 0, 128, 255});
    const Imported imported = own.read("newmtl a\nKs 0.5 0.5 0.5\nNs 40\nillum 3\nmap_Ks t.png\n");
    const Material& m = imported.scene.materials[0];
    REQUIRE(m.specular_lobes);
    CHECK(m.metallic == 1);
    CHECK(m.specular_lobes->color.texture == 0);
    CHECK(m.specular_lobes->level.texture == no_index);
    REQUIRE(m.specular_lobes->lobes.size() == 1);
    CHECK(m.specular_lobes->lobes[0].specular == Approx(0.5));
    CHECK(m.specular_lobes->lobes[0].shininess == 10);
    CHECK(m.specular_lobes->lobes[0].reflection == Color(0.5F));
    CHECK(own.lost(imported) == Lines{"a.mtl:5: material 'a': map_Ks is approximate: the highlight "
                                      "is white in grazing light"});
    const Imported varied = own.read("newmtl a\nKs 1 1 1\nNs 56\nmap_Ns t.png\n");
    REQUIRE(varied.scene.materials[0].specular_lobes);
    CHECK(varied.scene.materials[0].metallic == 0);
    const auto& lobes = varied.scene.materials[0].specular_lobes->lobes;
    REQUIRE(lobes.size() == 8);
    CHECK(lobes[0].shininess == 1);
    CHECK(lobes[4].shininess == Approx(8));
    CHECK(lobes[7].shininess == Approx(14));
    CHECK_FALSE(varied.scene.textures.at(0).srgb);
    CHECK(own.lost(varied) == Lines{"a.mtl:4: material 'a': map_Ns: mixed from 8 Phong lobes"});
    CHECK(own.losses("newmtl a\nKs 1 1 1\nNs 40\nd 0.5\nmap_Ks t.png\n") ==
          Lines{"a.mtl:5: material 'a': map_Ks is ignored: the surface is transparent"});
}

TEST_CASE("Mtl, map_Pr and map_Pm vary the specular lobes") {
    const Files own;
    save(own, "rough.png", 1, {51, 255});
    save(own, "metal.png", 1, {0, 255});
    save(own, "color.png", 3, {255, 0, 0, 0, 0, 255});
    save(own, "even.png", 1, {51, 51});

    const Imported plastic = own.read("newmtl a\nKd 1 0.5 0\nPm 0\nmap_Pr rough.png\n");
    const Material& p = plastic.scene.materials[0];
    REQUIRE(p.specular_lobes);
    CHECK(p.metallic == 0);
    CHECK(p.diffuse == Approx(0.96));
    CHECK(p.color == Color(1, 0.5F, 0));
    CHECK(std::holds_alternative<std::monostate>(p.pattern));
    CHECK(p.specular_lobes->color.texture == no_index);
    CHECK(samples_of(plastic.scene, p.specular_lobes->level.texture) == std::vector<int>{0, 255});
    REQUIRE(p.specular_lobes->lobes.size() == 8);
    // The law of set_metallic_roughness() at both ends.
    for (const auto& [lobe, roughness] : {std::pair(p.specular_lobes->lobes.front(), 0.2F),
                                          std::pair(p.specular_lobes->lobes.back(), 1.0F)}) {
        Material expected;
        set_metallic_roughness(expected, 0, roughness);
        CHECK(lobe.specular == Approx(expected.specular));
        CHECK(lobe.shininess == Approx(expected.shininess));
        CHECK(lobe.reflection.x == Approx(expected.reflection.x));
    }
    CHECK(own.lost(plastic) == Lines{"a.mtl:1: material 'a': metallic and roughness images: mixed "
                                     "from 8 Phong lobes"});

    const Imported metal = own.read("newmtl a\nmap_Kd color.png\nPr 0.2\nmap_Pm metal.png\n");
    const Material& m = metal.scene.materials[0];
    REQUIRE(m.specular_lobes);
    CHECK(m.metallic == 1);
    CHECK(m.diffuse == 1);
    CHECK(m.specular_lobes->level.texture == no_index);
    REQUIRE(m.specular_lobes->lobes.size() == 1);
    // 0.04 is 56 of 255; the metal is blue.
    CHECK(samples_of(metal.scene, m.specular_lobes->color.texture) ==
          std::vector<int>{56, 56, 56, 0, 0, 255});
    CHECK(samples_of(metal.scene, std::get<ImageMap>(m.pattern).texture).at(0) == 250);

    const Imported even = own.read("newmtl a\nPm 1\nmap_Pr even.png\n");
    Material expected;
    set_metallic_roughness(expected, 1, 0.2F);
    CHECK_FALSE(even.scene.materials[0].specular_lobes);
    CHECK(even.scene.materials[0].specular == expected.specular);
    CHECK(even.scene.materials[0].shininess == Approx(expected.shininess));

    CHECK(own.losses("newmtl a\nmap_Kd color.png\nPr 0.2\nmap_Pm -s 2 2 metal.png\n") ==
          Lines{"a.mtl:4: material 'a': map_Pm is replaced by its mean: it is laid in another way "
                "than the first image"});
    CHECK(own.losses("newmtl a\nd 0.5\nmap_Pr rough.png\n") ==
          Lines{"a.mtl:3: material 'a': map_Pr is replaced by its mean: the surface is "
                "transparent"});
}
