#include "scene_case.h"

#include "renderer.h"
#include "steps.h"
#include "values.h"

#include "penumbra/exporters.h"
#include "penumbra/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* stem = "scene";  // of the exported files

// A scene that is ready for both renderers.
struct Prepared {
    NormalisedScene scene = {};
    RenderOptions options = {};
    Color background = {};  // as it is seen: exposure brightens it as well
    Losses losses = {};
};

Prepared prepare(const Context& context, const SceneJob& job) {
    Imported imported = load(context, job.inputs, job.load);
    Prepared result = {.options = imported.render, .losses = std::move(imported.losses)};
    result.options.threads = job.threads;
    result.background = imported.scene.background * float(std::exp2(imported.render.exposure));
    result.scene = normalise(std::move(imported.scene), result.options);
    return result;
}

// One scene's way through all steps.
class SceneRun {
  public:
    SceneRun(const Context& with, const SceneJob& of, ReportFolder& into, const SceneCases& to)
        : context(with), job(of), report(into), cases(to.cases), reuse(to.reuse),
          compared_by(compare_options(of.judging)) {
        cases[0].name = job.name;
        cases[0].folder = job.folder;
        cases[0].commands = {shell_command(job.words), fmt::format("povray {}.ini", stem)};
    }

    void run() {
        const Stopwatch import_time;
        prepared = prepare(context, job);
        cases[0].losses = prepared.losses;
        cases[0].seconds["import"] = import_time.seconds();
        report_losses(context, prepared.losses);
        compared_by.background = prepared.background;
        make_folder(job.folder);
        export_scene();
        const CaseKey key = job.folder.empty() ? CaseKey() : key_of_case();
        if (!job.folder.empty() && reuse && restore(key)) return;
        preload_image_module();  // while the picture is rendered
        render_ours();
        run_povray_on_it();
        judge(cases[0]);
        for (const OtherRenderer& renderer : context.arguments.renderers) run_other(renderer);
        keep(key);
    }

  private:
    const Context& context;
    const SceneJob& job;
    ReportFolder& report;
    std::vector<Case>& cases;
    bool reuse;
    CompareOptions compared_by;
    Prepared prepared = {};

    fs::path folder() const { return report.path() / job.folder; }

    void make_folder(const std::string& name) {
        std::error_code error;
        fs::create_directories(report.path() / name, error);
        if (error) throw Error(Failure::output, (report.path() / name).string(), error.message());
    }

    void export_scene() {
        const Stopwatch watch;
        Case& own = cases[0];
        const Exported exported =
            write_pov(prepared.scene, prepared.options, folder() / (std::string(stem) + ".pov"),
                      {.source = source_of(context.arguments, job.inputs),
                       .command = shell_command(job.words),
                       .losses = own.losses});
        own.seconds["export"] = watch.seconds();
        report_losses(context, exported.losses);
        own.losses.insert(own.losses.end(), exported.losses.begin(), exported.losses.end());
        own.files["pov"] = in_report(own, std::string(stem) + ".pov");
        own.files["ini"] = in_report(own, std::string(stem) + ".ini");
    }

    void render_ours() {
        Rendered rendered = render_scene(context, prepared.scene, prepared.options,
                                         "render " + job.name, job.quiet);
        cases[0].test = std::move(rendered.image);
        cases[0].seconds["render"] = rendered.build_seconds + rendered.render_seconds;
        save_image(folder() / "ours.exr", cases[0].test);
        cases[0].files["test"] = in_report(cases[0], "ours.exr");
    }

    void run_povray_on_it() {
        Case& own = cases[0];
        PovrayOptions povray = context.arguments.povray;
        povray.threads = job.threads;
        povray.memory = job.memory;
        povray.keep_exr = false;  // ours is of the raw pixels
        std::function<void(double)> progress;
        if (!job.quiet)
            progress = context.console.progress("povray " + job.name,
                                                sample_count(prepared.options), " samples");
        const Stopwatch watch;
        PovrayRun run = run_povray(folder() / (std::string(stem) + ".ini"), prepared.options.width,
                                   prepared.options.height, povray, {progress, context.stop});
        context.console.clear_progress();
        own.seconds["povray"] = watch.seconds();
        own.reference = std::move(run.image);
        own.povray_log = std::move(run.log);
        save_image(folder() / "povray.exr", own.reference);
        own.files["reference"] = in_report(own, "povray.exr");
    }

    // A further renderer's failure is that of its own case.
    void run_other(const OtherRenderer& renderer) {
        Case other;
        other.name = fmt::format("{} [{}]", job.name, renderer.name);
        other.folder = fmt::format("{}@{}", job.folder, renderer.name);
        other.reference_name = renderer.name;
        other.test = cases[0].test;
        other.files["test"] = cases[0].files["test"];
        other.commands = {shell_command(job.words), shell_command(renderer.words)};
        make_folder(other.folder);
        std::vector<fs::path> scene = job.inputs;
        if (job.load.sidecar) scene.push_back(*job.load.sidecar);
        try {
            OtherPicture picture = run_renderer(renderer,
                                                {.pov = folder() / (std::string(stem) + ".pov"),
                                                 .scene = scene,
                                                 .folder = report.path() / other.folder,
                                                 .width = prepared.options.width,
                                                 .height = prepared.options.height,
                                                 .timeout = context.arguments.povray.timeout,
                                                 .memory = job.memory},
                                                {.stop = context.stop});
            other.reference = std::move(picture.image);
            other.povray_log = std::move(picture.log);
            other.seconds["render"] = picture.seconds;
            other.files["reference"] = in_report(other, picture.file);
            judge(other);
        } catch (const Error& error) {
            if (error.failure == Failure::interrupted) throw;
            other.message = report.with_final_names(error.what());
            other.comparison.verdict = Verdict::error;
        }
        cases.push_back(std::move(other));
    }

