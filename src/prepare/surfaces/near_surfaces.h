// Surfaces that lie beside one another within POV-Ray's tolerance of shadow rays.
#pragma once

#include "penumbra/error.h"
#include "penumbra/scene.h"

namespace penumbra {

/// Says so where a surface casts no shadow on another one that is too near, and that can be seen:
/// it lets light pass, or the gap is as wide as a pixel of `width` x `height`. `box` is
/// bounds(scene). What lies in one plane counts as parted already. Precondition: that of
/// losses_by_size.
Losses losses_by_nearness(const Scene& scene, const Bounds& box, int width, int height);

}  // namespace penumbra
