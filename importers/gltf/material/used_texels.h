// Which texels of an image facets can show.
#pragma once

#include "image/texels.h"
#include "importers/gltf/reader/material_cache.h"

#include "penumbra/scene.h"

#include <optional>
#include <vector>

namespace penumbra::gltf {

/// The texels of an image of width x height that facets look up, neighbours of bilinear lookups
/// included; `map` lays it and `frame` says how it wraps. None where it is not worth finding out.
std::optional<TexelMask> texels_under(const std::vector<LaidFacet>& facets, const ImageMap& map,
                                      const Texture& frame, int width, int height);

}  // namespace penumbra::gltf
