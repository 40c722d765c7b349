// An image of all directions, as cells of light.
#pragma once

#include "penumbra/math.h"
#include "penumbra/scene.h"

#include <vector>

namespace penumbra {

/// Light from some directions: its luminance (Rec. 709) summed over solid angle, and the same
/// weighed by direction.
struct LightMoments {
    double energy = 0;
    Vec3 vector = Vec3(0);

    void add(const LightMoments& other) {
        energy += other.energy;
        vector += other.vector;
    }
    /// Half the mean square of the chords between the directions, times `energy`.
    double variance() const {
        return energy > 0 ? std::max(0.0, energy - vector.length2() / energy) : 0;
    }
};

/// Light by longitude and latitude; row by row from the top of the image.
struct SkyCells {
    int width = 0, height = 0;
    std::vector<LightMoments> moments = {};
    std::vector<Vec3> flux = {};  ///< RGB radiance summed over solid angle

    std::size_t at(int x, int y) const {
        return std::size_t(y) * std::size_t(width) + std::size_t(x);
    }
};

/// At most 512 x 256 cells of an equirectangular image, laid out as Sky says, and a quarter of them
/// for up to 256 sources: more than a hundred make one. What is negative or not a number counts as
/// 0.
SkyCells sky_cells(const Texture& texture, int sources = 4096);

}  // namespace penumbra
