// Materials as Tachyon's textures.
#pragma once

#include "exporters/tachyon/output.h"

#include <string>

namespace penumbra::tachyon {

/// What stands after TEXTURE or TEXDEF for a mesh or a sphere of this material.
const std::string& texture_of(Output& out, Index material);

/// The same for `plane`, which shows an image if its material has one. Throws Error (output).
std::string texture_of(Output& out, const Plane& plane);

}  // namespace penumbra::tachyon
