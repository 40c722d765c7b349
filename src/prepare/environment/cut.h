// An image of all directions -> parallel lights that stand for its parts.
#pragma once

#include "prepare/environment/sky_cells.h"

#include <vector>

namespace penumbra {

/// A parallel light.
struct SkySource {
    Vec3 toward = Vec3(0);  ///< unit, to the light
    Vec3 flux = Vec3(0);    ///< RGB irradiance of what faces it
};

struct SkySources {
    std::vector<SkySource> sources = {};
    /// The square, in radians, of the radius of a disc that stands for a source's part of the sky:
    /// the variance by which a highlight is widened so that those of neighbours melt into one.
    double spread = 0;
};

/// The part of the light, from 0 on, that each cell belongs to: `count` parts, or fewer of light
/// that comes from fewer cells. Cuts the part with the largest variance in longitude or latitude
/// where the variances of both sides are least together, again and again: the median cut of Debevec
/// (A Median Cut Algorithm for Light Probe Sampling, 2005) with variance on the sphere in place of
/// area times energy. Sums are taken from tables (Crow 1984).
std::vector<int> cut_by_variance(const SkyCells& cells, int count);

/// Moves cells to the part whose mean direction is nearest, a few times (Lloyd 1982).
void relax(const SkyCells& cells, std::vector<int>& part_of);

/// Cuts, relaxes and sums up. The sum of all flux is that of the image. The result is the same on
/// all machines: what differs by rounding alone is a tie.
SkySources sky_sources(const SkyCells& cells, int count);

}  // namespace penumbra
