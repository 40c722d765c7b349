// Materials that do not fit what they are on -> materials that do. What that drops is a loss.
#pragma once

#include "penumbra/importers.h"

namespace penumbra {

/// An image needs texture coordinates: without them a mesh gets the material's plain colour.
void drop_images_without_texcoords(Imported& result);

/// Some images can only vary opaque surfaces; a sidecar may have made theirs translucent.
void drop_maps_of_translucent_materials(Imported& result);

}  // namespace penumbra
