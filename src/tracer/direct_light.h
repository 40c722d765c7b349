// The light that reaches surfaces from the sources, and what they send to the eye of it.
#pragma once

#include "tracer/light_loops.h"

namespace penumbra {

/// Scratch space of add_direct_light(), kept between calls.
struct LightWork {
    LightSamples arrival;
    std::vector<Block> blocks;
    PointGroups points;  ///< the blocks
    /// Points show light from sources that the mirrored eye ray meets at no smaller cosine.
    std::vector<double> shown_from;
    Blockers blockers;                ///< between the blocks and one light
    std::vector<std::size_t> shaded;  ///< blocks between which and the light anything may be
    std::vector<Index> asked;         ///< points whose shadow rays facets may block
    Media media;                      ///< that the shadow rays of a block cross
    std::vector<Index> filtered;      ///< points whose light translucent facets may filter
    std::vector<Hit> crossed;         ///< those along a shadow ray

    explicit LightWork(std::size_t capacity = 0) : arrival(capacity), shown_from(capacity) {}
};

/// Adds ambient, emitted, diffuse and highlight terms of every surface point to radiance.
void add_direct_light(const PreparedScene& prepared, const SurfacePoints& surfaces, LightWork& work,
                      Vec3Array& radiance);

}  // namespace penumbra
