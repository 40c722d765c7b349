// Parts of a picture, as matrices of picture.h.
#pragma once

#include "validation/metrics/picture.h"

#include "penumbra/compare.h"

#include <opencv2/core.hpp>

#include <vector>

namespace penumbra::metrics {

/// Pixels that count: not ignored by the options. Throws Error (usage) when the mask has another
/// size than the pictures.
cv::Mat counted_pixels(const CompareOptions& options, int width, int height);

/// Where either picture shows something else than the background.
cv::Mat covered_pixels(const Shown& test, const Shown& reference, const Background& background);

/// Rows first <= y < last of a picture's pixels, row by row from the top, as a region.
cv::Mat rows_of(const std::vector<bool>& pixels, int width, int first, int last);

/// Pixels beside an edge: whose 3 x 3 neighbourhood spans more than a tenth in some channel.
cv::Mat edge_band(const cv::Mat& encoded);

/// Where each picture shows a colour, with its alpha, that the other one has no more than `radius`
/// pixels away, within `step`.
cv::Mat matched_pixels(const Shown& test, const Shown& reference, int radius, double step);

}  // namespace penumbra::metrics
