#include "penumbra/math.h"

#include <cmath>

namespace penumbra {

// IEC 61966-2-1, in float32 as POV-Ray 3.7 computes it (source/base/image/colourspace.cpp).
float srgb_to_linear(float encoded) {
    if (encoded < 0.04045F) return encoded / 12.92F;
    return std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

float linear_to_srgb(float linear) {
    if (linear <= 0.0031308F) return linear * 12.92F;
    return 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

}  // namespace penumbra
