#include "penumbra/render_file.h"

#include "image/picture_writer.h"
#include "render/checkpoint.h"
#include "render/picture_identity.h"
#include "scene/check_options.h"

#include "penumbra/error.h"
#include "penumbra/tracer.h"

#include <cassert>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace penumbra {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Samples that wait for the next checkpoint.
constexpr std::size_t most_unsaved = std::size_t(8) << 20;

// What writing is taken to cost before it was measured.
constexpr double seconds_a_byte = 1e-9;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<PictureTrait> traits_of(const NormalisedScene& scene, const RenderOptions& options,
                                    const PictureFormat& format, const RenderFileOptions& chosen) {
    std::vector<PictureTrait> traits = picture_traits(scene, options);
    const bool integers = format.frame.depth != Depth::f32;
    traits.push_back({"bits per channel", std::to_string(8 * int(format.frame.depth)), integers});
    traits.push_back({"negative light", format.positive ? "dropped" : "kept"});
    if (chosen.program) traits.push_back({"program version", chosen.program()});
    return traits;
}

// The picture's file and its checkpoint.
class Target {
  public:
    Target(const NormalisedScene& scene, const RenderOptions& options, const fs::path& file,
           const RenderFileOptions& chosen)
        : format_(picture_format(file, options.width, options.height, chosen.save)),
          out_(file, format_.frame, format_.srgb()), interval_(chosen.checkpoint_interval),
          checkpoint_name_(file.string() + ".checkpoint"),
          traits_([&] { return traits_of(scene, options, format_, chosen); }) {
        // Devices and pipes have nothing beside them.
        std::error_code ignored;
        if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored)) interval_ = 0;
        share_ = chosen.checkpoint_share;
        if (chosen.resume) open_checkpoint();
    }

    /// Rows above the checkpoint's first one. They have to be rendered before restore().
    int missing_rows() const { return missing_; }
    /// Takes the checkpoint's rows; returns the one behind them.
    int restore() {
        if (!checkpoint_) return 0;
        checkpoint_->restore([&](std::span<const std::byte> rows) {
            out_.append(rows);
            restored_ = true;
        });
        return unsaved_rows_.first = unsaved_rows_.last = checkpoint_->end();
    }
    const std::string& warning() const { return problem_; }

    /// Before restore() that is all.
    void write(const Image& rows) {
        samples_.clear();
        append_samples(rows.pixels, format_, samples_);
        out_.append(samples_);
    }

    void take(int first, const Image& rows) {
        write(rows);
        if (interval_ <= 0) return;
        unsaved_rows_.last = first + rows.height;
        unsaved_.insert(unsaved_.end(), samples_.begin(), samples_.end());
        const bool full = unsaved_.size() > most_unsaved;
        if (!full && seconds_since(last_save_) < interval_) return;
        // A gap would cost what an earlier run has left, of which nobody knows how long it took.
        if (may_save() || (full && restored_))
            save();
        else if (full)
            forget();
    }

    /// What is finished is not lost, if it is worth a file.
    void interrupted() {
        if (interval_ > 0 && (has_checkpoint() || seconds_since(last_save_) >= interval_)) save();
    }

    bool has_checkpoint() const { return checkpoint_ && checkpoint_->exists(); }

    void finish() {
        out_.finish();
        if (checkpoint_) checkpoint_->remove();
        if (interval_ > 0) Checkpoint::remove_stale(checkpoint_name_);
    }

  private:
    PictureFormat format_;
    SampleWriter out_;
    double interval_;
    double share_ = 0;
    std::string checkpoint_name_;
    std::function<std::vector<PictureTrait>()> traits_;  // takes a while
    std::optional<Checkpoint> checkpoint_ = {};
    Clock::time_point start_ = Clock::now(), last_save_ = start_;
    double saving_ = 0;  // seconds
    std::size_t saved_ = 0;
    std::vector<std::byte> samples_ = {}, unsaved_ = {};
    RowRange unsaved_rows_ = {};
    int missing_ = 0;
    bool restored_ = false;  // some rows
    std::string problem_ = {};

    void name_checkpoint(const std::vector<PictureTrait>& traits) {
        const Raster& frame = format_.frame;
        const std::size_t row =
            std::size_t(frame.width) * std::size_t(frame.channels) * std::size_t(frame.depth);
        checkpoint_.emplace(checkpoint_name_, identity_of(traits), row, frame.height);
    }

    void open_checkpoint() {
        const std::vector<PictureTrait> traits = traits_();
        name_checkpoint(traits);
        const Checkpoint::Found found = checkpoint_->open();
        switch (found.kind) {
        case Checkpoint::Found::Kind::nothing: break;
        case Checkpoint::Found::Kind::rows: missing_ = found.first; break;
        case Checkpoint::Found::Kind::foreign:
            problem_ =
                checkpoint_name_ + ": is not a checkpoint; the picture is rendered from the start";
            break;
        case Checkpoint::Found::Kind::in_use:
            throw Error(Failure::output, checkpoint_name_,
                        "is in use by another run, which renders the same file; wait for its end");
        case Checkpoint::Found::Kind::other:
            throw Error(Failure::input, checkpoint_name_,
                        "is of another picture (" +
                            (found.identity.empty() ? "program version changed"
                                                    : difference_from(found.identity, traits)) +
                            ")",
                        Remedy::restart);
        }
    }

    bool may_save() const {
        const double each = saved_ > 0 ? saving_ / double(saved_) : seconds_a_byte;
        return saving_ + each * double(unsaved_.size()) <= share_ * seconds_since(start_);
    }

    void forget() {
        unsaved_.clear();
        unsaved_rows_.first = unsaved_rows_.last;
    }

    void save() {
        last_save_ = Clock::now();
        if (unsaved_.empty()) return;
        if (!checkpoint_) name_checkpoint(traits_());
        const Clock::time_point begin = Clock::now();
        if (!checkpoint_->append(unsaved_rows_, unsaved_) && problem_.empty())
            problem_ = "no checkpoint can be written beside the picture";
        saving_ += seconds_since(begin);
        saved_ += unsaved_.size();
        forget();
    }
};

}  // namespace

