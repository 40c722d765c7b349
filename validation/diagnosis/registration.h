// How one picture lies over the other. Matrices are those of validation/metrics/picture.h.
#pragma once

#include <opencv2/core.hpp>

namespace penumbra::metrics {

/// How one picture lies over another, about the middle: a point p of the test picture shows what
/// the reference shows at p - shift - zoom p - roll perpendicular(p).
struct Motion {
    double dx = 0, dy = 0;  ///< pixels
    double zoom = 0;        ///< 1 - 1 / the test picture's scale
    double roll = 0;        ///< radians, clockwise
};

/// One kind of motion, what it is, and what it leaves of the mean square error.
struct Registration {
    Motion motion = {};
    double left = 1;
};

enum class Moves { shift, zoom, roll, all };

/// The best motion of a kind. Pictures are compared through a blur of two and a half pixels,
/// because one sample a pixel makes edges jump by whole pixels. Small pictures have none. Also
/// takes pictures in 16 bits, CV_16UC3.
Registration register_pictures(const cv::Mat& test_encoded, const cv::Mat& reference_encoded,
                               Moves moves);

}  // namespace penumbra::metrics
