// A number for a picture: what is the same renders to the same bytes.
#pragma once

#include "penumbra/scene.h"

#include <cstdint>

namespace penumbra {

/// Of everything that render() takes but the number of threads. Not meant to resist forgery.
std::uint64_t fingerprint(const NormalisedScene& scene, const RenderOptions& options);

}  // namespace penumbra
