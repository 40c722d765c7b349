#include "plain_text.h"
#include "steps.h"
#include "values.h"

#include "penumbra/exporters.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace penumbra::cli {

int export_scene(const Context& context) {
    const Arguments& arguments = context.arguments;
    const bool include = arguments.pov_style == PovStyle::include;
    const std::filesystem::path output =
        arguments.output.value_or(stem_of(arguments) + (include ? ".inc" : ".pov"));
    if (output.extension() != ".pov" && !(include && output.extension() == ".inc"))
        throw Error(Failure::output, output.string(),
                    include ? "the name of an include file of POV-Ray ends in .inc or .pov"
                            : "the name of a POV-Ray scene ends in .pov");
    check_writable(output);

    Imported imported = load(context, arguments.inputs);
    Losses losses = imported.losses;
    report_losses(context, losses);
    const NormalisedScene scene = normalise(std::move(imported.scene), imported.render);
    const Exported exported = write_pov(scene, imported.render, output,
                                        {.style = arguments.pov_style,
                                         .source = source_of(arguments, arguments.inputs),
                                         .command = shell_command(arguments.words),
                                         .losses = imported.losses});
    report_losses(context, exported.losses);
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
