// The rays that a surface sends on: mirrored, refracted, or straight through.
#pragma once

#include "tracer/path.h"
#include "tracer/surface_points.h"

namespace penumbra {

/// Where scattered rays go.
struct Onward {
    int max_depth = 0;
    Media& media;
    Generation& next;
};

/// Pushes the rays that surface point `slot`, reached by `path`, sends on.
void scatter(const PreparedScene& prepared, const SurfacePoints& surfaces, std::size_t slot,
             const Path& path, Onward onward);

/// The objects around the point `eye` where rays start.
MediumStack media_at(const PreparedScene& prepared, const Vec3& eye, Media& media);

}  // namespace penumbra
