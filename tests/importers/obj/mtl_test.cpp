#include "importers/obj/mtl_files.h"

#include "penumbra/light_model.h"

using namespace penumbra;
using test::facet;
using test::Files;
using test::Lines;

namespace fs = std::filesystem;

namespace {

const Files files;  // shared where nothing but a.mtl and m.obj is written

}  // namespace

TEST_CASE("Mtl, an ordinary material becomes a Phong surface") {
    const Material m = files.material("newmtl a\nKa 1 0.5 0\nKd 0.8 0.4 0.2\nKs 0.5 0.5 0.5\n"
                                      "Ns 80\nillum 2\n");
    CHECK(m.name == "a");
    CHECK(m.color == Color(0.8F, 0.4F, 0.2F));
    CHECK(m.diffuse == 1);
    CHECK(m.ambient.x == Approx(0.1));
    CHECK(m.ambient.y == Approx(0.05));
    CHECK(m.ambient.z == 0);
    CHECK(m.specular == Approx(0.5));
    CHECK(m.shininess == 20);  // Ns / 4
    CHECK(m.opacity == 1);
    CHECK(m.ior == 1);
    CHECK(m.reflection == Color(0));
    CHECK(m.emission == Color(0));
    CHECK(std::holds_alternative<std::monostate>(m.pattern));
}

TEST_CASE("Mtl, what is not given has a sensible value") {
    const Material m = files.material("newmtl a\n");
    CHECK(m.color == Color(0.8F));
    CHECK(m.diffuse == 1);
    CHECK(m.specular == 0);
    CHECK(m.ambient.x == Approx(0.1));
    CHECK(files.material("newmtl a\nKd 0.3\n").color == Color(0.3F));
}

TEST_CASE("Mtl, colours from 0 to 255 are scaled and said") {
    const Imported imported = files.read("newmtl a\nKd 128 64 32\nKs 510 255 0\nKe 3 0 0\n");
    const Material& m = imported.scene.materials.at(0);
    CHECK(m.color == Color(128, 64, 32) / 255);
    CHECK(m.emission == Color(3, 0, 0));  // light may be as strong as it likes
    CHECK(files.lost(imported).at(0) ==
          "a.mtl:2: material 'a': Kd exceeds 1; it is taken as 0 to 255");
    CHECK(files.lost(imported).at(1) ==
          "a.mtl:3: material 'a': Ks exceeds 1; it is taken as 0 to 255");
    CHECK(imported.losses.at(0).kind == Loss::approximated);
    CHECK(files.material("newmtl a\nKd 1.2 1 0.5\n").color == Color(1.2F, 1, 0.5F));
    CHECK(files.material("newmtl a\nKd 1 1 1\nKa 20 20 20\n").ambient == Color(2));
    CHECK(files.losses("newmtl a\nKd 9 9 9\nKa 255 0 0\n") ==
          Lines{"a.mtl:2: material 'a': Kd exceeds 1; it is taken as 0 to 255",
                "a.mtl:3: material 'a': Ka exceeds 1; it is taken as 0 to 255"});
}

TEST_CASE("Mtl, keys are known in upper and lower case") {
    const Material m = files.material("NewMtl a\nkd 0.1 0.2 0.3\nKE 1 2 3\nNS 40\nks 1 1 1\n");
    CHECK(m.color == Color(0.1F, 0.2F, 0.3F));
    CHECK(m.emission == Color(1, 2, 3));
    CHECK(m.shininess == 10);
    CHECK(m.specular == Approx(1));
}

TEST_CASE("Mtl, illum says what of a material is used") {
    const std::string text = "newmtl a\nKd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nNs 40\nillum ";
    CHECK(files.material(text + "1\n").specular == 0);
    CHECK(files.material(text + "2\n").specular == Approx(0.25));
    CHECK(files.material(text + "2\n").reflection == Color(0));
    for (const char* mirror : {"3", "5", "8"}) {
        const Material m = files.material(text + mirror + "\n");
        CHECK(m.reflection == Color(0.25F));
        CHECK(m.specular == Approx(0.25));
    }
    const Material constant = files.material(text + "0\n");
    CHECK(constant.emission == Color(0.5F));
    CHECK(constant.diffuse == 0);
    CHECK(constant.ambient == Color(0));
    CHECK(constant.specular == 0);
    CHECK(files.losses(text + "4\n") ==
          Lines{"a.mtl:1: material 'a': the mirror reflection of illum 4 is left out"});
    CHECK(files.losses(text + "10\n") == Lines{"a.mtl:1: material 'a': illum 10 is taken as 2"});
}

