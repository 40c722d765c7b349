// The light that reaches surfaces from the sources, and what they send to the eye of it.
#pragma once

#include "tracer/light_loops.h"

namespace penumbra {

/// Scratch space of add_direct_light(), kept between calls.
struct LightWork {
    LightSamples arrival;
    std::vector<Block> blocks;
    PointGroups points;                   ///< the blocks
    std::vector<unsigned char> receives;  ///< whether a point could show light from a source
    Blockers blockers;                    ///< between the blocks and one light
    std::vector<std::size_t> shaded;      ///< blocks between which and the light anything may be
    std::vector<Index> asked;             ///< points whose shadow rays facets may block
    Media media;                          ///< that the shadow rays of a block cross

    explicit LightWork(std::size_t capacity = 0) : arrival(capacity), receives(capacity) {}
};

/// Adds ambient, emitted, diffuse and highlight terms of every surface point to radiance.
void add_direct_light(const PreparedScene& prepared, const SurfacePoints& surfaces, LightWork& work,
                      Vec3Array& radiance);

}  // namespace penumbra
