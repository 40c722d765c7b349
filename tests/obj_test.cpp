#include "support.h"

#include "penumbra/importers.h"

#include <cmath>
#include <ctime>

using namespace penumbra;

namespace {

const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Imported read(const std::string& text) {
    const test::TempDir folder;
    return read_obj(test::write(folder / "m.obj", text));
}

// The message without the folder.
std::string message(const std::string& text) {
    const test::TempDir folder;
    const std::string prefix = folder.path.string() + '/';
    std::string result = test::message_of([&] { read_obj(test::write(folder / "m.obj", text)); });
    if (result.starts_with(prefix)) result.erase(0, prefix.size());
    return result;
}

// "m.obj:7: what" of every loss.
std::vector<std::string> losses(const Imported& imported) {
    std::vector<std::string> result;
    for (const Loss& loss : imported.losses)
        result.push_back(test::fs::path(loss.place).filename().string() + ": " + loss.what);
    return result;
}

using Lines = std::vector<std::string>;

double area(const Scene& scene) {
    double sum = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const auto& t : mesh.triangles) {
            const Vec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
            sum += (b - a).cross(c - a).length() / 2;
        }
    return sum;
}

std::size_t facets(const Scene& scene) {
    std::size_t sum = 0;
    for (const Mesh& mesh : scene.meshes) sum += mesh.triangles.size();
    return sum;
}

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

// A prism over a regular polygon of n corners, sides only, with the given smoothing statement.
std::string prism(int n, const std::string& smoothing) {
    std::string text;
    for (int i = 0; i < n; ++i)
        for (const char* y : {"0", "1"})
            text += "v " + std::to_string(std::cos(radians(360.0 * i / n))) + ' ' + y + ' ' +
                    std::to_string(-std::sin(radians(360.0 * i / n))) + '\n';
    text += smoothing;
    for (int i = 0; i < n; ++i) {
        const int a = 2 * i + 1, b = 2 * ((i + 1) % n) + 1;
        text += "f " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(b + 1) +
                ' ' + std::to_string(a + 1) + '\n';
    }
    return text;
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
    CHECK(message(quad + "vt 0 0\nf 1/0 2/1 3/1\n") ==
          "m.obj:6: '1/0' has the index 0; the first is 1");
    for (const std::string word :
         {"1.5", "a", "0x1", "1-2", "1/1/1/1", "//", "1/a", "//1", "1///2"})
        CHECK(message(quad + "f " + word + " 2 3\n") ==
              "m.obj:5: '" + word + "' is not a vertex of the form v, v/vt, v//vn or v/vt/vn");
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
    const auto of = [](const std::string& vertex) { return message("v 0 0 0\n" + vertex + "\n"); };
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
    CHECK(of("vt inf") == "m.obj:2: vt has the number 'inf', which is not finite");
    CHECK(of("vt 1e40 0") == "m.obj:2: vt has a number that is too large; the limit is 3.4e38");
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
}

TEST_CASE("Obj, each object, group and material is a mesh of its own") {
    const Imported imported =
        read(quad + "usemtl a\no box\nf 1 2 3\ng lid\nf 1 2 4\nusemtl b\nf 2 3 4\n"
                    "g lid\nf 1 3 4\no ball\nf 1 2 3\ng one  two\nf 1 2 4\no box\nusemtl a\n"
                    "f 1 3 4\n");
    Lines names;
    for (const Mesh& mesh : imported.scene.meshes)
        names.push_back(mesh.name + " " + imported.scene.materials[mesh.material].name + " " +
                        std::to_string(mesh.triangles.size()));
    CHECK(names == Lines{"box a 2", "box/lid a 1", "box/lid b 2", "ball b 1", "ball/one two b 1"});
    CHECK(imported.scene.instances.size() == 5);
    CHECK(imported.scene.instances[1].name == "box/lid");
}

TEST_CASE("Obj, corners that agree in all share one vertex") {
    const Imported imported = read(quad + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\n"
                                          "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 1/5 2/2 4/4\n");
    const Mesh& mesh = imported.scene.meshes[0];
    CHECK(mesh.positions.size() == 5);  // only vertex 1 has two texture coordinates
    REQUIRE(mesh.texcoords.size() == 5);
    for (std::size_t i = 0; i < 4; ++i)
        CHECK(mesh.texcoords[i] == Vec2f(mesh.positions[i].x, mesh.positions[i].y));
    CHECK(mesh.texcoords[4] == Vec2f(0.5F, 0.5F));
}

TEST_CASE("Obj, given normals are made unit") {
    const Imported imported = read(quad + "vn 0 0 5\nvn 3 0 4\nf 1//1 2//2 3//1\n");
    const Mesh& mesh = imported.scene.meshes[0];
    REQUIRE(mesh.normals.size() == 3);
    CHECK(mesh.normals[0] == Vec3f(0, 0, 1));
    CHECK((mesh.normals[1] - Vec3f(0.6F, 0, 0.8F)).length() < 1e-7F);
}

