// What is measured of a pair, before it becomes figures.
#pragma once

#include "validation/compare/pair.h"
#include "validation/diagnosis/finding.h"
#include "validation/metrics/figures.h"

#include "penumbra/compare.h"

#include <opencv2/core.hpp>

#include <optional>

namespace penumbra::metrics {

/// Sums over the pixels of a region.
struct RegionSums {
    std::size_t pixels = 0, alike = 0;
    double squares = 0;                    ///< of the differences of encoded channels, and of alpha
    cv::Scalar test = {}, reference = {};  ///< of encoded colours
    double flip = 0, ssim = 0;
};

struct Measured {
    RegionSums whole = {}, covered = {}, edges = {}, inside = {};
    EdgeCounts either_edges = {};
    std::size_t inexact = 0, outliers = 0;
    PixelPair worst = {};
    double max_error = -1;
    std::optional<double> hdr_flip = {};  ///< mean
    cv::Mat alike = {};                   ///< a region
    cv::Mat flip = {}, ssim = {};         ///< CV_32F
};

/// `options` say what is background, how near outliers may have their like, and the exposure;
/// `always_hdr` that HDR-FLIP is asked for, however dark the pictures are.
Measured measure(const Pair& pair, const CompareOptions& options, bool always_hdr);

}  // namespace penumbra::metrics
