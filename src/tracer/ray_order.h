// Brings rays together that are near to each other.
#pragma once

#include "penumbra/scene.h"

#include <cstdint>
#include <vector>

namespace penumbra {

/// The place of a point on a Z-order curve through the box (Morton 1966), of 30 bits.
std::uint32_t place_on_curve(const Vec3& point, const Bounds& box);

/// Orders entries by their upper half, of which 30 bits are in use: least significant digit first.
/// Equal ones keep their order.
void sort_by_key(std::vector<std::uint64_t>& entries, std::vector<std::uint64_t>& scratch);

}  // namespace penumbra
