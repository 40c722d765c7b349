// Names of files in other encodings and spellings.
#include "importers/obj/mtl_files.h"

using namespace penumbra;
using test::facet;
using test::Files;
using test::Lines;

namespace fs = std::filesystem;

namespace {

const std::string red = "\nKd 0.5 0 0\n";

// A model that names a library and a material.
fs::path model(const Files& files, const std::string& library, const std::string& material = "a") {
    return test::write(files.path("m.obj"), "mtllib " + library + "\n" + facet + "usemtl " +
                                                material + "\nf 1/1 2/2 3/3\n");
}

// Whether the library is found that is `file` on the disk and `written` in the model.
void check_library(const std::string& file, const std::string& written) {
    const Files files;
    test::write(files.path(file), "newmtl a" + red);
    const Imported imported = read_obj(model(files, written));
    CHECK(imported.scene.materials.at(0).color == Color(0.5F, 0, 0));
    CHECK(files.lost(imported) == Lines{});
}

// The same for an image, that is named by its library.
void check_image(const std::string& file, const std::string& written) {
    const Files files;
    files.image(file);
    const Imported imported = files.read("newmtl a\nmap_Kd " + written + "\n");
    CHECK(files.lost(imported) == Lines{});
    CHECK(imported.scene.textures.size() == 1);
}

}  // namespace

TEST_CASE("Mtl names, are found in UTF-8 where the file is GBK or Shift-JIS, and as bytes") {
    const std::string gbk = "\xb4\xf3\xb5\xd8\xd0\xce", sjis = "\x93\xfa\x96\x7b";
    check_library("\u5927\u5730\u5f62.mtl", gbk + ".mtl");
    check_library("\u65e5\u672c.mtl", sjis + ".mtl");
    check_library(gbk + ".mtl", gbk + ".mtl");
    check_library("\u5927\u5730\u5f62/A.MTL", gbk + "\\a.mtl");
    check_image("\u5927\u5730\u5f62.png", gbk + ".png");
    check_image("\u65e5\u672c.png", sjis + ".png");
    check_image(sjis + ".png", sjis + ".png");
}

TEST_CASE("Mtl names, keep a backslash that is half a character") {
    const std::string hyou = "\x95\x5c";  // U+8868
    check_image("\u8868.png", hyou + ".png");
    check_image(hyou + ".png", hyou + ".png");
    check_image("\u8868/\u8868.png", hyou + "\\" + hyou + ".png");
    const Files files;
    test::write(files.path("a.mtl"), "newmtl " + hyou + red);
    const Imported imported = read_obj(model(files, "a.mtl", hyou));
    CHECK(imported.scene.materials.at(0).color == Color(0.5F, 0, 0));
    CHECK(files.lost(imported) == Lines{});
}

TEST_CASE("Mtl names, of materials are the same in other encodings and spellings") {
    const auto check = [](const std::string& used, const std::string& defined) {
        const Files files;
        test::write(files.path("a.mtl"), "newmtl " + defined + red);
        const Imported imported = read_obj(model(files, "a.mtl", used));
        CHECK(imported.scene.materials.at(0).color == Color(0.5F, 0, 0));
        CHECK(files.lost(imported) == Lines{});
    };
    check("\xb2\xc4\xd6\xca", "\u6750\u8d28");
    check("\u6750\u8d28", "\xb2\xc4\xd6\xca");
    check("m\u00fcll", "m\xfcll");
    check("m\u00fcll", "mu\u0308ll");
}

TEST_CASE("Mtl names, are found whether letters and marks are one character or two") {
    const std::string pairs[][2] = {{"\u00e9", "e\u0301"},
                                    {"\u03ae", "\u03b7\u0301"},
                                    {"\u0439", "\u0438\u0306"},
                                    {"\u304c\u30d1", "\u304b\u3099\u30cf\u309a"},
                                    {"\ud55c\uae00", "\u1112\u1161\u11ab\u1100\u1173\u11af"},
                                    {"\u1ead", "a\u0323\u0302"}};
    for (const auto& [one, two] : pairs) {
        check_library(one + ".mtl", two + ".mtl");
        check_library(two + "/" + two + ".mtl", one + "\\" + one + ".mtl");
        check_image(one + ".png", two + ".png");
        check_image(two + ".png", one + ".png");
    }
    check_library("E\u0301.MTL", "\u00e9.mtl");
    check_library("cafe\u0301.mtl", "caf\xe9.mtl");
}

