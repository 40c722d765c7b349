// Bytes -> JSON text and BIN chunk.
#pragma once

#include "penumbra/error.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace penumbra::gltf {

using Bytes = std::span<const std::byte>;

/// The two parts of a glTF file; `bin` is empty where there is no BIN chunk.
struct Container {
    std::string_view json = {};
    Bytes bin = {};
};

/// Splits a .glb, or takes all of `content` as JSON. Throws Error (input).
Container split_container(Bytes content, const std::string& file, Losses& losses);

}  // namespace penumbra::gltf
