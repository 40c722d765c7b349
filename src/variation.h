// Pictures as a renderer with a fault would make them: for the diagnosis of differences.
#pragma once

#include "penumbra/tracer.h"

namespace penumbra {

/// What is done otherwise.
struct Variation {
    bool shadows = true;    ///< else nothing hides a source
    double dx = 0, dy = 0;  ///< pixels by which every ray starts more to the right and further down
};

/// render() with one thing done otherwise.
Image render_variation(const NormalisedScene& scene, const RenderOptions& options,
                       const Variation& variation, const Watch& watch = {});

}  // namespace penumbra
