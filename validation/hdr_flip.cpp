// HDR-FLIP: the worst LDR-FLIP over all exposures at which the reference shows something.
//
// Andersson, Nilsson, Akenine-Moller 2021, "Visualizing and Communicating Errors in Rendered
// Images", Ray Tracing Gems II, chapter 19, and Andersson, Nilsson, Shirley, Akenine-Moller 2021,
// "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics.
#include "metrics.h"

#include <algorithm>
#include <cmath>

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

Image tone_mapped(const Image& image, double exposure) {
    const double gain = std::exp2(exposure);
    Image result(image.width, image.height);
    each_row(image.height, [&](int y) {
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c)
                result.at(x, y)[c] =
                    tone_mapped(gain * std::clamp(double(image.at(x, y)[c]), 0.0, brightest));
    });
    return result;
}

// What the curve maps to `target`.
double preimage_of_target() {
    const double a = k0 - k3 * target, b = k1 - k4 * target, c = -k5 * target;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

struct Exposures {
    double first = 0, last = 0;
    int count = 2;
    double at(int i) const { return first + (last - first) * i / (count - 1); }
};

// Exposures that bring the brightest and the median luminance (ITU-R BT.709) of the reference to
// the target, and steps of at most one exposure value between. The papers leave open what a median
// of 0 means; here only pixels with some light count.
Exposures exposures_for(const Image& reference) {
    std::vector<double> luminances;
    for (const Color& c : reference.pixels) {
        const double y = 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z);
        if (y > 0) luminances.push_back(std::min(y, brightest));
    }
    if (luminances.empty()) return {};
    const auto middle = luminances.begin() + (std::ssize(luminances) - 1) / 2;
    std::ranges::nth_element(luminances, middle);
    const double median = *middle, most = std::ranges::max(luminances);
    Exposures result = {.first = std::log2(preimage_of_target() / most),
                        .last = std::log2(preimage_of_target() / median)};
    result.count = std::clamp(int(std::ceil(result.last - result.first)), 2, most_exposures);
    return result;
}

}  // namespace

cv::Mat hdr_flip_map(const Image& test, const Image& reference) {
    const Exposures exposures = exposures_for(reference);
    cv::Mat worst(reference.height, reference.width, CV_32F, cv::Scalar(0));
    for (int i = 0; i < exposures.count; ++i) {
        const double exposure = exposures.at(i);
        cv::max(worst, flip_map(tone_mapped(test, exposure), tone_mapped(reference, exposure)),
                worst);
    }
    return worst;
}

bool markedly_bright(const Image& image) {
    const auto bright = [](const Color& c) {
        constexpr float limit = 1.41421356F;
        return c.x > limit || c.y > limit || c.z > limit;
    };
    const auto count = std::ranges::count_if(image.pixels, bright);
    return double(count) > 0.001 * double(image.pixels.size());
}

}  // namespace penumbra::metrics
