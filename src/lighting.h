// The light that reaches surfaces from the sources, and what they send to the eye of it.
#pragma once

#include "blockers.h"
#include "surface.h"

namespace penumbra {

/// Scratch space of add_direct_light(), kept between calls. One entry a surface point.
struct LightWork {
    Vectors toward;                        ///< unit, to the source
    std::vector<double> distance, cosine;  ///< to the source; of the angle of incidence
    std::vector<double> arriving;          ///< share of the source's light: f_a, spot, shadow
    Vectors filter;                ///< what translucent surfaces leave of it, in such scenes
    std::vector<double> filtered;  ///< one channel of pigment times that
    Bounds all;                    ///< around the points
    std::vector<Bounds> boxes;     ///< around blocks of them
    Blockers blockers;             ///< between the blocks and one light
    bool shaded = false;           ///< anything may be
    std::vector<std::size_t> lit;  ///< surface points that need a shadow ray
    ShadowRays shadows;
    std::vector<double> visible;  ///< 1 where the shadow ray reaches the source, else 0
    std::vector<Index> asked;     ///< shadow rays that facets may block

    explicit LightWork(std::size_t capacity = 0);
};

/// POV-Ray's tint of metallic highlights and reflections: 1 + m (1 - F)(P - 1), where F is its
/// empirical Fresnel curve of the angle whose cosine is given (source/backend/render/trace.cpp of
/// 3.7, ComputePhongColour).
Vec3 metallic_tint(double metallic, double cosine, const Vec3& pigment);

/// Adds ambient, emitted, diffuse and highlight terms of every surface point to radiance.
void add_direct_light(const World& world, const Surfaces& surfaces, LightWork& work,
                      Vectors& radiance);

}  // namespace penumbra
