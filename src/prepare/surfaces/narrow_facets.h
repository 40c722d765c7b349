// Facets that are too small in their scene for surfaces in one plane to be parted by them.
#pragma once

#include "penumbra/error.h"
#include "penumbra/scene.h"

namespace penumbra {

/// Says so where facets are narrower than what part_surfaces() looks at and a pixel of `width` x
/// `height` wide at least, as in a scene that reaches far beyond what the camera is near to. `box`
/// is bounds(scene). Precondition: that of losses_by_size.
Losses losses_by_narrowness(const Scene& scene, const Bounds& box, int width, int height);

}  // namespace penumbra
