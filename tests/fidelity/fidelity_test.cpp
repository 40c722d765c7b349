// Every scene of scenes/ and a set of well-known models through POV-Ray itself. The figures are
// tables of docs/fidelity.md.
#include "support/fidelity_tables.h"

#include <algorithm>

using namespace penumbra;

namespace {

constexpr int width = 320, height = 240;

struct Row {
    std::string name;
    double parity_limit, exactness_limit;
    test::Parity measured = {};
};

// Curved mirrors and lenses amplify the rounding of a hit point into a moved edge here and there.
bool amplifies(const std::string& name) {
    for (const char* one : {"mirrors", "glass", "lights"})
        if (name == one) return true;
    return false;
}

std::vector<std::filesystem::path> own_scenes() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(PENUMBRA_SOURCE_DIR) / "scenes"))
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

// Models by other people, by their path below the asset folder.
const std::vector<std::string> models = {
    "obj/common3d/spot/spot.obj",
    "obj/common3d/teapot/teapot.obj",
    "obj/common3d/suzanne/suzanne.obj",
    "obj/assimp/spider.obj",
    "obj/pt/CornellBox-Original/CornellBox-Original.obj",
    "obj/assimp/concave_polygon.obj",
    "gltf/Box/Box.gltf",
    "gltf/BoxVertexColors/BoxVertexColors.gltf",
    "gltf/BoxInterleaved/BoxInterleaved.glb",
    "gltf/SimpleInstancing/SimpleInstancing.glb",
    "gltf/NegativeScaleTest/NegativeScaleTest.glb",
    "gltf/Suzanne/Suzanne.gltf",
    "gltf/Cameras/Cameras.gltf",
    "gltf/LightsPunctualLamp/LightsPunctualLamp.gltf",
};

test::Table table(const std::string& name, const std::vector<Row>& rows) {
    test::Table table = {.name = name,
                         .columns = {"scene", "parity", "exactness", "largest difference", "SSIM",
                                     "FLIP", "losses"}};
    for (const Row& row : rows) {
        const test::Parity& m = row.measured;
        test::Cells cells = test::figures(m);
        cells.insert(cells.begin(), row.name);
        cells.push_back(fmt::format("{:.5f}", m.ssim));
        cells.push_back(fmt::format("{:.5f}", m.flip));
        cells.push_back(std::to_string(m.losses.size()));
        table.rows.push_back(cells);
    }
    return table;
}

Row measure(const std::string& name, const std::filesystem::path& file, double parity_limit,
            double exactness_limit) {
    const test::TempDir folder;
    return {name, parity_limit, exactness_limit, test::parity_of(file, width, height, folder.path)};
}

void check(const Row& row) {
    const test::Parity& m = row.measured;
    INFO(row.name << ": worst pixel " << m.worst.x << "," << m.worst.y << " ours " << m.worst.test
                  << " POV-Ray " << m.worst.reference);
    CHECK(m.verdict == Verdict::pass);
    CHECK(m.parity >= row.parity_limit);
    CHECK(m.exactness >= row.exactness_limit);
}

}  // namespace

TEST_CASE("fidelity, our own scenes are the same picture in POV-Ray") {
    if (!test::have_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    std::vector<Row> rows;
    for (const auto& file : own_scenes()) {
        const std::string name = file.stem().string();
        rows.push_back(measure(name, file, amplifies(name) ? 0.9995 : 0.9999, 0.999));
        check(rows.back());
        CHECK(rows.back().measured.losses.empty());
    }
    test::document(table("scenes", rows));
}

TEST_CASE("fidelity, well-known models are the same picture in POV-Ray") {
    if (!test::have_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    if (!std::filesystem::exists(test::assets())) PENUMBRA_SKIP("the models are not here");
    std::vector<Row> rows;
    for (const std::string& model : models) {
        const std::filesystem::path file = test::assets() / model;
        rows.push_back(measure(file.filename().string(), file, 0.999, 0.99));
        check(rows.back());
    }
    test::document(table("models", rows));
}
