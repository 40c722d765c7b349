// glTF files in memory instead of on the disk.
#include "importers/gltf/gltf_materials.h"
#include "scene/fingerprint.h"

#include <span>

using namespace penumbra;
using test::Gltf, test::TempDir, test::triangle;
namespace fs = std::filesystem;

namespace {

Imported from_memory(const std::string& content, const std::string& name,
                     const ModelOptions& options = {}) {
    return read_gltf(std::as_bytes(std::span(content)), name, options);
}

std::string problem_of(const std::string& content, const std::string& name,
                       const ModelOptions& options = {}) {
    return test::message_of([&] { from_memory(content, name, options); });
}

// All of a scene that a picture shows.
std::uint64_t number_of(Scene scene) {
    complete(scene, 1);
    REQUIRE(defects(scene).empty());
    return fingerprint(normalise(std::move(scene), {}), {});
}

// A triangle with a picture on it.
Gltf pictured() {
    Gltf gltf = test::with_material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", {{"index", 0}}}}}});
    gltf.add("textures", {{"source", gltf.add("images", test::picture(Color(0.5F, 0.25F, 1)))}});
    return gltf;
}

// The same in three files: box.gltf, box.bin and sub/box.png.
struct ThreeFiles {
    TempDir folder = {};
    fs::path model = {};
    std::string text = {};

    ThreeFiles() {
        Gltf gltf = pictured();
        Image image(2, 1);
        image.at(0, 0) = Color(0.5F, 0.25F, 1);
        const auto png = encode_png(image);
        test::write(folder / "sub/box.png",
                    {reinterpret_cast<const char*>(png.data()), png.size()});
        gltf.root["images"][0] = {{"uri", "sub/box.png"}};
        gltf.root["buffers"] = {{{"byteLength", gltf.bin.size()}, {"uri", "box.bin"}}};
        test::write(folder / "box.bin", gltf.bin);
        text = gltf.text();
        model = test::write(folder / "box.gltf", text);
    }
    Imported read(const std::vector<fs::path>& allowed) const {
        return from_memory(text, model.string(), {.allowed_paths = allowed});
    }
    std::string problem(const std::vector<fs::path>& allowed) const {
        return problem_of(text, model.string(), {.allowed_paths = allowed});
    }
};

const std::string refusal =
    "the folders of ModelOptions::allowed_paths, which are all that a model "
    "in memory may read";

}  // namespace

TEST_CASE("glTF in memory, gives the scene of the file") {
    const TempDir folder;
    const Gltf gltf = pictured();
    const auto check = [&](const std::string& content, const std::string& name) {
        const Imported from_file = read_gltf(test::write(folder / name, content));
        const Imported imported = from_memory(content, (folder / name).string());
        REQUIRE(imported.scene.textures.size() == 1);
        CHECK(number_of(imported.scene) == number_of(from_file.scene));
        CHECK(imported.losses == from_file.losses);
        CHECK(imported.models.at(0).file == from_file.models.at(0).file);
        CHECK(imported.models.at(0).format == "glTF 2.0");
        Scene other = imported.scene;
        other.textures[0].raster.data[0] ^= std::byte(1);
        CHECK(number_of(other) != number_of(from_file.scene));
    };
    check(gltf.text(), "box.gltf");
    check(gltf.glb(), "box.glb");
}

TEST_CASE("glTF in memory, needs no folder, and its bytes no longer than the call") {
    const std::string glb = pictured().glb();
    CHECK(from_memory(glb, "nowhere/at/all.glb").scene.meshes.size() == 1);
    CHECK(from_memory(glb, "").scene.meshes.size() == 1);
    // What was read does not refer to the bytes.
    std::string content = glb;
    const Imported imported = from_memory(content, "box.glb");
    const auto before = number_of(imported.scene);
    content.assign(content.size(), '\0');
    CHECK(number_of(imported.scene) == before);
}

TEST_CASE("glTF in memory, names itself where it is malformed") {
    CHECK(problem_of("", "upload 7") == "upload 7: the file is empty");
    CHECK(problem_of("{\n  \"asset\": {]\n}", "upload 7") ==
          "upload 7:2:13: the JSON cannot be parsed here");
    CHECK(problem_of(triangle().glb().substr(0, 8), "a/box.glb") ==
          "a/box.glb: the file ends before the end of the GLB header (needs 12 bytes, has 8)");
    Gltf gltf = triangle();
    gltf.root["nodes"][0]["mesh"] = 3;
    CHECK(problem_of(gltf.text(), "a/box.gltf") ==
          "a/box.gltf#/nodes/0/mesh: is 3, but the file has 1 meshes");
    CHECK(problem_of(triangle().text(), "box.gltf", {.scene = "Attic"}) ==
          "box.gltf: there is no scene 'Attic' (the file has one scene: '0')");
    CHECK(from_memory(triangle().glb() + "tail", "box.glb").losses ==
          Losses{{Loss::dropped, "box.glb", "4 bytes after the model are ignored"}});
}

TEST_CASE("glTF in memory, is refused beyond the size of files") {
    // Only its size is looked at.
    const std::string content = triangle().glb();
    const std::span<const std::byte> huge(reinterpret_cast<const std::byte*>(content.data()),
                                          (std::size_t(4) << 30) + 1);
    CHECK(test::message_of([&] { read_gltf(huge, "box.glb"); }) ==
          "box.glb: has 4294967297 bytes, more than the 4294967296 that are read");
}

TEST_CASE("glTF in memory, reads no file that is not allowed") {
    const ThreeFiles files;
    const std::string at = files.model.string() + "#/buffers/0: the uri 'box.bin' leads out of ";
    CHECK(files.problem({}) == at + refusal);
    CHECK(files.problem({files.folder / "sub"}) == at + refusal);
    // The answer does not tell what is there.
    fs::remove(files.folder / "box.bin");
    CHECK(files.problem({}) == at + refusal);
    CHECK(files.problem({files.folder.path}) ==
          files.model.string() + "#/buffers/0: " + (files.folder / "box.bin").string() +
              ": no such file");
}

TEST_CASE("glTF in memory, loses images that are not allowed") {
    const ThreeFiles files;
    fs::create_directory(files.folder / "bin");
    fs::rename(files.folder / "box.bin", files.folder / "bin/box.bin");
    const std::string text = [&] {
        auto root = test::json::parse(files.text);
        root["buffers"][0]["uri"] = "bin/box.bin";
        return root.dump();
    }();
    const Imported imported =
        from_memory(text, files.model.string(), {.allowed_paths = {files.folder / "bin"}});
    REQUIRE(imported.losses.size() == 1);
    INFO(imported.losses[0].what);
    CHECK(imported.losses[0].what.find("the uri 'sub/box.png' leads out of " + refusal) !=
          std::string::npos);
    CHECK(imported.scene.textures.empty());
}

TEST_CASE("glTF in memory, reads files beside its name where that is allowed") {
    const ThreeFiles files;
    const Imported imported = files.read({files.folder.path});
    CHECK(imported.losses.empty());
    CHECK(number_of(imported.scene) == number_of(read_gltf(files.model).scene));
}
