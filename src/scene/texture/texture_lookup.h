// Texture lookup, as POV-Ray 3.7 filters image maps.
#pragma once

#include "image/texels.h"

#include "penumbra/scene.h"

namespace penumbra {

/// A texture made ready for lookups. Refers to it.
struct TextureLookup {
    const Texture* texture;
    LinearSamples samples;  ///< texels keep their own bit depth

    explicit TextureLookup(const Texture& given)
        : texture(&given), samples(given.raster, given.srgb) {}
};

/// The texel of [0, size) that stands at `index` of an endless row.
inline int wrapped(int index, int size, Wrap wrap) {
    if (index >= 0 && index < size) return index;
    if (wrap == Wrap::clamp) return index < 0 ? 0 : size - 1;
    const int period = wrap == Wrap::mirror ? 2 * size : size;
    index %= period;
    if (index < 0) index += period;
    return index < size ? index : period - 1 - index;
}

/// The colour at texture coordinates (u right, v up), filtered as Texture says.
Color sample(const TextureLookup& lookup, double u, double v);

}  // namespace penumbra
