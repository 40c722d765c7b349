#include "importers/obj/obj_files.h"

#include <cmath>
#include <ctime>

using namespace penumbra;
using test::area;
using test::facets;
using test::Lines;
using test::losses;
using test::quad;

namespace {

Imported read(const std::string& text) { return test::read_text(text); }

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
    CHECK(
        losses(imported) ==
        Lines{"m.obj:4: vertex colours of an object are ignored: some of its vertices have none"});
}

TEST_CASE("Obj, objects whose vertices all have a colour keep theirs beside others without") {
    const std::string plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const std::string red = "v 0 0 1 1 0 0\nv 1 0 1 1 0 0\nv 0 1 1 1 0 0\n";
    const std::string mixed = "v 0 0 2\nv 1 0 2 0 1 0\nv 0 1 2 0 1 0\n";
    for (const std::string name : {"o ", "g "}) {
        const Imported imported = read(plain + name + "a\nf 1 2 3\n" + red + name + "b\nf 4 5 6\n" +
                                       mixed + name + "c\nf 7 8 9\n");
        REQUIRE(imported.scene.meshes.size() == 3);
        CHECK(imported.scene.meshes[0].colors.empty());
        CHECK(imported.scene.meshes[1].colors == std::vector<Color>(3, Color(1, 0, 0)));
        CHECK(imported.scene.meshes[2].colors.empty());
        CHECK(losses(imported) == Lines{"m.obj:15: vertex colours of an object are ignored: some "
                                        "of its vertices have none"});
    }
    CHECK(losses(read(plain + "o a\nf 1 2 3\n" + red + "o b\nf 4 5 6\n")).empty());
}

TEST_CASE("Obj, colours that ZBrush writes in comments are read") {
    const std::string face = "f 1 2 3\n";
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const Imported imported =
        read(corners + "#MRGB ffff0000ff00FF00\n#MRGB ff808080\n# End of MRGB block\n" + face);
    const auto& colors = imported.scene.meshes[0].colors;
    REQUIRE(colors.size() == 3);
    CHECK(colors[0] == Color(1, 0, 0));
    CHECK(colors[1] == Color(0, 1, 0));
    CHECK(colors[2].x == Approx(0.21586).margin(1e-5));  // IEC 61966-2-1
    CHECK(losses(imported).empty());

    // Each object has a block of its own, and one may have none.
    const Imported two =
        read(corners + "o a\n" + face + corners + "#MRGB ff0000ffff0000ffff0000ff\no b\nf 4 5 6\n" +
             corners + "#MRGB ffff0000ffff0000ffff0000\no c\nf 7 8 9\n");
    REQUIRE(two.scene.meshes.size() == 3);
    CHECK(two.scene.meshes[0].colors.empty());
    CHECK(two.scene.meshes[1].colors == std::vector<Color>(3, Color(0, 0, 1)));
    CHECK(two.scene.meshes[2].colors == std::vector<Color>(3, Color(1, 0, 0)));
}

TEST_CASE("Obj, colours of ZBrush that do not fit are said") {
    const auto lost = [](const std::string& paint) {
        return losses(read("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + paint + "f 1 2 3\n"));
    };
    const std::string red = "ffff0000";
    for (const std::string& text : {red + "ff", red + " xyz", red + "fffff00g"})
        CHECK(lost("#MRGB " + text + "\n") ==
              Lines{"m.obj:4: the colours of #MRGB are ignored: they are not eight hexadecimal "
                    "digits for each vertex"});
    CHECK(lost("#MRGB " + red + red + "\n") ==
          Lines{"m.obj:5: vertex colours of an object are ignored: some of its vertices have "
                "none"});
    CHECK(lost("#MRGB " + red + red + red + red + "\n") ==
          Lines{"m.obj:4: #MRGB has more colours than there are vertices before it"});
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

TEST_CASE("Obj, groups and facets take time in proportion to their number") {
    // Processor seconds for `count` groups of two facets each and three times as many in another.
    const auto seconds = [](int count) {
        std::string text = quad;
        for (int i = 0; i < count; ++i) {
            const std::string number = std::to_string(i);
            text += "g g" + number + "\ns " + number + "\nf 1 2 3 4\n";
        }
        text += "g last\ns off\n";
        for (int i = 0; i < count * 3 / 2; ++i) text += "f 1 2 3 4\n";
        const auto start = std::clock();
        const Imported imported = read(text);
        const double taken = double(std::clock() - start) / CLOCKS_PER_SEC;
        CHECK(imported.scene.meshes.size() == std::size_t(count) + 1);
        CHECK(facets(imported.scene) == std::size_t(count) * 5);
        return taken;
    };
    // Squares would be 64 times.
    CHECK(seconds(20000) < 24 * seconds(2500));
}
