// What complete() gives a scene, piece by piece.
#pragma once

#include "prepare/outline.h"

#include "penumbra/scene.h"

namespace penumbra {

/// Looks from front-right-above; not framed yet.
Camera default_camera();

/// Moves `camera` along and across its direction of view until the outline of all things, or the
/// box stage() where there are none, fills its picture but for a margin of 7 % at the nearest
/// edges. An orthographic camera also gets its extent. Precondition: `aspect`, width / height, is
/// above 0.
void frame(Camera& camera, const Scene& scene, double aspect);

}  // namespace penumbra
