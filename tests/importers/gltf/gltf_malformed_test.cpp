// Broken and hostile glTF files: the exact message of each.
#include "importers/gltf/gltf_builder.h"

#include <limits>

using namespace penumbra;
using test::Gltf;
namespace fs = std::filesystem;
using test::json;
using test::problem;
using test::triangle;

namespace {

// The message for a triangle in which the value at `pointer` is replaced.
std::string with(const std::string& pointer, const json& value) {
    Gltf gltf = triangle();
    gltf.root[json::json_pointer(pointer)] = value;
    return problem(gltf);
}

std::string without(const std::string& parent, const std::string& key) {
    Gltf gltf = triangle();
    gltf.root[json::json_pointer(parent)].erase(key);
    return problem(gltf);
}

std::string with_buffer(const json& buffer) {
    Gltf gltf = triangle();
    gltf.root["buffers"] = json::array({buffer});
    return problem(gltf);
}

}  // namespace

TEST_CASE("Malformed glTF, is missing, empty or no glTF") {
    CHECK(test::message_of([] { read_gltf("nowhere/box.gltf"); }) ==
          "nowhere/box.gltf: no such file");
    CHECK(problem("") == "box.gltf: the file is empty");
    CHECK(problem("{\n  \"asset\": {]\n}") == "box.gltf:2:13: the JSON cannot be parsed here");
    CHECK(problem("[]") == "box.gltf: the JSON is not an object");
    CHECK(problem("{\"asset\": {\"version\": \"2.0\"}, \"scene\": 1e999}") ==
          "box.gltf:1:44: the number that ends here is out of range");
    CHECK(problem("{}") == "box.gltf: there is no asset.version: is this a glTF 2.0 file?");
}

TEST_CASE("Malformed glTF, is cut short") {
    const std::string glb = triangle().glb();
    const auto cut = [&](std::size_t size) { return problem(glb.substr(0, size), "box.glb"); };
    CHECK(cut(8) ==
          "box.glb: the file ends before the end of the GLB header (needs 12 bytes, has 8)");
    CHECK(cut(100) == "box.glb: the file ends before the length that its header gives (needs " +
                          std::to_string(glb.size()) + " bytes, has 100)");
    std::string wrong = glb;
    wrong[15] = char(0x7f);  // the JSON chunk claims 2 GB
    CHECK_THAT(
        problem(wrong, "box.glb"),
        Catch::Matchers::StartsWith("box.glb: the file ends before the end of its JSON chunk"));
    wrong = glb;
    wrong[4] = 1;
    CHECK(problem(wrong, "box.glb") ==
          "box.glb: GLB container version 1 is not supported, only version 2 is");
    wrong = glb;
    wrong[16] = 'X';
    CHECK(problem(wrong, "box.glb") == "box.glb: the first GLB chunk is not JSON");
}

TEST_CASE("Malformed glTF, ignores bytes after the model and says so") {
    CHECK(test::read_content(triangle().glb() + "tail", "box.glb").losses ==
          Losses{{Loss::dropped, "box.glb", "4 bytes after the model are ignored"}});
}

TEST_CASE("Malformed glTF, is of another version or needs an unknown extension") {
    CHECK(with("/asset/version", "1.0") ==
          "box.gltf#/asset/version: is \"1.0\", only glTF 2 is supported");
    CHECK(with("/asset/minVersion", "2.1") ==
          "box.gltf#/asset/minVersion: is \"2.1\", only 2.0 is supported");
    CHECK(with("/asset/version", "2.1").empty());
    CHECK(with("/extensionsRequired", {"KHR_lights_punctual", "ACME_gizmo"}) ==
          "box.gltf#/extensionsRequired: the model needs the extension ACME_gizmo, which is not "
          "supported");
}

TEST_CASE("Malformed glTF, refers to what is not there") {
    CHECK(with("/scene", 3) == "box.gltf#/scene: is 3, but the file has 1 scenes");
    CHECK(with("/nodes/0/mesh", -1) == "box.gltf#/nodes/0/mesh: is -1, but the file has 1 meshes");
    CHECK(with("/nodes/0/mesh", 0.5) == "box.gltf#/nodes/0/mesh: must be a whole number");
    CHECK(with("/nodes/0/mesh", 0.0).empty());
    CHECK(with("/nodes/0/camera", 0) ==
          "box.gltf#/nodes/0/camera: is 0, but the file has 0 cameras");
    CHECK(with("/nodes/0/children", {0, 9}) ==
          "box.gltf#/nodes/0/children/1: is 9, but the file has 1 nodes");
    CHECK(with("/meshes/0/primitives/0/attributes/POSITION", 4294967295U) ==
          "box.gltf#/meshes/0/primitives/0/attributes/POSITION: is 4294967295, but the file has 1 "
          "accessors");
    CHECK(with("/accessors/0/bufferView", 7) ==
          "box.gltf#/accessors/0/bufferView: is 7, but the file has 1 bufferViews");
    CHECK(with("/materials", {{{"normalTexture", {{"index", 2}}}}}) ==
          "box.gltf#/materials/0/normalTexture/index: is 2, but the file has 0 textures");
}

