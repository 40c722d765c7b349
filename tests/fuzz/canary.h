// The picture beside the sandbox that no input can read, unless a path leads out.
#pragma once

#include <array>
#include <cstddef>

namespace fuzz {

inline constexpr std::array canary_texels = {
    std::byte{0xc3}, std::byte{0x5a}, std::byte{0x17}, std::byte{0xe9}, std::byte{0x42},
    std::byte{0x8d}, std::byte{0xf0}, std::byte{0x2b}, std::byte{0x66}, std::byte{0x9e},
    std::byte{0x05}, std::byte{0xb1}, std::byte{0x73}};

}  // namespace fuzz
