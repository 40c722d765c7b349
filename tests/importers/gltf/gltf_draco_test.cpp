// Primitives that glTF files hold compressed by Draco.
#include "importers/gltf/gltf_builder.h"

#include <cmath>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::read;

namespace {

// A band of six quads as libdraco 1.5.5 encodes it: positions (i, 0, 0) and (i, 1, 0), 12 bits each
// where they are quantised (edge breaker); texture coordinates (i / 64, y); colours of bytes, red
// being the vertex's number and green 51. In base64.
const std::string sequential =
    "RFJBQ08CAgEAAAAMDgEAAQICAQMCAwQEAwUEBQYGBQcGBwgIBwkICQoKCQsKCwwMCw0BAwAJAwAHAwkCAAgCAgQB"
    "CQAAAQAAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAgD8AAAAAAAAAAAAAgD8AAIA/AAAAAAAAAEAAAAAAAAAAAAAA"
    "AEAAAIA/AAAAAAAAQEAAAAAAAAAAAAAAQEAAAIA/AAAAAAAAgEAAAAAAAAAAAAAAgEAAAIA/AAAAAAAAoEAAAAAA"
    "AAAAAAAAoEAAAIA/AAAAAAAAwEAAAAAAAAAAAAAAwEAAAIA/AAAAAAAAAAAAAAAAAAAAAAAAgD8AAIA8AAAAAAAA"
    "gDwAAIA/AAAAPQAAAAAAAAA9AACAPwAAQD0AAAAAAABAPQAAgD8AAIA9AAAAAAAAgD0AAIA/AACgPQAAAAAAAKA9"
    "AACAPwAAwD0AAAAAAADAPQAAgD8AAQEBAmfdLiUB3Q7/iyUBClIDI57QgO7DaoAAAAAA/wAAAA==";
const std::string edge_breaker =
    "RFJBQ08CAgEBAAAADgwCDAAABV/XdV0H/wER/wK7QP8Cu0AD/wAAAAAAAQAAAQAJAwAHAgEDCQIACAABAgIEAQkB"
    "AQEBAAwDuS0lCR8lCQT0J/dBmapVAUBVAAAAgYBAQAAAAAAA/w8AAAAAAAAAAAAAAAAAAAAAwEAMAADAPQAAAAAA"
    "AKA9AACAPwAAwD0AAIA/AACgPQAAAAAAAIA9AACAPwAAgD0AAAAAAABAPQAAgD8AAEA9AAAAAAAAAD0AAIA/AAAA"
    "PQAAAAAAAIA8AACAPwAAgDwAAAAAAAAAAAAAgD8AAAAAAAAAAAEBAQECZ006SQIHJQFLJQH/MyUBB8Tx9L6vr4AA"
    "AAAA/wAAAA==";

constexpr std::size_t vertices = 14, facets = 12;

std::string from_base64(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < text.size() && text[i] != '='; ++i) {
        bits = bits << 6 | std::uint32_t(digits.find(text[i]));
        if (i % 4 != 0) bytes += char(bits >> (6 - 2 * (i % 4)) & 0xff);
    }
    return bytes;
}

struct Draco {
    Gltf gltf;

    explicit Draco(const std::string& data) {
        const int view = gltf.view(std::vector<char>(data.begin(), data.end()));
        const auto accessor = [&](int type, const char* kind, std::size_t count) {
            return gltf.add("accessors", {{"componentType", type},
                                          {"count", count},
                                          {"type", kind},
                                          {"normalized", type == 5121}});
        };
        gltf.show({{"attributes",
                    {{"POSITION", accessor(5126, "VEC3", vertices)},
                     {"TEXCOORD_0", accessor(5126, "VEC2", vertices)},
                     {"COLOR_0", accessor(5121, "VEC4", vertices)}}},
                   {"indices", accessor(5123, "SCALAR", 3 * facets)},
                   {"extensions",
                    {{"KHR_draco_mesh_compression",
                      {{"bufferView", view},
                       {"attributes", {{"POSITION", 7}, {"TEXCOORD_0", 8}, {"COLOR_0", 9}}}}}}}});
        gltf.root["extensionsUsed"] = {"KHR_draco_mesh_compression"};
        gltf.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    }
    json& primitive() { return gltf.root["meshes"][0]["primitives"][0]; }
    json& extension() { return primitive()["extensions"]["KHR_draco_mesh_compression"]; }
};

