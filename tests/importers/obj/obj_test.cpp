#include "importers/obj/obj_files.h"

#include <fmt/format.h>

#include <cmath>

using namespace penumbra;
using test::area;
using test::facets;
using test::Lines;
using test::losses;
using test::message;
using test::quad;

namespace {

Imported read(const std::string& text) { return test::read_text(text); }

// Bytes of `text`, which is ASCII, in UTF-16.
std::string utf16(const std::string& text, bool big_endian, bool mark) {
    std::string result = mark ? (big_endian ? "\xfe\xff" : "\xff\xfe") : "";
    for (const char c : text) {
        if (big_endian) result += '\0';
        result += c;
        if (!big_endian) result += '\0';
    }
    return result;
}

void check_unit_quad(const std::string& text) {
    const Imported imported = read(text);
    CHECK(facets(imported.scene) == 2);
    CHECK(area(imported.scene) == 1);
    CHECK(losses(imported).empty());
}

}  // namespace

TEST_CASE("Obj, one quad becomes one mesh of two facets") {
    const Imported imported = read(quad + "f 1 2 3 4\n");
    const Scene& scene = imported.scene;
    REQUIRE(scene.meshes.size() == 1);
    REQUIRE(scene.instances.size() == 1);
    CHECK(scene.instances[0].mesh == 0);
    CHECK(scene.instances[0].transform == Matrix());
    const Mesh& mesh = scene.meshes[0];
    CHECK(mesh.positions == std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    CHECK(mesh.triangles == std::vector<std::array<Index, 3>>{{0, 1, 2}, {0, 2, 3}});
    CHECK(mesh.material == no_index);
    CHECK(mesh.normals.empty());
    CHECK(mesh.texcoords.empty());
    CHECK(mesh.colors.empty());
    REQUIRE(imported.models.size() == 1);
    CHECK(imported.models[0].format == "OBJ");
}

TEST_CASE("Obj, the same text is read in every encoding") {
    const std::string text = quad + "f 1 2 3 4\n";
    check_unit_quad("\xef\xbb\xbf" + text);
    check_unit_quad(utf16(text, false, true));
    check_unit_quad(utf16(text, true, true));
    check_unit_quad(utf16(text, false, false));
    check_unit_quad(utf16(text, true, false));
    for (const std::string end : {"\r\n", "\r"}) {
        std::string other;
        for (const char c : text) other += c == '\n' ? end : std::string(1, c);
        check_unit_quad(other);
    }
    check_unit_quad(text.substr(0, text.size() - 1));
    CHECK(read("g m\xfcll\n" + text).scene.meshes[0].name == "m\xc3\xbcll");
    CHECK(read("g m\xc3\xbcll\n" + text).scene.meshes[0].name == "m\xc3\xbcll");
}

TEST_CASE("Obj, blanks, comments and continued lines are read as they are meant") {
    check_unit_quad("  v 0 0 0\n\tv\t1  0 0  \nv 1 1 0 # corner\nv 0 1 0#\n\nf 1 2 3 4 # all\n");
    check_unit_quad(quad + "f 1 2 \\\n3 4\n");
    check_unit_quad(quad + "f \\\r\n1 2 \\\r\n3 \\\r\n4\r\n");
    check_unit_quad("# C:\\models\\\n" + quad + "f 1 2 3 4\\");
    check_unit_quad("v +0 0. .0\nv 1e0 -0 0\nv 10E-1 +.1e+1 0\nv 0 1 0\nf +1 2 3 4\n");
}

TEST_CASE("Obj, line numbers survive continued lines") {
    CHECK(message(quad + "f 1 \\\n2 \\\n3\nf 1 2 9\n") == "m.obj:8: vertex 9 of 4 does not exist");
}

TEST_CASE("Obj, incomplete index triples are repaired") {
    check_unit_quad(quad + "f 1// 2// 3// 4//\n");
    check_unit_quad(quad + "f 1/ 2/ 3/ 4/\n");
    check_unit_quad(quad + "vt 0 0\nf 1/1/ 2/1/ 3/1/ 4/1/\n");
}

TEST_CASE("Obj, relative indices count back from their line") {
    check_unit_quad("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1\nv 9 9 9\n");
}

TEST_CASE("Obj, a face may come before its vertices") { check_unit_quad("f 1 2 3 4\n" + quad); }

TEST_CASE("Obj, an index that does not exist is an error with its line") {
    CHECK(message(quad + "f 1 2 12\n") == "m.obj:5: vertex 12 of 4 does not exist");
    CHECK(message(quad + "f 1 2 2147483647\n") == "m.obj:5: vertex 2147483647 of 4 does not exist");
    CHECK(message(quad + "f -1 -2 -5\n") ==
          "m.obj:5: vertex -5 of the 4 before this line does not exist");
    CHECK(message(quad + "vt 0 0\nf 1/1 2/1 3/2\n") ==
          "m.obj:6: texture coordinate 2 of 1 does not exist");
    CHECK(message(quad + "vn 0 0 1\nf 1//1 2//1 3//2\n") ==
          "m.obj:6: normal 2 of 1 does not exist");
    CHECK(message(quad + "f 1 2 4294967298\n") == "m.obj:5: index '4294967298' is out of range");
    CHECK(message(quad + "f 1 2 99999999999999999999\n") ==
          "m.obj:5: index '99999999999999999999' is out of range");
    CHECK(message(quad + "f 0 1 2\n") == "m.obj:5: '0' has the index 0; the first is 1");
    for (const std::string word :
         {"1.5", "a", "0x1", "1-2", "1/1/1/1", "//", "1/a", "//1", "1///2", "+-1", "1/-"})
        CHECK(message(quad + "f " + word + " 2 3\n") ==
              "m.obj:5: '" + word + "' is not a vertex of the form v, v/vt, v//vn or v/vt/vn");
}

// A file that is read in several pieces: `count` quads side by side, each of its own vertices.
std::string long_file(int count) {
    std::string text = "s 1\no row\ng first\n";
    for (int i = 0; i < count; ++i) {
        if (i == count / 2) text += "s off\ng second\n";
        for (const char* corner : {"0", "1"})
            text += fmt::format("v {0}.000000000000 {1} 0\nv {0}.500000000000 {1} 0\n", i, corner);
        text += i % 2 == 0
                    ? "f -4 -3 -1 -2\n"
                    : fmt::format("f {} {} {} {}\n", 4 * i + 1, 4 * i + 2, 4 * i + 4, 4 * i + 3);
    }
    return text;
}

TEST_CASE("Obj, a long file says what it would say in one piece") {
    const int count = 60000;
    const std::string text = long_file(count);
    REQUIRE(text.size() > 5'000'000);
    const Imported imported = read(text);
    const Scene& scene = imported.scene;
    CHECK(losses(imported).empty());
    CHECK(facets(scene) == 2 * count);
    CHECK(std::abs(area(scene) - 0.5 * count) < 1e-6 * count);
    REQUIRE(scene.meshes.size() == 2);
    CHECK(scene.meshes[0].name == "row/first");
    CHECK(scene.meshes[1].name == "row/second");
    CHECK(scene.meshes[0].triangles.size() == count);
    CHECK_FALSE(scene.meshes[0].normals.empty());
    CHECK(scene.meshes[1].normals.empty());
}

TEST_CASE("Obj, of the faults of a long file the first is said, with its line") {
    const int count = 60000;
    const std::string text = long_file(count);
    const int lines = 3 + 2 + 5 * count;  // of the text
    CHECK(message(text + "f 1 2 999999\nf 1 2 x\n") ==
          fmt::format("m.obj:{}: '{}' is not a vertex of the form v, v/vt, v//vn or v/vt/vn",
                      lines + 2, "x"));
    CHECK(message(text + "f 1 2 999999\n" + text + "v 1e300 0 0\n") ==
          fmt::format("m.obj:{}: vertex 999999 of {} does not exist", lines + 1, 8 * count + 1));
    CHECK(message("f 1 2 -3\n" + text + "v 1e300 0 0\n") ==
          "m.obj:1: vertex -3 of the 0 before this line does not exist");
    CHECK(
        message(text + "v 1e300 0 0\nf -1 1 2\n") ==
        fmt::format("m.obj:{}: v has a number that is too large; the limit is 3.4e38", lines + 1));
}

TEST_CASE("Obj, indices into what the file has none of are ignored and said") {
    const Imported imported = read(quad + "f 1/1/1 2/2/1 3/3/1\n");
    CHECK(facets(imported.scene) == 1);
    CHECK(losses(imported) ==
          Lines{"m.obj:5: texture coordinate indices are ignored: the file has no texture "
                "coordinates (3 times)",
                "m.obj:5: normal indices are ignored: the file has no normals (3 times)"});
}

TEST_CASE("Obj, a coordinate that is no finite number is an error with its line") {
    const auto of = [](const std::string& vertex) {
        return message("v 0 0 0\n" + vertex + "\nf -1 -1 1\n");
    };
    CHECK(of("v nan 0 0") == "m.obj:2: v has the number 'nan', which is not finite");
    CHECK(of("v 0 -inf 0") == "m.obj:2: v has the number '-inf', which is not finite");
    CHECK(of("v 0 -1.#IND 0") == "m.obj:2: v has the number '-1.#IND', which is not finite");
    CHECK(of("v 1e39 0 0") == "m.obj:2: v has a number that is too large; the limit is 3.4e38");
    CHECK(of("v 1e999 0 0") == "m.obj:2: v has a number that is too large; the limit is 3.4e38");
    CHECK(of("v 0 0 1e9999999999") ==
          "m.obj:2: v has the number '1e9999999999', which is not finite");
    for (const std::string word : {"abc", "1,5", "1.2.3", "0x1", "1d0", "-", "+-1", "1e", "."})
        CHECK(of("v " + word + " 0 0") == "m.obj:2: v has '" + word + "' where a number should be");
    CHECK(of("v 1 2") == "m.obj:2: v needs 3 numbers but has 2");
    CHECK(of("v") == "m.obj:2: v needs 3 numbers but has 0");
    CHECK(of("vn 0 1") == "m.obj:2: vn needs 3 numbers but has 2");
    CHECK(of("vn 0 1 x") == "m.obj:2: vn has 'x' where a number should be");
    CHECK(of(std::string("v 0 0 1\0", 8)) == "m.obj:2: v has '1?' where a number should be");
}

TEST_CASE("Obj, an exponent with its sign before the e is mended and said") {
    const Imported imported = read("v 0 0 0\nv 1+e2 0 0\nv 0 1-e2 0\nf 1 2 3\n");
    CHECK(imported.scene.meshes[0].positions[1] == Vec3f(100, 0, 0));
    CHECK(imported.scene.meshes[0].positions[2] == Vec3f(0, 0.01F, 0));
    CHECK(
        losses(imported) ==
        Lines{"m.obj:2: a sign before the e of an exponent is taken as the exponent's (2 times)"});
}

TEST_CASE("Obj, a file without facets is an error") {
    CHECK(message("") == "m.obj: no facets in it");
    CHECK(message("# only a comment\n") == "m.obj: no facets in it");
    CHECK(message(quad) == "m.obj: no facets in it");
    CHECK(message(quad + "f 1 2\nl 1 2 3\n") == "m.obj: no facets in it");
}

TEST_CASE("Obj, a file that cannot be read is an error as the user wrote it") {
    CHECK(test::message_of([] { read_obj("nowhere/x.obj"); }) == "nowhere/x.obj: no such file");
    CHECK(test::message_of([] { read_obj("/dev"); }) == "/dev: is a folder");
    CHECK(test::message_of([] { read_obj("/dev/zero"); }) == "/dev/zero: is not a regular file");
}

TEST_CASE("Obj, many kinds of things that are left out are one in the end, also in a large file") {
    std::string text = quad + "f 1 2 3 4\n";
    for (int i = 0; i < 1500; ++i) text += fmt::format("word{} {}\n", i, std::string(2000, 'x'));
    const Losses lost = read(text).losses;
    REQUIRE(lost.size() == 1001);
    CHECK(lost.back().what == "other things of many kinds are ignored (500 times)");
    CHECK(lost.back().count == 500);
}

TEST_CASE("Obj, what is left out is said once, with count and first line") {
    const Imported imported =
        read(quad + "f 1 2 3 4\np 1\np 2 3\nl 1 2\ncstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\n"
                    "parm u 0 1\nend\nsurf 0 1 0 1 1 2 3 4\nf 1 2\nf\nlod 3\ncall other.obj\n"
                    "csh rm x\nfoo bar\nfoo\ns x\nv 1 2 3 0.5\nv 1 2 3 4 5\n");
    CHECK(area(imported.scene) == 1);
    CHECK(losses(imported) ==
          Lines{"m.obj:6: points (p) are ignored (2 times)", "m.obj:8: lines (l) are ignored",
                "m.obj:11: free-form curves and surfaces are ignored (2 times)",
                "m.obj:15: a face with fewer than three corners is ignored (2 times)",
                "m.obj:17: display attributes (bevel, lod, ...) are ignored",
                "m.obj:18: 'call' is not followed", "m.obj:19: 'csh' is not run",
                "m.obj:20: unknown keyword 'foo' is ignored (2 times)",
                "m.obj:22: smoothing group 'x' is not a number; taken as off",
                "m.obj:23: the weight w of a vertex is ignored: facets have none",
                "m.obj:24: numbers at the end of a v line are ignored"});
    CHECK(imported.losses[0].count == 2);
    CHECK(imported.losses[8].kind == Loss::approximated);
    for (const std::size_t i : {0, 3, 5, 6, 7, 9, 10})
        CHECK(imported.losses[i].kind == Loss::dropped);
}
