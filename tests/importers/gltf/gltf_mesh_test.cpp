// Accessors and primitives of glTF.
#include "importers/gltf/gltf_builder.h"

#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::read;

namespace {

Mesh only_mesh(const Gltf& gltf) {
    const Imported imported = read(gltf);
    REQUIRE(imported.scene.meshes.size() == 1);
    return imported.scene.meshes[0];
}

// Positions (i, 0, 0), (i, 1, 0) for i = 0, 1, 2: a band of four triangles.
const std::vector<float> band = {0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0};

using Triangles = std::vector<std::array<Index, 3>>;

template <class T>
Triangles indexed_by() {
    Gltf gltf;
    const int positions = gltf.accessor("VEC3", band);
    const int indices = gltf.accessor("SCALAR", std::vector<T>{5, 4, 3, 0, 1, 2});
    gltf.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    return only_mesh(gltf).triangles;
}

template <class T>
std::vector<Vec2f> texcoords_from(const std::vector<T>& values) {
    Gltf gltf = test::triangle();
    gltf.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        gltf.accessor("VEC2", values, {{"normalized", true}});
    return only_mesh(gltf).texcoords;
}

}  // namespace

TEST_CASE("glTF meshes, read indices of every type") {
    const Triangles expected = {{5, 4, 3}, {0, 1, 2}};
    CHECK(indexed_by<std::uint8_t>() == expected);
    CHECK(indexed_by<std::uint16_t>() == expected);
    CHECK(indexed_by<std::uint32_t>() == expected);
}

TEST_CASE("glTF meshes, turn strips and fans into triangles") {
    Gltf gltf;
    const int positions = gltf.accessor("VEC3", band);
    json& primitive = gltf.show({{"attributes", {{"POSITION", positions}}}, {"mode", 5}});
    CHECK(only_mesh(gltf).triangles == Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}});
    primitive["mode"] = 6;
    CHECK(only_mesh(gltf).triangles == Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}, {4, 5, 0}});
    primitive["mode"] = 4;
    CHECK(only_mesh(gltf).triangles == Triangles{{0, 1, 2}, {3, 4, 5}});
}

TEST_CASE("glTF meshes, count the points and lines that they leave out") {
    const auto loss = [](int mode) {
        Gltf gltf;
        const int positions = gltf.accessor("VEC3", band);
        gltf.show({{"attributes", {{"POSITION", positions}}}, {"mode", mode}});
        const Imported imported = read(gltf);
        CHECK(imported.scene.meshes.empty());
        CHECK(imported.losses.at(0).place == "box.gltf#/meshes/0/primitives/0");
        return imported.losses.at(0).what;
    };
    CHECK(loss(0) == "6 points are ignored");
    CHECK(loss(1) == "3 lines are ignored");
    CHECK(loss(2) == "6 lines are ignored");
    CHECK(loss(3) == "5 lines are ignored");
}

TEST_CASE("glTF meshes, name what many primitives lose once") {
    Gltf gltf;
    const json attributes = {{"POSITION", gltf.accessor("VEC3", band)}};
    const json lines = {{"attributes", attributes}, {"mode", 1}},
               points = {{"attributes", attributes}, {"mode", 0}};
    gltf.show(points);
    gltf.show(lines);
    gltf.show({{"attributes", attributes}, {"mode", 3}});
    json colored = {{"attributes", attributes}};
    colored["attributes"]["COLOR_1"] = colored["attributes"]["COLOR_2"] = 0;
    gltf.root["meshes"][1]["primitives"].push_back(colored);
    gltf.root["meshes"][2]["primitives"].push_back(colored);
    CHECK(read(gltf).losses ==
          Losses{{Loss::dropped, "box.gltf#/meshes/0/primitives/0", "6 points are ignored"},
                 {Loss::dropped, "box.gltf#/meshes/1/primitives/0",
                  "8 lines are ignored (in 2 primitives)", 2},
                 {Loss::dropped, "box.gltf#/meshes/1/primitives/1",
                  "its COLOR_1 is ignored; only COLOR_0 has a meaning (in 2 primitives)", 2},
                 {Loss::dropped, "box.gltf#/meshes/1/primitives/1",
                  "its COLOR_2 is ignored; only COLOR_0 has a meaning (in 2 primitives)", 2}});
}

TEST_CASE("glTF meshes, read and normalise every component type") {
    const auto first = [](const std::vector<Vec2f>& texcoords) {
        REQUIRE(texcoords.size() == 3);
        return Vec2f(texcoords[0].x, 1 - texcoords[0].y);  // glTF's v runs down
    };
    CHECK(first(texcoords_from(std::vector<std::uint8_t>{51, 255, 0, 0, 0, 0})) == Vec2f(0.2F, 1));
    CHECK(first(texcoords_from(std::vector<std::uint16_t>{65535, 0, 0, 0, 0, 0})) == Vec2f(1, 0));
    // -128 / 127 is less than -1.
    CHECK(first(texcoords_from(std::vector<std::int8_t>{127, -128, 0, 0, 0, 0})) == Vec2f(1, -1));
    CHECK(first(texcoords_from(std::vector<std::int16_t>{-32767, 32767, 0, 0, 0, 0})) ==
          Vec2f(-1, 1));
    CHECK(first(texcoords_from(std::vector<float>{0.25F, -3, 0, 0, 0, 0})) == Vec2f(0.25F, -3));
}

