// Scene -> picture file, without the picture ever being in memory as a whole.
#pragma once

#include "penumbra/image.h"
#include "penumbra/prepare.h"
#include "penumbra/render_options.h"
#include "penumbra/tracer.h"
#include "penumbra/watch.h"

#include <filesystem>
#include <functional>
#include <string>

namespace penumbra {

struct RenderFileOptions {
    SaveOptions save = {};
    /// Seconds between checkpoints: what is finished is kept in a file beside the picture's,
    /// "chair.png.checkpoint", which goes away with success. 0: none.
    double checkpoint_interval = 5;
    /// The most of the time that checkpoints may take. Rows that come faster are not kept and
    /// rendered again, which takes less than 1 / share times as long as keeping them. A run that
    /// goes on from a checkpoint keeps all rows.
    double checkpoint_share = 0.01;
    /// Go on from the checkpoint of an earlier, interrupted call with the same scene and options. A
    /// checkpoint of another picture is an error that names what differs, and stays.
    bool resume = false;
    /// Told how many rows a checkpoint had, before the others are rendered. What Watch::progress
    /// says counts these others alone.
    std::function<void(int rows)> resumed = {};
    /// Gives one line that changes with the program: another one's checkpoint is another picture's.
    /// Asked only once there is a checkpoint.
    std::function<std::string()> program = {};
};

/// What render_file() has done, and the wall time of it.
struct RenderedFile {
    double build_seconds = 0, render_seconds = 0;  ///< the search trees; the picture
    int resumed_rows = 0;                          ///< that a checkpoint had
    std::string warning = {};                      ///< about the checkpoint; may be empty
};

/// Renders to `file` as render() and save_image() do, with the same bytes whether it was
/// interrupted and resumed or not. The file appears when it is whole. Precondition:
/// defects(scene.scene).empty(). Throws Error (usage: see RenderOptions; input: not enough memory,
/// a checkpoint of another picture; output, also where another process writes the checkpoint;
/// interrupted).
RenderedFile render_file(const Tracer& tracer, const RenderOptions& options,
                         const std::filesystem::path& file,
                         const RenderFileOptions& file_options = {}, const Watch& watch = {});
RenderedFile render_file(const NormalisedScene& scene, const RenderOptions& options,
                         const std::filesystem::path& file,
                         const RenderFileOptions& file_options = {}, const Watch& watch = {});

}  // namespace penumbra
