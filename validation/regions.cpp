// Parts of a picture: what counts, what shows the scene, what lies beside an edge.
#include "metrics.h"

#include "penumbra/error.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace penumbra::metrics {
namespace {

constexpr double least_contrast = 0.1;  // of an edge, encoded

cv::Vec3f pixel(const Color& color) { return {color.x, color.y, color.z}; }

void ignore_box(cv::Mat& counted, const PixelBox& box) {
    const cv::Rect area(box.x0, box.y0, std::max(0, box.x1 - box.x0), std::max(0, box.y1 - box.y0));
    const cv::Rect inside = area & cv::Rect(0, 0, counted.cols, counted.rows);
    if (!inside.empty()) counted(inside) = 0;
}

// Does `picture` show a colour like `color` around (x, y)?
bool shows(const cv::Mat& picture, int x, int y, const cv::Vec3f& color, int radius, double step) {
    const int top = std::max(0, y - radius), bottom = std::min(picture.rows - 1, y + radius);
    const int left = std::max(0, x - radius), right = std::min(picture.cols - 1, x + radius);
    for (int v = top; v <= bottom; ++v)
        for (int u = left; u <= right; ++u)
            if (alike(picture.at<cv::Vec3f>(v, u), color, step)) return true;
    return false;
}

}  // namespace

cv::Mat counted_pixels(const CompareOptions& options, int width, int height) {
    cv::Mat counted(height, width, CV_8U, cv::Scalar(255));
    const Image& mask = options.mask;
    if (!mask.pixels.empty()) {
        if (mask.width != width || mask.height != height)
            throw Error(Failure::usage, "",
                        fmt::format("the mask has {}x{} pixels, the pictures have {}x{}",
                                    mask.width, mask.height, width, height));
        each_row(height, [&](int y) {
            for (int x = 0; x < width; ++x)
                if (alike(pixel(encoded(mask.at(x, y))), {0, 0, 0})) counted.at<uchar>(y, x) = 0;
        });
    }
    for (const PixelBox& box : options.ignored) ignore_box(counted, box);
    return counted;
}

cv::Mat covered_pixels(const cv::Mat& test_encoded, const cv::Mat& reference_encoded,
                       const std::optional<Color>& background) {
    const cv::Vec3f empty =
        background ? pixel(encoded(*background)) : border_color(reference_encoded);
    cv::Mat covered(test_encoded.size(), CV_8U);
    each_row(covered.rows, [&](int y) {
        for (int x = 0; x < covered.cols; ++x)
            covered.at<uchar>(y, x) = alike(test_encoded.at<cv::Vec3f>(y, x), empty) &&
                                              alike(reference_encoded.at<cv::Vec3f>(y, x), empty)
                                          ? 0
                                          : 255;
    });
    return covered;
}

// The morphological gradient of Beucher and Lantuejoul 1979, of each channel.
cv::Mat edge_band(const cv::Mat& encoded) {
    const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
    cv::Mat highest, lowest;
    cv::dilate(encoded, highest, square);
    cv::erode(encoded, lowest, square);
    cv::Mat band(encoded.size(), CV_8U);
    each_row(band.rows, [&](int y) {
        for (int x = 0; x < band.cols; ++x) {
            const cv::Vec3f span = highest.at<cv::Vec3f>(y, x) - lowest.at<cv::Vec3f>(y, x);
            band.at<uchar>(y, x) =
                double(std::max({span[0], span[1], span[2]})) > least_contrast ? 255 : 0;
        }
    });
    return band;
}

cv::Mat matched_pixels(const cv::Mat& test_encoded, const cv::Mat& reference_encoded, int radius,
                       double step) {
    cv::Mat matched(test_encoded.size(), CV_8U);
    each_row(matched.rows, [&](int y) {
        for (int x = 0; x < matched.cols; ++x) {
            const auto& a = test_encoded.at<cv::Vec3f>(y, x);
            const auto& b = reference_encoded.at<cv::Vec3f>(y, x);
            const bool found = alike(a, b, step) ||
                               (radius > 0 && shows(reference_encoded, x, y, a, radius, step) &&
                                shows(test_encoded, x, y, b, radius, step));
            matched.at<uchar>(y, x) = found ? 255 : 0;
        }
    });
    return matched;
}

}  // namespace penumbra::metrics

namespace penumbra {

Image masked_reference(const Image& test, Image reference, const CompareOptions& options) {
    const cv::Mat counted = metrics::counted_pixels(options, test.width, test.height);
    for (int y = 0; y < test.height; ++y)
        for (int x = 0; x < test.width; ++x)
            if (counted.at<uchar>(y, x) == 0) reference.at(x, y) = test.at(x, y);
    return reference;
}

}  // namespace penumbra