TEST_CASE("Mtl names, of the same file in two spellings mean the one that is written") {
    const Files files;
    test::write(files.path("e\u0301.mtl"), "newmtl a" + red);
    test::write(files.path("\u00e9.mtl"), "newmtl a\nKd 0 0.5 0\n");
    test::write(files.path("E\u0301.mtl"), "newmtl a\nKd 0 0 0.5\n");
    CHECK(read_obj(model(files, "\u00e9.mtl")).scene.materials.at(0).color == Color(0, 0.5F, 0));
    CHECK(read_obj(model(files, "e\u0301.mtl")).scene.materials.at(0).color == Color(0.5F, 0, 0));
    fs::remove(files.path("\u00e9.mtl"));
    CHECK(read_obj(model(files, "\u00e9.mtl")).scene.materials.at(0).color == Color(0.5F, 0, 0));
}

TEST_CASE("Mtl names, that are not found give way to the library that is called as the model") {
    const auto lost = [](const std::string& written, const std::string& file) {
        const Files files;
        test::write(files.path(file), "newmtl a" + red);
        const Imported imported = read_obj(model(files, written));
        const bool used = imported.scene.materials.at(0).color == Color(0.5F, 0, 0);
        CHECK(used == (imported.losses.size() == 1));
        if (used) CHECK(imported.losses[0].kind == Loss::approximated);
        return files.lost(imported);
    };
    CHECK(lost("none.mtl", "m.mtl") == Lines{"m.obj:1: material library 'none.mtl' is not found; "
                                             "'m.mtl' beside the model is used"});
    CHECK(lost("\xff\xff.mtl", "M.MTL").at(0).ends_with("'M.MTL' beside the model is used"));
    CHECK(lost("../none.mtl", "m.mtl") ==
          Lines{"m.obj:1: material library '../none.mtl' lies outside the model's folder; "
                "'m.mtl' beside the model is used"});
    CHECK(lost("C:\\\x93\xfa\\\x96\x7b.mtl", "\u672c.mtl")
              .at(0)
              .ends_with("lies outside the model's folder; '\u672c.mtl' beside the model is used"));
    CHECK(lost("none.mtl", "other.mtl").size() == 2);
    CHECK(lost("none.mtl", "sub/m.mtl").size() == 2);

    const Files files;  // one that is found is enough
    test::write(files.path("x.mtl"), "newmtl a" + red);
    test::write(files.path("m.mtl"), "newmtl a\nKd 1 1 1\n");
    const Imported imported = read_obj(model(files, "none.mtl x.mtl"));
    CHECK(imported.scene.materials.at(0).color == Color(0.5F, 0, 0));
    CHECK(files.lost(imported) == Lines{"m.obj:1: material library 'none.mtl' is not found"});
}

TEST_CASE("Mtl names, in another spelling lead out of no folder") {
    const Files files;
    fs::create_directory(files.path("model"));
    test::write(files.path("secret.mtl"), "newmtl a" + red);
    fs::create_symlink(files.path("secret.mtl"), files.path("model/e\u0301.mtl"));
    fs::create_symlink(files.path("secret.mtl"), files.path("model/\u8868.mtl"));
    for (const std::string name : {"\u00e9", "\x95\x5c"}) {
        const Imported imported =
            read_obj(test::write(files.path("model/m.obj"), "mtllib " + name + ".mtl\n" + facet +
                                                                "usemtl a\nf 1/1 2/2 3/3\n"));
        CHECK(imported.scene.materials.at(0).color == Color(0.8F));
        CHECK(imported.losses.size() == 2);
    }
}
