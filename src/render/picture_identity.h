// What tells the picture of a checkpoint from others, so that a difference can be named.
#pragma once

#include "penumbra/prepare.h"
#include "penumbra/render_options.h"

#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// One thing in which pictures may differ.
struct PictureTrait {
    std::string name = {};   ///< "samples", "camera"
    std::string value = {};  ///< without ';' and line feeds
    bool readable = false;   ///< the value says something to a person; else it is a hash
};

/// Of everything that render() takes but the number of threads.
std::vector<PictureTrait> picture_traits(const NormalisedScene& scene,
                                         const RenderOptions& options);

/// All of them in one line: "size=640x480;samples=1;camera=0123456789abcdef".
std::string identity_of(const std::vector<PictureTrait>& traits);

/// In what the picture of another identity differs: "samples 2, now 1", or "camera changed;
/// lights changed" where all that a person can read is the same.
std::string difference_from(std::string_view identity, const std::vector<PictureTrait>& traits);

}  // namespace penumbra