TEST_CASE("glTF meshes, read quantised positions as they are") {
    Gltf gltf;
    gltf.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    const int positions =
        gltf.accessor("VEC3", std::vector<std::int16_t>{-5, 0, 0, 7, 0, 0, 0, 300, 0});
    gltf.show({{"attributes", {{"POSITION", positions}}}});
    CHECK(only_mesh(gltf).positions == std::vector<Vec3f>{{-5, 0, 0}, {7, 0, 0}, {0, 300, 0}});
}

TEST_CASE("glTF meshes, follow strides and offsets") {
    Gltf gltf;
    // Position and normal interleaved, after four bytes that belong to nobody.
    const int view =
        gltf.view(std::vector<float>{9, 0, 0, 0, 0, 0, 2, 1, 0, 0, 0, 0, 2, 0, 1, 0, 0, 0, 2},
                  {{"byteStride", 24}});
    json accessor = {{"bufferView", view},
                     {"byteOffset", 4},
                     {"componentType", 5126},
                     {"count", 3},
                     {"type", "VEC3"}};
    const int positions = gltf.add("accessors", accessor);
    accessor["byteOffset"] = 16;
    const int normals = gltf.add("accessors", accessor);
    gltf.show({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
    const Mesh mesh = only_mesh(gltf);
    CHECK(mesh.positions == std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(mesh.normals == std::vector<Vec3f>(3, Vec3f(0, 0, 1)));  // made unit
}

TEST_CASE("glTF meshes, read numbers that are not aligned and say so") {
    Gltf gltf = test::triangle();
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::vector<std::uint8_t> bytes(3 + sizeof(float) * positions.size());
    std::memcpy(bytes.data() + 3, positions.data(), sizeof(float) * positions.size());
    json& accessor = gltf.root["accessors"][0];
    accessor["bufferView"] = gltf.view(bytes);
    accessor["byteOffset"] = 3;
    const Imported imported = read(gltf);
    CHECK(imported.scene.meshes.at(0).positions ==
          std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(imported.losses == Losses{{Loss::approximated, "box.gltf#/accessors/0",
                                     "its numbers do not begin at multiples of their size; "
                                     "they are read from where they are said to be"}});
}

TEST_CASE("glTF meshes, apply sparse accessors") {
    Gltf gltf = test::triangle();
    const int indices = gltf.view(std::vector<std::uint16_t>{2, 0});
    const int values = gltf.view(std::vector<float>{0, 5, 0, -1, 0, 0});
    json& accessor = gltf.root["accessors"][0];
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                          {"values", {{"bufferView", values}}}};
    CHECK(only_mesh(gltf).positions == std::vector<Vec3f>{{-1, 0, 0}, {1, 0, 0}, {0, 5, 0}});

    accessor.erase("bufferView");  // zeros but for the sparse ones
    CHECK(only_mesh(gltf).positions == std::vector<Vec3f>{{-1, 0, 0}, {0, 0, 0}, {0, 5, 0}});

    accessor["sparse"]["indices"]["bufferView"] = gltf.view(std::vector<std::uint16_t>{2, 3});
    CHECK(test::problem(gltf) ==
          "box.gltf#/accessors/0/sparse: index 1 is 3, but there are 3 elements");
}

TEST_CASE("glTF meshes, take indices without a buffer view for zeros") {
    Gltf gltf = test::triangle();
    const int zeros =
        gltf.add("accessors", {{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}});
    gltf.root["meshes"][0]["primitives"][0]["indices"] = zeros;
    CHECK(only_mesh(gltf).triangles == Triangles{{0, 0, 0}});
}

TEST_CASE("glTF meshes, copy only the vertices that a primitive uses") {
    Gltf gltf;
    const int positions = gltf.accessor("VEC3", band);
    const int indices = gltf.accessor("SCALAR", std::vector<std::uint16_t>{5, 3, 4});
    gltf.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    const Mesh mesh = only_mesh(gltf);
    CHECK(mesh.positions == std::vector<Vec3f>{{1, 1, 0}, {2, 0, 0}, {2, 1, 0}});
    CHECK(mesh.triangles == Triangles{{2, 0, 1}});
}

TEST_CASE("glTF meshes, list the vertices of a primitive that uses few of many") {
    constexpr std::size_t count = 40;
    const auto numbers = [](int width) {
        std::vector<float> values(count * std::size_t(width));
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = float(1 + i * 7 % 23) / 32 + float(width);
        return values;
    };
    Gltf gltf;
    const json attributes = {{"POSITION", gltf.accessor("VEC3", numbers(3))},
                             {"NORMAL", gltf.accessor("VEC3", numbers(3))},
                             {"TEXCOORD_0", gltf.accessor("VEC2", numbers(2))},
                             {"COLOR_0", gltf.accessor("VEC3", numbers(3))}};
    gltf.root["accessors"][0]["sparse"] = {
        {"count", 3},
        {"indices",
         {{"bufferView", gltf.view(std::vector<std::uint8_t>{17, 18, 39})},
          {"componentType", 5121}}},
        {"values", {{"bufferView", gltf.view(std::vector<float>(9, 5))}}}};
    const json targets = {{{"POSITION", gltf.accessor("VEC3", numbers(3))}}};
    std::vector<std::uint8_t> all(count + 2, 39);
    std::iota(all.begin(), all.begin() + count, std::uint8_t(0));
    for (const auto& indices : {all, {39, 3, 17, 3, 39, 20}}) {
        gltf.show({{"attributes", attributes},
                   {"targets", targets},
                   {"indices", gltf.accessor("SCALAR", indices)}});
        gltf.root["meshes"].back()["weights"] = {0.5};
    }
    const std::vector<Mesh> meshes = read(gltf).scene.meshes;
    REQUIRE(meshes.size() == 2);
    CHECK(meshes[1].triangles == Triangles{{3, 0, 1}, {0, 3, 2}});
    const auto check_chosen = [&](const auto& whole, const auto& some) {
        REQUIRE(whole.size() == count);
        CHECK(some ==
              std::remove_cvref_t<decltype(some)>{whole[3], whole[17], whole[20], whole[39]});
    };
    check_chosen(meshes[0].positions, meshes[1].positions);
    check_chosen(meshes[0].normals, meshes[1].normals);
    check_chosen(meshes[0].texcoords, meshes[1].texcoords);
    check_chosen(meshes[0].colors, meshes[1].colors);
    CHECK(meshes[1].positions[1] != meshes[1].positions[0]);

    gltf.root["meshes"].erase(0);
    gltf.root["nodes"].erase(0);
    gltf.root["scenes"][0]["nodes"] = {0};
    gltf.root["nodes"][0]["mesh"] = 0;
    const float infinite = std::numeric_limits<float>::infinity();
    std::memcpy(gltf.bin.data() + 20 * 12, &infinite, sizeof infinite);
    CHECK(test::problem(gltf) == "box.gltf#/accessors/0: element 20 is not a finite number");
    std::memcpy(gltf.bin.data() + 20 * 12, gltf.bin.data(), sizeof infinite);
    std::memcpy(gltf.bin.data() + 21 * 12, &infinite, sizeof infinite);  // of no triangle
    CHECK_NOTHROW(read(gltf));
}

TEST_CASE("glTF meshes, read vertex colours in every form") {
    const auto colors = [](const std::string& type, auto values, bool normalized) {
        Gltf gltf = test::triangle();
        gltf.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
            gltf.accessor(type, values, {{"normalized", normalized}});
        return only_mesh(gltf).colors;
    };
    const std::vector<Color> expected = {{1, 0, 0.2F}, {0, 1, 0}, {0, 0, 1}};
    CHECK(colors("VEC3", std::vector<float>{1, 0, 0.2F, 0, 1, 0, 0, 0, 1}, false) == expected);
    CHECK(colors("VEC4", std::vector<float>{1, 0, 0.2F, 9, 0, 1, 0, 9, 0, 0, 1, 9}, false) ==
          expected);
    CHECK(colors("VEC3", std::vector<std::uint8_t>{255, 0, 51, 0, 255, 0, 0, 0, 255}, true) ==
          expected);
    CHECK(colors("VEC4",
                 std::vector<std::uint16_t>{65535, 0, 13107, 0, 0, 65535, 0, 0, 0, 0, 65535, 0},
                 true) == expected);
}

TEST_CASE("glTF meshes, mend normals of length zero") {
    Gltf gltf = test::triangle();
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        gltf.accessor("VEC3", std::vector<float>{0, 0, 0, 3, 0, 0, 0, 0, 0});
    const Imported imported = read(gltf);
    CHECK(imported.scene.meshes.at(0).normals ==
          std::vector<Vec3f>{{0, 0, 1}, {1, 0, 0}, {0, 0, 1}});
    CHECK(imported.losses ==
          Losses{{Loss::approximated, "box.gltf#/meshes/0/primitives/0/attributes/NORMAL",
                  "2 of 3 normals have no length; those of the facets are used"}});
}

TEST_CASE("glTF meshes, name what makes no triangle") {
    Gltf gltf;
    const int positions = gltf.accessor("VEC3", band);
    const int indices = gltf.accessor("SCALAR", std::vector<std::uint16_t>{0, 1, 2, 3, 4});
    gltf.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    const Imported imported = read(gltf);
    CHECK(facet_count(imported.scene) == 1);
    CHECK(imported.losses == Losses{{Loss::dropped, "box.gltf#/meshes/0/primitives/0",
                                     "2 indices at the end make no triangle"}});
}