TEST_CASE("Mtl, without illum there is a highlight only when Ks and Ns are given") {
    CHECK(files.material("newmtl a\nKs 1 1 1\nNs 40\n").specular == Approx(1));
    CHECK(files.material("newmtl a\nKs 1 1 1\n").specular == 0);
    CHECK(files.material("newmtl a\nNs 40\n").specular == 0);
}

TEST_CASE("Mtl, a small exponent becomes no less than 1") {
    CHECK(files.material("newmtl a\nKs 1 1 1\nNs 2\n").shininess == 1);
}

TEST_CASE("Mtl, glass bends light only where it lets it through") {
    const auto ior = [](const std::string& more) {
        return files.material("newmtl a\nNi 1.5\n" + more).ior;
    };
    CHECK(ior("d 0.3\nillum 9\n") == 1.5F);
    CHECK(ior("d 0.3\nillum 6\n") == 1.5F);
    CHECK(ior("d 0.3\nillum 2\n") == 1);
    CHECK(ior("illum 4\n") == 1);
    CHECK(files.material("newmtl a\nd 0.3\nillum 9\n").opacity == 0.3F);
}

TEST_CASE("Mtl, glass and mirrors reflect as their illum says") {
    const auto made = [](const std::string& more) {
        return files.material("newmtl a\nKs 0.5 0.5 0.5\nNs 40\n" + more);
    };
    for (const char* glass : {"4", "6", "7"})
        CHECK(made(std::string("d 0.5\nNi 1.3\nillum ") + glass + "\n").reflection == Color(0.5F));
    CHECK(made("d 0.5\nillum 9\n").reflection == Color(0));
    CHECK_FALSE(made("d 0.5\nNi 1.3\nillum 6\n").fresnel);
    CHECK_FALSE(made("Ni 1.3\nillum 3\n").fresnel);
    for (const char* fresnel : {"d 0.5\nillum 7\n", "illum 5\n"}) {
        CHECK(made(std::string("Ni 1.3\n") + fresnel).fresnel);
        CHECK(made(std::string("Ni 1.3\n") + fresnel).ior == 1.3F);
        CHECK(made(fresnel).ior == 1.5F);  // without Ni there would be no reflection
    }
    // illum 5 lets nothing bend, which Fresnel's term needs.
    const Imported pane = files.read("newmtl a\nKs 1 1 1\nNs 9\nNi 1.5\nd 0.5\nillum 5\n");
    CHECK_FALSE(pane.scene.materials[0].fresnel);
    CHECK(pane.scene.materials[0].ior == 1);
    CHECK(files.lost(pane) == Lines{"a.mtl:1: material 'a': the Fresnel reflection of illum 5 is "
                                    "replaced by Ks"});
}

TEST_CASE("Mtl, Tf tints what shines through as far as the colour of the surface can") {
    // Glass without a colour of its own: exactly.
    const Material bottle = files.material("newmtl a\nKd 0 0 0\nd 0.2\nTf 0.5 1 0.5\n");
    CHECK(bottle.color == Color(0.5F, 1, 0.5F));
    CHECK(bottle.transmission == 1);
    CHECK(bottle.diffuse == 0);
    CHECK(bottle.ambient == Color(0));
    // 1 - t + t (1, 0, 0) = (1, 0.5, 0.5) with t = 1/2: exactly.
    CHECK(files.material("newmtl a\nKd 1 0 0\nd 0.5\nTf 1 0.5 0.5\n").transmission == 0.5F);
    const Imported near = files.read("newmtl a\nKd 1 0 0\nd 0.5\nTf 1 0.5 0\n");
    CHECK(near.scene.materials[0].transmission == 0.75F);
    CHECK(files.lost(near) == Lines{"a.mtl:1: material 'a': Tf is approximate: what shines through "
                                    "is tinted by Kd"});
    CHECK(files.losses("newmtl a\nKd 1 1 1\nd 0.5\nTf 1 0 0\n") ==
          Lines{"a.mtl:1: material 'a': the colour of what shines through (Tf) is ignored"});
    CHECK(files.material("newmtl a\nd 0.5\nTf 1 1 1\n").transmission == 0);
    CHECK(files.material("newmtl a\nTf 1 0 0\n").opacity == 1);
}

