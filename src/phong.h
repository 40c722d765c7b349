// Metallic-roughness -> the terms of a Phong surface, for one point of it.
#pragma once

#include "penumbra/scene.h"

namespace penumbra {

/// What follows from the roughness alone; phong.cpp explains the terms.
struct Polish {
    double highlight = 0;  ///< K_S of a surface that reflects all, not limited
    double exponent = 1;   ///< N
    double sharp = 0;      ///< the part of what is reflected that is seen as a mirror image
};
Polish polish_of(double roughness);

/// K_D: how much of the base colour is scattered evenly. `highlight` is K_S over the base colour.
double scattered(const Polish& polish, double metallic, double f0, double highlight);

/// Highlight and mirror of a surface that reflects all, to be tinted by what it does reflect, which
/// is at most `strongest`. The highlight is at most `limit`.
Lobe full_lobe(double roughness, double limit, double strongest);

/// Lays a clear coat of the reflectance `f0` over `lobe`: its mirror image is added, of the two
/// highlights the stronger one stays.
void add_coat(Lobe& lobe, double f0, double roughness);

}  // namespace penumbra
