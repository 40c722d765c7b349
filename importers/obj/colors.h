// Colours of vertices.
#pragma once

#include "importers/obj/clean.h"

#include <string>
#include <vector>

namespace penumbra::obj {

/// Of a vertex without a colour.
inline const Color no_color(-1);
inline bool has_color(const Color& color) { return color.x >= 0; }

/// The linear colours of all vertices of a file; empty where none has one.
std::vector<Color> vertex_colors(const std::vector<Piece>& pieces, const std::string& file,
                                 Tally& tally);

}  // namespace penumbra::obj
