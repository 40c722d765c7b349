// A picture of a prepared scene.
#pragma once

#include "tracer/prepared/prepared_scene.h"

#include "penumbra/tracer.h"

#include <vector>

namespace penumbra {

/// Pixels.
struct Shift {
    double x = 0, y = 0;
};

/// What a picture is taken of, and how.
struct Shot {
    const PreparedScene& prepared;
    const Camera& camera;
    const RenderOptions& options;
    Shift shift = {};  ///< of where rays start: to the right and down
};

/// See Tracer::render_rows().
void render_tiles(const Shot& shot, const RowRange& rows, const TakeRows& take, const Watch& watch);

/// See Tracer::objects_seen().
std::vector<Index> objects_in_picture(const Shot& shot);

}  // namespace penumbra
