// Nodes that show other glTF files.
#include "importers/gltf/gltf_builder.h"

using namespace penumbra;
using test::Gltf;
using test::json;

namespace {

// Shows a triangle of its own, and `uri` two to the right.
Gltf showing(const std::string& uri) {
    Gltf gltf = test::triangle();
    gltf.root["asset"]["version"] = "2.1";
    gltf.root["files"] = {{{"uri", uri}, {"mimeType", "model/gltf+json"}}};
    gltf.root["externalAssets"] = {{{"file", 0}}};
    const int node = gltf.add("nodes", {{"externalAsset", 0}, {"translation", {2, 0, 0}}});
    gltf.root["scenes"][0]["nodes"].push_back(node);
    return gltf;
}

std::vector<Vec3> origins(const Imported& imported) {
    std::vector<Vec3> found;
    for (const Instance& instance : imported.scene.instances)
        found.push_back(instance.transform.translation());
    return found;
}

const std::string left_out = "its external asset is left out: ";

}  // namespace

TEST_CASE("glTF external assets, are shown where their nodes stand") {
    const test::TempDir folder;
    test::fs::create_directory(folder / "parts");
    Gltf inner = test::triangle();
    inner.root["nodes"][0]["translation"] = {0, 3, 0};
    inner.root["meshes"][0]["primitives"][0]["material"] =
        inner.add("materials", {{"name", "red"}});
    test::write(folder / "parts/inner.glb", inner.glb());
    Gltf outer = showing("parts/inner.glb");
    const int again = outer.add("nodes", {{"externalAsset", 0}, {"scale", {2, 2, 2}}});
    outer.root["scenes"][0]["nodes"].push_back(again);
    const Imported imported = read_gltf(test::write(folder / "outer.gltf", outer.text()));
    CHECK(imported.losses.empty());
    CHECK(origins(imported) == std::vector<Vec3>{{0, 0, 0}, {2, 3, 0}, {0, 6, 0}});
    CHECK(imported.scene.meshes.size() == 2);
    CHECK(imported.scene.materials.at(imported.scene.meshes.at(1).material).name == "red");
    REQUIRE(imported.models.size() == 2);
    CHECK(imported.models[1].file == (folder / "parts/inner.glb").string());
}

TEST_CASE("glTF external assets, may lie in the file itself") {
    const std::string uri = "data:model/gltf-binary;base64," + test::base64(test::triangle().glb());
    CHECK(origins(test::read(showing(uri))) == std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}});
}

TEST_CASE("glTF external assets, read what the outermost file may read") {
    const test::TempDir folder;
    test::fs::create_directories(folder / "model/parts");
    Gltf inner = test::triangle();
    test::write(folder / "model/data.bin", inner.bin);
    inner.root["buffers"] = {{{"byteLength", inner.bin.size()}, {"uri", "../data.bin"}}};
    test::write(folder / "model/parts/inner.gltf", inner.text());
    const auto outer = test::write(folder / "model/outer.gltf", showing("parts/inner.gltf").text());
    CHECK(origins(read_gltf(outer)).size() == 2);

    test::write(folder / "data.bin", inner.bin);
    inner.root["buffers"][0]["uri"] = "../../data.bin";
    test::write(folder / "model/parts/inner.gltf", inner.text());
    const Imported imported = read_gltf(outer);
    CHECK(origins(imported).size() == 1);
    REQUIRE(imported.losses.size() == 1);
    CHECK(imported.losses[0].what.find("leads out of") != std::string::npos);
}

TEST_CASE("glTF external assets, are a loss where they cannot be read") {
    const Imported missing = test::read(showing("none.gltf"));
    CHECK(missing.scene.instances.size() == 1);
    CHECK(missing.losses == Losses{{Loss::dropped, "box.gltf#/nodes/1/externalAsset",
                                    left_out + "none.gltf: no such file"}});
    CHECK(test::read(showing("box.gltf")).losses ==
          Losses{{Loss::dropped, "box.gltf#/nodes/1/externalAsset",
                  left_out + "the file shows itself"}});
    CHECK(test::problem([] {
              Gltf gltf = showing("box.gltf");
              gltf.root["externalAssets"][0]["file"] = 1;
              return gltf;
          }()) == "box.gltf#/externalAssets/0/file: is 1, but the file has 1 files");
}
