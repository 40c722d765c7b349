// What is too small for the scene that it is in.
#pragma once

#include "penumbra/error.h"
#include "penumbra/scene.h"

namespace penumbra {

/// Says so where POV-Ray's absolute tolerances leave out the shadows of small or thin objects,
/// and where a picture of `width` x `height` pixels shows nothing since all objects are smaller
/// than a pixel. `box` is bounds(scene). Precondition: defects(scene) finds nothing in instances,
/// spheres and cameras, and the scene has an active camera.
Losses losses_by_size(const Scene& scene, const Bounds& box, int width, int height);

}  // namespace penumbra
