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
    require(options.max_depth >= 1,
            fmt::format("a path must have at least 1 ray segment, not {}", options.max_depth));
}

}  // namespace penumbra