namespace {

// `tracer` is asked for it only where rows are missing.
RenderedFile render_with(const std::function<const Tracer&()>& tracer, const NormalisedScene& scene,
                         const RenderOptions& options, const fs::path& file,
                         const RenderFileOptions& chosen, const Watch& watch) {
    check(options);
    assert(defects(scene.scene).empty());
    RenderedFile result;
    Target target(scene, options, file, chosen);
    double before = 0, wanted = options.height;  // rows that this call renders
    const auto render = [&](const RowRange& rows, const TakeRows& take) {
        if (rows.first >= rows.last) return;
        const Clock::time_point start = Clock::now();
        const Tracer& prepared = tracer();
        const double building = seconds_since(start);
        Watch own = {.progress = {}, .stop = watch.stop};
        if (watch.progress)
            own.progress = [&, count = rows.last - rows.first](double done) {
                watch.progress((before + done * count) / wanted);
            };
        prepared.render_rows(options, rows, take, {}, own);
        result.build_seconds += building;
        result.render_seconds += seconds_since(start) - building;
    };
    try {
        render({0, target.missing_rows()}, [&](int, const Image& rows) { target.write(rows); });
        const int next = target.restore();
        result.resumed_rows = next - target.missing_rows();
        before = target.missing_rows();
        wanted = options.height - result.resumed_rows;
        if (result.resumed_rows > 0 && chosen.resumed) chosen.resumed(result.resumed_rows);
        render({next, options.height},
               [&](int first, const Image& rows) { target.take(first, rows); });
        target.finish();
    } catch (const Error& error) {
        if (error.failure == Failure::interrupted) target.interrupted();
        if (!target.has_checkpoint()) throw;
        throw Error(error.failure, "", error.what(), Remedy::resume);
    }
    result.warning = target.warning();
    return result;
}

}  // namespace

RenderedFile render_file(const Tracer& tracer, const RenderOptions& options, const fs::path& file,
                         const RenderFileOptions& chosen, const Watch& watch) {
    // NOLINTNEXTLINE(bugprone-return-const-ref-from-parameter): it is called while `tracer` lives
    return render_with([&]() -> const Tracer& { return tracer; }, tracer.scene(), options, file,
                       chosen, watch);
}

RenderedFile render_file(const NormalisedScene& scene, const RenderOptions& options,
                         const fs::path& file, const RenderFileOptions& chosen,
                         const Watch& watch) {
    std::optional<Tracer> tracer;
    const auto prepared = [&]() -> const Tracer& {
        if (!tracer) tracer.emplace(scene, options.threads);
        return *tracer;
    };
    return render_with(prepared, scene, options, file, chosen, watch);
}

}  // namespace penumbra
