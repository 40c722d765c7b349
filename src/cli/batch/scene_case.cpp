#include "cli/batch/scene_case.h"

#include "cli/advice.h"
#include "cli/batch/renderer.h"
#include "cli/options/values.h"
#include "cli/steps.h"

#include "penumbra/exporters.h"
#include "penumbra/image.h"
#include "penumbra/image_module.h"
#include "penumbra/tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* stem = "scene";  // of the exported files

// A scene that is ready for both renderers.
struct Prepared {
    NormalisedScene scene = {};
    std::unique_ptr<Metered> metered = {};
    RenderOptions options = {};
    Color background = {};  // as it is seen: exposure brightens it as well
    Losses losses = {};
    std::vector<fs::path> files = {};  // that it comes from
};

Prepared prepare(const Context& context, const SceneJob& job) {
    Imported imported = load(context, job.inputs, job.load);
    std::unique_ptr<Metered> metered = meter(context, imported);
    Prepared result = {.metered = std::move(metered),
                       .options = imported.render,
                       .losses = std::move(imported.losses),
                       .files = std::move(imported.files)};
    result.options.threads = job.threads;
    result.background = imported.scene.background * float(std::exp2(imported.render.exposure));
    result.scene = normalise(std::move(imported.scene), result.options);
    return result;
}

// One scene's way through all steps.
class SceneRun {
  public:
    SceneRun(const Context& with, const SceneJob& of, ReportFolder& into, const SceneCases& to)
        : context_(with), job_(of), report_(into), cases_(to.cases), reuse_(to.reuse),
          compared_by_(compare_options(of.judging)) {
        cases_[0].name = job_.name;
        cases_[0].folder = job_.folder;
        cases_[0].commands = {shell_command(job_.words), fmt::format("povray {}.ini", stem)};
    }

    void run() {
        const Stopwatch import_time;
        prepared_ = prepare(context_, job_);
        report_.protect(prepared_.files);
        cases_[0].losses = prepared_.losses;
        cases_[0].sampling = sampling_of(prepared_.options);
        cases_[0].seconds["import"] = import_time.seconds();
        report_losses(context_, prepared_.losses);
        compared_by_.background = prepared_.background;
        make_folder(job_.folder);
        export_scene();
        const CaseKey key = job_.folder.empty() ? CaseKey() : key_of_case();
        if (!job_.folder.empty() && reuse_ && restore(key)) return;
        preload_image_module();  // while the picture is rendered
        render_ours();
        run_povray_on_it();
        judge(cases_[0]);
        for (const OtherRenderer& renderer : context_.arguments.renderers) run_other(renderer);
        keep(key);
    }

  private:
    const Context& context_;
    const SceneJob& job_;
    ReportFolder& report_;
    std::vector<Case>& cases_;
    bool reuse_;
    CompareOptions compared_by_;
    Prepared prepared_ = {};

    fs::path folder() const { return report_.path() / job_.folder; }

    void make_folder(const std::string& name) {
        std::error_code error;
        fs::create_directories(report_.path() / name, error);
        if (error) throw Error(Failure::output, (report_.path() / name).string(), error.message());
    }

    void export_scene() {
        const Stopwatch watch;
        Case& own = cases_[0];
        const Exported exported =
            write_pov(prepared_.scene, prepared_.options, folder() / (std::string(stem) + ".pov"),
                      {.source = source_of(context_.arguments, job_.inputs),
                       .command = shell_command(job_.words),
                       .losses = own.losses});
        own.seconds["export"] = watch.seconds();
        report_losses(context_, exported.losses);
        own.losses.insert(own.losses.end(), exported.losses.begin(), exported.losses.end());
        own.files["pov"] = in_report(own, std::string(stem) + ".pov");
        own.files["ini"] = in_report(own, std::string(stem) + ".ini");
    }

    void render_ours() {
        Rendered rendered =
            render_scene(context_, prepared_.scene, prepared_.options, prepared_.metered.get(),
                         "render " + job_.name, job_.quiet);
        prepared_.metered.reset();
        cases_[0].test = std::move(rendered.image);
        compared_by_.covered = std::move(rendered.subject);
        cases_[0].seconds["render"] = rendered.build_seconds + rendered.render_seconds;
        save_image(folder() / "ours.exr", cases_[0].test);
        cases_[0].files["test"] = in_report(cases_[0], "ours.exr");
    }

    void run_povray_on_it() {
        Case& own = cases_[0];
        PovrayOptions povray = context_.arguments.povray;
        povray.threads = job_.threads;
        povray.memory = job_.memory;
        povray.keep_exr = false;  // ours is of the raw pixels
        std::function<void(double)> progress;
        const Work work = work_of(prepared_.options);
        if (!job_.quiet)
            progress = context_.console.progress("povray " + job_.name, work.count, work.unit);
        const Stopwatch watch;
        PovrayRun run = run_povray(folder() / (std::string(stem) + ".ini"), prepared_.options.width,
                                   prepared_.options.height, povray, {progress, context_.stop});
        context_.console.clear_progress();
        own.seconds["povray"] = watch.seconds();
        own.reference = std::move(run.image);
        own.povray_log = std::move(run.log);
        save_image(folder() / "povray.exr", own.reference);
        own.files["reference"] = in_report(own, "povray.exr");
    }

