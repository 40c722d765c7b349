#include "penumbra/render_file.h"

#include "checkpoint.h"
#include "fingerprint.h"
#include "image_writer.h"

#include "penumbra/error.h"
#include "penumbra/tracer.h"

#include <chrono>
#include <cstdio>
#include <functional>
#include <optional>

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

std::string identity_of(const NormalisedScene& scene, const RenderOptions& options,
                        const PictureFormat& format, const RenderFileOptions& chosen) {
    std::array<char, 64> text = {};
    std::snprintf(text.data(), text.size(), "%016llx %d %d ",
                  static_cast<unsigned long long>(fingerprint(scene, options)),
                  int(format.frame.depth), int(format.positive));
    return text.data() + (chosen.program ? chosen.program() : std::string());
}

// The picture's file and its checkpoint.
class Target {
  public:
    Target(const NormalisedScene& scene, const RenderOptions& options, const fs::path& file,
           const RenderFileOptions& chosen)
        : format(picture_format(file, options.width, options.height, chosen.save)),
          out(file, format.frame, format.srgb()), interval(chosen.checkpoint_interval),
          checkpoint_name(file.string() + ".checkpoint"),
          identity([&] { return identity_of(scene, options, format, chosen); }) {
        // Devices and pipes have nothing beside them.
        std::error_code ignored;
        if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored)) interval = 0;
        share = chosen.checkpoint_share;
        if (chosen.resume) open_checkpoint();
    }

    /// Rows above the checkpoint's first one. They have to be rendered before restore().
    int missing_rows() const { return missing; }
    /// Takes the checkpoint's rows; returns the one behind them.
    int restore() {
        if (!checkpoint) return 0;
        checkpoint->restore([&](std::span<const std::byte> rows) {
            out.append(rows);
            restored = true;
        });
        return unsaved_rows.first = unsaved_rows.last = checkpoint->end();
    }
    const std::string& warning() const { return problem; }

    /// Before restore() that is all.
    void write(const Image& rows) {
        samples.clear();
        append_samples(rows.pixels, format, samples);
        out.append(samples);
    }

    void take(int first, const Image& rows) {
        write(rows);
        if (interval <= 0) return;
        unsaved_rows.last = first + rows.height;
        unsaved.insert(unsaved.end(), samples.begin(), samples.end());
        const bool full = unsaved.size() > most_unsaved;
        if (!full && seconds_since(last_save) < interval) return;
        // A gap would cost what an earlier run has left, of which nobody knows how long it took.
        if (may_save() || (full && restored))
            save();
        else if (full)
            forget();
    }

    /// What is finished is not lost, if it is worth a file.
    void interrupted() {
        if (interval > 0 && (has_checkpoint() || seconds_since(last_save) >= interval)) save();
    }

    bool has_checkpoint() const { return checkpoint && checkpoint->exists(); }

    void finish() {
        out.finish();
        if (checkpoint) checkpoint->remove();
        if (interval > 0) Checkpoint::remove_stale(checkpoint_name);
    }

  private:
    PictureFormat format;
    SampleWriter out;
    double interval;
    double share = 0;
    std::string checkpoint_name;
    std::function<std::string()> identity;  // takes a while
    std::optional<Checkpoint> checkpoint = {};
    Clock::time_point start = Clock::now(), last_save = start;
    double saving = 0;  // seconds
    std::size_t saved = 0;
    std::vector<std::byte> samples = {}, unsaved = {};
    RowRange unsaved_rows = {};
    int missing = 0;
    bool restored = false;  // some rows
    std::string problem = {};

    void name_checkpoint() {
        const Raster& frame = format.frame;
        const std::size_t row =
            std::size_t(frame.width) * std::size_t(frame.channels) * std::size_t(frame.depth);
        checkpoint.emplace(checkpoint_name, identity(), row, frame.height);
    }

    void open_checkpoint() {
        name_checkpoint();
        if (const auto first = checkpoint->open())
            missing = *first;
        else
            problem = checkpoint_name +
                      ": is of another picture or in use; the picture is rendered from the start";
    }

    bool may_save() const {
        const double each = saved > 0 ? saving / double(saved) : seconds_a_byte;
        return saving + each * double(unsaved.size()) <= share * seconds_since(start);
    }

    void forget() {
        unsaved.clear();
        unsaved_rows.first = unsaved_rows.last;
    }

    void save() {
        last_save = Clock::now();
        if (unsaved.empty()) return;
        if (!checkpoint) name_checkpoint();
        const Clock::time_point begin = Clock::now();
        if (!checkpoint->append(unsaved_rows, unsaved) && problem.empty())
            problem = "no checkpoint can be written beside the picture";
        saving += seconds_since(begin);
        saved += unsaved.size();
        forget();
    }
};

}  // namespace

RenderedFile render_file(const NormalisedScene& scene, const RenderOptions& options,
                         const fs::path& file, const RenderFileOptions& chosen,
                         const Watch& watch) {
    RenderedFile result;
    Target target(scene, options, file, chosen);
    const auto render = [&](const RowRange& rows, const TakeRows& take) {
        if (rows.first >= rows.last) return;
        Clock::time_point start = Clock::now();
        const auto progress = [&](double done) {
            if (done == 0) {
                result.build_seconds += seconds_since(start);
                start = Clock::now();
            }
            if (watch.progress) watch.progress(done);
        };
        render_rows(scene, options, rows, take, {progress, watch.stop});
        result.render_seconds += seconds_since(start);
    };
    try {
        render({0, target.missing_rows()}, [&](int, const Image& rows) { target.write(rows); });
        const int next = target.restore();
        result.resumed_rows = next - target.missing_rows();
        render({next, options.height},
               [&](int first, const Image& rows) { target.take(first, rows); });
    } catch (const Error& error) {
        if (error.failure != Failure::interrupted) throw;
        target.interrupted();
        if (!target.has_checkpoint()) throw;
        throw Error(Failure::interrupted, "", "interrupted; --resume goes on from its checkpoint");
    }
    result.warning = target.warning();
    target.finish();
    return result;
}

}  // namespace penumbra
