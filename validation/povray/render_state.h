// POV-Ray's render-state file -> Image.
#pragma once

#include "penumbra/image.h"

#include <cstddef>
#include <optional>
#include <span>

namespace penumbra {

/// The pixels in a render-state file of POV-Ray 3.7: its own float32 values, neither rounded nor
/// clamped. Nothing when the file is of another kind, damaged, of another size or incomplete.
std::optional<Image> decode_render_state(std::span<const std::byte> file, int width, int height);

/// Size that such a file has at the end; what is there of it tells how far POV-Ray is.
double render_state_size(int width, int height);

}  // namespace penumbra
