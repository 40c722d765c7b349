#include "tracer/accel/rays.h"

#include "base/simd.h"

#include <cassert>

namespace penumbra {

PENUMBRA_VECTORISED
Extent extent_of(const double* values, const IndexRange& range) {
    assert(range.first < range.last);
    // Several at a time: a single one would wait for the one before.
    constexpr std::size_t lanes = 8;
    std::array<double, lanes> low, high;
    low.fill(values[range.first]);
    high.fill(values[range.first]);
    std::size_t i = range.first;
    for (; i + lanes <= range.last; i += lanes)
        for (std::size_t k = 0; k < lanes; ++k) {
            const double value = values[i + k];
            low[k] = value < low[k] ? value : low[k];
            high[k] = value > high[k] ? value : high[k];
        }
    for (; i < range.last; ++i) {
        low[0] = std::min(low[0], values[i]);
        high[0] = std::max(high[0], values[i]);
    }
    return {*std::min_element(low.begin(), low.end()), *std::max_element(high.begin(), high.end())};
}

Bounds box_around(const Vec3Array& vectors, const IndexRange& range) {
    Bounds box;
    for (int axis = 0; axis < 3; ++axis) {
        const Extent extent = extent_of(vectors.axis[std::size_t(axis)].data(), range);
        box.min[axis] = extent.low;
        box.max[axis] = extent.high;
    }
    return box;
}

}  // namespace penumbra
