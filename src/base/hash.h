// The one hash: XXH3 (https://github.com/Cyan4973/xxHash), for keys, sums and tables. Not meant to
// resist forgery. The same on every machine, so that it may stand in files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace penumbra {

/// 128 bits.
struct Digest {
    std::uint64_t high = 0, low = 0;
    bool operator==(const Digest&) const = default;
};

/// 32 hexadecimal digits.
std::string text_of(const Digest& digest);

/// 64 bits of bytes that are at hand: the quickest for a few of them.
std::uint64_t hash_of(std::span<const std::byte> bytes);

/// Of bytes that come one after another.
class Hash {
  public:
    Hash();

    void add(std::span<const std::byte> bytes);
    /// With its size before it: {"ab", "c"} is not {"a", "bc"}.
    void add(std::string_view text);
    template <class T>
        requires std::is_arithmetic_v<T> || std::is_enum_v<T>
    void add(T value) {
        add(std::as_bytes(std::span(&value, 1)));
    }

    /// Of all that was added so far. 64 bits are the low half.
    Digest digest() const;

  private:
    // XXH3_state_t of the library, whose header no other file needs.
    alignas(64) std::array<std::byte, 576> state_;
};

}  // namespace penumbra
