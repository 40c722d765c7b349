// Pictures as OpenCV matrices: CV_32FC3, RGB order. `encoded` ones are clamped to [0, 1] and
// sRGB-encoded; a region is CV_8U: 255 inside, 0 outside.
#pragma once

#include "penumbra/image.h"
#include "penumbra/math.h"

#include <opencv2/core.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <new>
#include <string>
#include <vector>

namespace penumbra::metrics {

/// Runs `row(y)` for every row, on all cores. Rows must not share what they write.
template <class Row>
void each_row(int height, const Row& row) {
    cv::parallel_for_(cv::Range(0, height), [&](const cv::Range& range) {
        for (int y = range.start; y < range.end; ++y) row(y);
    });
}

/// Calls `work`, and makes what OpenCV throws where there is no memory std::bad_alloc.
template <class Work>
void with_own_errors(const Work& work) {
    try {
        work();
    } catch (const cv::Exception& error) {
        if (error.code == cv::Error::StsNoMem) throw std::bad_alloc();
        throw;
    }
}

/// `color` as a display shows it: clamped to [0, 1] and sRGB-encoded. NaN stays NaN.
Color encoded(const Color& color);
cv::Mat encoded(const cv::Mat& linear);

/// Encoded colours and their alpha, CV_32F; without a matrix alpha is 1 everywhere.
struct Shown {
    cv::Mat color = {}, alpha = {};

    float alpha_at(int y, int x) const { return alpha.empty() ? 1 : alpha.at<float>(y, x); }
};

/// `map` of each channel.
cv::Mat mapped(const cv::Mat& image, const std::function<float(float)>& map);

/// The pixels of `image` without a copy.
cv::Mat view(const Image& image);

/// Encoded colours that are no farther apart than this count as equal.
inline constexpr double display_step = 1.0 / 255 + 1e-6;
/// Encoded colours that are farther apart than this are outliers.
inline constexpr double outlier_step = 8.0 / 255 + 1e-6;

/// True when the encoded colours differ by no more than `step` in any channel; never with NaN.
bool alike(const cv::Vec3f& a, const cv::Vec3f& b, double step = display_step);

bool alike(float alpha, float other_alpha, double step = display_step);

/// A colour and its alpha.
struct Background {
    cv::Vec3f color = {};
    float alpha = 1;
};

/// What most of the pixels that are counted have, to 8 bits.
class Majority {
  public:
    void count(const cv::Vec3f& encoded, float alpha = 1);
    /// Precondition: something was counted.
    Background most() const;

  private:
    std::map<std::array<int, 4>, std::size_t> counts_;
};

/// Mean over pixels and channels of the squared difference.
double mean_square(const cv::Mat& a, const cv::Mat& b);

/// Why the pictures cannot be laid over each other: one is empty, or their sizes differ.
std::vector<std::string> misfits(const Image& test, const Image& reference);

/// Throws Error (usage) with the first of these.
void check_fit(const Image& test, const Image& reference);

}  // namespace penumbra::metrics