TEST_CASE("Mtl, a clear coat adds its mirror image") {
    const std::string text = "newmtl a\nKs 0.5 0.5 0.5\nNs 40\nillum 2\n";
    const Imported coated = files.read(text + "Pc 0.5\n");
    CHECK(coated.scene.materials[0].reflection == Color(0.02F));
    CHECK(coated.scene.materials[0].specular == 1);  // of a polished coat, stronger than 0.5
    CHECK(files.lost(coated) ==
          Lines{"a.mtl:1: material 'a': Pc is approximate: its mirror image is added, the stronger "
                "highlight stays"});
    // A rough coat mirrors nothing, and its highlight is the weaker one.
    const Imported rough = files.read(text + "Pc 0.5\nPcr 0.9\n");
    CHECK(rough.scene.materials[0].reflection == Color(0));
    CHECK(rough.scene.materials[0].specular == 0.5F);
}

TEST_CASE("Mtl, d and Tr are opposites and d wins") {
    CHECK(files.material("newmtl a\nd 0.25\n").opacity == 0.25F);
    CHECK(files.material("newmtl a\nTr 0.25\n").opacity == 0.75F);
    CHECK(files.material("newmtl a\nTr 0.75\nd 0.25\n").opacity == 0.25F);
    for (const std::string text : {"newmtl a\nTr 0.5\nd 0.25\n", "newmtl a\nd 0.25\nTr 0.5\n"}) {
        const Imported imported = files.read(text);
        CHECK(imported.scene.materials[0].opacity == 0.25F);
        REQUIRE(imported.losses.size() == 1);
        CHECK(imported.losses[0].what == "material 'a': Tr contradicts d; d is used");
    }
    const Imported invisible = files.read("newmtl a\nTr 1\n");
    CHECK(invisible.scene.materials[0].opacity == 1);
    CHECK(files.lost(invisible) ==
          Lines{"a.mtl:2: material 'a': Tr 1 would make it invisible; it is taken as opaque"});
    CHECK(files.losses("newmtl a\nd -halo 0.5\n") ==
          Lines{"a.mtl:2: material 'a': the halo of d is ignored"});
}

TEST_CASE("Mtl, a coloured highlight has its colour and is said to lose it in grazing light") {
    const Imported imported = files.read("newmtl a\nKs 0.8 0.2 0\nNs 40\nillum 3\n");
    const Material& m = imported.scene.materials[0];
    CHECK(m.specular == 0.8F);
    REQUIRE(m.specular_color);
    CHECK((*m.specular_color - Color(1, 0.25F, 0)).length() < 1e-6F);
    CHECK(m.metallic == 0);
    CHECK(m.reflection == Color(0.8F, 0.2F, 0));  // the mirror in any light
    CHECK(files.lost(imported) ==
          Lines{"a.mtl:1: material 'a': the coloured highlight (Ks) is approximate: it becomes "
                "white in grazing light"});
    CHECK_FALSE(files.material("newmtl a\nKs 0.5 0.5 0.5\nNs 40\n").specular_color);
}

TEST_CASE("Mtl, the PBR extension is read as metallic and roughness") {
    const Material read = files.material("newmtl a\nKd 1 0.5 0\nPm 1\nPr 0.3\nKs 1 0 0\nNs 9\n");
    Material expected;
    expected.color = Color(1, 0.5F, 0);
    set_metallic_roughness(expected, 1, 0.3F);
    CHECK(read.metallic == expected.metallic);
    CHECK(read.specular == expected.specular);
    CHECK(read.shininess == expected.shininess);
    CHECK(read.diffuse == expected.diffuse);
    CHECK(read.reflection == expected.reflection);
    CHECK(read.color == Color(1, 0.5F, 0));
    CHECK(files.losses("newmtl a\nPr 1\nPc 0.5\nPs 0\naniso 0.1\n") ==
          Lines{"a.mtl:5: material 'a': aniso is ignored",
                "a.mtl:1: material 'a': Pc is approximate: its mirror image is added, the stronger "
                "highlight stays"});
}

