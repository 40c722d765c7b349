// Nodes -> cameras.
#pragma once

#include "penumbra/math.h"

namespace penumbra::gltf {

struct Reader;

/// Adds the camera of a node that has one.
void read_camera(Reader& reader, int node, const Matrix& world);

/// Where a camera or a light looks: both look along -z (glTF 2.0, section 3.10, and
/// KHR_lights_punctual).
Vec3 direction_of(const Matrix& world);

}  // namespace penumbra::gltf
