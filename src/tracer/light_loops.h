// The dense loops of the light that reaches surfaces: one source, a block of neighbouring points.
#pragma once

#include "tracer/blockers.h"
#include "tracer/surface_points.h"

namespace penumbra {

/// Neighbouring surface points, [first, last) of SurfacePoints.
struct Block {
    std::size_t first = 0, last = 0;
    bool shines = false;  ///< some of them have highlights
};

/// What is known of surface points and one source, one entry a point.
struct LightSamples {
    Vec3Array toward;                      ///< unit, to the source
    std::vector<double> distance, cosine;  ///< to the source; of the angle of incidence
    std::vector<double> share;             ///< of the source's light: f_a, spot, shadow
    std::vector<double> reflected;         ///< cosine of the mirrored eye ray to the source
    std::vector<double> sin_to_facet;      ///< sine of the angle to the facet, no less than 0
    // In scenes with translucent surfaces:
    Vec3Array filter;    ///< what they leave of the light
    Vec3Array filtered;  ///< that, times the pigment

    explicit LightSamples(std::size_t capacity = 0);
};

/// Sets toward, distance, cosine and share (1 where the surface faces the source, else 0).
void aim(const PreparedSource& source, const SurfacePoints& surfaces, const Block& block,
         LightSamples& out);

/// Multiplies the share by what distance and cone leave, and makes what is too weak nothing.
void weigh(const PreparedSource& source, const Block& block, LightSamples& out);

/// Sets the sin_to_facet of the rays to the source.
void find_sin_to_facet(const SurfacePoints& surfaces, const Block& block, LightSamples& out);

/// Sets the cosine of the mirrored eye ray.
void find_reflected(const SurfacePoints& surfaces, const Block& block, LightSamples& out);

/// Adds the light of `color` that points with these pigments scatter to radiance.
void add_diffuse(const Vec3& color, const Vec3Array& pigments, const std::vector<double>& diffuse,
                 const Block& block, const LightSamples& arrival, Vec3Array& radiance);

/// aim() and add_diffuse() of all sources of a light, for matte points that nothing can shade and
/// sources that are plain(): nothing is stored between the steps.
void add_open_matte(const SourceGroup& light, const SurfacePoints& surfaces, const Block& block,
                    Vec3Array& radiance);

/// Is it made of points or parallel light that neither fade nor are too weak to count?
bool plain(const SourceGroup& light);

}  // namespace penumbra
