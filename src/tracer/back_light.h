// Light that falls on the other side of a surface and is scattered through it.
#pragma once

#include "tracer/surface_points.h"

namespace penumbra {

/// Adds what the backlit ones among the surface points show of the light from behind.
void add_back_light(const PreparedScene& prepared, const SurfacePoints& surfaces,
                    Vec3Array& radiance);

}  // namespace penumbra
