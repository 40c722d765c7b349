// The size and quality of a picture.
#pragma once

#include <optional>
#include <string>

namespace penumbra {

/// POV-Ray's recursive anti-aliasing (`+AM2 +A<threshold> +R<depth> -J`): the corners of every
/// pixel; where two of them differ, five more points and the same for each quarter, depth - 1 times
/// at most. A pixel is the mean of its quarters, and these of theirs.
struct Antialiasing {
    /// Corners differ where |dR| + |dG| + |dB| is as large, of linear channels to the power 1/2.5.
    double threshold = 0.2;
    int depth = 2;  ///< 1 to 9: a pixel has 2^(depth - 1) cells a side at most
};

/// Where rays go through a pixel; the same for the tracer and for POV-Ray.
struct Sampling {
    int samples = 1;  ///< 1: the pixel's centre; n > 1: n x n grid and the centre once more
    std::optional<Antialiasing> antialiasing = {};  ///< in the place of `samples`
};

/// How a scene is turned into a picture; the same for the tracer and for POV-Ray. What takes them
/// throws Error (usage) when a side, `samples` or `max_depth` is less than 1, `samples` over 256,
/// or `antialiasing` has a threshold below 0 or a depth that is not from 1 to 9.
struct RenderOptions {
    int width = 800, height = 600;                  ///< pixels
    int samples = 1;                                ///< see Sampling
    std::optional<Antialiasing> antialiasing = {};  ///< see Sampling
    int max_depth = 5;    ///< ray segments along a path, the primary one included
    double exposure = 0;  ///< EV: light, ambience, emission and background are scaled by 2^EV
    int threads = 0;      ///< 0: as many as the machine has
};

inline Sampling sampling_of(const RenderOptions& options) {
    return {options.samples, options.antialiasing};
}

/// "one sample a pixel", "a grid of 3 x 3 samples a pixel and the centre once more" or "adaptive
/// anti-aliasing, threshold 0.1, depth 3".
std::string to_string(const Sampling& sampling);

}  // namespace penumbra
