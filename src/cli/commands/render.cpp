#include "base/file.h"
#include "base/text/text.h"
#include "cli/batch/case_cache.h"
#include "cli/steps.h"

#include "penumbra/image_module.h"
#include "penumbra/render_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <memory>

namespace penumbra::cli {
namespace {

void check_picture(const std::filesystem::path& file, int bits) {
    if (!can_save_image(file))
        throw Error(Failure::output, file.string(),
                    "unknown picture format (use .png, .exr, .tif, .jpg or .hdr)");
    const std::string extension = lower_extension(file);
    if (bits == 16 && extension != ".png" && extension != ".tif" && extension != ".tiff")
        throw Error(Failure::usage, "--depth",
                    fmt::format("16 bits are for .png and .tif, not {}", extension));
    check_writable(file);
}

}  // namespace

int render(const Context& context) {
    const Arguments& arguments = context.arguments;
    const std::filesystem::path output = arguments.output.value_or(stem_of(arguments) + ".png");
    check_picture(output, arguments.bits);

    const Stopwatch import_time;
    Imported imported = load(context, arguments.inputs);
    NormalisedScene scene;  // outlives the trees
    const std::unique_ptr<Metered> metered = meter(context, imported);
    check_not_input(output, imported.files);
    if (lower_extension(output) != ".png") preload_image_module();  // while the picture is rendered
    report_losses(context, imported.losses);
    const RenderOptions options = imported.render;
    scene = normalise(std::move(imported.scene), options);
    const double import_seconds = import_time.seconds();

    // The bar and its rate count what is rendered now.
    const Work work = work_of(options);
    auto bar = context.console.progress("render", work.count, work.unit);
    const auto resumed = [&](int rows) {
        const double rest = work.count * (options.height - rows) / options.height;
        bar = context.console.progress("render", rest, work.unit);
        context.console.detail(
            fmt::format("{} of {} rows are from the checkpoint", rows, options.height));
    };
    std::function<void(double)> progress;
    if (bar) progress = [&](double share) { bar(share); };
    const RenderFileOptions how = {.save = {arguments.bits},
                                   .checkpoint_interval = arguments.checkpoint_interval,
                                   .resume = arguments.resume,
                                   .resumed = resumed,
                                   .program = program_key};
    const Watch watch = {progress, context.stop};
    const RenderedFile done =
        metered ? render_file(metered->tracer_for(scene), options, output, how, watch)
                : render_file(scene, options, output, how, watch);
    context.console.clear_progress();
    if (!done.warning.empty()) context.console.warning(done.warning);

    if (arguments.json) {
        context.console.result(json_text({{"version", 1},
                                          {"file", output.string()},
                                          {"width", options.width},
                                          {"height", options.height},
                                          {"resumed_rows", done.resumed_rows},
                                          {"seconds",
                                           {{"import", import_seconds},
                                            {"build", done.build_seconds},
                                            {"render", done.render_seconds}}},
                                          {"losses", losses_json(imported.losses)}}));
    } else if (!arguments.quiet) {
        context.console.result(fmt::format("{}: {} x {} pixels in {:.2f} s\n", output.string(),
                                           options.width, options.height,
                                           done.build_seconds + done.render_seconds));
    }
    return exit_success;
}

}  // namespace penumbra::cli