    void judge(Case& one) {
        const Stopwatch watch;
        one.comparison = penumbra::compare(one.test, one.reference, compared_by);
        if (one.comparison.verdict == Verdict::fail)
            explain(prepared.scene, prepared.options, one.test,
                    masked_reference(one.test, one.reference, compared_by), one.comparison,
                    {.stop = context.stop});
        one.seconds["compare"] = watch.seconds();
        save_maps(report.path(), one);
    }

    // ---- earlier runs

    CaseKey key_of_case() const {
        const RenderOptions& o = prepared.options;
        Hash pictures, verdict;
        pictures.add(program_key());
        pictures.add(job.povray);
        pictures.add(fmt::format("{} {} {} {} {} {}", o.width, o.height, o.samples, o.max_depth,
                                 o.exposure, int(job.load.normal_maps)));
        for (const OtherRenderer& renderer : context.arguments.renderers) {
            pictures.add(renderer.name);
            for (const std::string& word : renderer.words) pictures.add(word);
        }
        pictures.add_folder(folder());
        const Limits& limits = job.judging.limits;
        verdict.add(fmt::format("{} {}", limits.warn_band, job.judging.shift_tolerance));
        for (const auto& [name, limit] : limits.limits)
            verdict.add(fmt::format("{} {}", name, limit));
        for (const PixelBox& b : job.judging.ignored)
            verdict.add(fmt::format("{} {} {} {}", b.x0, b.y0, b.x1, b.y1));
        if (job.judging.mask) verdict.add_file(*job.judging.mask);
        return {pictures.text(), verdict.text()};
    }

    bool restore(const CaseKey& key) {
        auto cached = cached_cases(report.final_path() / job.folder);
        if (!cached || cached->key.pictures != key.pictures) return false;
        const auto there = [&](const Case& one) {
            std::error_code ignored;
            for (const auto& [role, file] : one.files)
                if (!fs::exists(report.final_path() / file, ignored)) return false;
            return fs::exists(report.final_path() / one.folder / "index.html", ignored);
        };
        if (!std::ranges::all_of(cached->cases, there)) return false;
        for (Case& one : cached->cases) one.cached = true;
        if (cached->key == key) {
            cases = std::move(cached->cases);
            std::error_code ignored;
            fs::remove_all(folder(), ignored);
            return true;
        }
        return judge_again(std::move(cached->cases), key);
    }

    // The pictures are the same, the limits are not.
    bool judge_again(std::vector<Case> earlier, const CaseKey& key) {
        for (Case& one : earlier) {
            make_folder(one.folder);
            if (one.comparison.verdict == Verdict::error) continue;
            one.test = load_image(report.final_path() / one.files.at("test"));
            one.reference = load_image(report.final_path() / one.files.at("reference"));
            for (const char* role : {"test", "reference"}) {
                std::error_code error;
                const fs::path& file = one.files.at(role);
                fs::copy_file(report.final_path() / file, report.path() / file,
                              fs::copy_options::skip_existing, error);
                if (error) throw Error(Failure::output, file.string(), error.message());
            }
            judge(one);
        }
        cases = std::move(earlier);
        keep(key);
        return true;
    }

    // A scene of several is complete when its folder has its name.
    void keep(const CaseKey& key) {
        if (job.folder.empty()) return;
        for (Case& one : cases) write_case_page(report.path() / one.folder, one, "..");
        store_cases(folder(), {key, cases});
        for (std::size_t i = cases.size(); i-- > 0;) report.publish(cases[i].folder);
    }
};

}  // namespace

void keep_failure(const Error& error, ReportFolder& report, Case& failed) {
    if (failed.folder.empty() || error.failure == Failure::interrupted) return;
    failed.message = error.what();
    failed.comparison.verdict = Verdict::error;
    std::error_code ignored;
    fs::create_directories(report.path() / failed.folder, ignored);
    write_case_page(report.path() / failed.folder, failed, "..");
    report.publish(failed.folder);
}

void validate_scene(const Context& context, const SceneJob& job, ReportFolder& report,
                    const SceneCases& into) {
    std::vector<Case>& cases = into.cases;
    cases[0].folder = job.folder;
    try {
        SceneRun(context, job, report, into).run();
    } catch (const Error& error) {
        const Error named(error.failure, "", report.with_final_names(error.what()));
        cases.resize(1);
        keep_failure(named, report, cases[0]);
        throw named;
    } catch (const std::exception& error) {
        cases.resize(1);
        keep_failure(Error(Failure::input, "", fmt::format("internal error: {}", error.what())),
                     report, cases[0]);
        throw;
    }
}

}  // namespace penumbra::cli
