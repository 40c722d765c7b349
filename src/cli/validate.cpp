#include "figures.h"
#include "report_folder.h"
#include "steps.h"
#include "values.h"

#include "penumbra/exporters.h"
#include "penumbra/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <set>
#include <thread>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* stem = "scene";  // of the exported files

// One scene to validate and where its files go.
struct Job {
    std::vector<fs::path> inputs = {};
    std::string name = {};
    std::string folder = {};  // below the report's; empty: the report's own
    int threads = 0;          // 0: all
};

struct Outcome {
    Case result = {};
    int status = exit_internal;
    std::exception_ptr failure = {};
};

std::string in_folder(const Job& job, const std::string& file) {
    return job.folder.empty() ? file : job.folder + "/" + file;
}

// The command that validates this job alone.
std::string own_command(const Arguments& arguments, const Job& job) {
    if (!arguments.each) return shell_command(arguments.words);
    std::vector<std::string> words;
    const auto is_other = [&](const std::string& word) {
        return word != job.inputs[0].string() &&
               std::find(arguments.inputs.begin(), arguments.inputs.end(), fs::path(word)) !=
                   arguments.inputs.end();
    };
    for (std::size_t i = 0; i < arguments.words.size(); ++i) {
        const std::string& word = arguments.words[i];
        if (word == "--jobs" || word == "--report") ++i;  // and its value
        const bool of_all = word == "--each" || word.starts_with("--jobs") ||
                            word.starts_with("--report") || is_other(word);
        if (!of_all) words.push_back(word);
    }
    return shell_command(words);
}

void export_case(const Context& context, const Job& job, const fs::path& folder,
                 const NormalisedScene& scene, const RenderOptions& options, Case& result) {
    const Stopwatch watch;
    const Exported exported = write_pov(scene, options, folder / (std::string(stem) + ".pov"),
                                        {.source = source_of(context.arguments, job.inputs),
                                         .command = own_command(context.arguments, job),
                                         .losses = result.losses});
    result.seconds["export"] = watch.seconds();
    result.losses.insert(result.losses.end(), exported.losses.begin(), exported.losses.end());
    result.files["pov"] = in_folder(job, std::string(stem) + ".pov");
    result.files["ini"] = in_folder(job, std::string(stem) + ".ini");
}

void run_reference(const Context& context, const Job& job, const fs::path& folder,
                   const RenderOptions& options, Case& result) {
    PovrayOptions povray = context.arguments.povray;
    povray.threads = job.threads;
    povray.keep_exr = false;  // ours is of the raw pixels
    const Stopwatch watch;
    PovrayRun run = run_povray(
        folder / (std::string(stem) + ".ini"), options.width, options.height, povray,
        {context.arguments.jobs > 1
             ? std::function<void(double)>{}
             : context.console.progress("povray " + job.name, sample_count(options), " samples"),
         context.stop});
    context.console.clear_progress();
    result.seconds["povray"] = watch.seconds();
    result.reference = std::move(run.image);
    result.povray_log = std::move(run.log);
    save_image(folder / "povray.exr", result.reference);
    result.files["reference"] = in_folder(job, "povray.exr");
}

// Fills `result` step by step, so that a failing step leaves what was found before it.
void run_case(const Context& context, const Job& job, const fs::path& report, Case& result) {
    const Arguments& arguments = context.arguments;
    result.name = job.name;
    result.commands = {own_command(arguments, job), fmt::format("povray {}.ini", stem)};

    const Stopwatch import_time;
    Imported imported = load(context, job.inputs);
    preload_image_module();  // while the picture is rendered
    result.losses = imported.losses;
    report_losses(context, imported.losses);
    const RenderOptions options = imported.render;
    const Color background = imported.scene.background;
    NormalisedScene scene = normalise(std::move(imported.scene), options);
    result.seconds["import"] = import_time.seconds();

    const fs::path folder = job.folder.empty() ? report : report / job.folder;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw Error(Failure::output, folder.string(), error.message());
    export_case(context, job, folder, scene, options, result);
    report_losses(context, {result.losses.begin() + std::ptrdiff_t(imported.losses.size()),
                            result.losses.end()});

    RenderOptions own = options;
    own.threads = job.threads;
    Rendered rendered = render_scene(context, scene, own, "render " + job.name);
    result.test = std::move(rendered.image);
    result.seconds["render"] = rendered.build_seconds + rendered.render_seconds;
    scene = {};
    save_image(folder / "ours.exr", result.test);
    result.files["test"] = in_folder(job, "ours.exr");

    run_reference(context, job, folder, options, result);
    const Stopwatch compare_time;
    // Exposure brightens the background as well.
    const Color seen = background * float(std::exp2(options.exposure));
    result.comparison = penumbra::compare(result.test, result.reference, {arguments.limits, seen});
    result.seconds["compare"] = compare_time.seconds();
    save_maps(report, job.folder, result);
}

