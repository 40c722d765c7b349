// Vertices that are the same but for their index.
#pragma once

#include "penumbra/math.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace penumbra {

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
