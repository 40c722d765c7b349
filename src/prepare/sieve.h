// What is there more than once, told from hashes in little memory.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra {

/// A set that may say yes to what it does not hold: one bit for a hash.
class Sieve {
  public:
    explicit Sieve(std::size_t count)
        : bits_(std::bit_ceil(std::max<std::size_t>(count, 64)) / 4), mask_(bits_.size() * 64 - 1) {
    }
    /// Whether something with this hash, or another that looks alike, was there already.
    bool insert(std::uint64_t hash) {
        const std::uint64_t at = hash & mask_, bit = std::uint64_t(1) << (at % 64);
        std::uint64_t& word = bits_[at / 64];
        const bool there = (word & bit) != 0;
        word |= bit;
        return there;
    }
    bool contains(std::uint64_t hash) const {
        const std::uint64_t at = hash & mask_;
        return (bits_[at / 64] >> (at % 64) & 1U) != 0;
    }

  private:
    std::vector<std::uint64_t> bits_;
    std::uint64_t mask_;
};

}  // namespace penumbra