TEST_CASE("Malformed glTF, has values of the wrong kind") {
    CHECK(with("/meshes", nullptr) == "box.gltf#/meshes: must be an array");
    CHECK(with("/nodes/0", json::array()) == "box.gltf#/nodes/0: must be an object");
    CHECK(with("/nodes/0/name", 5) == "box.gltf#/nodes/0/name: must be a string");
    CHECK(with("/nodes/0/matrix", {1, 2, 3}) ==
          "box.gltf#/nodes/0/matrix: has 3 numbers instead of 16");
    CHECK(with("/nodes/0/scale", {1, "2", 3}) == "box.gltf#/nodes/0/scale/1: must be a number");
    CHECK(with("/nodes/0/scale", {1, 1e39, 3}) ==
          "box.gltf#/nodes/0/scale/1: is 1e+39, more than 3.40282e+38");
    CHECK(with("/meshes/0/primitives/0/mode", 9) ==
          "box.gltf#/meshes/0/primitives/0/mode: is 9, more than 6");
    CHECK(with("/accessors/0/type", "VEC5\n") ==
          "box.gltf#/accessors/0/type: is 'VEC5?', which is none of SCALAR VEC2 VEC3 VEC4 MAT2 "
          "MAT3 MAT4");
    CHECK(with("/accessors/0/componentType", 5124) ==
          "box.gltf#/accessors/0/componentType: is 5124, which glTF does not have");
    CHECK(without("/accessors/0", "count") == "box.gltf#/accessors/0: has no 'count'");
    CHECK(with("/cameras",
               {{{"type", "perspective"}, {"perspective", {{"yfov", 0}, {"znear", 1}}}}}) ==
          "box.gltf#/cameras/0/perspective/yfov: is 0, less than 1e-05");
}

TEST_CASE("Malformed glTF, has cameras that see nothing") {
    Gltf gltf = triangle();
    gltf.root["nodes"][0]["camera"] = 0;
    gltf.add("cameras", {{"type", "perspective"}});
    CHECK(problem(gltf) == "box.gltf#/cameras/0: has no 'perspective'");
    gltf.root["cameras"][0] = {
        {"type", "orthographic"},
        {"orthographic", {{"xmag", 1}, {"ymag", 0}, {"znear", 0}, {"zfar", 9}}}};
    CHECK(problem(gltf) == "box.gltf#/cameras/0/orthographic/ymag: must not be 0");
}

TEST_CASE("Malformed glTF, has accessors that leave their buffers") {
    CHECK(with("/accessors/0/count", 4) ==
          "box.gltf#/accessors/0: ends at byte 48 of buffer view 0, which has 36");
    CHECK(with("/accessors/0/count", 9007199254740992U) ==
          "box.gltf#/accessors/0: ends at byte 108086391056891904 of buffer view 0, which has 36");
    CHECK(with("/accessors/0/byteOffset", 4) ==
          "box.gltf#/accessors/0: ends at byte 40 of buffer view 0, which has 36");
    CHECK(with("/bufferViews/0/byteStride", 4) ==
          "box.gltf#/accessors/0: has elements of 12 bytes, more than the byteStride 4 of buffer "
          "view 0");
    CHECK(with("/bufferViews/0/byteLength", 40) ==
          "box.gltf#/bufferViews/0: ends at byte 40 of buffer 0, which has 36");
    Gltf gltf = triangle();
    gltf.root["accessors"][0].erase("bufferView");
    gltf.root["accessors"][0]["count"] = 4294967295U;
    CHECK(problem(gltf) == "box.gltf#/accessors/0: has 4294967295 elements and no buffer view");
}

TEST_CASE("Malformed glTF, has attributes and indices that do not fit") {
    Gltf gltf = triangle();
    json& primitive = gltf.root["meshes"][0]["primitives"][0];
    const int indices = gltf.accessor("SCALAR", std::vector<std::uint16_t>{0, 1, 65535});
    primitive["indices"] = indices;
    const std::string at = "box.gltf#/meshes/0/primitives/0";
    CHECK(problem(gltf) == at + "/indices: index 65535 is used, but there are 3 vertices");
    primitive["indices"] = 0;
    CHECK(problem(gltf) == at + "/indices: accessor 0 must hold single unsigned integers");
    primitive.erase("indices");
    primitive["attributes"]["NORMAL"] = gltf.accessor("VEC3", std::vector<float>{0, 0, 1});
    CHECK(problem(gltf) == at + "/attributes/NORMAL: has 1 elements, but POSITION has 3");
    primitive["attributes"] = {{"POSITION", indices}};
    CHECK(problem(gltf) ==
          at + "/attributes/POSITION: accessor 1 has the wrong type, a VEC3 is needed");
    primitive["attributes"]["POSITION"] =
        gltf.accessor("VEC3", std::vector<std::uint8_t>{0, 0, 0, 1, 0, 0, 0, 1, 0});
    CHECK(problem(gltf) == at + "/attributes/POSITION: accessor 3 has the componentType 5121, "
                                "which is not allowed here");
}

