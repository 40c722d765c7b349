// The size and quality of a picture.
#pragma once

namespace penumbra {

/// How a scene is turned into a picture; the same for the tracer and for POV-Ray. What takes them
/// throws Error (usage) when a side, `samples` or `max_depth` is less than 1, or `samples` over
/// 256.
struct RenderOptions {
    int width = 800, height = 600;  ///< pixels
    int samples = 1;      ///< 1: the pixel's centre; n > 1: n x n grid and the centre once more
    int max_depth = 5;    ///< ray segments along a path, the primary one included
    double exposure = 0;  ///< EV: light, ambience, emission and background are scaled by 2^EV
    int threads = 0;      ///< 0: as many as the machine has
};

}  // namespace penumbra
