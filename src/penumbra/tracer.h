// Scene -> Image, by recursive ray tracing.
#pragma once

#include "penumbra/image.h"
#include "penumbra/scene.h"
#include "penumbra/watch.h"

namespace penumbra {

/// Renders `scene` as its active camera sees it, with POV-Ray 3.7's light model and tolerances.
/// The same input gives the same bytes for any number of threads.
/// Precondition: defects(scene.scene).empty(). Throws Error (interrupted).
Image render(const NormalisedScene& scene, const RenderOptions& options, const Watch& watch = {});

}  // namespace penumbra