TEST_CASE("Mtl, keys and maps that are not supported are said once each") {
    CHECK(files.losses("newmtl a\nmap_Ks s.png\nmap_Bump b.png\nnorm n.png\nmap_ks t.png\n"
                       "sharpness 60\nfoo 1\nfoo 2\nrefl -type sphere r.png\n") ==
          Lines{"a.mtl:6: material 'a': sharpness is ignored",
                "a.mtl:7: material 'a': foo is ignored",
                "a.mtl:4: material 'a': texture 'n.png' is not found",
                "a.mtl:2: material 'a': map_Ks is ignored",
                "a.mtl:3: material 'a': map_Bump is ignored: it gives heights, norm would give "
                "normals",
                "a.mtl:9: material 'a': refl is ignored"});
}

TEST_CASE("Mtl, values that make no sense are said and mended") {
    CHECK(files.losses("newmtl a\nKd 1 x 0\nKa\nd 7\nNs -3\nKe 1e99\nillum 99\n"
                       "Ks spectral f.rfl\nNi nan\n") ==
          Lines{"a.mtl:2: material 'a': Kd '1 x 0' is not a number and is ignored",
                "a.mtl:3: material 'a': Ka without a number is ignored",
                "a.mtl:8: material 'a': Ks spectral is ignored: only RGB is read",
                "a.mtl:9: material 'a': Ni 'nan' is not a number and is ignored",
                "a.mtl:6: material 'a': Ke 1e+99 is out of range; 3.403e+38 is used",
                "a.mtl:5: material 'a': Ns -3 is out of range; 0 is used",
                "a.mtl:4: material 'a': d 7 is out of range; 1 is used",
                "a.mtl:7: material 'a': illum 99 is out of range; 10 is used",
                "a.mtl:1: material 'a': illum 10 is taken as 2"});
    CHECK(files.losses("Kd 1 1 1\nKs 1 1 1\nnewmtl a\nKd 0 1 0\nnewmtl a\nKd 1 0 0\n") ==
          Lines{"a.mtl:1: what stands before newmtl is ignored",
                "a.mtl:5: material 'a' is defined again; the first is used"});
}

TEST_CASE("Mtl, what several materials lose is said once") {
    const Files own;
    test::write(own.path("a.mtl"), "newmtl a\nsharpness 9\nKd xyz 1 1 1\nnewmtl b\nsharpness 9\n"
                                   "newmtl c\nsharpness 9\nnewmtl d\nKd xyz 1 1 1\n");
    test::write(own.path("m.obj"), "mtllib a.mtl\n" + facet +
                                       "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n"
                                       "usemtl d\nf 1 2 3\n");
    CHECK(
        own.lost(read_obj(own.path("m.obj"))) ==
        Lines{"a.mtl:2: material 'a': sharpness is ignored (and 2 more materials)",
              "a.mtl:3: material 'a': Kd xyz is ignored: only RGB is read (and 1 more material)"});
}

TEST_CASE("Mtl, names may hold blanks and number signs") {
    for (const std::string name : {"dark red wood", "Material #25", "a/b\\c", "r\xc3\xb6t"}) {
        const Imported imported = files.read("newmtl " + name + "\r\nKd 0.5 0 0\n", "a.mtl", name);
        CHECK(imported.scene.materials[0].name == name);
        CHECK(imported.scene.materials[0].color == Color(0.5F, 0, 0));
    }
    const Imported commented =
        files.read("newmtl red  # the first\nKd 0.5 0 0\n", "a.mtl # all", "red # here");
    CHECK(commented.scene.materials[0].name == "red");
    CHECK(commented.scene.materials[0].color == Color(0.5F, 0, 0));
}

TEST_CASE("Mtl, materials that no library has are said and keep their names") {
    const Files own;
    test::write(own.path("m.obj"), facet + "usemtl one\nf 1 2 3\nusemtl two\nf 1 3 2\n");
    const Imported imported = read_obj(own.path("m.obj"));
    CHECK(own.lost(imported) ==
          Lines{"m.obj:7: material 'one' is not defined; it gets default values (and 1 more)"});
    REQUIRE(imported.scene.materials.size() == 2);
    CHECK(imported.scene.materials[1].name == "two");
    CHECK(imported.scene.meshes[1].material == 1);
}

TEST_CASE("Mtl, an empty usemtl ends the material") {
    const Files own;
    test::write(own.path("m.obj"), facet + "usemtl\nf 1 2 3\n");
    CHECK(read_obj(own.path("m.obj")).scene.meshes[0].material == no_index);
}

