// How one picture lies over the other: the method of Lucas and Kanade 1981, "An Iterative Image
// Registration Technique with an Application to Stereo Vision", from coarse to fine.
#include "validation/diagnosis/registration.h"

#include "base/luminance.h"
#include "validation/metrics/picture.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::metrics {
namespace {

using Parameters = std::array<double, 4>;  // dx, dy, zoom, roll

constexpr int working_size = 400;  // pixels; larger pictures are reduced
constexpr int least_size = 24;
constexpr double finest_blur = 2.5;  // pixels

std::array<bool, 4> free_parameters(Moves moves) {
    switch (moves) {
    case Moves::shift: return {true, true, false, false};
    case Moves::zoom: return {false, false, true, false};
    case Moves::roll: return {false, false, false, true};
    case Moves::all: break;
    }
    return {true, true, true, true};
}

cv::Mat luma(const cv::Mat& encoded) {
    cv::Mat result;
    const auto& [red, green, blue] = luminance_weights;
    cv::transform(encoded, result, cv::Matx13f(float(red), float(green), float(blue)));
    return result;
}

cv::Mat blurred(const cv::Mat& image, double sigma) {
    cv::Mat result;
    cv::GaussianBlur(image, result, {0, 0}, sigma, sigma, cv::BORDER_REPLICATE);
    return result;
}

// What the test picture would be if it were the reference moved like this.
cv::Mat moved(const cv::Mat& reference, const Parameters& p) {
    const double x = (reference.cols - 1) / 2.0, y = (reference.rows - 1) / 2.0;
    // (u, v) from the middle comes from (1 - zoom)(u, v) - roll (-v, u) - (dx, dy).
    const double s = 1 - p[2], r = p[3];
    const cv::Matx23d map(s, r, x - p[0] - s * x - r * y, -r, s, y - p[1] + r * x - s * y);
    cv::Mat result;
    cv::warpAffine(reference, result, map, reference.size(), cv::INTER_CUBIC | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REPLICATE);
    return result;
}

// Where the border has no part in it.
cv::Mat inner(const cv::Mat& image) {
    const int margin = std::clamp(std::min(image.cols, image.rows) / 10, 3, 12);
    return image(cv::Rect(margin, margin, image.cols - 2 * margin, image.rows - 2 * margin));
}

// One Gauss-Newton step: what to add to the parameters.
Parameters step(const cv::Mat& test, const cv::Mat& warped, const std::array<bool, 4>& free) {
    cv::Mat along_x, along_y;
    cv::Sobel(warped, along_x, CV_32F, 1, 0, 3, 1.0 / 8);
    cv::Sobel(warped, along_y, CV_32F, 0, 1, 3, 1.0 / 8);
    const cv::Mat a = inner(test), b = inner(warped), gx = inner(along_x), gy = inner(along_y);
    cv::Matx44d normal = cv::Matx44d::zeros();
    cv::Vec4d right = cv::Vec4d::all(0);
    for (int y = 0; y < a.rows; ++y) {
        for (int x = 0; x < a.cols; ++x) {
            const double u = x - (a.cols - 1) / 2.0, v = y - (a.rows - 1) / 2.0;
            const double dx = -double(gx.at<float>(y, x)), dy = -double(gy.at<float>(y, x));
            const cv::Vec4d slope(dx, dy, dx * u + dy * v, -dx * v + dy * u);
            const double error = double(a.at<float>(y, x)) - double(b.at<float>(y, x));
            for (int i = 0; i < 4; ++i) {
                right[i] += slope[i] * error;
                for (int j = 0; j < 4; ++j) normal(i, j) += slope[i] * slope[j];
            }
        }
    }
    for (int i = 0; i < 4; ++i) {
        if (free[std::size_t(i)]) continue;
        for (int j = 0; j < 4; ++j) normal(i, j) = normal(j, i) = 0;
        normal(i, i) = 1;
        right[i] = 0;
    }
    for (int i = 0; i < 4; ++i) normal(i, i) *= 1 + 1e-6;
    cv::Vec4d result = cv::Vec4d::all(0);
    cv::solve(normal, right, result, cv::DECOMP_SVD);
    return {result[0], result[1], result[2], result[3]};
}

double left_by(const cv::Mat& test, const cv::Mat& reference, const Parameters& p) {
    const double before = mean_square(inner(test), inner(reference));
    return before > 0 ? mean_square(inner(test), inner(moved(reference, p))) / before : 1;
}

}  // namespace

Registration register_pictures(const cv::Mat& test_encoded, const cv::Mat& reference_encoded,
                               Moves moves) {
    if (std::min(test_encoded.cols, test_encoded.rows) < least_size) return {};
    cv::Mat test = test_encoded, reference = reference_encoded;
    const double reduction = std::max(1.0, double(test.cols) / working_size);
    if (reduction > 1) {
        const cv::Size size(working_size, std::max(least_size, cvRound(test.rows / reduction)));
        cv::resize(test, test, size, 0, 0, cv::INTER_AREA);
        cv::resize(reference, reference, size, 0, 0, cv::INTER_AREA);
    }
    for (cv::Mat* picture : {&test, &reference})
        if (picture->depth() == CV_16U) picture->convertTo(*picture, CV_32F, 1.0 / 65535);
    const std::array<bool, 4> free = free_parameters(moves);
    const cv::Mat gray = luma(test), other = luma(reference);
    Parameters p = {};
    for (const double sigma : {8.0, 4.0, finest_blur}) {
        const cv::Mat a = blurred(gray, sigma), b = blurred(other, sigma);
        for (int i = 0; i < 6; ++i) {
            const Parameters delta = step(a, moved(b, p), free);
            for (std::size_t k = 0; k < 4; ++k) p[k] += delta[k];
            if (!(std::abs(p[0]) + std::abs(p[1]) < 16 && std::abs(p[2]) + std::abs(p[3]) < 0.2))
                return {};
        }
    }
    const Registration result = {
        .motion = {p[0] * reduction, p[1] * reduction, p[2], p[3]},
        .left = left_by(blurred(test, finest_blur), blurred(reference, finest_blur), p)};
    return std::isfinite(result.left) ? result : Registration{};
}

}  // namespace penumbra::metrics
