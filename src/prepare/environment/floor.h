// The seamless floor of an Environment's stage.
#pragma once

#include "penumbra/scene.h"

#include <vector>

namespace penumbra {

/// The radiance of that floor where nothing shades it, by directional lights: the same everywhere,
/// so that a background of that colour hides its horizon.
Color floor_radiance(const std::vector<Light>& lights);

/// Lays it, unless it would hide something: see Environment::stage.
void give_floor(Scene& scene);

}  // namespace penumbra
