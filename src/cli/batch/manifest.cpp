#include "cli/batch/manifest.h"

#include "base/text/suggest.h"
#include "base/toml/section.h"
#include "cli/advice.h"
#include "cli/batch/batch.h"
#include "cli/options/values.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;

// A file of the manifest, or the files that "folder/*.glb" stands for, in order.
std::vector<fs::path> files(const Section& section, const std::string& key,
                            const std::string& pattern) {
    const fs::path path = section.layer().folder / pattern;
    if (pattern.find_first_of("*?[") == std::string::npos) return {path};
    std::vector<fs::path> found;
    std::error_code error;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
        if (fnmatch(path.filename().c_str(), entry.path().filename().c_str(), FNM_PERIOD) == 0)
            found.push_back(folder == "." && !path.has_parent_path() ? entry.path().filename()
                                                                     : entry.path());
    if (found.empty()) section.fail(key, fmt::format("no file matches '{}'", pattern));
    std::ranges::sort(found);
    return found;
}

std::vector<fs::path> file_list(Section& section, const std::string& key) {
    std::vector<std::string> patterns;
    std::vector<fs::path> result;
    section.read(key, patterns);
    for (const std::string& pattern : patterns)
        std::ranges::copy(files(section, key, pattern), std::back_inserter(result));
    return result;
}

// All metrics that may have a limit.
std::vector<std::string> metric_names() {
    std::vector<std::string> names;
    for (const Metric& metric : penumbra::compare(Image(), Image()).metrics)
        names.push_back(metric.name);
    return names;
}

void read_limits(Section& section, Limits& limits) {
    std::string profile;
    if (section.read("profile", profile)) {
        try {
            limits = profile_limits(profile);
        } catch (const Error& error) {
            section.fail("profile", with_advice(error));
        }
    }
    section.read("warn_band", limits.warn_band, {.low = 0, .high = 1});
    std::optional<Section> table = section.table("limits");
    if (!table) return;
    const std::vector<std::string> names = metric_names();
    for (const std::string& name : table->keys()) {
        if (std::ranges::find(names, name) == names.end())
            table->fail(name, fmt::format("unknown metric '{}'{} (known: {})", name,
                                          did_you_mean(name, names), fmt::join(names, ", ")));
        table->read(name, limits.limits[name]);
    }
}

void read_judging(Section& section, Judging& judging) {
    read_limits(section, judging.limits);
    std::string mask;
    if (section.read("mask", mask)) judging.mask = section.layer().folder / mask;
    std::vector<std::vector<double>> boxes;
    section.read_rows("ignore", 4, boxes, "[x0, y0, x1, y1]");
    for (const std::vector<double>& b : boxes) {
        const auto whole = [](double x) { return x >= 0 && x <= 1e6 && x == std::floor(x); };
        if (!std::ranges::all_of(b, whole) || b[0] >= b[2] || b[1] >= b[3])
            section.reject("ignore", "must be whole pixels [x0, y0, x1, y1] with x0 < x1, y0 < y1");
        judging.ignored.push_back({int(b[0]), int(b[1]), int(b[2]), int(b[3])});
    }
    section.read("shift_tolerance", judging.shift_tolerance, {.low = 0, .high = 16});
}

struct Group {
    std::string name = {};
    std::vector<fs::path> models = {}, sidecars = {};
    std::vector<std::string> cameras = {};
    LoadOptions load = {};
    Judging judging = {};
};

// What defaults and a [[case]] share.
void read_common(Section& section, Group& group) {
    if (const auto sidecars = file_list(section, "sidecars"); !sidecars.empty())
        group.sidecars = sidecars;
    section.read("cameras", group.cameras);
    std::vector<std::string> settings;
    section.read("settings", settings);
    std::ranges::copy(settings, std::back_inserter(group.load.settings));
    read_judging(section, group.judging);
}

std::string name_of(const Group& group, const fs::path& model, const fs::path& sidecar,
                    const std::string& camera) {
    std::string name = group.models.size() > 1 || group.name.empty() ? model.stem().string() : "";
    const auto append = [&](const std::string& part) {
        if (!part.empty()) name += (name.empty() ? "" : "-") + part;
    };
    if (group.sidecars.size() > 1) append(sidecar.stem().string());
    if (group.cameras.size() > 1) append(camera);
    std::ranges::replace(name, '/', '_');
    if (group.name.empty()) return name;
    return name.empty() ? group.name : group.name + "-" + name;
}

void expand(const Group& group, const std::vector<std::string>& typed, Names& names,
            std::vector<ManifestCase>& cases) {
    const std::vector<fs::path> sidecars =
        group.sidecars.empty() ? std::vector<fs::path>(1) : group.sidecars;
    const std::vector<std::string> cameras =
        group.cameras.empty() ? std::vector<std::string>(1) : group.cameras;
    for (const fs::path& model : group.models)
        for (const fs::path& sidecar : sidecars)
            for (const std::string& camera : cameras) {
                ManifestCase one = {.name = names.unused(name_of(group, model, sidecar, camera)),
                                    .inputs = {model},
                                    .load = group.load,
                                    .judging = group.judging};
                if (!sidecar.empty()) one.load.sidecar = sidecar;
                if (!camera.empty())
                    one.load.settings.push_back("camera.name=" + toml_string(camera));
                // The command line has the last word.
                std::ranges::copy(typed, std::back_inserter(one.load.settings));
                cases.push_back(std::move(one));
            }
}

}  // namespace

std::vector<ManifestCase> read_manifest(const fs::path& file, const Arguments& arguments) {
    const Layer layer = read_sidecar(file);
    Section top(layer, layer.table);
    Group defaults = {.load = arguments.load, .judging = arguments.judging};
    defaults.load.settings.clear();
    read_common(top, defaults);
    std::vector<ManifestCase> cases;
    Names names;
    for (Section& section : top.list("case")) {
        Group group = defaults;
        section.read("name", group.name);
        if (group.name.find('/') != std::string::npos || group.name.starts_with('.'))
            section.reject("name", "must be a name for a folder, without '/' and no '.' in front");
        section.require("models");
        group.models = file_list(section, "models");
        if (group.models.empty()) section.reject("models", "must name at least one file");
        read_common(section, group);
        section.finish();
        expand(group, arguments.load.settings, names, cases);
    }
    top.finish();
    if (cases.empty()) throw Error(Failure::input, file.string(), "has no [[case]]");
    return cases;
}

}  // namespace penumbra::cli
