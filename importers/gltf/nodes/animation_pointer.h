// KHR_animation_pointer: animations of any property of a glTF file.
#pragma once

#include "penumbra/importers.h"

#include <nlohmann/json_fwd.hpp>

namespace penumbra::gltf {

struct Document;

/// Sets the properties in `root`, the JSON of the Document, that the animation asked for points at
/// to their values at that instant, and says whether there are any. What cannot be followed is a
/// loss. Throws Error (usage, input).
bool follow_pointers(const Document& document, const ModelOptions& options, nlohmann::json& root,
                     Losses& losses);

}  // namespace penumbra::gltf
