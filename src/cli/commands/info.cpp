#include "base/loss_tally.h"
#include "base/text/text.h"
#include "cli/steps.h"

#include "penumbra/exporters.h"
#include "penumbra/light_model.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <set>
#include <variant>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// What the files of all inputs hold together.
struct Totals {
    std::size_t nodes = 0, animations = 0;
    std::set<std::string> extensions = {};
};

Totals totals_of(const std::vector<ModelInfo>& models) {
    Totals totals;
    for (const ModelInfo& model : models) {
        totals.nodes += model.nodes;
        totals.animations += model.animations;
        totals.extensions.insert(model.extensions.begin(), model.extensions.end());
    }
    return totals;
}

struct Report {
    Imported imported = {};
    Losses losses = {};  // the importers' and the exporter's
    Bounds box = {};
    std::size_t facets = 0;
    Totals totals = {};
};

// ---- JSON

Json vector_json(const Vec3& v) { return {v.x, v.y, v.z}; }

Json bounds_json(const Bounds& box) {
    if (box.empty()) return nullptr;
    return {{"min", vector_json(box.min)}, {"max", vector_json(box.max)}};
}

Json environment_json(const Scene& scene) {
    if (!scene.environment) return nullptr;
    const Environment& e = *scene.environment;
    return {{"name", e.name},
            {"sources", e.sources},
            {"intensity", e.intensity},
            {"visible", e.visible}};
}

Json document(const Arguments& arguments, const Report& report) {
    const Scene& scene = report.imported.scene;
    Json inputs = Json::array();
    for (const fs::path& input : arguments.inputs) inputs.push_back(input.string());
    if (arguments.load.sidecar) inputs.push_back(arguments.load.sidecar->string());
    Json models = Json::array();
    for (const ModelInfo& model : report.imported.models)
        models.push_back({{"file", model.file},
                          {"format", model.format},
                          {"nodes", model.nodes},
                          {"animations", model.animations},
                          {"extensions", model.extensions}});
    return {{"version", 1},
            {"inputs", inputs},
            {"bounds", bounds_json(report.box)},
            {"facets", report.facets},
            {"meshes", scene.meshes.size()},
            {"instances", scene.instances.size()},
            {"spheres", scene.spheres.size()},
            {"planes", scene.planes.size()},
            {"materials", scene.materials.size()},
            {"textures", scene.textures.size()},
            {"lights", scene.lights.size()},
            {"environment", environment_json(scene)},
            {"cameras", scene.cameras.size()},
            {"exposure", report.imported.render.exposure},
            {"animations", report.totals.animations},
            {"extensions", report.totals.extensions},
            {"losses", losses_json(report.losses)},
            {"nodes", report.totals.nodes},
            {"models", models}};
}

// ---- text

