// Meshes that are the surface of a body.
#pragma once

#include "penumbra/scene.h"

namespace penumbra {

/// Is the mesh closed, with its facets' fronts outside? Precondition: indices are in range.
bool bounds_body(const Mesh& mesh);

/// Shows both sides of opaque bodies whose backs could only be hidden with some of their fronts
/// (smooth facets with vertex colours: see scene/sides.h): nobody sees those backs. Not of bodies
/// that the camera may be in. Precondition: indices are in range.
void show_whole_bodies(Scene& scene);

}  // namespace penumbra
