// Base64 (RFC 4648, section 4).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// With padding, on one line.
std::string to_base64(std::span<const std::byte> bytes);

/// White space is skipped and the padding may be missing; none for what is not base64.
std::optional<std::vector<std::byte>> from_base64(std::string_view text);

}  // namespace penumbra
