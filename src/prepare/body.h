// Meshes that are the surface of a body.
#pragma once

#include "penumbra/scene.h"

#include <cstdint>

namespace penumbra {

/// Equal points have equal hashes, with zeros of either sign.
std::uint64_t hash_of_point(const Vec3f& p);

/// Is the mesh closed, with its facets' fronts outside? Precondition: indices are in range.
bool bounds_body(const Mesh& mesh);

}  // namespace penumbra
