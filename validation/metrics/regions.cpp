// Parts of a picture: what counts, what shows the scene, what lies beside an edge.
#include "validation/metrics/regions.h"

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

bool alike_at(const Shown& one, const cv::Point& at, const Shown& other, const cv::Point& there,
              double step) {
    return alike(one.color.at<cv::Vec3f>(at), other.color.at<cv::Vec3f>(there), step) &&
           alike(one.alpha_at(at.y, at.x), other.alpha_at(there.y, there.x), step);
}

// Does `picture` show around (x, y) what `other` shows there?
bool shows(const Shown& picture, const Shown& other, int x, int y, int radius, double step) {
    const int rows = picture.color.rows, cols = picture.color.cols;
    const int top = std::max(0, y - radius), bottom = std::min(rows - 1, y + radius);
    const int left = std::max(0, x - radius), right = std::min(cols - 1, x + radius);
    for (int v = top; v <= bottom; ++v)
        for (int u = left; u <= right; ++u)
            if (alike_at(other, {x, y}, picture, {u, v}, step)) return true;
    return false;
}

bool empty_at(const Shown& picture, int y, int x, const Background& background) {
    return alike(picture.color.at<cv::Vec3f>(y, x), background.color) &&
           alike(picture.alpha_at(y, x), background.alpha);
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

cv::Mat covered_pixels(const Shown& test, const Shown& reference, const Background& background) {
    cv::Mat covered(test.color.size(), CV_8U);
    each_row(covered.rows, [&](int y) {
        for (int x = 0; x < covered.cols; ++x)
            covered.at<uchar>(y, x) =
                empty_at(test, y, x, background) && empty_at(reference, y, x, background) ? 0 : 255;
    });
    return covered;
}

// The morphological gradient of Beucher and Lantuejoul 1979, of each channel.
cv::Mat rows_of(const std::vector<bool>& pixels, int width, int first, int last) {
    cv::Mat region(last - first, width, CV_8U);
    auto pixel = pixels.begin() + std::ptrdiff_t(first) * width;
    for (uchar& value : cv::Mat_<uchar>(region)) value = *pixel++ ? 255 : 0;
    return region;
}

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

cv::Mat matched_pixels(const Shown& test, const Shown& reference, int radius, double step) {
    cv::Mat matched(test.color.size(), CV_8U);
    each_row(matched.rows, [&](int y) {
        for (int x = 0; x < matched.cols; ++x) {
            const bool found = alike_at(test, {x, y}, reference, {x, y}, step) ||
                               (radius > 0 && shows(reference, test, x, y, radius, step) &&
                                shows(test, reference, x, y, radius, step));
            matched.at<uchar>(y, x) = found ? 255 : 0;
        }
    });
    return matched;
}

}  // namespace penumbra::metrics

namespace penumbra {

Image masked_reference(const Image& test, Image reference, const CompareOptions& options) {
    metrics::check_fit(test, reference);
    const cv::Mat counted = metrics::counted_pixels(options, test.width, test.height);
    for (int y = 0; y < test.height; ++y)
        for (int x = 0; x < test.width; ++x)
            if (counted.at<uchar>(y, x) == 0) reference.at(x, y) = test.at(x, y);
    return reference;
}

}  // namespace penumbra