Outcome outcome_of(const Context& context, const Job& job, const fs::path& report) {
    Outcome outcome;
    const auto fail = [&](int status, const std::string& message) {
        outcome.status = status;
        outcome.failure = std::current_exception();
        outcome.result.message = message;
        outcome.result.comparison.verdict = Verdict::error;
    };
    try {
        run_case(context, job, report, outcome.result);
        outcome.status = verdict_status(outcome.result.comparison.verdict);
    } catch (const Error& error) {
        // With several scenes a setting that does not suit one of them is that scene's fault.
        fail(error.failure == Failure::usage ? exit_input : exit_status(error.failure),
             error.what());
    } catch (const std::exception& error) {
        fail(exit_internal, fmt::format("internal error: {}", error.what()));
    }
    return outcome;
}

// "chair", "chair-2", ... : names of cases and of their folders.
std::string unused_name(const fs::path& input, std::set<std::string>& used) {
    const std::string first = input.stem().string().empty() ? "scene" : input.stem().string();
    std::string name = first;
    for (int i = 2; !used.insert(name).second; ++i) name = fmt::format("{}-{}", first, i);
    return name;
}

std::vector<Job> jobs_of(const Arguments& arguments) {
    if (!arguments.each) return {{arguments.inputs, stem_of(arguments), "", arguments.threads}};
    const int all = arguments.threads > 0 ? arguments.threads
                                          : int(std::max(1U, std::thread::hardware_concurrency()));
    const int threads = arguments.jobs > 1 ? std::max(1, all / arguments.jobs) : arguments.threads;
    std::vector<Job> jobs;
    std::set<std::string> used = {"index.html", "report.json", "junit.xml"};
    for (const fs::path& input : arguments.inputs) {
        const std::string name = unused_name(input, used);
        jobs.push_back({{input}, name, name, threads});
    }
    return jobs;
}

std::vector<Outcome> run_all(const Context& context, const std::vector<Job>& jobs,
                             const fs::path& report) {
    std::vector<Outcome> outcomes(jobs.size());
    std::atomic<std::size_t> next = 0, done = 0;
    const auto worker = [&] {
        for (std::size_t i = next++; i < jobs.size(); i = next++) {
            if (context.stop.stop_requested()) return;
            outcomes[i] = outcome_of(context, jobs[i], report);
            const std::string& message = outcomes[i].result.message;
            if (!message.empty() && jobs.size() > 1 && !context.stop.stop_requested())
                context.console.error(message);
            if (jobs.size() > 1)
                context.console.detail(
                    fmt::format("{} of {}: {} {}", ++done, jobs.size(), jobs[i].name,
                                to_string(outcomes[i].result.comparison.verdict)));
        }
    };
    {
        std::vector<std::jthread> helpers;
        for (int i = 1; i < context.arguments.jobs; ++i) helpers.emplace_back(worker);
        worker();
    }
    if (context.stop.stop_requested()) throw Error(Failure::interrupted, "", "interrupted");
    return outcomes;
}

int worst_status(const std::vector<Outcome>& outcomes) {
    constexpr std::array order = {exit_internal,       exit_povray,    exit_output, exit_input,
                                  exit_not_comparable, exit_different, exit_success};
    for (const int status : order)
        for (const Outcome& outcome : outcomes)
            if (outcome.status == status) return status;
    return exit_internal;
}

// A scene that cannot even be read needs no report, only its message.
void stop_without_scene(const Arguments& arguments, const std::vector<Outcome>& outcomes) {
    const Outcome& only = outcomes.front();
    if (!arguments.each && only.failure && only.result.files.empty())
        std::rethrow_exception(only.failure);
}

void print(const Context& context, const std::vector<Case>& cases, const fs::path& report) {
    if (context.arguments.json) return context.console.result(report_json(cases));
    std::string text = context.arguments.each ? overview(cases) : figures(cases.front());
    context.console.result(text + fmt::format("report: {}\n", (report / "index.html").string()));
}

}  // namespace

int validate(const Context& context) {
    const Arguments& arguments = context.arguments;
    const std::string name = arguments.each ? "penumbra" : stem_of(arguments);
    const fs::path report = arguments.report.value_or(name + "-report");
    check_report(report);
    context.console.detail(povray_version(arguments.povray));

    ReportFolder folder(report);
    const auto outcomes = run_all(context, jobs_of(arguments), folder.path());
    stop_without_scene(arguments, outcomes);
    std::vector<Case> cases;
    for (const Outcome& outcome : outcomes) cases.push_back(outcome.result);
    write_report(folder.path(), cases);
    folder.finish();
    if (!arguments.each && outcomes.front().failure)
        context.console.error(outcomes.front().result.message);
    print(context, cases, report);
    return worst_status(outcomes);
}

}  // namespace penumbra::cli
