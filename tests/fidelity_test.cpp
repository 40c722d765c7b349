// Every scene of scenes/ and a set of well-known models through POV-Ray itself. The figures are the
// tables of docs/fidelity.md; this program writes them when PENUMBRA_WRITE_FIDELITY names a file.
#include "parity.h"
#include "support.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

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

std::string table_row(const Row& row) {
    const test::Parity& m = row.measured;
    return fmt::format("| {} | {:.6f} | {:.6f} | {:.2g} | {:.5f} | {:.5f} | {} |\n", row.name,
                       m.parity, m.exactness, m.max_error, m.ssim, m.flip, m.losses.size());
}

std::string table(const std::vector<Row>& rows) {
    std::string text =
        "| scene | parity | exactness | largest difference | SSIM | FLIP | losses |\n"
        "|---|---|---|---|---|---|---|\n";
    for (const Row& row : rows) text += table_row(row);
    return text;
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

// The documented table must have these very rows, and figures that are no better than measured.
void check_documented(const std::string& document, const std::vector<Row>& rows) {
    for (const Row& row : rows) {
        const std::size_t at = document.find("| " + row.name + " | ");
        INFO("docs/fidelity.md is stale at " << row.name
                                             << ": write it anew (see CONTRIBUTING.md)");
        REQUIRE(at != std::string::npos);
        const double documented = std::stod(document.substr(at + row.name.size() + 5));
        CHECK(documented == Approx(row.measured.parity).margin(2e-4));
    }
}

void write_document(const std::string& heading, const std::vector<Row>& rows) {
    const char* file = std::getenv("PENUMBRA_WRITE_FIDELITY");
    if (file == nullptr) return;
    std::ofstream(file, std::ios::app) << heading << "\n\n" << table(rows) << '\n';
}

std::string document() {
    return test::read(std::filesystem::path(PENUMBRA_SOURCE_DIR) / "docs/fidelity.md");
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
    write_document("## Our scenes", rows);
    check_documented(document(), rows);
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
    write_document("## Models by others", rows);
    check_documented(document(), rows);
}