TEST_CASE("Obj, a normal without direction is replaced by the facet's") {
    for (const std::string bad : {"0 0 0", "nan nan nan", "0 -nan(ind) 1", "1.#QNAN 0 0"}) {
        const Imported imported = read(quad + "vn " + bad + "\nvn 0 0.6 -0.8\nf 1//1 2//2 3//2\n");
        const Mesh& mesh = imported.scene.meshes[0];
        REQUIRE(mesh.normals.size() == 3);
        // On the side of the facet's other normals.
        CHECK(mesh.normals[0] == Vec3f(0, 0, -1));
        CHECK((mesh.normals[1] - Vec3f(0, 0.6F, -0.8F)).length() < 1e-7F);
        CHECK(losses(imported) ==
              Lines{"m.obj:7: a normal without direction is replaced by the facet's"});
    }
}

TEST_CASE("Obj, without normals and smoothing groups facets are flat") {
    for (const std::string statement : {"", "s off\n", "s 0\n"}) {
        const Imported imported = read(prism(8, statement));
        CHECK(imported.scene.meshes[0].normals.empty());
        CHECK(imported.scene.meshes[0].positions.size() == 16);
    }
}

TEST_CASE("Obj, a smoothing group gives a prism the normals of its cylinder") {
    for (const std::string statement : {"s 1\n", "s on\n", "s 7\n"}) {
        const Imported imported = read(prism(12, statement));
        const Mesh& mesh = imported.scene.meshes[0];
        REQUIRE(mesh.positions.size() == 24);
        REQUIRE(mesh.normals.size() == 24);
        for (std::size_t i = 0; i < 24; ++i) {
            const Vec3f radial = Vec3f(mesh.positions[i].x, 0, mesh.positions[i].z).normalized();
            CHECK((mesh.normals[i] - radial).length() < 1e-5F);
        }
    }
}

TEST_CASE("Obj, normals do not depend on how a side is cut") {
    // Three faces meet at the origin; z = 0 is cut into two triangles there, whose sum by area or
    // by count would pull the normal towards z.
    const std::string cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\n"
                             "s 1\nf 1 3 2\nf 1 4 3\nf 1 2 6 5\nf 1 5 7 4\n";
    const Imported imported = read(cube);
    const Mesh& mesh = imported.scene.meshes[0];
    REQUIRE(mesh.positions[0] == Vec3f(0));
    CHECK((mesh.normals[0] - Vec3f(-1).normalized()).length() < 1e-6F);
}

TEST_CASE("Obj, groups are not smoothed into each other, and flat facets keep their normal") {
    // A roof of two sides, and a flat gable that shares its corners.
    const std::string roof = "v 0 0 0\nv 0 0 4\nv 1 1 0\nv 1 1 4\nv 2 0 0\nv 2 0 4\n";
    const std::string left = "f 1 2 4 3\n", right = "f 3 4 6 5\n", gable = "f 1 3 5\n";
    const Imported apart = read(roof + "s 1\n" + left + "s 2\n" + right);
    const float h = std::sqrt(0.5F);
    for (const Vec3f& n : apart.scene.meshes[0].normals)
        CHECK((n - Vec3f(n.x < 0 ? -h : h, h, 0)).length() < 1e-6F);
    CHECK(apart.scene.meshes[0].positions.size() == 8);

    const Imported mixed = read(roof + "s 1\n" + left + right + "s off\n" + gable);
    const Mesh& mesh = mixed.scene.meshes[0];
    CHECK(mesh.positions.size() == 9);  // six of the roof, three of the gable
    const auto& last = mesh.triangles.back();
    for (const Index i : last) CHECK(mesh.normals[i] == Vec3f(0, 0, -1));
    CHECK((mesh.normals[mesh.triangles[0][2]] - Vec3f(0, 1, 0)).length() < 1e-6F);  // the ridge
}

TEST_CASE("Obj, smoothing goes across materials") {
    const std::string text = "v 0 0 0\nv 0 0 4\nv 1 1 0\nv 1 1 4\nv 2 0 0\nv 2 0 4\ns 1\n"
                             "usemtl a\nf 1 2 4 3\nusemtl b\nf 3 4 6 5\n";
    const Imported imported = read(text);
    REQUIRE(imported.scene.meshes.size() == 2);
    for (const Mesh& mesh : imported.scene.meshes)
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            if (mesh.positions[i].x == 1)
                CHECK((mesh.normals[i] - Vec3f(0, 1, 0)).length() < 1e-6F);
}

TEST_CASE("Obj, given normals win over smoothing groups") {
    const Imported imported = read("vn 0 0 -1\n" + quad + "s 1\nf 1//1 2//1 3//1\n");
    for (const Vec3f& n : imported.scene.meshes[0].normals) CHECK(n == Vec3f(0, 0, -1));
}