std::string counted(std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string count_line(const char* what, std::size_t count, const std::string& names = "") {
    return fmt::format("{:<11}{}{}\n", what, count, names.empty() ? "" : "  " + names);
}

// "wood, 'red paint', ..." of the first few things.
template <class Things>
std::string names_of(const Things& things) {
    constexpr std::size_t most = 6;
    std::string text;
    for (std::size_t i = 0; i < std::min(most, things.size()); ++i)
        text += (text.empty() ? "" : ", ") +
                (things[i].name.empty() ? std::string("(no name)") : one_line(things[i].name));
    return things.size() > most ? text + ", ..." : text;
}

std::string light_names(const Scene& scene) {
    std::array<std::size_t, 3> kinds{};
    std::size_t sources = 0;
    for (const Light& light : scene.lights) {
        ++kinds[std::size_t(light.type)];
        sources += virtual_sources(light).size();
    }
    std::string text;
    constexpr std::array names = {"point", "spot", "directional"};
    for (std::size_t i = 0; i < names.size(); ++i)
        if (kinds[i] > 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", kinds[i], names[i]);
    if (sources > scene.lights.size()) text += fmt::format("; {} virtual sources", sources);
    return text;
}

std::string environment_line(const Scene& scene) {
    if (!scene.environment) return "";
    const Environment& e = *scene.environment;
    std::string text = fmt::format("environment {}: {}", one_line(e.name),
                                   counted(std::size_t(e.sources), "source"));
    if (e.intensity != 1) text += fmt::format(", intensity {:g}", e.intensity);
    return text + (e.visible ? "\n" : ", seen in mirrors only\n");
}

std::string pattern_names(const Scene& scene) {
    std::array<std::size_t, std::variant_size_v<Pattern>> kinds{};
    for (const Material& material : scene.materials) ++kinds[material.pattern.index()];
    std::string text;
    constexpr std::array names = {"", "textured", "checkered", "with noise"};
    for (std::size_t i = 1; i < names.size(); ++i)
        if (kinds[i] > 0) text += fmt::format(", {} {}", kinds[i], names[i]);
    return text;
}

std::string contents(const Report& report) {
    const Scene& scene = report.imported.scene;
    std::string text;
    for (const ModelInfo& model : report.imported.models)
        text += fmt::format("{} ({}{})\n", one_line(model.file), model.format,
                            model.nodes > 0 ? ", " + counted(model.nodes, "node") : "");
    if (!report.box.empty())
        text += fmt::format("{:<11}({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n",
                            "bounds", report.box.min.x, report.box.min.y, report.box.min.z,
                            report.box.max.x, report.box.max.y, report.box.max.z);
    text += count_line("facets", report.facets);
    text += count_line("meshes", scene.meshes.size(),
                       "in " + counted(scene.instances.size(), "instance"));
    text += count_line("spheres", scene.spheres.size());
    text += count_line("planes", scene.planes.size());
    text += count_line("materials", scene.materials.size(),
                       names_of(scene.materials) + pattern_names(scene));
    text += count_line("textures", scene.textures.size(), names_of(scene.textures));
    text += count_line("lights", scene.lights.size(), light_names(scene));
    text += environment_line(scene);
    text += count_line("cameras", scene.cameras.size(), names_of(scene.cameras));
    if (report.imported.render.exposure != 0)
        text += fmt::format("{:<11}{:+g} EV{}\n", "exposure", report.imported.render.exposure,
                            report.imported.auto_exposure ? ", metered" : "");
    if (report.totals.animations > 0) text += count_line("animations", report.totals.animations);
    if (!report.totals.extensions.empty())
        text += "extensions " +
                one_line(fmt::format("{}", fmt::join(report.totals.extensions, ", "))) + "\n";
    return text;
}

std::string fidelity(const Losses& losses) {
    if (losses.empty()) return "Everything is rendered and exported exactly.\n";
    std::string approximate, dropped;
    for (const Loss& loss : merged(losses))
        (loss.kind == Loss::dropped ? dropped : approximate) +=
            fmt::format("  {}\n", one_line(loss.place + ": " + loss.what));
    std::string text;
    if (!approximate.empty()) text += "approximate:\n" + approximate;
    if (!dropped.empty()) text += "dropped:\n" + dropped;
    return text + "Everything else is rendered and exported exactly.\n";
}

}  // namespace

int info(const Context& context) {
    const Arguments& arguments = context.arguments;
    Report report;
    // The facets are the model's own, not those that normal maps are baked into.
    Arguments unbaked = arguments;
    unbaked.load.normal_maps = NormalMaps::pixel;
    const Context own = {unbaked, context.console, context.stop};
    report.imported = load(own, arguments.inputs);
    meter(own, report.imported);
    Scene& scene = report.imported.scene;
    report.box = bounds(scene);
    report.facets = facet_count(scene);
    report.totals = totals_of(report.imported.models);
    report.losses = report.imported.losses;
    const Losses settled = settle_normal_maps(scene, arguments.load.normal_maps);
    report.losses.insert(report.losses.end(), settled.begin(), settled.end());
    const Losses backs = shown_backs(scene);
    report.losses.insert(report.losses.end(), backs.begin(), backs.end());
    const RenderOptions& options = report.imported.render;
    const Losses exported = pov_losses(normalise(scene, options), options);
    report.losses.insert(report.losses.end(), exported.begin(), exported.end());

    context.console.result(arguments.json ? json_text(document(arguments, report))
                                          : contents(report) + fidelity(report.losses));
    if (arguments.strict) report_losses(context, report.losses);
    return exit_success;
}

}  // namespace penumbra::cli
