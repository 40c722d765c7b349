// OBJ files in memory instead of on the disk.
#include "importers/obj/mtl_files.h"
#include "scene/fingerprint.h"

#include "penumbra/image.h"

#include <span>

using namespace penumbra;
using test::Lines, test::TempDir;
namespace fs = std::filesystem;

namespace {

Imported from_memory(const std::string& text, const std::string& name,
                     const ModelOptions& options = {}) {
    return read_obj(std::as_bytes(std::span(text)), name, options);
}

// All of a scene that a picture shows.
std::uint64_t number_of(Scene scene) {
    complete(scene, 1);
    REQUIRE(defects(scene).empty());
    return fingerprint(normalise(std::move(scene), {}), {});
}

const std::string model = "mtllib a.mtl\n" + test::facet + "usemtl a\nf 1/1 2/2 3/3\n";
const std::string refusal =
    "lies outside the folders of ModelOptions::allowed_paths, which are all "
    "that a model in memory may read";

// A model with a library and an image.
struct Textured : test::Files {
    Textured() {
        image("textures/a.png");
        read("newmtl a\nKd 0.5 0.25 0.125\nmap_Kd textures/a.png\n");
    }
};

}  // namespace

TEST_CASE("Obj in memory, gives the scene of the file") {
    const TempDir folder;
    const std::string text = "# Grüße\r\n" + test::quad + "f 1 2 3 4\r\nl 1 2\r\n";
    const Imported from_file = read_obj(test::write(folder / "m.obj", text));
    const Imported imported = from_memory(text, (folder / "m.obj").string());
    CHECK(number_of(imported.scene) == number_of(from_file.scene));
    CHECK(imported.losses == from_file.losses);
    CHECK(imported.losses.size() == 1);
    CHECK(imported.models.at(0).file == (folder / "m.obj").string());
    CHECK(imported.models.at(0).format == "OBJ");
    const std::string wider = "v 0 0 0\nv 2 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    CHECK(number_of(from_memory(wider, "m.obj").scene) != number_of(from_file.scene));
}

TEST_CASE("Obj in memory, has the materials of the file where its folder is allowed") {
    const Textured files;
    const fs::path file = files.path("m.obj");
    const Imported from_file = read_obj(file);
    const Imported imported =
        from_memory(model, file.string(), {.allowed_paths = {files.folder.path}});
    CHECK(imported.losses == from_file.losses);
    REQUIRE(imported.scene.textures.size() == 1);
    CHECK(number_of(imported.scene) == number_of(from_file.scene));
    // As from the disk: case does not matter, and a file beside the model replaces a lost one.
    for (const char* library : {"A.MTL", "C:\\models\\a.mtl", "../other/a.mtl"}) {
        const std::string text = "mtllib " + std::string(library) + model.substr(12);
        test::write(file, text);
        const Imported renamed =
            from_memory(text, file.string(), {.allowed_paths = {files.folder.path}});
        CHECK(renamed.scene.textures.size() == 1);
        CHECK(renamed.losses == read_obj(file).losses);
    }
}

TEST_CASE("Obj in memory, reads no file that is not allowed") {
    const Textured files;
    const std::string name = files.path("m.obj").string();
    const Lines lost = {"m.obj:1: material library 'a.mtl' " + refusal,
                        "m.obj:8: material 'a' is not defined; it gets default values"};
    const auto losses = [&](const std::string& text, const std::vector<fs::path>& allowed) {
        return test::losses(from_memory(text, name, {.allowed_paths = allowed}));
    };
    CHECK(losses(model, {}) == lost);
    CHECK(losses(model, {files.path("textures")}) == lost);
    // The answer does not tell what is there.
    fs::remove(files.path("a.mtl"));
    CHECK(losses(model, {}) == lost);
    for (const std::string library : {"../a.mtl", "/etc/passwd", "C:\\a.mtl", "."})
        CHECK(losses("mtllib " + library + model.substr(12), {}).at(0) ==
              "m.obj:1: material library '" + library + "' " + refusal);
}

TEST_CASE("Obj in memory, reads a folder that is allowed below one that is not") {
    const Textured files;
    fs::create_directories(files.path("a/b"));
    fs::rename(files.path("a.mtl"), files.path("a/b/a.mtl"));
    fs::rename(files.path("textures"), files.path("a/b/textures"));
    const std::string text = "mtllib a/b/a.mtl" + model.substr(12);
    const Imported imported =
        from_memory(text, files.path("m.obj").string(), {.allowed_paths = {files.path("a/b")}});
    CHECK(imported.losses.empty());
    CHECK(imported.scene.textures.size() == 1);
}

TEST_CASE("Obj in memory, names itself where it is malformed") {
    const auto problem = [](const std::string& text) {
        return test::message_of([&] { from_memory(text, "upload 7"); });
    };
    CHECK(problem("") == "upload 7: no facets in it");
    CHECK(problem("v 0 0 0\nv 1 0\n") == "upload 7:2: v needs 3 numbers but has 2");
    const std::byte one{};
    CHECK(test::message_of([&] {
              read_obj(std::span<const std::byte>(&one, (std::size_t(4) << 30) + 1), "m.obj");
          }) == "m.obj: has 4294967297 bytes, more than the 4294967296 that are read");
}
