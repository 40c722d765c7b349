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
constexpr std::size_t most_unsaved = std::size_t(32) << 20;

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
        if (chosen.resume) restore(options);
    }

    int restored_rows() const { return restored; }
    const std::string& warning() const { return problem; }

    void take(const Image& rows) {
        samples.clear();
        append_samples(rows.pixels, format, samples);
        out.append(samples);
        if (interval <= 0) return;
        unsaved.insert(unsaved.end(), samples.begin(), samples.end());
        if (unsaved.size() > most_unsaved || seconds_since(last_save) >= interval) save();
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
    std::string checkpoint_name;
    std::function<std::string()> identity;  // takes a while
    std::optional<Checkpoint> checkpoint = {};
    Clock::time_point last_save = Clock::now();
    std::vector<std::byte> samples = {}, unsaved = {};
    int restored = 0;
    std::string problem = {};

    void restore(const RenderOptions& options) {
        checkpoint.emplace(checkpoint_name, identity());
        const std::size_t row = std::size_t(options.width) * std::size_t(format.frame.channels) *
                                std::size_t(format.frame.depth);
        std::size_t size = 0;
        const bool usable = checkpoint->restore([&](std::span<const std::byte> rows) {
            out.append(rows);
            size += rows.size();
        });
        restored = int(size / row);
        if (!usable)
            problem = checkpoint_name +
                      ": is of another picture or in use; the picture is rendered from the start";
    }

    void save() {
        last_save = Clock::now();
        if (unsaved.empty()) return;
        if (!checkpoint) checkpoint.emplace(checkpoint_name, identity());
        if (!checkpoint->append(unsaved) && problem.empty())
            problem = "no checkpoint can be written beside the picture";
        unsaved.clear();
    }
};

}  // namespace

RenderedFile render_file(const NormalisedScene& scene, const RenderOptions& options,
                         const fs::path& file, const RenderFileOptions& chosen,
                         const Watch& watch) {
    RenderedFile result;
    Target target(scene, options, file, chosen);
    result.resumed_rows = target.restored_rows();
    Clock::time_point start = Clock::now();
    const auto progress = [&](double done) {
        if (done == 0) {
            result.build_seconds = seconds_since(start);
            start = Clock::now();
        }
        if (watch.progress) watch.progress(done);
    };
    try {
        if (result.resumed_rows < options.height)
            render_rows(scene, options, result.resumed_rows,
                        [&](int, const Image& rows) { target.take(rows); }, {progress, watch.stop});
    } catch (const Error& error) {
        if (error.failure != Failure::interrupted) throw;
        target.interrupted();
        if (!target.has_checkpoint()) throw;
        throw Error(Failure::interrupted, "", "interrupted; --resume goes on from its checkpoint");
    }
    result.render_seconds = seconds_since(start);
    result.warning = target.warning();
    target.finish();
    return result;
}

}  // namespace penumbra
