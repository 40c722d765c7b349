// Compressed buffer views and primitives -> plain ones.
#pragma once

#include "importers/gltf/document/container.h"

#include "penumbra/error.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <vector>

namespace penumbra::gltf {

struct Document;

// ---- half_floats.cpp --------------------------------------------------------------------------

/// Makes accessors of 16-bit floats such of floats, each with a buffer of its own.
void widen_half_floats(Document& document, nlohmann::json& root);

// ---- meshopt.cpp, meshopt_vertices.cpp --------------------------------------------------------

/// Decompresses the buffer views that EXT_ or KHR_meshopt_compression compresses, each into a
/// buffer of its own. Throws Error (input).
void decode_meshopt(Document& document, nlohmann::json& root, Losses& losses);

/// By buffer: whether it only serves programs that cannot decompress, and need not be read.
/// Precondition: check_schema() passed.
std::vector<bool> fallback_buffers(const nlohmann::json& root);

/// The bytes of `count` elements of `stride` bytes, a multiple of 4 up to 256, from the attribute
/// codec of KHR_meshopt_compression, version 1. None where `data` are not valid.
std::vector<std::byte> decode_vertices_v1(Bytes data, std::size_t count, std::size_t stride);

// ---- draco.cpp --------------------------------------------------------------------------------

/// Decompresses the primitives that KHR_draco_mesh_compression compresses, into accessors of their
/// own. Throws Error (input).
void decode_draco(Document& document, nlohmann::json& root, Losses& losses);

}  // namespace penumbra::gltf
