// Material -> POV-Ray textures.
#pragma once

#include "exporters/pov/layers.h"

#include <string>
#include <vector>

namespace penumbra::pov {

/// The declaration of the texture of a surface that is not there.
std::string nothing_text(const Plan& plan);

/// The declaration of a look, the textures it needs included; of a tinted one what its tints share.
std::string look_text(const Plan& plan, const Look& look);

/// Declarations that end in that of `name`, the look's texture at vertices of that tint.
std::string tint_declaration(const Plan& plan, const Look& look, const std::string& name,
                             const Tint& tint);

/// Can the look's texture stand in a list without a name?
bool is_single(const Plan& plan, const Look& look);

/// The pigment and finish of a single look of vertex colour `tint`, as it stands in texture { }.
std::string single_texture(const Plan& plan, const Look& look, const Color& tint);

}  // namespace penumbra::pov
