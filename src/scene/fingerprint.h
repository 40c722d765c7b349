// A number for a picture: what is the same renders to the same bytes.
#pragma once

#include "penumbra/prepare.h"
#include "penumbra/render_options.h"
#include "penumbra/scene.h"

#include <cstdint>
#include <vector>

namespace penumbra {

/// A part of a scene, and a number for it.
struct PartFingerprint {
    const char* name = "";  ///< "camera", "lights", ...
    std::uint64_t value = 0;
};

/// Of all that a picture's scene consists of.
std::vector<PartFingerprint> fingerprints(const NormalisedScene& scene);

/// Of everything that render() takes but the number of threads. Not meant to resist forgery.
std::uint64_t fingerprint(const NormalisedScene& scene, const RenderOptions& options);

}  // namespace penumbra
