// LDR-FLIP, the perceived difference of two pictures that alternate on a display.
//
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A Difference
// Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2). Section numbers
// below are those of the paper. Its filters are products or sums of products of one-dimensional
// ones, so each is applied along rows and then along columns; pixels beyond the border repeat it.
#include "validation/metrics/figures.h"
#include "validation/metrics/picture.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

namespace penumbra::metrics {
namespace {

constexpr double pixels_per_degree = 67;  // a 0.7 m wide 3840 pixel display seen from 0.7 m

// Linear sRGB to CIE XYZ and the white that it gives for (1, 1, 1), in fractions of IEC 61966-2-1's
// primaries and D65 (0.3127, 0.3290).
const cv::Matx33f rgb_to_xyz =
    cv::Matx33d{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,
                2613072.0 / 12288897,  8788810.0 / 12288897, 887015.0 / 12288897,
                1425312.0 / 73733382,  8788810.0 / 73733382, 70074185.0 / 73733382};
const cv::Matx33f xyz_to_rgb = rgb_to_xyz.inv();
const cv::Vec3f white = rgb_to_xyz * cv::Vec3f(1, 1, 1);

// ---- colours ----------------------------------------------------------------------------------

// XYZ relative to white.
cv::Vec3f relative_xyz(const cv::Vec3f& rgb) {
    const cv::Vec3f xyz = rgb_to_xyz * rgb;
    return {xyz[0] / white[0], xyz[1] / white[1], xyz[2] / white[2]};
}

// The linear opponent space YCxCz of section 4.1.1.
cv::Vec3f ycxcz(const cv::Vec3f& rgb) {
    const cv::Vec3f n = relative_xyz(rgb);
    return {116 * n[1] - 16, 500 * (n[0] - n[1]), 200 * (n[1] - n[2])};
}

cv::Vec3f rgb_of_ycxcz(const cv::Vec3f& c) {
    const float y = (c[0] + 16) / 116;
    const cv::Vec3f xyz = {(y + c[1] / 500) * white[0], y * white[1], (y - c[2] / 200) * white[2]};
    return xyz_to_rgb * xyz;
}

// CIELAB's compression.
float lightness(float t) {
    constexpr float delta = 6.F / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.F / 29;
}

// CIELAB with the Hunt effect: chroma fades with lightness (section 4.1.3).
cv::Vec3f hunt_lab(const cv::Vec3f& rgb) {
    const cv::Vec3f n = relative_xyz(rgb);
    const float x = lightness(n[0]), y = lightness(n[1]), z = lightness(n[2]);
    const float l = 116 * y - 16;
    return {l, 0.01F * l * 500 * (x - y), 0.01F * l * 200 * (y - z)};
}

// The colour distance HyAB (section 4.1.4).
float hyab(const cv::Vec3f& a, const cv::Vec3f& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// Maps HyAB to [0, 1]: 0.4 of the largest power is stretched over 0.95 of it (section 4.1.5).
float redistributed(float distance) {
    constexpr float qc = 0.7F, pc = 0.4F, pt = 0.95F;
    static const float largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), qc);
    const float power = std::pow(distance, qc), knee = pc * largest;
    return power < knee ? pt / knee * power : pt + (power - knee) / (largest - knee) * (1 - pt);
}

// ---- filters ----------------------------------------------------------------------------------

template <class Weight>
cv::Mat kernel(int radius, const Weight& weight) {
    cv::Mat result(2 * radius + 1, 1, CV_64F);
    for (int i = -radius; i <= radius; ++i) result.at<double>(i + radius) = weight(double(i));
    return result;
}

cv::Mat filtered(const cv::Mat& plane, const cv::Mat& along_x, const cv::Mat& along_y) {
    cv::Mat result;
    cv::sepFilter2D(plane, result, CV_32F, along_x, along_y, {-1, -1}, 0, cv::BORDER_REPLICATE);
    return result;
}

// One term a sqrt(pi/b) exp(-pi^2 d^2 / b) of a contrast sensitivity function, d in degrees.
struct Term {
    double a, b;
};

// The filters are cut at three standard deviations of the widest term, 0.04.
const int sensitivity_radius = int(
    std::ceil(3 * std::sqrt(0.04 / (2 * std::numbers::pi * std::numbers::pi)) * pixels_per_degree));

cv::Mat blurred(const cv::Mat& plane, const std::vector<Term>& terms) {
    cv::Mat result = cv::Mat::zeros(plane.size(), CV_32F);
    double total = 0;
    for (const Term& term : terms) {
        const cv::Mat line = kernel(sensitivity_radius, [&](double i) {
            const double x = i / pixels_per_degree;
            return std::exp(-std::numbers::pi * std::numbers::pi * x * x / term.b);
        });
        const double sum = cv::sum(line)[0];
        const double weight = term.a * std::sqrt(std::numbers::pi / term.b) * sum * sum;
        const cv::Mat normal = line / sum;
        cv::scaleAdd(filtered(plane, normal, normal), weight, result, result);
        total += weight;
    }
    return result / total;
}

// Derivative kernels have positive weights of sum 1 and negative ones of sum -1.
cv::Mat balanced(cv::Mat line) {
    double positive = 0, negative = 0;
    for (int i = 0; i < line.rows; ++i) {
        const double weight = line.at<double>(i);
        (weight > 0 ? positive : negative) += std::abs(weight);
    }
    for (int i = 0; i < line.rows; ++i) {
        double& weight = line.at<double>(i);
        weight /= weight > 0 ? positive : negative;
    }
    return line;
}

// Strength of edges (first derivative) and of points (second), section 4.2.
struct Features {
    cv::Mat edges, points;
};

Features features(const cv::Mat& y) {
    const double sd = 0.5 * 0.082 * pixels_per_degree;
    const int radius = int(std::ceil(3 * sd));
    const auto gauss = [&](double x) { return std::exp(-x * x / (2 * sd * sd)); };
    const cv::Mat line = kernel(radius, gauss), across = line / cv::sum(line)[0];
    const auto strength = [&](const cv::Mat& along) {
        cv::Mat result;
        cv::magnitude(filtered(y, along, across), filtered(y, across, along), result);
        return result;
    };
    return {strength(balanced(kernel(radius, [&](double x) { return -x * gauss(x); }))),
            strength(balanced(
                kernel(radius, [&](double x) { return (x * x / (sd * sd) - 1) * gauss(x); })))};
}

// ---- one picture ------------------------------------------------------------------------------

struct Seen {
    cv::Mat luma, colour;  // CV_32F of [0, 1]; CV_32FC3 of Hunt-adjusted CIELAB
    Features feature;
};

Seen seen(const cv::Mat& image) {
    const cv::Size size = image.size();
    std::array<cv::Mat, 3> planes;
    for (cv::Mat& plane : planes) plane.create(size, CV_32F);
    each_row(size.height, [&](int y) {
        for (int x = 0; x < size.width; ++x) {
            const auto& c = image.at<cv::Vec3f>(y, x);
            const cv::Vec3f opponent =
                ycxcz({std::clamp(c[0], 0.F, 1.F), std::clamp(c[1], 0.F, 1.F),
                       std::clamp(c[2], 0.F, 1.F)});
            for (int i = 0; i < 3; ++i) planes[std::size_t(i)].at<float>(y, x) = opponent[i];
        }
    });
    Seen result;
    result.luma = (planes[0] + 16) / 116;
    result.feature = features(result.luma);

    // Contrast sensitivity of the achromatic, red-green and blue-yellow channels, section 4.1.2.
    planes = {blurred(planes[0], {{1, 0.0047}}), blurred(planes[1], {{1, 0.0053}}),
              blurred(planes[2], {{34.1, 0.04}, {13.5, 0.025}})};
    result.colour.create(size, CV_32FC3);
    each_row(size.height, [&](int y) {
        for (int x = 0; x < size.width; ++x) {
            cv::Vec3f rgb = rgb_of_ycxcz(
                {planes[0].at<float>(y, x), planes[1].at<float>(y, x), planes[2].at<float>(y, x)});
            for (int i = 0; i < 3; ++i) rgb[i] = std::clamp(rgb[i], 0.F, 1.F);
            result.colour.at<cv::Vec3f>(y, x) = hunt_lab(rgb);
        }
    });
    return result;
}

}  // namespace

cv::Mat flip_map(const cv::Mat& test, const cv::Mat& reference) {
    assert(sensitivity_radius <= flip_radius);
    const Seen a = seen(test), b = seen(reference);
    cv::Mat result(test.size(), CV_32F);
    each_row(test.rows, [&](int y) {
        for (int x = 0; x < test.cols; ++x) {
            const auto change = [&](const cv::Mat& one, const cv::Mat& other) {
                return std::abs(one.at<float>(y, x) - other.at<float>(y, x));
            };
            const float color =
                redistributed(hyab(a.colour.at<cv::Vec3f>(y, x), b.colour.at<cv::Vec3f>(y, x)));
            // Section 4.2, with q_f = 1/2, and the final combination of section 4.3.
            const float feature = std::sqrt(std::max(change(a.feature.edges, b.feature.edges),
                                                     change(a.feature.points, b.feature.points)) /
                                            std::numbers::sqrt2_v<float>);
            result.at<float>(y, x) = color == 0 ? 0 : std::pow(color, 1 - feature);
        }
    });
    return result;
}

}  // namespace penumbra::metrics
