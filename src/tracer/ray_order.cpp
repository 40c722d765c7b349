#include "tracer/ray_order.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace penumbra {

namespace {

// Three bits of each of the lowest ten bits of a number: 0, 3, 6, ...
std::uint32_t spread(std::uint32_t x) {
    x = (x | (x << 16U)) & 0x030000FFU;
    x = (x | (x << 8U)) & 0x0300F00FU;
    x = (x | (x << 4U)) & 0x030C30C3U;
    return (x | (x << 2U)) & 0x09249249U;
}

}  // namespace

std::uint32_t place_on_curve(const Vec3& point, const Bounds& box) {
    std::uint32_t place = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double share = (point[axis] - box.min[axis]) / (box.max[axis] - box.min[axis]);
        place |= spread(std::uint32_t(std::clamp(share, 0.0, 1.0) * 1023)) << unsigned(axis);
    }
    return place;
}

void sort_by_key(std::vector<std::uint64_t>& entries, std::vector<std::uint64_t>& scratch) {
    constexpr unsigned digit_bits = 10;
    constexpr std::size_t digits = 1U << digit_bits;
    scratch.resize(entries.size());
    for (unsigned shift = 32; shift < 32 + 3 * digit_bits; shift += digit_bits) {
        std::array<std::uint32_t, digits> place{};
        const auto digit = [&](std::uint64_t entry) { return entry >> shift & (digits - 1); };
        for (const std::uint64_t entry : entries) ++place[digit(entry)];
        std::exclusive_scan(place.begin(), place.end(), place.begin(), 0U);
        for (const std::uint64_t entry : entries) scratch[place[digit(entry)]++] = entry;
        entries.swap(scratch);
    }
}

}  // namespace penumbra
