// The scale that normalise() brings a scene to, for those who work in it earlier, and how much
// they work.
#pragma once

#include "penumbra/scene.h"

#include <cstddef>

namespace penumbra {

/// What normalise() multiplies lengths by where bounds() is `box`: a power of two.
double normalising_factor(const Bounds& box);

/// Moves meshes whose vertices lie far from the mesh's own origin there, and their instances back:
/// both renderers keep vertices, and compute with them, in float32. `radius` is the scene's.
void center_meshes(Scene& scene, double radius);

/// Of scenes with more facets in the world only those meshes count that are shown once: what is
/// made of many instances must not take the time of all their facets.
inline constexpr std::size_t most_facets = std::size_t(1) << 22;

}  // namespace penumbra
