#include "cli/batch/batch.h"
#include "cli/batch/picture_pairs.h"
#include "cli/options/values.h"
#include "cli/steps.h"

#include "penumbra/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;

CompareOptions options_of(const Context& context) {
    CompareOptions options = compare_options(context.arguments.judging);
    options.background = context.arguments.background;
    options.exposure = context.arguments.exposure;
    return options;
}

// The command that compares this pair alone.
std::string own_command(const Arguments& arguments, const PicturePair& pair) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < arguments.words.size(); ++i) {
        const std::string& word = arguments.words[i];
        if (word == "--report" || word == "--jobs") ++i;  // and its value
        if (word == "--report" || word == "--jobs" || word.starts_with("--report=") ||
            word.starts_with("--jobs="))
            continue;
        words.push_back(word == arguments.inputs[0].string()   ? pair.test.string()
                        : word == arguments.inputs[1].string() ? pair.reference.string()
                                                               : word);
    }
    return shell_command(words);
}

void brighten(Image& image, double exposure) {
    if (exposure == 0) return;
    for (Color& color : image.pixels) color *= float(std::exp2(exposure));
}

void compare_pair(const Context& context, const CompareOptions& options, const PicturePair& pair,
                  Case& result) {
    result.test_name = pair.test.string();
    result.reference_name = pair.reference.string();
    if (pair.test.empty())
        throw Error(Failure::input, pair.reference.string(),
                    "has no counterpart in " + context.arguments.inputs[0].string());
    if (pair.reference.empty())
        throw Error(Failure::input, pair.test.string(),
                    "has no counterpart in " + context.arguments.inputs[1].string());
    Picture test = load_picture(pair.test, context.arguments.ignore_alpha);
    Picture reference = load_picture(pair.reference, context.arguments.ignore_alpha);
    result.losses = test.losses;
    result.losses.insert(result.losses.end(), reference.losses.begin(), reference.losses.end());
    report_losses(context, result.losses);
    const Stopwatch watch;
    result.comparison = penumbra::compare(test, reference, options);
    result.seconds["compare"] = watch.seconds();
    result.test = std::move(test.colors);
    result.reference = std::move(reference.colors);
    brighten(result.test, options.exposure);  // as it was judged, for the report
    brighten(result.reference, options.exposure);
}

// "a/b.png" -> "a_b.png": one folder a case.
std::string folder_name(std::string name) {
    std::ranges::replace(name, '/', '_');
    return name.starts_with('.') ? '_' + name : name;
}

}  // namespace

int compare(const Context& context) {
    const Arguments& arguments = context.arguments;
    if (arguments.report) check_report(*arguments.report, arguments.force);
    const auto pairs = picture_pairs(arguments.inputs[0], arguments.inputs[1]);
    const bool several = fs::is_directory(arguments.inputs[0]);
    const CompareOptions options = options_of(context);
    std::optional<ReportFolder> report;
    if (arguments.report) report.emplace(*arguments.report, arguments.force);

    for (const PicturePair& pair : pairs)
        if (report) report->protect(std::array{pair.test, pair.reference});
    if (report && arguments.judging.mask) report->protect({&*arguments.judging.mask, 1});

    std::vector<Job> jobs;
    Names names;
    for (const PicturePair& pair : pairs) {
        const std::string folder = several ? names.unused(folder_name(pair.name)) : "";
        jobs.push_back({pair.name, [&, pair, folder](std::vector<Case>& cases, bool) {
                            Case& result = cases[0];
                            result.folder = folder;
                            result.commands = {several ? own_command(arguments, pair)
                                                       : shell_command(arguments.words)};
                            compare_pair(context, options, pair, result);
                            if (!report) return;
                            save_maps(report->path(), result);
                            if (several) write_case_page(report->path() / folder, result, "..");
                        }});
    }
    auto outcomes = run_jobs(context, jobs, arguments.jobs, !several);
    const int status = worst_status(outcomes);
    if (!several && outcomes.front().failure) std::rethrow_exception(outcomes.front().failure);
    const std::vector<Case> cases = cases_of(std::move(outcomes));
    if (report) {
        write_report(report->path(), cases);
        report->finish();
    }
    print_cases(context, cases, arguments.report);
    return status;
}

}  // namespace penumbra::cli
