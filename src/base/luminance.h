// How bright a colour is.
#pragma once

#include "penumbra/math.h"

#include <array>

namespace penumbra {

/// Of red, green and blue in the luminance (ITU-R BT.709).
inline constexpr std::array luminance_weights = {0.2126, 0.7152, 0.0722};

/// The relative luminance of linear Rec. 709 RGB, computed in the precision of the colour.
template <class T>
constexpr T luminance(const Imath::Vec3<T>& c) {
    constexpr auto& w = luminance_weights;
    return T(w[0]) * c.x + T(w[1]) * c.y + T(w[2]) * c.z;
}

}  // namespace penumbra
