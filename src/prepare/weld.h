// Vertices that are the same but for their index.
#pragma once

#include "base/hash.h"

#include "penumbra/math.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace penumbra {

/// Equal points have equal hashes, with zeros of either sign.
inline std::uint64_t hash_of_point(const Vec3f& p) {
    const std::array<float, 3> numbers = {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};
    return hash_of(std::as_bytes(std::span(numbers)));
}

/// For tables of points.
struct PointHash {
    std::size_t operator()(const Vec3f& p) const { return hash_of_point(p); }
};

/// For each of `count` vertices the first in index order among those with the same key;
/// key(i) is an array of floats.
template <class Key>
std::vector<Index> weld(std::size_t count, const Key& key) {
    std::vector<Index> order(count), first(count);
    std::iota(order.begin(), order.end(), Index(0));
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
        const auto left = key(a), right = key(b);
        return left < right || (left == right && a < b);
    });
    for (std::size_t i = 0; i < count; ++i)
        first[order[i]] =
            i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    return first;
}

}  // namespace penumbra
