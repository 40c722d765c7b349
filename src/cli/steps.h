// The steps that several commands share.
#pragma once

#include "cli/context.h"

#include "penumbra/tracer.h"

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <memory>
#include <string>
#include <utility>

namespace penumbra::cli {

/// Seconds since it was made.
class Stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The scene of `inputs` with all that `options`, else the command line, lays over it. Its exposure
/// is still to be metered. Throws Error.
Imported load(const Context& context, const std::vector<std::filesystem::path>& inputs);
Imported load(const Context& context, const std::vector<std::filesystem::path>& inputs,
              const LoadOptions& options);

/// A scene in which light was metered, with the trees that took.
class Metered {
  public:
    Metered(NormalisedScene scene, int threads)
        : scene_(std::move(scene)), tracer_(scene_, threads) {}
    Metered(const Metered&) = delete;
    Metered& operator=(const Metered&) = delete;

    const Tracer& tracer() const { return tracer_; }
    /// For `scene`, which is that one with other light and must outlive this.
    const Tracer& tracer_for(const NormalisedScene& scene) {
        tracer_.update(scene);
        scene_ = {};
        return tracer_;
    }

  private:
    NormalisedScene scene_;
    Tracer tracer_;
};

/// Sets the exposure where it is to be metered, and returns what that has prepared: a picture of
/// the scene needs no other trees. Elsewhere null. Throws Error.
std::unique_ptr<Metered> meter(const Context& context, Imported& imported);

/// With the mask read. Throws Error (input).
CompareOptions compare_options(const Judging& judging);

/// Warns of what could not be carried over; with --strict throws Error (input) if there is any.
void report_losses(const Context& context, const Losses& losses);

/// Throws Error (output) when `file` can clearly not be written, before work is spent on it.
void check_writable(const std::filesystem::path& file);

/// "chair" for "models/chair.glb": the default name of what a command makes of its inputs.
std::string stem_of(const Arguments& arguments);

/// The inputs as the user named them, for messages: "chair.glb studio.toml".
std::string source_of(const Arguments& arguments, const std::vector<std::filesystem::path>& inputs);

/// A picture, and the wall time of what made it: the search trees, then the picture itself.
struct Rendered {
    Image image = {};
    double build_seconds = 0, render_seconds = 0;
    std::vector<bool> subject = {};  ///< Tracer::subject_seen()
};

/// Renders under a progress bar. `metered`, if not null, is of the same scene with other light.
Rendered render_scene(const Context& context, const NormalisedScene& scene,
                      const RenderOptions& options, Metered* metered, const std::string& name,
                      bool quiet);

/// What the rate of the progress bar is of: samples or, where nobody knows how many they will be,
/// pixels; in a whole picture.
struct Work {
    double count = 0;
    const char* unit = "";
};
Work work_of(const RenderOptions& options);

/// [{"place", "what", "kind", "count"}], equal ones together.
nlohmann::ordered_json losses_json(const Losses& losses);

/// `document` as text, with what is no UTF-8 replaced and what a terminal may obey escaped.
std::string json_text(const nlohmann::ordered_json& document);

}  // namespace penumbra::cli
