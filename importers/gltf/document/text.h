// Text of a glTF file in messages.
#pragma once

#include "base/text/text.h"

#include <string>
#include <string_view>

namespace penumbra::gltf {

/// `text` on one line: control characters become '?', what is beyond 80 bytes is cut.
inline std::string printable(std::string_view text) { return penumbra::printable(text, 80); }

}  // namespace penumbra::gltf
