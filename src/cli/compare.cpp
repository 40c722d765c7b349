#include "figures.h"
#include "report_folder.h"
#include "steps.h"
#include "values.h"

#include "penumbra/image.h"

#include <fmt/format.h>

namespace penumbra::cli {

int compare(const Context& context) {
    const Arguments& arguments = context.arguments;
    if (arguments.report) check_report(*arguments.report);

    Case result;
    result.test_name = arguments.inputs[0].string();
    result.reference_name = arguments.inputs[1].string();
    result.name = fmt::format("{} vs {}", arguments.inputs[0].filename().string(),
                              arguments.inputs[1].filename().string());
    result.commands = {shell_command(arguments.words)};
    result.test = load_image(arguments.inputs[0]);
    result.reference = load_image(arguments.inputs[1]);
    const Stopwatch watch;
    result.comparison =
        penumbra::compare(result.test, result.reference, {arguments.limits, arguments.background});
    result.seconds["compare"] = watch.seconds();
    const int status = verdict_status(result.comparison.verdict);

    if (arguments.report) {
        ReportFolder folder(*arguments.report);
        save_maps(folder.path(), "", result);
        write_report(folder.path(), {result});
        if (context.stop.stop_requested()) throw Error(Failure::interrupted, "", "interrupted");
        folder.finish();
    }
    if (arguments.json)
        context.console.result(report_json({result}));
    else
        context.console.result(figures(result));
    if (arguments.report && !arguments.json)
        context.console.result(
            fmt::format("report: {}\n", (*arguments.report / "index.html").string()));
    return status;
}

}  // namespace penumbra::cli
