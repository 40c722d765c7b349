// The rays of a camera.
#pragma once

#include "penumbra/light_model.h"

namespace penumbra {

struct CameraRay {
    Vec3 origin = Vec3(0), direction = Vec3(0);  ///< unit
};

/// The ray through the point (u, v) of the picture, u right and v up in [-1/2, 1/2].
inline CameraRay camera_ray(const View& view, double u, double v) {
    const Vec3 shift = view.right * u + view.up * v;
    if (view.orthographic) return {view.location + shift, view.direction};
    return {view.location, (view.direction + shift).normalized()};
}

}  // namespace penumbra
