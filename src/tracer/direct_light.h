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

/// POV-Ray's tint of metallic highlights and reflections: 1 + m (1 - F)(P - 1), where F is its
/// empirical Fresnel curve of the angle whose cosine is given (source/backend/render/trace.cpp of
/// 3.7, ComputePhongColour).
Vec3 metallic_tint(double metallic, double cosine, const Vec3& pigment);

/// Adds ambient, emitted, diffuse and highlight terms of every surface point to radiance.
void add_direct_light(const PreparedScene& prepared, const SurfacePoints& surfaces, LightWork& work,
                      Vec3Array& radiance);

}  // namespace penumbra
