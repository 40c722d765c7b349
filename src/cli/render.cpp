#include "steps.h"

#include "penumbra/image.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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
    if (output.extension() != ".png") preload_image_module();  // while the picture is rendered
    report_losses(context, imported.losses);
    const RenderOptions options = imported.render;
    const NormalisedScene scene = normalise(std::move(imported.scene), options);
    const double import_seconds = import_time.seconds();

    const auto& [image, build_seconds, render_seconds] =
        render_scene(context, scene, options, "render");
    if (context.stop.stop_requested()) throw Error(Failure::interrupted, "", "interrupted");
    save_image(output, image, {arguments.bits});

    if (arguments.json) {
        context.console.result(json_text(
            {{"version", 1},
             {"file", output.string()},
             {"width", image.width},
             {"height", image.height},
             {"seconds",
              {{"import", import_seconds}, {"build", build_seconds}, {"render", render_seconds}}},
             {"losses", losses_json(imported.losses)}}));
    } else if (!arguments.quiet) {
        context.console.result(fmt::format("{}: {} x {} pixels in {:.2f} s\n", output.string(),
                                           image.width, image.height,
                                           build_seconds + render_seconds));
    }
    return exit_success;
}

}  // namespace penumbra::cli
