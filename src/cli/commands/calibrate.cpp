#include "cli/batch/batch.h"
#include "cli/batch/picture_pairs.h"
#include "cli/steps.h"

#include "penumbra/picture.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace penumbra::cli {
namespace {

std::vector<Comparison> measured(const Context& context, const std::vector<PicturePair>& pairs) {
    std::vector<Comparison> result;
    for (const PicturePair& pair : pairs) {
        if (context.stop.stop_requested()) throw Error(Failure::interrupted, "", "interrupted");
        if (pair.test.empty() || pair.reference.empty()) {
            context.console.warning(
                fmt::format("{}: has no counterpart and is left out",
                            (pair.test.empty() ? pair.reference : pair.test).string()));
            continue;
        }
        const bool ignore_alpha = context.arguments.ignore_alpha;
        const Picture test = load_picture(pair.test, ignore_alpha);
        const Picture reference = load_picture(pair.reference, ignore_alpha);
        report_losses(context, test.losses);
        report_losses(context, reference.losses);
        Comparison comparison = penumbra::compare(test, reference, {.limits = {{}}});
        comparison.flip_map = {};
        if (comparison.verdict == Verdict::not_comparable) {
            context.console.warning(
                fmt::format("{}: is left out: {}", pair.name, comparison.diagnosis.front()));
            continue;
        }
        result.push_back(std::move(comparison));
    }
    return result;
}

std::string text_of(const Limits& limits, std::size_t pairs) {
    std::string text = fmt::format("limits that {} known-good pair{} meet{}:\n", pairs,
                                   pairs == 1 ? "" : "s", pairs == 1 ? "s" : "");
    std::string options, table;
    for (const auto& [metric, limit] : limits.limits) {
        text += fmt::format("  {:<16} {:.6g}\n", metric, limit);
        options += fmt::format(" --limit {}={:.6g}", metric, limit);
        table += fmt::format("{}{} = {:.6g}", table.empty() ? "" : ", ", metric, limit);
    }
    return text + "as options:" + options + "\nin a manifest: limits = { " + table + " }\n";
}

}  // namespace

int calibrate(const Context& context) {
    const Arguments& arguments = context.arguments;
    std::vector<Comparison> good;
    for (std::size_t i = 0; i + 1 < arguments.inputs.size(); i += 2)
        for (Comparison& comparison :
             measured(context, picture_pairs(arguments.inputs[i], arguments.inputs[i + 1])))
            good.push_back(std::move(comparison));
    if (good.empty())
        throw Error(Failure::input, "", "no pair of pictures can be compared; no limits follow");
    const Limits limits = calibrated_limits(good, arguments.margin);
    if (!arguments.json) {
        context.console.result(text_of(limits, good.size()));
        return exit_success;
    }
    nlohmann::ordered_json document = {
        {"version", 1}, {"pairs", good.size()}, {"margin", arguments.margin}};
    for (const auto& [metric, limit] : limits.limits) document["limits"][metric] = limit;
    context.console.result(json_text(document));
    return exit_success;
}

}  // namespace penumbra::cli