TEST_CASE("Mtl, libraries are found however they are written") {
    const Files own;
    const std::string red = "newmtl a\nKd 0.5 0 0\n";
    const auto check = [&](const std::string& file, const std::string& written) {
        test::write(own.path(file), red);
        test::write(own.path("m.obj"), "mtllib " + written + "\n" + facet + "usemtl a\nf 1 2 3\n");
        const Imported imported = read_obj(own.path("m.obj"));
        CHECK(imported.scene.materials[0].color == Color(0.5F, 0, 0));
        fs::remove(own.path(file));
        return own.lost(imported);
    };
    CHECK(check("my red.mtl", "my red.mtl").empty());
    CHECK(check("my red.mtl", "\"my red.mtl\"").empty());
    CHECK(check("MyRed.MTL", "myred.mtl").empty());
    CHECK(check("Sub/Dir/x.mtl", "sub\\DIR\\x.mtl").empty());
    CHECK(check("x.mtl", "./y/../x.mtl").empty());
    CHECK(check("x.mtl", "none.mtl x.mtl") ==
          Lines{"m.obj:1: material library 'none.mtl' is not found"});
    CHECK(check("x y.mtl", "none.mtl x y.mtl") ==
          Lines{"m.obj:1: material library 'none.mtl' is not found"});
    CHECK(check("x.mtl", "C:\\models\\x.mtl") ==
          Lines{"m.obj:1: material library 'C:\\models\\x.mtl' lies outside the model's folder; "
                "'x.mtl' beside the model is used"});
}

TEST_CASE("Mtl, all libraries are read") {
    const Files own;
    test::write(own.path("1.mtl"), "newmtl a\nKd 0.5 0 0\n");
    test::write(own.path("2.mtl"), "newmtl b\nKd 0 0.5 0\n");
    test::write(own.path("3.mtl"), "newmtl c\nKd 0 0 0.5\n");
    test::write(own.path("m.obj"), facet + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nmtllib 1.mtl "
                                           "2.mtl\nmtllib 3.mtl\nusemtl c\nf 1 2 3\n");
    const Imported imported = read_obj(own.path("m.obj"));
    CHECK(imported.losses.empty());
    REQUIRE(imported.scene.materials.size() == 3);
    for (int i = 0; i < 3; ++i) CHECK(imported.scene.materials[std::size_t(i)].color[i] == 0.5F);
}

TEST_CASE("Mtl, nothing outside the model's folder is opened") {
    const Files own;
    fs::create_directory(own.path("model"));
    test::write(own.path("secret.mtl"), "newmtl a\nKd 0.5 0 0\n");
    fs::create_symlink(own.path("secret.mtl"), own.path("model/link.mtl"));
    const auto check = [&](const std::string& written, const std::string& what) {
        test::write(own.path("model/m.obj"),
                    "mtllib " + written + "\n" + facet + "usemtl a\nf 1 2 3\n");
        const Imported imported = read_obj(own.path("model/m.obj"));
        CHECK(imported.scene.materials[0].color == Color(0.8F));
        CHECK(own.lost(imported) ==
              Lines{"model/m.obj:1: material library " + what,
                    "model/m.obj:8: material 'a' is not defined; it gets default values"});
    };
    check("../secret.mtl", "'../secret.mtl' lies outside the model's folder");
    check("..\\secret.mtl", "'..\\secret.mtl' lies outside the model's folder");
    check("x/../../secret.mtl", "'x/../../secret.mtl' lies outside the model's folder");
    check("/dev/zero", "'/dev/zero' lies outside the model's folder");
    check("link.mtl", "'link.mtl' lies outside the model's folder");
    check(".", "is ignored: model/.: is a folder");
    check("none.mtl", "'none.mtl' is not found");
}

TEST_CASE("Mtl, UTF-16 and byte order marks are read") {
    CHECK(files.material("\xef\xbb\xbfnewmtl a\nKd 0.5 0 0\n").color == Color(0.5F, 0, 0));
    std::string wide = "\xff\xfe";
    for (const char c : std::string("newmtl a\nKd 0.5 0 0\n")) (wide += c) += '\0';
    CHECK(files.material(wide).color == Color(0.5F, 0, 0));
}

TEST_CASE("Mtl, a hundred thousand materials that nobody uses cost nothing") {
    std::string text = "newmtl a\nKd 0.5 0 0\n";
    for (int i = 0; i < 100000; ++i) text += "newmtl m" + std::to_string(i) + "\nKd 1 1 1\n";
    CHECK(files.read(text).scene.materials.size() == 1);
}
