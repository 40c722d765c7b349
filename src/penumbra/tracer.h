// Scene -> Image, by recursive ray tracing.
#pragma once

#include "penumbra/image.h"
#include "penumbra/scene.h"
#include "penumbra/watch.h"

#include <functional>
#include <vector>

namespace penumbra {

/// Renders `scene` as its active camera sees it, with POV-Ray 3.7's light model and tolerances.
/// The same input gives the same bytes for any number of threads.
/// Precondition: defects(scene.scene).empty(). Throws Error (interrupted).
Image render(const NormalisedScene& scene, const RenderOptions& options, const Watch& watch = {});

/// The rows of a picture from number `first` on.
using TakeRows = std::function<void(int first, const Image& rows)>;

/// Pictures are rendered in bands of so many rows, whatever is done with them.
inline constexpr int render_band = 32;

/// [first, last) of a picture's rows: multiples of render_band, or the picture's end.
struct RowRange {
    int first = 0, last = 0;
};

/// Some rows of the same picture, without ever being in memory as a whole: calls `take` for
/// finished bands from the top, one at a time, on any thread. What it throws ends the rendering.
/// Throws Error (interrupted).
void render_rows(const NormalisedScene& scene, const RenderOptions& options, const RowRange& rows,
                 const TakeRows& take, const Watch& watch = {});

/// What the ray through the centre of each pixel hits, row by row from the top: objects are counted
/// instances first, then spheres, then planes; no_index where it hits nothing.
/// Precondition: that of render().
std::vector<Index> objects_seen(const NormalisedScene& scene, const RenderOptions& options);

/// The exposure, in EV and added to what is folded into `scene`, at which the picture looks right:
/// its logarithmic mean becomes a middle grey, less so where that would clip the highlights. Takes
/// a small picture of single sources; a multiple of 1/4 from -32 to 32, 0 when the picture is
/// black.
double metered_exposure(const NormalisedScene& scene, const RenderOptions& options,
                        const Watch& watch = {});

}  // namespace penumbra
