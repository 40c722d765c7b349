#include "scene/check_options.h"

#include "penumbra/error.h"

#include <fmt/format.h>

namespace penumbra {

void check(const RenderOptions& options) {
    const auto require = [](bool rule, const std::string& problem) {
        if (!rule) throw Error(Failure::usage, "", problem);
    };
    require(options.width >= 1 && options.height >= 1,
            fmt::format("a picture must have at least 1 x 1 pixels, not {} x {}", options.width,
                        options.height));
    require(options.samples >= 1,
            fmt::format("a picture must have at least 1 sample a pixel, not {}", options.samples));
    // An edge then has 65,536 steps, all that 16 bits can show.
    constexpr int most_samples = 256;
    require(options.samples <= most_samples,
            fmt::format("a picture must have at most {0} x {0} samples a pixel, not {1} x {1}",
                        most_samples, options.samples));
    if (options.antialiasing) {
        const auto& [threshold, depth] = *options.antialiasing;
        require(
            threshold >= 0,
            fmt::format("the threshold of anti-aliasing must be at least 0, not {}", threshold));
        require(depth >= 1 && depth <= most_antialias_depth,
                fmt::format("the depth of anti-aliasing must be from 1 to {}, not {}",
                            most_antialias_depth, depth));
    }
    require(options.max_depth >= 1,
            fmt::format("a path must have at least 1 ray segment, not {}", options.max_depth));
}

std::string to_string(const Sampling& sampling) {
    if (sampling.antialiasing)
        return fmt::format("adaptive anti-aliasing, threshold {}, depth {}",
                           sampling.antialiasing->threshold, sampling.antialiasing->depth);
    if (sampling.samples == 1) return "one sample a pixel";
    return fmt::format("a grid of {0} x {0} samples a pixel and the centre once more",
                       sampling.samples);
}

}  // namespace penumbra