TEST_CASE("Obj, vertex colours are decoded from sRGB") {
    const Imported imported = read("v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
    const auto& colors = imported.scene.meshes[0].colors;
    REQUIRE(colors.size() == 3);
    CHECK(colors[0] == Color(1, 0, 0));
    CHECK(colors[1].y == Approx(0.21404).margin(1e-5));  // IEC 61966-2-1
    CHECK(losses(imported).empty());
}

TEST_CASE("Obj, vertex colours from 0 to 255 are scaled and said") {
    const Imported imported = read("v 0 0 0 255 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 255\nf 1 2 3\n");
    CHECK(imported.scene.meshes[0].colors[0] == Color(1, 0, 0));
    CHECK(losses(imported) == Lines{"m.obj: vertex colours exceed 1; they are taken as 0 to 255"});
}

TEST_CASE("Obj, vertex colours that some vertices lack are ignored and said") {
    const Imported imported = read("v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK(imported.scene.meshes[0].colors.empty());
    CHECK(losses(imported) ==
          Lines{"m.obj:2: vertex colours are ignored: only 1 of 3 vertices have one"});
}

TEST_CASE("Obj, a model far from the origin keeps its shape") {
    // At 5e6 float32 knows only halves.
    const Imported imported = read("v 5000000.125 10 -3000000.25\nv 5000000.25 10 -3000000.25\n"
                                   "v 5000000.125 10.125 -3000000.25\nv 0 0 0\nf 1 2 3\n");
    CHECK(area(imported.scene) == 0.125 * 0.125 / 2);
    const Matrix& place = imported.scene.instances[0].transform;
    const Vec3 corner = Vec3(imported.scene.meshes[0].positions[0]) * place;
    CHECK(corner == Vec3(5000000.125, 10, -3000000.25));
    CHECK(read(quad + "f 1 2 3\n").scene.instances[0].transform == Matrix());
}

TEST_CASE("Obj, a polygon of many corners is not cut off") {
    // tinyobjloader counts corners in eight bits.
    std::string text, face = "f";
    for (int i = 0; i < 1000; ++i) {
        const double r = i % 2 ? 1 : 0.5;
        text += "v " + std::to_string(r * std::cos(radians(0.36 * i))) + ' ' +
                std::to_string(r * std::sin(radians(0.36 * i))) + " 0\n";
        face += ' ' + std::to_string(i + 1);
    }
    const Imported imported = read(text + face + "\n");
    CHECK(facets(imported.scene) == 998);
    CHECK(area(imported.scene) == Approx(500 * 0.5 * std::sin(radians(0.36))).epsilon(1e-4));
    CHECK(losses(imported).empty());
}

TEST_CASE("Obj, where edges of a polygon cross all attributes are interpolated") {
    const Imported imported =
        read("v 0 0 0 0 0 0\nv 2 2 0 0 0 0\nv 2 0 0 1 1 1\nv 0 2 0 1 1 1\n"
             "vt 0 0\nvt 1 1\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n");
    const Mesh& mesh = imported.scene.meshes[0];
    REQUIRE(mesh.positions.size() == 5);
    bool found = false;
    for (std::size_t i = 0; i < 5; ++i) {
        if (mesh.positions[i] != Vec3f(1, 1, 0)) continue;
        found = true;
        CHECK(mesh.texcoords[i].x == Approx(0.5));
        CHECK(mesh.texcoords[i].y == Approx(0.5));
        CHECK(mesh.normals[i] == Vec3f(0, 0, 1));
        CHECK(mesh.colors[i].x == Approx(0.5));
    }
    CHECK(found);
    CHECK(losses(imported) ==
          Lines{"m.obj:10: a polygon crosses itself; what its outline encloses is filled"});
}

TEST_CASE("Obj, a folded polygon is said") {
    const Imported imported = read("v 0 0 0\nv 1 0 1\nv 1 1 0\nv 0 1 1\nf 1 2 3 4\nf 4 3 2 1\n");
    CHECK(losses(imported) ==
          Lines{"m.obj:5: a polygon is not flat; it is folded along diagonals of our choice "
                "(2 times)"});
}

TEST_CASE("Obj, a bridge to a hole adds no vertices") {
    const Imported imported =
        read("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\n"
             "f 1 2 3 4 1 5 6 7 8 5\n");
    CHECK(imported.scene.meshes[0].positions.size() == 8);
    CHECK(area(imported.scene) == 12);
    CHECK(losses(imported).empty());
}

TEST_CASE("Obj, 20,000 groups and 100,000 facets take no time") {
    std::string text = quad;
    for (int i = 0; i < 20000; ++i)
        text += "g g" + std::to_string(i) + "\ns " + std::to_string(i) + "\nf 1 2 3 4\n";
    text += "g last\ns off\n";
    for (int i = 0; i < 30000; ++i) text += "f 1 2 3 4\n";
    const auto start = std::clock();
    const Imported imported = read(text);
    CHECK(double(std::clock() - start) / CLOCKS_PER_SEC < 2);
    CHECK(imported.scene.meshes.size() == 20001);
    CHECK(facets(imported.scene) == 100000);
}
