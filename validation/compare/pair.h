// Both pictures as they are compared, a few rows at a time, so that there is never a second copy of
// a large picture.
#pragma once

#include "validation/metrics/picture.h"

#include "penumbra/compare.h"
#include "penumbra/picture.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace penumbra::metrics {

/// A picture wherever it is kept.
struct Source {
    const Image& colors;
    const Raster& alpha;  ///< one channel; without data it is 1 everywhere
};

/// Rows of both pictures, linear. An alpha without a matrix is 1 everywhere.
struct Rows {
    cv::Mat test = {}, reference = {};              ///< CV_32FC3
    cv::Mat test_alpha = {}, reference_alpha = {};  ///< CV_32F

    bool opaque() const { return test_alpha.empty() && reference_alpha.empty(); }
};

/// Rows of both pictures as they are displayed.
struct ShownRows {
    Shown test = {}, reference = {};
};
ShownRows shown(const Rows& linear);

/// Both laid over white instead of black.
Rows over_white(const Rows& rows);

/// Rows first <= y < last of a picture, and those that lie so near that they matter to these.
struct Span {
    int first = 0, last = 0;
    int top = 0, bottom = 0;

    /// Rows first to last of a matrix of the rows from top to bottom.
    cv::Mat inner(const cv::Mat& rows) const { return rows.rowRange(first - top, last - top); }
};

/// What is measured and how: ignored pixels do not differ, nor do those that lie within the shift
/// tolerance of their like. Refers to the pictures.
class Pair {
  public:
    /// The pictures fit. `counted` is a region.
    Pair(const Source& test, const Source& reference, const cv::Mat& counted);

    int width() const { return test_.colors.width; }
    int height() const { return test_.colors.height; }
    const cv::Mat& counted() const { return counted_; }
    bool opaque() const { return test_.alpha.data.empty() && reference_.alpha.data.empty(); }

    /// A sentence for each picture with pixels that are counted and NaN or infinite.
    std::vector<std::string> not_finite() const;
    /// Lets pixels have the colour of any that is so near, in pixels. `gain` is that of the
    /// display.
    void tolerate_shifts(int tolerance, float gain);

    /// The rows, copied, `gain` times as bright.
    Rows rows(int first, int last, float gain) const;

    /// Calls `work` with spans that have all rows, in order, with up to `halo` more on both sides.
    template <class Work>
    void each_span(int halo, const Work& work) const {
        for (int first = 0; first < height(); first += step()) {
            const int last = std::min(first + step(), height());
            work(Span{first, last, std::max(0, first - halo), std::min(height(), last + halo)});
        }
    }

    /// How many pixels a span has at most, with its halo.
    std::size_t most_in_span(int halo) const {
        return std::size_t(width()) * std::size_t(std::min(height(), step() + 2 * halo));
    }

  private:
    // Rows of a span. Filters take some 250 bytes for each pixel, and the halo is filtered twice.
    int step() const {
        constexpr int pixels = 1 << 18, least = 32, most = 128;
        return std::clamp(pixels / width(), least, most);
    }

    Source test_, reference_;
    cv::Mat counted_;
    cv::Mat settled_ = {};  ///< a region: the test picture shows the reference there

    void fill_row(int y, int to, float gain, Rows& rows) const;
};

}  // namespace penumbra::metrics
