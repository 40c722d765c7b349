// Whole files, read and written safely.
#pragma once

#include "penumbra/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// Largest file that is read; no model or picture in use comes near it.
inline constexpr std::uintmax_t max_file_size = std::uintmax_t(4) << 30;

/// The content of a regular file. Throws Error (input): "FILE: no such file", "FILE: is a folder",
/// "FILE: is not a regular file", "FILE: has N bytes, more than the M that are read", or the
/// system's reason.
std::string read_text(const std::filesystem::path& file, std::uintmax_t max = max_file_size);
std::vector<std::byte> read_bytes(const std::filesystem::path& file,
                                  std::uintmax_t max = max_file_size);

/// Replaces `file` in one step: writes a file beside it, flushes it to the disk and renames it, so
/// that whatever fails or interrupts leaves what was there. Throws Error (output).
void write_file(const std::filesystem::path& file, std::span<const std::byte> content);
void write_file(const std::filesystem::path& file, std::string_view content);

}  // namespace penumbra
