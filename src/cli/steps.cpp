#include "cli/steps.h"

#include "base/loss_tally.h"
#include "base/text/text.h"

#include "penumbra/image.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;

// Messages about the library's options name ours: --set, or the option that a setting stands for.
std::string in_users_words(const Arguments& arguments, const LoadOptions& options,
                           const Error& error) {
    const std::string message = error.what();
    const auto renamed = [&](const std::string& place, const std::string& ours) {
        return message.starts_with(place + ": ") ? ours + message.substr(place.size()) : "";
    };
    for (const std::string& setting : options.settings) {
        const auto origin = arguments.origins.find(setting);
        const std::string typed =
            origin == arguments.origins.end() ? "--set " + printable(setting) : origin->second;
        std::string text = renamed("setting '" + printable(setting) + "'", typed);
        if (!text.empty()) return text;
    }
    const std::string text = renamed("allowed_paths", "--allow-path");
    return text.empty() ? message : text;
}

}  // namespace

Imported load(const Context& context, const std::vector<fs::path>& inputs) {
    return load(context, inputs, context.arguments.load);
}

Imported load(const Context& context, const std::vector<fs::path>& inputs,
              const LoadOptions& options) {
    const Arguments& arguments = context.arguments;
    try {
        Imported imported = load_scene(inputs, options);
        imported.render.threads = arguments.threads;
        // An average hides differences, and POV-Ray is slow.
        if (!imported.sampled && arguments.command != Command::validate)
            imported.render.antialiasing = Antialiasing();
        return imported;
    } catch (const Error& error) {
        throw Error(error.failure, "", in_users_words(arguments, options, error), error.remedy);
    }
}

std::unique_ptr<Metered> meter(const Context& context, Imported& imported) {
    RenderOptions& options = imported.render;
    if (!imported.auto_exposure) return nullptr;
    options.exposure = 0;
    auto metered = std::make_unique<Metered>(normalise(imported.scene, options), options.threads);
    options.exposure = metered_exposure(metered->tracer(), options, {.stop = context.stop});
    context.console.detail(fmt::format("exposure: {:+.2f} EV, metered", options.exposure));
    if (imported.plain_background) imported.scene.background *= float(std::exp2(-options.exposure));
    return metered;
}

CompareOptions compare_options(const Judging& judging) {
    CompareOptions options = {.limits = judging.limits,
                              .ignored = judging.ignored,
                              .shift_tolerance = judging.shift_tolerance};
    if (judging.mask) options.mask = load_image(*judging.mask);
    return options;
}

void report_losses(const Context& context, const Losses& losses) {
    context.console.losses(losses);
    if (context.arguments.strict && !losses.empty())
        throw Error(
            Failure::input, "",
            fmt::format("{} thing{} cannot be carried over and --strict is given; the first "
                        "is {}: {}",
                        losses.size(), losses.size() == 1 ? "" : "s", losses[0].place,
                        losses[0].what));
}

void check_writable(const fs::path& file) {
    std::error_code ignored;
    if (fs::is_directory(file, ignored))
        throw Error(Failure::output, file.string(), "cannot write: is a folder");
    const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!fs::exists(folder, ignored))
        throw Error(Failure::output, file.string(), "its folder does not exist");
    if (!fs::is_directory(folder, ignored))
        throw Error(Failure::output, file.string(),
                    fmt::format("'{}' is not a folder", folder.string()));
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        throw Error(Failure::output, file.string(),
                    fmt::format("cannot write in its folder: {}", std::strerror(errno)));
}

std::string stem_of(const Arguments& arguments) {
    const fs::path first = arguments.inputs.empty() ? *arguments.load.sidecar : arguments.inputs[0];
    const std::string stem = first.stem().string();
    return stem.empty() ? "scene" : stem;
}

std::string source_of(const Arguments& arguments, const std::vector<fs::path>& inputs) {
    std::string source;
    const auto add = [&](const fs::path& file) {
        source += (source.empty() ? "" : " ") + file.string();
    };
    for (const fs::path& file : inputs) add(file);
    if (arguments.load.sidecar) add(*arguments.load.sidecar);
    return source;
}

Work work_of(const RenderOptions& options) {
    const double pixels = double(options.width) * options.height;
    if (options.antialiasing) return {pixels, " pixels"};
    const double grid = options.samples > 1 ? double(options.samples) * options.samples + 1 : 1;
    return {pixels * grid, " samples"};
}

Rendered render_scene(const Context& context, const NormalisedScene& scene,
                      const RenderOptions& options, Metered* metered, const std::string& name,
                      bool quiet) {
    std::function<void(double)> show;
    const Work work = work_of(options);
    if (!quiet) show = context.console.progress(name, work.count, work.unit);
    Rendered result;
    Stopwatch time;
    const auto progress = [&](double done) {
        if (done == 0) {
            result.build_seconds = time.seconds();
            time = {};
        }
        if (show) show(done);
    };
    std::optional<Tracer> own;
    if (!metered) own.emplace(scene, options.threads);
    const Tracer& tracer = metered ? metered->tracer_for(scene) : *own;
    result.image = tracer.render(options, {}, {progress, context.stop});
    result.render_seconds = time.seconds();
    context.console.clear_progress();
    result.subject = tracer.subject_seen(options);
    return result;
}

nlohmann::ordered_json losses_json(const Losses& losses) {
    auto list = nlohmann::ordered_json::array();
    for (const Loss& loss : merged(losses))
        list.push_back({{"place", loss.place},
                        {"what", loss.what},
                        {"kind", to_string(loss.kind)},
                        {"count", loss.count}});
    return list;
}

std::string json_text(const nlohmann::ordered_json& document) {
    return plain_json(
               document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) +
           '\n';
}

}  // namespace penumbra::cli
