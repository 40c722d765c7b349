// What explains the difference of two pictures, as far as they tell. Matrices are those of
// validation/metrics/picture.h.
#pragma once

#include "penumbra/image.h"

#include <opencv2/core.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace penumbra::metrics {

/// One sentence about where pixels of `counted` are not `matched`; empty when they are. `measure`
/// is what they differ in.
std::vector<std::string> differing_area(const cv::Mat& matched, const cv::Mat& counted,
                                        const char* measure);

/// What explains the difference of two pictures.
struct Finding {
    double left = 1;            ///< fraction of the mean square error that it leaves
    std::string cause = {};     ///< identifier, as Comparison::cause; empty: nothing is known
    std::string sentence = {};  ///< a clause without a period

    /// A quarter of the mean square is half of the root mean square.
    bool convincing() const { return !cause.empty() && left < 0.25; }
};

/// The simplest of the convincing findings, among those that leave about the least.
Finding best_of(const std::vector<Finding>& simplest_first);

/// "<sentence>: that explains 97 % of the mean square error"
std::string said(const Finding& finding);

/// A linear picture, row by row: CV_32FC3. May be asked by several threads.
struct LinearRows {
    int width = 0, height = 0;
    std::function<cv::Mat(int y)> row = {};
};

/// What explains most of the difference as far as pictures tell: a shift, a wrong brightness, ...
Finding likely_cause(const LinearRows& test, const LinearRows& reference);
Finding likely_cause(const Image& test, const Image& reference);

/// Pixels, and how many of them lie beside an edge of either picture.
struct EdgeCounts {
    std::size_t pixels = 0, beside = 0;
    std::size_t differing = 0, differing_beside = 0;
};

/// Where else the difference lies when nothing explains it; no share is left out of it.
Finding only_edges(const EdgeCounts& counts);

}  // namespace penumbra::metrics
