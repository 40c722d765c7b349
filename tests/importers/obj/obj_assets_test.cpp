// Models by other people, and files made to hurt.

#include "importers/obj/obj_files.h"

#include <algorithm>
#include <cmath>
#include <map>

using namespace penumbra;
using test::area;
using test::facets;

namespace {

using Asset = std::map<std::string, std::string>;

// The manifest's entries, whose values stand on one line each.
std::vector<Asset> manifest(const std::string& kind) {
    std::vector<Asset> result;
    std::ifstream in(test::assets() / "MANIFEST.toml");
    Asset asset;
    const auto finish = [&] {
        if (asset["kind"] == kind) result.push_back(asset);
        asset.clear();
    };
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("[[")) finish();
        const std::size_t equals = line.find(" = ");
        if (equals == std::string::npos) continue;
        std::string value = line.substr(equals + 3);
        if (value.starts_with('"')) value = value.substr(1, value.size() - 2);
        asset[line.substr(0, equals)] = value;
    }
    finish();
    return result;
}

}  // namespace

TEST_CASE("Obj assets, every valid model has the facets that it should") {
    if (!test::fs::exists(test::assets())) PENUMBRA_SKIP("no assets");
    const auto assets = manifest("obj");
    CHECK(assets.size() > 100);
    for (Asset asset : assets) {
        const std::string file = asset["file"];
        // One of its polygons goes round a square 234 times; the manifest counts each round.
        if (file == "obj/assimp/box_longline.obj") asset["triangles"] = "12";
        INFO(file);
        std::size_t found = 0;
        const std::string message = test::message_of([&] {
            Imported imported = read_obj(test::assets() / file);
            found = facets(imported.scene);
            complete(imported.scene, 1);
            CHECK(defects(imported.scene) == std::vector<std::string>{});
        });
        CHECK(found == std::stoul(asset["triangles"]));
        CHECK(message == (asset["triangles"] == "0"
                              ? (test::assets() / file).string() + ": no facets in it"
                              : ""));
    }
}

TEST_CASE("Obj assets, a broken file is refused or loaded, never more") {
    if (!test::fs::exists(test::assets())) PENUMBRA_SKIP("no assets");
    const auto assets = manifest("bad-obj");
    CHECK(assets.size() > 100);
    for (Asset asset : assets) {
        INFO(asset["file"]);
        const std::string message = test::message_of([&] {
            Imported imported = read_obj(test::assets() / asset["file"]);
            CHECK(facets(imported.scene) > 0);
            complete(imported.scene, 1);
            CHECK(defects(imported.scene) == std::vector<std::string>{});
        });
        CHECK(message.find('\n') == std::string::npos);
        if (asset["expect"] == "load") CHECK(message.empty());
        if (!message.empty())
            CHECK_THAT(message, Catch::Matchers::StartsWith(
                                    (test::assets() / asset["file"]).string() + ':'));
    }
}

TEST_CASE("Obj assets, polygons have their true areas") {
    if (!test::fs::exists(test::assets())) PENUMBRA_SKIP("no assets");
    const auto area_of = [](const std::string& file) {
        return area(read_obj(test::assets() / file).scene);
    };
    const std::string folder = "bad/synthetic/obj/";
    CHECK(area_of(folder + "ngon-comb.obj") == Approx(1.485).epsilon(1e-6));
    CHECK(area_of(folder + "ngon-spiral.obj") == Approx(41.3427).epsilon(1e-6));
    CHECK(area_of(folder + "ngon-star.obj") == Approx(1.5707).epsilon(1e-4));
    CHECK(area_of(folder + "ngon-40000.obj") == Approx(std::acos(-1)).epsilon(1e-6));
    CHECK(area_of(folder + "concave.obj") == Approx(10));
    CHECK(area_of("obj/assimp/concave_polygon.obj") == Approx(0.245497).epsilon(1e-5));
    CHECK(area_of("obj/assimp/box_UTF16BE.obj") == Approx(6));
}
