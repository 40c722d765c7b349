// Faults of a few statements that leave the others as they are.
#include "importers/obj/obj_files.h"

using namespace penumbra;
using test::area;
using test::facets;
using test::Lines;
using test::losses;
using test::message;
using test::quad;

namespace {

Imported read(const std::string& text) { return test::read_text(text); }

const std::string face = "f 1 2 3 4\n";

}  // namespace

TEST_CASE("Obj, a texture coordinate that is not finite is taken as 0 and said") {
    for (const std::string word :
         {"inf", "-INF", "nan", "-1.#IND", "1e39", "1e999", "1e9999999999"}) {
        const Imported imported = read(quad + "vt 0.5 0.5\nvt " + word + " 1\nvt 0.25 " + word +
                                       "\nvt 0 0\n" + "f 1/1 2/2 3/3 4/4\n");
        REQUIRE(imported.scene.meshes.size() == 1);
        CHECK(imported.scene.meshes[0].texcoords ==
              std::vector<Vec2f>{{0.5F, 0.5F}, {0, 1}, {0.25F, 0}, {0, 0}});
        CHECK(losses(imported) ==
              Lines{"m.obj:6: a number of vt that is not finite is taken as 0 (2 times)"});
        CHECK(imported.losses[0].kind == Loss::approximated);
    }
    CHECK(losses(read(quad + "vt 0 0 nan\nf 1/1 2/1 3/1\n")).empty());  // w is never used
}

TEST_CASE("Obj, a vertex that is not finite does no harm where no face uses it") {
    for (const std::string word : {"nan", "-inf", "1.#QNAN", "1e39", "1e9999999999"}) {
        const Imported imported = read(quad + "v 0 " + word + " 0\nv 7 7 " + word + "\n" + face);
        CHECK(area(imported.scene) == 1);
        CHECK(losses(imported) == Lines{"m.obj:5: a vertex that is not finite is ignored: no face "
                                        "uses it (2 times)"});
        CHECK(imported.losses[0].kind == Loss::dropped);
    }
    CHECK(message(quad + "v nan 0 0\nv inf 0 0\n" + face + "f 1 2 6\n") ==
          "m.obj:6: v has the number 'inf', which is not finite");
    CHECK(message(quad + "v 1e39 0 0\nv inf 0 0\n" + face + "f 1 2 5\n") ==
          "m.obj:5: v has a number that is too large; the limit is 3.4e38");
}

TEST_CASE("Obj, a colour that is not finite is taken as 0 and said") {
    const Imported imported = read("v 0 0 0 1 nan 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 inf\nf 1 2 3\n");
    CHECK(imported.scene.meshes[0].colors == std::vector<Color>(3, Color(1, 0, 0)));
    CHECK(losses(imported) ==
          Lines{"m.obj:1: a number of a vertex colour that is not finite is taken as 0 (2 times)"});
}

TEST_CASE("Obj, a normal that is not finite is replaced and said") {
    for (const std::string word : {"nan", "-inf", "1.#IND", "1e999"}) {
        const Imported imported =
            read(quad + "vn 0 0 " + word + "\nvn 0 0 1\nf 1//1 2//2 3//2 4//2\n");
        for (const Vec3f& n : imported.scene.meshes[0].normals) CHECK(n == Vec3f(0, 0, 1));
        CHECK(losses(imported) ==
              Lines{"m.obj:7: a normal without direction is replaced by the facet's"});
    }
    CHECK(losses(read(quad + "vn nan nan nan\n" + face)).empty());
}

TEST_CASE("Obj, an index of 0 for a normal or texture coordinate is as good as none, and said") {
    const std::string given = quad + "vt 0.5 1\nvn 0 0 1\n";
    const auto check = [&](const std::string& text, bool textured, const Lines& lost) {
        const Imported imported = read(given + text + "\n");
        CHECK(area(imported.scene) == 1);
        CHECK(losses(imported) == lost);
        const Mesh& mesh = imported.scene.meshes[0];
        CHECK(mesh.texcoords.empty() != textured);
        for (const Vec3f& n : mesh.normals) CHECK(n == Vec3f(0, 0, 1));
    };
    const std::string normal = "m.obj:7: a normal index of 0 is ignored; the first is 1";
    const std::string texcoord =
        "m.obj:7: a texture coordinate index of 0 is ignored; the first is 1";
    check("f 1/1/0 2/1/1 3/1/1 4/1/1", true, {normal});
    check("f 1//0 2//1 3//1 4//1", false, {normal});
    check("f 1/0 2/1 3/1 4/1", true, {texcoord});
    check("f 1/0/1 2/0/1 3/0/1 4/0/1", false, {texcoord + " (4 times)"});
    check("f 1/0/0 2/0/0 3/0/0 4/0/0", false, {texcoord + " (4 times)", normal + " (4 times)"});
    check("f +1/+0 -3/0/ 3 4", false, {texcoord + " (2 times)"});
    CHECK(message(given + "f 0/1/1 2 3\n") == "m.obj:7: '0/1/1' has the index 0; the first is 1");
    CHECK(message(given + "f 0/0/0 2 3\n") == "m.obj:7: '0/0/0' has the index 0; the first is 1");
}

TEST_CASE("Obj, a backslash that is half a character continues no line") {
    // U+8868 in Shift-JIS, U+8A85 in GBK, and katakana of one byte before U+8868.
    for (const std::string name : {"\x95\x5c", "\xd5\x5c", "\xb6\xb7\x95\x5c", "a\x83\x41\x83\x5c"})
        CHECK(facets(read("g " + name + "\n" + quad + face).scene) == 2);
    // A whole character before a backslash, and the same as UTF-8.
    const std::string rest = quad + "f 1 2 3\nf 1 2\\\n 3\n";
    const Imported joined = read("g \x95\x95\\\nb\n" + rest);
    CHECK(facets(joined.scene) == 2);
    CHECK(losses(joined).empty());
    CHECK(read("g \xc3\xa9\\\nb\n" + rest).scene.meshes[0].name == "\xc3\xa9 b");
}
