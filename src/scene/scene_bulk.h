// A scene without what is large in it, to be changed and put back.
#pragma once

#include "penumbra/scene.h"

namespace penumbra {

/// `scene` without its meshes and without the samples of its textures.
Scene without_bulk(const Scene& scene);

/// Makes `scene` again what it was when without_bulk() gave `kept`, if its meshes and the samples
/// of its textures are still the same: textures that were appended go. Precondition: none was
/// removed.
void restore_all_but_bulk(Scene& scene, const Scene& kept);

}  // namespace penumbra
