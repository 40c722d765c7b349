// The light that reaches surfaces from the sources, and what they send to the eye of it.
#pragma once

#include "surface.h"

namespace penumbra {

/// Scratch space of add_direct_light(), kept between calls.
struct LightWork {
    Vectors toward;  ///< unit, to the source
    std::vector<double> distance, cosine, strength;
    std::vector<std::size_t> lit;  ///< surface points that face the source
    ShadowRays shadows;
    std::vector<unsigned char> visible;

    explicit LightWork(std::size_t capacity = 0);
};

/// POV-Ray's tint of metallic highlights and reflections: 1 + m (1 - F)(P - 1), where F is its
/// empirical Fresnel curve of the angle whose cosine is given (source/backend/render/trace.cpp of
/// 3.7, ComputePhongColour).
Vec3 metallic_tint(double metallic, double cosine, const Vec3& pigment);

/// Adds ambient, emitted, diffuse and highlight terms of every surface point to radiance[i].
void add_direct_light(const World& world, const Surfaces& surfaces, LightWork& work,
                      std::vector<Vec3>& radiance);

}  // namespace penumbra