    // A further renderer's failure is that of its own case.
    void run_other(const OtherRenderer& renderer) {
        Case other;
        other.name = fmt::format("{} [{}]", job_.name, renderer.name);
        other.folder = fmt::format("{}@{}", job_.folder, renderer.name);
        other.reference_name = renderer.name;
        other.sampling = cases_[0].sampling;
        other.test = cases_[0].test;
        other.files["test"] = cases_[0].files["test"];
        other.commands = {shell_command(job_.words), shell_command(renderer.words)};
        make_folder(other.folder);
        std::vector<fs::path> scene = job_.inputs;
        if (job_.load.sidecar) scene.push_back(*job_.load.sidecar);
        try {
            OtherPicture picture = run_renderer(renderer,
                                                {.pov = folder() / (std::string(stem) + ".pov"),
                                                 .scene = scene,
                                                 .folder = report_.path() / other.folder,
                                                 .width = prepared_.options.width,
                                                 .height = prepared_.options.height,
                                                 .timeout = context_.arguments.povray.timeout,
                                                 .memory = job_.memory},
                                                {.stop = context_.stop});
            other.reference = std::move(picture.image);
            other.povray_log = std::move(picture.log);
            other.seconds["render"] = picture.seconds;
            other.files["reference"] = in_report(other, picture.file);
            judge(other);
        } catch (const Error& error) {
            if (error.failure == Failure::interrupted) throw;
            other.message = report_.with_final_names(with_advice(error));
            other.comparison.verdict = Verdict::error;
        }
        cases_.push_back(std::move(other));
    }

    void judge(Case& one) {
        const Stopwatch watch;
        one.comparison = penumbra::compare(one.test, one.reference, compared_by_);
        if (one.comparison.verdict == Verdict::fail)
            explain(prepared_.scene, prepared_.options, one.test,
                    masked_reference(one.test, one.reference, compared_by_), one.comparison,
                    {.stop = context_.stop});
        one.seconds["compare"] = watch.seconds();
        save_maps(report_.path(), one);
    }

    // ---- earlier runs

    CaseKey key_of_case() const {
        const RenderOptions& o = prepared_.options;
        Hash pictures, verdict;
        pictures.add(program_key());
        pictures.add(job_.povray);
        pictures.add(fmt::format("{} {} {} {} {} {}", o.width, o.height, to_string(sampling_of(o)),
                                 o.max_depth, o.exposure, int(job_.load.normal_maps)));
        for (const OtherRenderer& renderer : context_.arguments.renderers) {
            pictures.add(renderer.name);
            for (const std::string& word : renderer.words) pictures.add(word);
        }
        add_folder(pictures, folder());
        const Limits& limits = job_.judging.limits;
        verdict.add(fmt::format("{} {}", limits.warn_band, job_.judging.shift_tolerance));
        for (const auto& [name, limit] : limits.limits)
            verdict.add(fmt::format("{} {}", name, limit));
        for (const PixelBox& b : job_.judging.ignored)
            verdict.add(fmt::format("{} {} {} {}", b.x0, b.y0, b.x1, b.y1));
        if (job_.judging.mask) add_file(verdict, *job_.judging.mask);
        return {text_of(pictures.digest()), text_of(verdict.digest())};
    }

    bool restore(const CaseKey& key) {
        auto cached = cached_cases(report_.final_path() / job_.folder);
        if (!cached || cached->key.pictures != key.pictures) return false;
        const auto there = [&](const Case& one) {
            std::error_code ignored;
            for (const auto& [role, file] : one.files)
                if (!fs::exists(report_.final_path() / file, ignored)) return false;
            return fs::exists(report_.final_path() / one.folder / "index.html", ignored);
        };
        if (!std::ranges::all_of(cached->cases, there)) return false;
        for (Case& one : cached->cases) one.cached = true;
        if (cached->key == key) {
            cases_ = std::move(cached->cases);
            std::error_code ignored;
            fs::remove_all(folder(), ignored);
            return true;
        }
        return judge_again(std::move(cached->cases), key);
    }

    // The pictures are the same, the limits are not.
    bool judge_again(std::vector<Case> earlier, const CaseKey& key) {
        compared_by_.covered =
            Tracer(prepared_.scene, job_.threads).subject_seen(prepared_.options);
        for (Case& one : earlier) {
            make_folder(one.folder);
            if (one.comparison.verdict == Verdict::error) continue;
            one.test = load_image(report_.final_path() / one.files.at("test"));
            one.reference = load_image(report_.final_path() / one.files.at("reference"));
            for (const char* role : {"test", "reference"}) {
                std::error_code error;
                const fs::path& file = one.files.at(role);
                fs::copy_file(report_.final_path() / file, report_.path() / file,
                              fs::copy_options::skip_existing, error);
                if (error) throw Error(Failure::output, file.string(), error.message());
            }
            judge(one);
        }
        cases_ = std::move(earlier);
        keep(key);
        return true;
    }

    // A scene of several is complete when its folder has its name.
    void keep(const CaseKey& key) {
        if (job_.folder.empty()) return;
        for (Case& one : cases_) write_case_page(report_.path() / one.folder, one, "..");
        store_cases(folder(), {key, cases_});
        for (std::size_t i = cases_.size(); i-- > 0;) report_.publish(cases_[i].folder);
    }
};

}  // namespace

void keep_failure(const Error& error, ReportFolder& report, Case& failed) {
    if (failed.folder.empty() || error.failure == Failure::interrupted) return;
    failed.message = with_advice(error);
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
        const Error named(error.failure, "", report.with_final_names(error.what()), error.remedy);
        cases.resize(1);
        keep_failure(named, report, cases[0]);
        throw Error(named);
    } catch (const std::exception& error) {
        cases.resize(1);
        keep_failure(Error(Failure::input, "", fmt::format("internal error: {}", error.what())),
                     report, cases[0]);
        throw;
    }
}

}  // namespace penumbra::cli