const std::string draco_place =
    "box.gltf#/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";

}  // namespace

TEST_CASE("glTF Draco, decompresses every attribute") {
    for (const std::string& text : {sequential, edge_breaker}) {
        const Imported imported = read(Draco(from_base64(text)).gltf);
        CHECK(imported.losses.empty());
        const Mesh& mesh = imported.scene.meshes.at(0);
        REQUIRE(mesh.positions.size() == vertices);
        CHECK(mesh.triangles.size() == facets);
        double area = 0;
        for (const auto& t : mesh.triangles) {
            const Vec3f a = mesh.positions[t[0]];
            area += (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).length() / 2;
        }
        CHECK(area == Approx(6).epsilon(1e-3));
        // The vertices may have another order, so that each is judged by itself.
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const float column = std::round(mesh.positions[i].x), y = mesh.positions[i].y;
            CHECK(mesh.positions[i].x == Approx(column).margin(1e-3));
            CHECK(mesh.texcoords.at(i) == Vec2f(column / 64, 1 - std::round(y)));
            CHECK(mesh.colors.at(i).x == Approx((2 * column + y) / 255).margin(1e-5));
            CHECK(mesh.colors.at(i).y == Approx(0.2));
        }
    }
}

TEST_CASE("glTF Draco, trusts the data more than the accessors") {
    Draco made(from_base64(edge_breaker));
    made.gltf.root["accessors"][3]["count"] = 3;
    const Imported imported = read(made.gltf);
    CHECK(imported.scene.meshes.at(0).triangles.size() == facets);
    CHECK(imported.losses ==
          Losses{{Loss::approximated, "box.gltf#/meshes/0/primitives/0",
                  "its compressed data have 36 indices, its accessor says 3; the data are used"}});
}

TEST_CASE("glTF Draco, morphs what it has decompressed") {
    Draco made(from_base64(sequential));
    std::vector<float> deltas;
    for (std::size_t i = 0; i < vertices; ++i) deltas.insert(deltas.end(), {0, 0, 5});
    made.primitive()["targets"] = {{{"POSITION", made.gltf.accessor("VEC3", deltas)}}};
    made.gltf.root["nodes"][0]["weights"] = {0.5};
    CHECK(read(made.gltf).scene.meshes.at(0).positions.at(0).z == 2.5F);
}

TEST_CASE("glTF Draco, refuses what cannot be") {
    {
        Draco made(from_base64(edge_breaker));
        made.extension()["attributes"]["POSITION"] = 3;
        CHECK(test::problem(made.gltf) ==
              draco_place + ": cannot be decompressed: there is no attribute 3");
        made.extension()["attributes"]["POSITION"] = 8;
        CHECK(test::problem(made.gltf) ==
              draco_place +
                  ": cannot be decompressed: attribute 8 has 2 numbers a vertex instead of 3");
        made.extension()["bufferView"] = 9;
        CHECK(test::problem(made.gltf) ==
              draco_place + "/bufferView: is 9, but the file has 1 bufferViews");
    }
    {
        Draco made(from_base64(edge_breaker));
        made.primitive()["mode"] = 0;
        CHECK(test::problem(made.gltf) ==
              draco_place + ": is for triangles and strips of them, not for mode 0");
    }
    {
        using namespace std::string_literals;
        Draco made("DRACO\2\2\1\0\0\0\xff\xff\xff\x7f\1\1"s);
        CHECK(test::problem(made.gltf) ==
              draco_place + ": cannot be decompressed: it claims 268435455 facets in 17 bytes");
    }
    Draco made("not draco...");
    CHECK(test::problem(made.gltf) == draco_place + ": cannot be decompressed: Not a Draco file");
}

TEST_CASE("glTF Draco, survives any data") {
    for (const std::string& text : {sequential, edge_breaker}) {
        const std::string data = from_base64(text);
        for (std::size_t i = 0; i < data.size(); ++i) {
            std::string spoilt = data;
            spoilt[i] = char(spoilt[i] ^ 0x5a);
            try {
                read(Draco(spoilt).gltf);
            } catch (const Error& error) {
                CHECK(error.failure == Failure::input);
            }
        }
    }
}
