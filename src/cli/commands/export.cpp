#include "base/text/text.h"
#include "cli/options/values.h"
#include "cli/steps.h"

#include "penumbra/exporters.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace penumbra::cli {

int export_scene(const Context& context) {
    const Arguments& arguments = context.arguments;
    const bool include = arguments.pov_style == PovStyle::include;
    const std::filesystem::path output =
        arguments.output.value_or(stem_of(arguments) + (include ? ".inc" : ".pov"));
    ExportOptions options = {.inputs = arguments.inputs,
                             .replace = arguments.force,
                             .pov_style = arguments.pov_style,
                             .source = source_of(arguments, arguments.inputs),
                             .command = shell_command(arguments.words)};
    check_export_file(output, options);
    check_writable(output);

    Imported imported = load(context, arguments.inputs);
    meter(context, imported);
    Losses losses = imported.losses;
    report_losses(context, losses);
    const NormalisedScene scene = normalise(std::move(imported.scene), imported.render);
    options.inputs = imported.files;
    options.losses = losses;
    const Exported exported = penumbra::export_scene(scene, imported.render, output, options);
    report_losses(context, exported.losses);
    for (const auto& file : exported.removed)
        context.console.detail(
            fmt::format("{}: removed, as this export does not need it", file.string()));
    losses.insert(losses.end(), exported.losses.begin(), exported.losses.end());

    if (arguments.json) {
        auto files = nlohmann::ordered_json::array();
        for (const auto& file : exported.files) files.push_back(file.string());
        context.console.result(
            json_text({{"version", 1}, {"files", files}, {"losses", losses_json(losses)}}));
    } else if (!arguments.quiet) {
        std::string text;
        for (const auto& file : exported.files) text += one_line(file.string()) + '\n';
        context.console.result(text);
    }
    return exit_success;
}

}  // namespace penumbra::cli
