#include "base/file.h"
#include "cli/batch/case_cache.h"
#include "cli/steps.h"

#include "penumbra/image_module.h"
#include "penumbra/render_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <functional>

namespace penumbra::cli {
namespace {

void check_picture(const std::filesystem::path& file, int bits) {
    if (!can_save_image(file))
        throw Error(Failure::output, file.string(),
                    "unknown picture format (use .png, .exr, .tif, .jpg or .hdr)");
    const std::string extension = file.extension().string();
    if (bits == 16 && extension.find_first_of("pPtT") != 1)
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
    check_not_input(output, imported.files);
    if (output.extension() != ".png") preload_image_module();  // while the picture is rendered
    report_losses(context, imported.losses);
    const RenderOptions options = imported.render;
    const NormalisedScene scene = normalise(std::move(imported.scene), options);
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
    const RenderedFile done = render_file(scene, options, output,
                                          {.save = {arguments.bits},
                                           .checkpoint_interval = arguments.checkpoint_interval,
                                           .resume = arguments.resume,
                                           .resumed = resumed,
                                           .program = program_key},
                                          {progress, context.stop});
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
