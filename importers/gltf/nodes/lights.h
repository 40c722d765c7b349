// Nodes -> lights.
#pragma once

#include "penumbra/scene.h"

namespace penumbra::gltf {

struct Reader;

/// Adds the light of a node if it has one.
void read_light(Reader& reader, int node, const Matrix& world);

/// Lets the lights that have a position fall off with the square of the distance, once the size of
/// the scene is known.
void set_attenuation(Scene& scene);

}  // namespace penumbra::gltf
