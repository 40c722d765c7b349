#include "cli/batch/batch.h"
#include "cli/batch/manifest.h"
#include "cli/batch/scene_case.h"
#include "cli/options/values.h"
#include "cli/steps.h"

#include "penumbra/limits.h"

#include <algorithm>
#include <thread>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;

// Options of the command line that are about many scenes, and take a value.
bool is_of_many(const std::string& word) {
    return word == "--jobs" || word == "--report" || word == "--manifest";
}

// The command that validates one of the inputs alone.
std::vector<std::string> own_words(const Arguments& arguments, const fs::path& input) {
    std::vector<std::string> words;
    const auto is_other = [&](const std::string& word) {
        return word != input.string() && std::find(arguments.inputs.begin(), arguments.inputs.end(),
                                                   fs::path(word)) != arguments.inputs.end();
    };
    for (std::size_t i = 0; i < arguments.words.size(); ++i) {
        const std::string& word = arguments.words[i];
        if (is_of_many(word)) ++i;  // and its value
        const bool of_all = is_of_many(word) || word == "--each" || word == "--fresh" ||
                            word.starts_with("--jobs=") || word.starts_with("--report=") ||
                            word.starts_with("--manifest=") || is_other(word);
        if (!of_all) words.push_back(word);
    }
    return words;
}

std::vector<std::string> own_words(const Arguments& arguments, const ManifestCase& one) {
    std::vector<std::string> words = own_words(arguments, fs::path());
    for (const fs::path& input : one.inputs) words.push_back(input.string());
    if (one.load.sidecar) words.insert(words.end(), {"--sidecar", one.load.sidecar->string()});
    const std::size_t typed = arguments.load.settings.size();
    for (std::size_t i = 0; i + typed < one.load.settings.size(); ++i)
        words.insert(words.end(), {"--set", one.load.settings[i]});
    return words;
}

std::vector<SceneJob> scenes_of(const Arguments& arguments) {
    const bool in_folders = arguments.each || !arguments.renderers.empty();
    Names names;
    std::vector<SceneJob> jobs;
    if (arguments.manifest) {
        for (ManifestCase& one : read_manifest(*arguments.manifest, arguments))
            jobs.push_back({.inputs = one.inputs,
                            .name = one.name,
                            .folder = one.name,
                            .load = one.load,
                            .judging = one.judging,
                            .words = own_words(arguments, one)});
    } else if (arguments.each) {
        for (const fs::path& input : arguments.inputs) {
            const std::string name = names.unused(input.stem().string());
            jobs.push_back({.inputs = {input},
                            .name = name,
                            .folder = name,
                            .load = arguments.load,
                            .judging = arguments.judging,
                            .words = own_words(arguments, input)});
        }
    } else {
        const std::string name = stem_of(arguments);
        jobs.push_back({.inputs = arguments.inputs,
                        .name = name,
                        .folder = in_folders ? names.unused(name) : "",
                        .load = arguments.load,
                        .judging = arguments.judging,
                        .words = arguments.words});
    }
    const int all = arguments.threads > 0 ? arguments.threads
                                          : int(std::max(1U, std::thread::hardware_concurrency()));
    const std::size_t at_once =
        std::max(std::min(std::size_t(arguments.jobs), jobs.size()), std::size_t(1));
    for (SceneJob& job : jobs) {
        job.memory = memory_limit() / at_once;
        job.threads = arguments.jobs > 1 ? std::max(1, all / arguments.jobs) : arguments.threads;
        job.quiet = arguments.jobs > 1;
    }
    return jobs;
}

// A scene that cannot even be read needs no report, only its message; and where nothing can be
// written an earlier report stays.
void stop_without_scene(const Outcome& only) {
    if (only.failure && (only.result.files.empty() || only.status == exit_output))
        std::rethrow_exception(only.failure);
}

fs::path report_of(const Arguments& arguments) {
    if (arguments.report) return *arguments.report;
    if (arguments.manifest) return arguments.manifest->stem().string() + "-report";
    return (arguments.each ? "penumbra" : stem_of(arguments)) + "-report";
}

}  // namespace

int validate(const Context& context) {
    const Arguments& arguments = context.arguments;
    std::vector<SceneJob> scenes = scenes_of(arguments);
    const fs::path report = report_of(arguments);
    check_report(report, arguments.force);
    const std::string povray = povray_version(arguments.povray);
    context.console.detail(povray);
    for (SceneJob& scene : scenes) scene.povray = povray;

    ReportFolder folder(report, arguments.force);
    if (arguments.manifest) folder.protect({&*arguments.manifest, 1});
    for (const SceneJob& scene : scenes)
        if (scene.judging.mask) folder.protect({&*scene.judging.mask, 1});
    std::vector<Job> jobs;
    for (const SceneJob& scene : scenes)
        jobs.push_back({scene.name,
                        [&context, &scene, &folder](std::vector<Case>& cases, bool again) {
                            const bool reuse = again || !context.arguments.fresh;
                            validate_scene(context, scene, folder, {cases, reuse});
                        },
                        [&scene, &folder](Case& one, const Error& crash) {
                            one.folder = scene.folder;
                            keep_failure(crash, folder, one);
                        }});
    const bool alone = scenes.size() == 1 && scenes[0].folder.empty();
    auto outcomes = run_jobs(context, jobs, arguments.jobs, alone);
    const int status = worst_status(outcomes);
    if (!arguments.each && !arguments.manifest) stop_without_scene(outcomes.front());
    const bool failed = alone && outcomes.front().failure;
    const std::vector<Case> cases = cases_of(std::move(outcomes));
    write_report(folder.path(), cases);
    folder.finish();
    if (failed) context.console.error(cases.front().message);
    print_cases(context, cases, report);
    return status;
}

}  // namespace penumbra::cli
