#include "mtl_files.h"

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
    for (const std::string operands : {"-s 2 3 1 -o 0.5 0.25 t.png", "t.png -o 0.5 0.25 0 -s 2 3"})
        CHECK(own.read("newmtl a\nmap_Kd " + operands + "\n").scene.meshes[0].texcoords ==
              std::vector<Vec2f>{{0.5F, 0.25F}, {2.5F, 0.25F}, {0.5F, 3.25F}});
    CHECK(own.losses("newmtl a\nmap_Kd -t 1 1 1 -mm 0.1 1 -blendu on -imfchan r t.png\n") ==
          Lines{"a.mtl:2: material 'a': option -t of map_Kd is ignored",
                "a.mtl:2: material 'a': option -mm of map_Kd is ignored",
                "a.mtl:2: material 'a': option -imfchan of map_Kd is ignored"});
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
