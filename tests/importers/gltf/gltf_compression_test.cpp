// Buffer views that glTF files hold compressed by meshopt.
#include "importers/gltf/gltf_builder.h"

#include <meshoptimizer.h>

#include <cmath>

using namespace penumbra;
using test::Gltf;
using test::json;

namespace {

using Byte = unsigned char;

// A band of 40 quads: positions (i, 0, 0) and (i, 1, 0).
constexpr unsigned columns = 41;

std::vector<float> band_positions() {
    std::vector<float> positions;
    for (unsigned i = 0; i < columns; ++i)
        for (const float y : {0.0F, 1.0F}) positions.insert(positions.end(), {float(i), y, 0});
    return positions;
}

std::vector<unsigned> band_indices() {
    std::vector<unsigned> indices;
    for (unsigned i = 0; i + 1 < columns; ++i)
        indices.insert(indices.end(),
                       {2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 2, 2 * i + 1, 2 * i + 3});
    return indices;
}

std::vector<Byte> encoded_vertices(const void* data, std::size_t count, std::size_t stride) {
    std::vector<Byte> bytes(meshopt_encodeVertexBufferBound(count, stride));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), data, count, stride));
    return bytes;
}

std::vector<Byte> encoded_triangles(const std::vector<unsigned>& indices) {
    std::vector<Byte> bytes(meshopt_encodeIndexBufferBound(indices.size(), 2 * columns));
    bytes.resize(
        meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return bytes;
}

std::vector<Byte> encoded_sequence(const std::vector<unsigned>& indices) {
    std::vector<Byte> bytes(meshopt_encodeIndexSequenceBound(indices.size(), 2 * columns));
    bytes.resize(
        meshopt_encodeIndexSequence(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return bytes;
}

struct Meshopt {
    Gltf gltf;
    std::string name = "EXT_meshopt_compression";

    // A view of a buffer 1 without content, with what it holds compressed in buffer 0.
    int view(const std::vector<Byte>& data, std::size_t count, std::size_t stride,
             const std::string& mode, const std::string& filter = "NONE") {
        const int plain = gltf.view(data);
        const json& source = gltf.root["bufferViews"][std::size_t(plain)];
        json extension = {{"buffer", 0},
                          {"byteOffset", source["byteOffset"]},
                          {"byteLength", source["byteLength"]},
                          {"count", count},
                          {"byteStride", stride},
                          {"mode", mode},
                          {"filter", filter}};
        return gltf.add(
            "bufferViews",
            {{"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{name, extension}}}});
    }
    int accessor(int view, int type, std::size_t count, const std::string& kind,
                 bool normalized = false) {
        return gltf.add("accessors", {{"bufferView", view},
                                      {"componentType", type},
                                      {"count", count},
                                      {"type", kind},
                                      {"normalized", normalized}});
    }
    json& extension(std::size_t view) { return gltf.root["bufferViews"][view]["extensions"][name]; }
    std::string text() {
        gltf.root["extensionsUsed"] = {name, "KHR_mesh_quantization"};
        gltf.root["extensionsRequired"] = {name, "KHR_mesh_quantization"};
        gltf.root["buffers"] = {
            {{"byteLength", gltf.bin.size()},
             {"uri", "data:application/octet-stream;base64," + test::base64(gltf.bin)}},
            {{"byteLength", 100000},
             {"uri", "missing.bin"},
             {"extensions", {{name, {{"fallback", true}}}}}}};
        return gltf.root.dump();
    }
};

// The band, its vertices interleaved with normals.
Meshopt meshopt_band(const std::vector<Byte>& indices, const std::string& mode) {
    Meshopt made;
    const auto positions = band_positions();
    const std::size_t vertices = positions.size() / 3, count = band_indices().size();
    const int view =
        made.view(encoded_vertices(positions.data(), vertices, 12), vertices, 12, "ATTRIBUTES");
    const int index_view = made.view(indices, count, 2, mode);
    made.gltf.show({{"attributes", {{"POSITION", made.accessor(view, 5126, vertices, "VEC3")}}},
                    {"indices", made.accessor(index_view, 5123, count, "SCALAR")}});
    return made;
}

Mesh only_mesh(const std::string& text) {
    const Imported imported = test::read_content(text);
    CHECK(imported.losses.empty());
    REQUIRE(imported.scene.meshes.size() == 1);
    return imported.scene.meshes[0];
}

void check_band(const Mesh& mesh) {
    const auto positions = band_positions();
    REQUIRE(mesh.positions.size() == positions.size() / 3);
    bool same = true;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        same = same && mesh.positions[i] ==
                           Vec3f(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    CHECK(same);
    CHECK(mesh.triangles.size() == band_indices().size() / 3);
    double area = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3f a = mesh.positions[t[0]];
        area += (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).length() / 2;
    }
    CHECK(area == Approx(columns - 1));
}

// What the one view of `stride` bytes decodes to, as numbers of accessor type `type`.
std::vector<Vec3f> filtered(const std::vector<Byte>& data, std::size_t count, std::size_t stride,
                            const std::string& filter, int type,
                            const std::string& name = "EXT_meshopt_compression") {
    Meshopt made;
    made.name = name;
    const int view = made.view(data, count, stride, "ATTRIBUTES", filter);
    const bool floats = type == 5126;
    json attributes = {{"POSITION", made.gltf.accessor("VEC3", test::corner)}};
    const char* what = filter == "COLOR" ? "COLOR_0" : floats ? "POSITION" : "NORMAL";
    // VEC3 of four numbers: the last one is not looked at.
    made.gltf.root["bufferViews"][std::size_t(view)]["byteStride"] = stride;
    attributes[what] = made.accessor(view, type, count, "VEC3", !floats);
    made.gltf.show({{"attributes", attributes}});
    const Mesh mesh = only_mesh(made.text());
    return filter == "COLOR" ? mesh.colors : floats ? mesh.positions : mesh.normals;
}

void check_near(const Vec3f& a, const Vec3f& b, float tolerance) {
    INFO(a << " is not " << b);
    CHECK((a - b).length() <= tolerance);
}

}  // namespace

TEST_CASE("glTF meshopt, decompresses attributes and triangles without their fallback") {
    check_band(only_mesh(meshopt_band(encoded_triangles(band_indices()), "TRIANGLES").text()));
}

TEST_CASE("glTF meshopt, decompresses indices in their order") {
    const Mesh mesh = only_mesh(meshopt_band(encoded_sequence(band_indices()), "INDICES").text());
    check_band(mesh);
    std::vector<unsigned> indices;
    for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
    CHECK(indices == band_indices());
}

TEST_CASE("glTF meshopt, undoes the filters") {
    const std::vector<float> normals = {0, 0, 1, 0, 0.6F, 0, 0.8F, 0, -0.36F, 0.48F, -0.8F, 0};
    std::vector<Byte> packed(3 * 8);
    meshopt_encodeFilterOct(packed.data(), 3, 8, 12, normals.data());
    const auto turned = filtered(encoded_vertices(packed.data(), 3, 8), 3, 8, "OCTAHEDRAL", 5122);
    REQUIRE(turned.size() == 3);
    for (std::size_t i = 0; i < 3; ++i)
        check_near(turned[i], Vec3f(normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]), 1e-3F);

    // Numbers as m 2^e: e in the upper 8 bits, m in the lower 24.
    const auto number = [](int e, int m) { return e * (1 << 24) + (m & 0xffffff); };
    const std::vector<std::int32_t> points = {number(-1, 3),  number(1, -1),     number(-2, 1),
                                              number(3, 125), number(-20, 1049), 0,
                                              number(0, 7),   number(3, 1),      number(0, -9)};
    const auto moved = filtered(encoded_vertices(points.data(), 3, 12), 3, 12, "EXPONENTIAL", 5126);
    CHECK(moved == std::vector<Vec3f>{{1.5F, -2, 0.25F}, {1000, 1049 / 1048576.0F, 0}, {7, 8, -9}});
}

TEST_CASE("glTF meshopt, undoes the filter of quaternions") {
    Meshopt made;
    const float s = std::sin(0.4F), c = std::cos(0.4F);
    const std::vector<float> turns = {0, 0, s, c, 0, 0, s, -c};
    std::vector<Byte> packed(16);
    meshopt_encodeFilterQuat(packed.data(), 2, 8, 16, turns.data());
    const int view =
        made.view(encoded_vertices(packed.data(), 2, 8), 2, 8, "ATTRIBUTES", "QUATERNION");
    const int rotations = made.accessor(view, 5122, 2, "VEC4", true);
    made.gltf.show({{"attributes", {{"POSITION", made.gltf.accessor("VEC3", test::corner)}}}});
    made.gltf.root["nodes"][0]["extensions"] = {
        {"EXT_mesh_gpu_instancing", {{"attributes", {{"ROTATION", rotations}}}}}};
    const Scene scene = test::read_content(made.text()).scene;
    REQUIRE(scene.instances.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
        const double sign = i == 0 ? 1 : -1;
        const Vec3 x = Vec3(1, 0, 0) * scene.instances[i].transform;
        check_near(Vec3f(x), Vec3f(Vec3(std::cos(0.8), sign * std::sin(0.8), 0)), 1e-3F);
    }
}

TEST_CASE("glTF meshopt, undoes the filter of colours") {
    // Y, Co, Cg with K = 8 bits, and alpha with 7 below a bit: opaque red, green and grey.
    // R = Y + Co - Cg, G = Y + Cg, B = Y - Co - Cg.
    const std::vector<std::int8_t> colors = {64, 127, -64, -1, 127, 0, 127, -1, 102, 0, 0, -1};
    const auto read_back = filtered(encoded_vertices(colors.data(), 3, 4), 3, 4, "COLOR", 5121,
                                    "KHR_meshopt_compression");
    REQUIRE(read_back.size() == 3);
    check_near(read_back[0], {1, 0, 1 / 255.0F}, 1e-6F);
    check_near(read_back[1], {0, 254 / 255.0F, 0}, 1e-6F);
    check_near(read_back[2], {0.4F, 0.4F, 0.4F}, 1e-6F);
}

TEST_CASE("glTF meshopt, decodes version 1 of the attribute codec") {
    // Sixteen elements of four bytes. Byte 0 is the example of KHR_meshopt_compression's appendix
    // A: 4-bit deltas with two that are too large for it. Byte 1 does not change, byte 2 is
    // literal, byte 3 has 1-bit deltas: one in the middle.
    const std::vector<Byte> example = {0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5};
    const std::vector<int> deltas = {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};
    std::vector<Byte> stream = {0xa1, 1 | 2 << 2 | 3 << 4 | 0 << 6, /*4 bits*/ 2};
    stream.insert(stream.end(), example.begin(), example.end());
    for (int i = 0; i < 16; ++i) stream.push_back(Byte(i % 2 == 0 ? 2 : 1));  // +1, -1
    stream.insert(stream.end(), {/*1 bit*/ 1, 0, 1, /*the eighth delta*/ 2});
    stream.resize(stream.size() + 24 - 5);
    stream.insert(stream.end(), {100, 7, 50, 9, /*channel of bytes*/ 0});

    Meshopt made;
    made.name = "KHR_meshopt_compression";
    const int view = made.view(stream, 16, 4, "ATTRIBUTES");
    made.gltf.root["bufferViews"][std::size_t(view)]["byteStride"] = 4;
    made.gltf.show({{"attributes", {{"POSITION", made.accessor(view, 5121, 15, "VEC3")}}}});
    Mesh mesh = only_mesh(made.text());
    REQUIRE(mesh.positions.size() == 15);
    int first = 100;
    for (std::size_t i = 0; i < 15; ++i) {
        first = (first + deltas[i]) & 255;
        CHECK(mesh.positions.at(i) == Vec3f(float(first), 7, i % 2 == 0 ? 51 : 50));
    }
    made.gltf.root["accessors"][0]["byteOffset"] = 1;
    mesh = only_mesh(made.text());
    CHECK(mesh.positions.at(7) == Vec3f(7, 50, 9));
    CHECK(mesh.positions.at(8) == Vec3f(7, 51, 10));
    CHECK(mesh.positions.at(14) == Vec3f(7, 51, 10));

    CHECK(test::read_content(made.text()).losses.empty());
    json& extensions = made.gltf.root["bufferViews"][std::size_t(view)]["extensions"];
    extensions = {{"EXT_meshopt_compression", extensions["KHR_meshopt_compression"]}};
    made.name = "EXT_meshopt_compression";
    CHECK(test::read_content(made.text()).losses ==
          Losses{{Loss::approximated, "box.gltf#/bufferViews/1/extensions/EXT_meshopt_compression",
                  "its data have version 1 of the attribute codec, which only "
                  "KHR_meshopt_compression allows; they are read as if it were that"}});
}

TEST_CASE("glTF meshopt, decodes numbers of two and four bytes of version 1") {
    // Three elements of eight bytes, all literal: two numbers of two bytes, of which the difference
    // is kept (zigzag), and one of four, of which the exclusive or is kept, rotated left by 3.
    const std::vector<Byte> stream = {0xa1, 0xff, 3 | 2 << 2 | 3 << 4 | 2 << 6,
                                      0x44, 0x01, 0,
                                      0x02, 0,    0,  // 290, -1, 0
                                      0x39, 0x32, 0,
                                      0x04, 0x04, 0,  // -541, 537, 0
                                      8,    0,    0,  // bit 0
                                      0,    4,    0,  // bit 15
                                      0,    0,    0,
                                      0,    0,    0,
                                      0,    0,    0,
                                      0,    0,    0,
                                      0,    0,    10,
                                      0,    5,    0,
                                      0x44, 0,    0,
                                      0,    1,    2 | 3 << 4};
    Meshopt made;
    made.name = "KHR_meshopt_compression";
    const int view = made.view(stream, 3, 8, "ATTRIBUTES");
    made.gltf.root["bufferViews"][std::size_t(view)]["byteStride"] = 8;
    made.gltf.show({{"attributes", {{"POSITION", made.accessor(view, 5123, 3, "VEC3")}}}});
    CHECK(only_mesh(made.text()).positions ==
          std::vector<Vec3f>{{300, 65000, 0x45}, {299, 1, 0x8045}, {299, 1, 0x8045}});
    made.extension(std::size_t(view))["count"] = 2;
    made.gltf.root["bufferViews"][std::size_t(view)]["byteLength"] = 16;
    made.gltf.root["accessors"][0]["count"] = 2;
    CHECK(test::problem(made.text()) ==
          "box.gltf#/bufferViews/1/extensions/KHR_meshopt_compression: its 45 bytes are no valid "
          "ATTRIBUTES data");
}

TEST_CASE("glTF meshopt, refuses what cannot be") {
    const std::string place = "box.gltf#/bufferViews/1/extensions/EXT_meshopt_compression";
    const auto broken = [](const json& members) {
        Meshopt made = meshopt_band(encoded_triangles(band_indices()), "TRIANGLES");
        made.extension(1).update(members);
        return test::problem(made.text());
    };
    CHECK(broken(json::object()) == "");
    CHECK(broken({{"byteStride", 6}}) ==
          place + ": has the byteStride 6, but ATTRIBUTES needs a multiple of 4 up to 256");
    CHECK(broken({{"filter", "QUATERNION"}}) ==
          place + ": has the byteStride 12, but QUATERNION needs 8");
    CHECK(broken({{"mode", "TRIANGLES"}}) ==
          place + ": has the byteStride 12, but TRIANGLES needs 2 or 4");
    CHECK(broken({{"mode", "TRIANGLES"}, {"byteStride", 4}, {"count", 82}}) ==
          place + ": has 82 indices, which are no whole triangles");
    CHECK(broken({{"mode", "INDICES"}, {"byteStride", 4}, {"filter", "EXPONENTIAL"}}) ==
          place + ": has the filter EXPONENTIAL in mode INDICES");
    CHECK(broken({{"mode", "INDICES"}, {"byteStride", 4}, {"count", 246}})
              .find("are no valid INDICES data") != std::string::npos);
    CHECK(broken({{"mode", "VERTICES"}}) ==
          place + "/mode: is 'VERTICES', which is none of ATTRIBUTES TRIANGLES INDICES");
    CHECK(broken({{"count", 4e12}}).find("has 4000000000000 elements of 12 bytes in ") !=
          std::string::npos);
    CHECK(broken({{"count", 81}}) ==
          place + ": has 972 bytes, fewer than the byteLength 984 of its buffer view");
    CHECK(broken({{"byteLength", 1e15}}).find("ends at byte 1000000000000000 of buffer 0") !=
          std::string::npos);
    CHECK(broken({{"buffer", 1}}) == place + ": buffer 1 has no content");
}

TEST_CASE("glTF meshopt, survives any data") {
    const Meshopt made = meshopt_band(encoded_triangles(band_indices()), "TRIANGLES");
    for (std::size_t i = 0; i < made.gltf.bin.size(); i += 3) {
        Meshopt spoilt = made;
        spoilt.gltf.bin[i] = char(spoilt.gltf.bin[i] ^ 0x5a);
        try {
            test::read_content(spoilt.text());
        } catch (const Error& error) {
            CHECK(error.failure == Failure::input);
        }
    }
}
