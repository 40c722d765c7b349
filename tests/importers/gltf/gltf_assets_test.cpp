// Real and broken glTF files by other people.
#include "support/support.h"

#include "penumbra/importers.h"

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>

using namespace penumbra;

namespace {

// One entry of the assets' MANIFEST.toml: "key = value" lines after [[asset]].
using Asset = std::map<std::string, std::string>;

std::vector<Asset> assets_of_kind(const std::string& kind) {
    std::vector<Asset> all;
    std::istringstream lines(test::read(test::assets() / "MANIFEST.toml"));
    for (std::string line; std::getline(lines, line);) {
        if (line == "[[asset]]") all.emplace_back();
        const std::size_t equals = line.find(" = ");
        if (equals == std::string::npos || all.empty()) continue;
        std::string value = line.substr(equals + 3);
        if (value.size() >= 2 && value.front() == '"') value = value.substr(1, value.size() - 2);
        all.back()[line.substr(0, equals)] = value;
    }
    std::erase_if(all, [&](const Asset& asset) { return asset.at("kind") != kind; });
    return all;
}

// Defects that an importer may cause; a camera is completed later.
std::vector<std::string> importer_defects(Scene scene) {
    if (scene.cameras.empty()) {
        scene.cameras.emplace_back();
        scene.camera = 0;
    }
    return defects(scene);
}

// The makers' number is that of one of the 125 instances.
std::size_t expected_facets(const Asset& asset) {
    const std::size_t facets = std::stoul(asset.at("scene_triangles"));
    return asset.at("file").ends_with("/SimpleInstancing.glb") ? 125 * facets : facets;
}

}  // namespace

TEST_CASE("glTF assets, give the number of facets that their makers say") {
    if (!test::fs::exists(test::assets())) PENUMBRA_SKIP("the assets are not here");
    const auto assets = assets_of_kind("gltf");
    CHECK(assets.size() > 150);
    for (const Asset& asset : assets) {
        INFO(asset.at("file"));
        const auto read = [&] { return read_gltf(test::assets() / asset.at("file")); };
        if (asset.at("expect") == "must-reject") {
            CHECK_FALSE(test::message_of(read).empty());
            continue;
        }
        std::optional<Imported> imported;
        const std::string problem = test::message_of([&] { imported = read(); });
        if (asset.at("file").ends_with("/box-shared-image-references-separate.gltf")) {
            CHECK(problem.ends_with("the model needs the extension KHR_techniques_webgl, which is "
                                    "not supported"));
            continue;
        }
        CHECK(problem == "");
        if (!imported) continue;
        CHECK(facet_count(imported->scene) == expected_facets(asset));
        CHECK(importer_defects(imported->scene) == std::vector<std::string>{});
    }
}

TEST_CASE("glTF assets, are shown, repaired or refused when they are broken") {
    if (!test::fs::exists(test::assets())) PENUMBRA_SKIP("the assets are not here");
    const auto assets = assets_of_kind("bad-gltf");
    CHECK(assets.size() > 400);
    // Valid for their makers, but not for us: a newer minVersion, a buffer on the network, a buffer
    // without content.
    const std::vector<std::string> refused = {"min_version_valid.gltf", "non_relative_uri.gltf",
                                              "unused_objects.gltf"};
    for (const Asset& asset : assets) {
        INFO(asset.at("file"));
        const test::fs::path file = test::assets() / asset.at("file");
        std::optional<Imported> imported;
        const std::string problem = test::message_of([&] { imported = read_gltf(file); });
        if (imported) CHECK(importer_defects(imported->scene) == std::vector<std::string>{});
        if (asset.at("expect") == "must-reject") CHECK_FALSE(imported);
        // The place comes first, and all is one line.
        if (!imported) CHECK(problem.rfind(file.string(), 0) == 0);
        CHECK(std::none_of(problem.begin(), problem.end(),
                           [](char c) { return c >= 0 && c < 0x20; }));
        if (asset.at("expect").rfind("load", 0) == 0 &&
            std::find(refused.begin(), refused.end(), file.filename().string()) == refused.end())
            CHECK(problem == "");
    }
}
