// Texture lookup, as POV-Ray 3.7 filters image maps.
#pragma once

#include "penumbra/scene.h"

namespace penumbra {

/// A texture made ready for lookups. Texels keep their own bit depth; `decode` turns an integer
/// sample into linear light.
struct Sampler {
    const Texture* texture = nullptr;
    std::vector<float> decode = {};  ///< 256 or 65536 entries; empty for float samples
};

Sampler make_sampler(const Texture& texture);

/// The colour at texture coordinates (u right, v up), filtered as Texture says.
Color sample(const Sampler& sampler, double u, double v);

}  // namespace penumbra
