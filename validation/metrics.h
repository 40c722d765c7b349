// The parts that compare() is made of. Pictures are OpenCV matrices here: CV_32FC3, RGB order;
// `encoded` ones are clamped to [0, 1] and sRGB-encoded.
#pragma once

#include "penumbra/image.h"
#include "penumbra/math.h"
#include "penumbra/validation.h"

#include <opencv2/core.hpp>

#include <array>
#include <optional>
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

/// `color` as a display shows it: clamped to [0, 1] and sRGB-encoded. NaN stays NaN.
Color encoded(const Color& color);
cv::Mat encoded(const Image& image);

/// The pixels of `image` without a copy.
cv::Mat view(const Image& image);

/// SSIM of each pixel, mean of the three channels: CV_32F.
cv::Mat ssim_map(const cv::Mat& test_encoded, const cv::Mat& reference_encoded);

/// LDR-FLIP of each pixel: CV_32F in [0, 1].
cv::Mat flip_map(const Image& test, const Image& reference);

enum class Worst { smallest, largest };

/// The worst mean of `map` over square tiles of `side` pixels. The last tile of a row or column
/// is moved inwards, so that all have the same area; a smaller picture is one tile.
double worst_tile(const cv::Mat& map, int side, Worst worst);

/// The value that the fraction `q` of all pixels does not exceed (nearest rank).
double quantile(const cv::Mat& map, double q);

/// Fraction of pixels where either picture shows something else than the background.
double coverage(const cv::Mat& test_encoded, const cv::Mat& reference_encoded,
                const std::optional<Color>& background);

/// True when the encoded colours differ by no more than 1/255 in any channel; never with NaN.
bool alike(const cv::Vec3f& a, const cv::Vec3f& b);

/// One sentence about where the pictures are not alike; empty when they are.
std::vector<std::string> differing_area(const cv::Mat& test_encoded,
                                        const cv::Mat& reference_encoded);

/// One sentence that names a single cause, such as a shift or a wrong brightness, that explains
/// most of the difference; empty when none does.
std::vector<std::string> likely_cause(const Image& test, const Image& reference);

/// Why the pictures cannot be compared at all; empty when they can (coverage is not looked at).
std::vector<std::string> obstacles(const Image& test, const Image& reference);

/// 16 evenly spaced colours of the magma map, sRGB 0xRRGGBB.
extern const std::array<unsigned, 16> magma;

}  // namespace penumbra::metrics
