// Perlin noise as POV-Ray 3.7 computes it.
#pragma once

#include "penumbra/scene.h"

namespace penumbra {

/// POV-Ray 3.7's noise generator 3 at `p`: gradient noise of period 2048 after Perlin 1985 ("An
/// Image Synthesizer"), in [0, 1]. Equal to POV-Ray's f_noise_generator(x, y, z, 3) to the last
/// printed digit.
double perlin_noise(const Vec3& p);

/// The value in [0, 1] of a Noise pattern at the world-space point `p`.
double noise_value(const Noise& noise, const Vec3& p);

}  // namespace penumbra
