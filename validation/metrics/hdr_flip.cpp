// HDR-FLIP: the worst LDR-FLIP over all exposures at which the reference shows something.
//
// Andersson, Nilsson, Akenine-Moller 2021, "Visualizing and Communicating Errors in Rendered
// Images", Ray Tracing Gems II, chapter 19, and Andersson, Nilsson, Shirley, Akenine-Moller 2021,
// "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics.
#include "base/luminance.h"
#include "validation/metrics/figures.h"
#include "validation/metrics/picture.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace penumbra::metrics {
namespace {

// Narkowicz 2016, "ACES Filmic Tone Mapping Curve", its exposure factor of 0.6 taken out, as the
// papers do: (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5).
constexpr double k0 = 0.6 * 0.6 * 2.51, k1 = 0.6 * 0.03;
constexpr double k3 = 0.6 * 0.6 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;

constexpr double target = 0.85;  // what the brightest and the median pixel are mapped to
constexpr double brightest = 65536;
constexpr int most_exposures = 24;

float tone_mapped(double x) {
    const double value = (k0 * x * x + k1 * x) / (k3 * x * x + k4 * x + k5);
    return float(std::clamp(value, 0.0, 1.0));
}

cv::Mat tone_mapped(const cv::Mat& image, double exposure) {
    const double gain = std::exp2(exposure);
    return mapped(image, [gain](float c) {
        return tone_mapped(gain * std::clamp(double(c), 0.0, brightest));
    });
}

// What the curve maps to `target`.
double preimage_of_target() {
    const double a = k0 - k3 * target, b = k1 - k4 * target, c = -k5 * target;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

}  // namespace

// Exposures that bring the brightest and the median luminance (ITU-R BT.709) of the reference to
// the target, and steps of at most one exposure value between. The papers leave open what a median
// of 0 means; here only pixels with some light count.
Exposures exposures_for(std::vector<double>& luminances) {
    if (luminances.empty()) return {};
    const auto middle = luminances.begin() + (std::ssize(luminances) - 1) / 2;
    std::ranges::nth_element(luminances, middle);
    const double median = *middle, most = std::ranges::max(luminances);
    Exposures result = {.first = std::log2(preimage_of_target() / most),
                        .last = std::log2(preimage_of_target() / median)};
    result.count = std::clamp(int(std::ceil(result.last - result.first)), 2, most_exposures);
    return result;
}

double luminance(const cv::Vec3f& c) {
    return std::min(penumbra::luminance(Vec3(double(c[0]), double(c[1]), double(c[2]))), brightest);
}

cv::Mat hdr_flip_map(const cv::Mat& test, const cv::Mat& reference, const Exposures& exposures) {
    cv::Mat worst(reference.size(), CV_32F, cv::Scalar(0));
    for (int i = 0; i < exposures.count; ++i) {
        const double exposure = exposures.at(i);
        cv::max(worst, flip_map(tone_mapped(test, exposure), tone_mapped(reference, exposure)),
                worst);
    }
    return worst;
}

bool markedly_bright(const cv::Vec3f& c) {
    constexpr float limit = 1.41421356F;
    return c[0] > limit || c[1] > limit || c[2] > limit;
}

}  // namespace penumbra::metrics