TEST_CASE("Malformed glTF, has positions that are no numbers") {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Gltf gltf;
        gltf.show({{"attributes",
                    {{"POSITION",
                      gltf.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, bad, 0, 1, 0})}}}});
        CHECK(problem(gltf) == "box.gltf#/accessors/0: element 1 is not a finite number");
    }
}

TEST_CASE("Malformed glTF, has nodes that form no tree") {
    CHECK(with("/nodes/0/children", {0}) == "box.gltf#/nodes/0: is its own ancestor");
    Gltf gltf = triangle();
    gltf.root["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
    CHECK(problem(gltf) == "box.gltf#/nodes/2: is a child of node 0 and of node 1");
    gltf.root["nodes"] = {{{"children", {2}}}, {{"mesh", 0}}, {{"mesh", 0}}};
    gltf.root["scenes"][0]["nodes"] = {0, 2};
    CHECK(problem(gltf) == "box.gltf#/nodes/2: is in the scene twice: a root of a scene must be no "
                           "other node's child");
}

TEST_CASE("Malformed glTF, names buffers that cannot be had") {
    CHECK(
        with_buffer({{"byteLength", 36}}) ==
        "box.gltf#/accessors/0: buffer 0 has no content: is the data compressed by an extension?");
    CHECK(with_buffer({{"byteLength", 36}, {"uri", "data:;base64,AAAA"}}) ==
          "box.gltf#/buffers/0: has 3 bytes, but its byteLength is 36");
    CHECK(with_buffer({{"byteLength", 36}, {"uri", "data:;base64,A?AA"}}) ==
          "box.gltf#/buffers/0: the data: URI is not valid base64");
    CHECK(with_buffer({{"byteLength", 36}, {"uri", "none.bin"}}) ==
          "box.gltf#/buffers/0: none.bin: no such file");
    CHECK(with_buffer({{"byteLength", 36}, {"uri", "."}}) == "box.gltf#/buffers/0: .: is a folder");
    for (const char* uri :
         {"../box.gltf", "%2e%2e/box.gltf", "..\\box.gltf", "/etc/passwd", "a/../../b"})
        CHECK(with_buffer({{"byteLength", 36}, {"uri", uri}}) ==
              std::string("box.gltf#/buffers/0: the uri '") + uri +
                  "' leads out of the model's folder");
    for (const char* uri : {"http://example.com/a.bin", "file:///etc/passwd", "C:\\a.bin"})
        CHECK(with_buffer({{"byteLength", 36}, {"uri", uri}}) ==
              std::string("box.gltf#/buffers/0: the uri '") + uri +
                  "' is neither a relative path nor a data: URI");
    CHECK(with_buffer({{"byteLength", 36}, {"uri", "a%00b"}}) ==
          "box.gltf#/buffers/0: the uri 'a%00b' has a control character");
}

TEST_CASE("Malformed glTF, follows no symbolic link out of the model's folder") {
    test::TempDir folder, outside;
    Gltf gltf = triangle();
    gltf.root["buffers"] = {{{"byteLength", gltf.bin.size()}, {"uri", "link.bin"}}};
    const fs::path file = test::write(folder / "box.gltf", gltf.text());
    fs::create_symlink(test::write(outside / "data.bin", gltf.bin), folder / "link.bin");
    CHECK(test::message_of([&] { read_gltf(file); }) ==
          file.string() + "#/buffers/0: the uri 'link.bin' leads out of the model's folder");
    fs::remove(folder / "link.bin");
    fs::create_symlink(test::write(folder / "data.bin", gltf.bin), folder / "link.bin");
    CHECK(read_gltf(file).scene.meshes.size() == 1);
}

TEST_CASE("Malformed glTF, is not believed about images") {
    // Reading beyond the buffer would put other memory into a picture.
    Gltf gltf = triangle();
    gltf.root["images"] = {{{"bufferView", 1}}};
    gltf.root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 4096}, {"byteLength", 64}});
    CHECK(problem(gltf) == "box.gltf#/bufferViews/1: ends at byte 4160 of buffer 0, which has 36");
}

TEST_CASE("Malformed glTF, may be nested without end") {
    std::string deep(60000, '[');
    deep += std::string(60000, ']');
    std::string text = triangle().text();
    text.insert(1, "\"extras\":" + deep + ",");
    const Imported imported = test::read_content(text);
    CHECK(imported.scene.meshes.size() == 1);
    CHECK(imported.losses == Losses{{Loss::dropped, "box.gltf",
                                     "what is nested more than 64 levels deep is ignored"}});
}
