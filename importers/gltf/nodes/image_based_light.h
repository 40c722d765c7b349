// EXT_lights_image_based -> Environment.
#pragma once

#include "importers/gltf/reader/reader.h"

namespace penumbra::gltf {

/// Gives reader.scene the environment that `scene` refers to, if any: the sharpest of its cube
/// maps; the others and the spherical harmonics are what follows from it.
void read_image_based_light(Reader& reader, const tinygltf::Scene& scene);

}  // namespace penumbra::gltf
