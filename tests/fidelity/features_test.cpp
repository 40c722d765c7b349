// Every feature is the same picture in POV-Ray. The figures are a table of docs/fidelity.md. With
// PENUMBRA_KEEP, the name of a folder, each feature's files and both pictures stay there.
#include "fidelity/features.h"
#include "support/fidelity_tables.h"
#include "support/small_scenes.h"

#include <atomic>
#include <set>
#include <span>
#include <thread>

using namespace penumbra;
using test::Feature;

namespace {

namespace fs = std::filesystem;

struct Measured {
    test::Parity parity = {};
    std::string error = {};
};

Imported load(const Feature& feature, const fs::path& folder) {
    for (const auto& [name, content] : feature.files) test::write(folder / name, content);
    Imported imported = load_scene({folder / "stage.toml"}, {.model = feature.model});
    imported.render.threads = 1;
    test::meter(imported);
    return imported;
}

// Map projections, Earth-centred coordinates: what info calls exact must be so there as well.
const std::array far_places = {Vec3(600, -50, 800), Vec3(-150000, 30, 90000),
                               Vec3(1113194.9, 120, -6800125.4)};

Measured measure(const Feature& feature, const Vec3& place) {
    const test::TempDir folder;
    Measured result;
    try {
        Imported imported = load(feature, folder.path);
        test::move_by(imported.scene, place);
        const NormalisedScene scene = normalise(std::move(imported.scene), imported.render);
        result.parity = test::parity_of(scene, imported.render, folder.path);
        Losses& losses = result.parity.losses;
        losses.insert(losses.begin(), imported.losses.begin(), imported.losses.end());
    } catch (const std::exception& error) {
        result.error = error.what();
    }
    if (const char* keep = std::getenv("PENUMBRA_KEEP"); keep != nullptr && place == Vec3(0)) {
        const fs::path kept = fs::path(keep) / (feature.group + ", " + feature.name);
        fs::create_directories(kept);
        fs::copy(folder.path, kept,
                 fs::copy_options::recursive | fs::copy_options::overwrite_existing);
        if (!result.error.empty()) return result;
        save_image(kept / "ours.png", result.parity.ours);
        save_image(kept / "povray.png", result.parity.theirs);
    }
    return result;
}

// Each at one of the places in turn. POV-Ray waits more than it works on such small scenes: more of
// them than there are processors.
std::vector<Measured> measure(const std::vector<Feature>& features, std::span<const Vec3> places) {
    std::vector<Measured> results(features.size());
    std::atomic<std::size_t> next = 0;
    std::vector<std::jthread> workers;
    for (int i = 0; i < 8; ++i)
        workers.emplace_back([&] {
            for (std::size_t at; (at = next++) < features.size();)
                results[at] = measure(features[at], places[at % places.size()]);
        });
    workers.clear();
    return results;
}

std::string said(const Losses& losses) {
    std::string text;
    for (const Loss& loss : losses) text += loss.place + ": " + loss.what + "\n";
    return text;
}

// For a cell of the table.
std::string words(const Losses& losses) {
    std::string text;
    for (const Loss& loss : losses) text += (text.empty() ? "" : "; ") + loss.what;
    return text;
}

// Fraction of the pixels that have another colour than the most frequent one.
double variety(const Image& image) {
    std::map<std::array<float, 3>, std::size_t> count;
    std::size_t most = 0;
    for (const Color& c : image.pixels) most = std::max(most, ++count[{c.x, c.y, c.z}]);
    return 1 - double(most) / double(image.pixels.size());
}

std::string bytes_of(const Image& image) {
    return {reinterpret_cast<const char*>(image.pixels.data()),
            image.pixels.size() * sizeof(Color)};
}

void check(const Feature& feature, const Measured& measured) {
    const test::Parity& m = measured.parity;
    INFO(feature.group << ", " << feature.name << ": " << measured.error << "\nworst pixel "
                       << m.worst.x << "," << m.worst.y << " ours " << m.worst.test << " POV-Ray "
                       << m.worst.reference << "\nlosses: " << said(m.losses));
    REQUIRE(measured.error.empty());
    CHECK(m.verdict == Verdict::pass);
    CHECK(m.parity >= feature.parity);
    CHECK(m.exactness >= feature.exactness);
    CHECK(m.losses.empty() == feature.loss.empty());
    CHECK(said(m.losses).find(feature.loss) != std::string::npos);
    CHECK(variety(m.ours) >= 0.1);
}

test::Table table(const std::vector<Feature>& features, const std::vector<Measured>& measured) {
    test::Table table = {
        .name = "features",
        .columns = {"group", "feature", "parity", "exactness", "largest difference", "loss"}};
    for (std::size_t i = 0; i < features.size(); ++i) {
        test::Cells row = test::figures(measured[i].parity);
        row.insert(row.begin(), {features[i].group, features[i].name});
        row.push_back(words(measured[i].parity.losses));
        table.rows.push_back(row);
    }
    return table;
}

}  // namespace

TEST_CASE("features, are the same picture in POV-Ray") {
    if (!test::have_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const std::vector<Feature> features = test::features();
    const std::vector<Measured> measured = measure(features, std::array{Vec3(0)});
    // What had no effect would leave two pictures the same.
    std::map<std::string, std::string> pictures;
    for (std::size_t i = 0; i < features.size(); ++i) {
        check(features[i], measured[i]);
        const auto [same, fresh] =
            pictures.emplace(bytes_of(measured[i].parity.ours), features[i].name);
        INFO(features[i].name << " looks like " << same->second);
        CHECK(fresh);
    }
    test::document(table(features, measured));
}

TEST_CASE("features, are the same picture in POV-Ray far from the origin") {
    if (!test::have_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const std::vector<Feature> features = test::features();
    const std::vector<Measured> measured = measure(features, far_places);
    for (std::size_t i = 0; i < features.size(); ++i) check(features[i], measured[i]);
}

TEST_CASE("features, look the same far from the origin") {
    const std::vector<Feature> features = test::features();
    for (const Feature& feature : features) {
        const test::TempDir folder;
        const Imported imported = load(feature, folder.path);
        const auto picture = [&](const Scene& scene) {
            return render(normalise(scene, imported.render), imported.render);
        };
        const Image near = picture(imported.scene);
        for (const Vec3& place : far_places) {
            INFO(feature.group << ", " << feature.name << " at " << place.x << ' ' << place.y << ' '
                               << place.z);
            Scene moved = imported.scene;
            test::move_by(moved, place);
            CHECK(drop_coincident_facets(moved) == 0);
            CHECK(test::share_off(picture(moved), near) <= 0.001);
        }
    }
}

TEST_CASE("features, are the rows of docs/fidelity.md, each once") {
    std::vector<std::string> all;
    for (const Feature& feature : test::features())
        all.push_back(feature.group + " | " + feature.name);
    CHECK(std::set(all.begin(), all.end()).size() == all.size());
    if (std::getenv("PENUMBRA_WRITE_FIDELITY") != nullptr) return;
    std::vector<test::Cells> rows = test::documented("features");
    REQUIRE(!rows.empty());
    const test::Cells columns = rows[0];
    rows.erase(rows.begin());
    CHECK(test::names(columns, rows) == all);
}
