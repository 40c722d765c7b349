// The seamless floor of an Environment's stage.
#pragma once

#include "penumbra/scene.h"

#include <vector>

namespace penumbra {

/// The radiance of that floor where nothing shades it, by directional lights: the same everywhere,
/// so that a background of that colour hides its horizon.
Color floor_radiance(const std::vector<Light>& lights);

/// Lays it, unless it would hide something: see Environment::stage. Returns whether it did.
bool give_floor(Scene& scene);

/// The image of all directions as it is over that floor, which from below sends back what falls on
/// it from above; it is what things and mirrors get of it. Laid out as Sky says.
Texture over_floor(const Texture& around);

}  // namespace penumbra
