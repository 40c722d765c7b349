// Pictures as a display shows them, and whether two of them can be compared.
#include "validation/metrics/picture.h"

#include "penumbra/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace penumbra::metrics {
namespace {

bool well_formed(const Image& image) {
    return image.width > 0 && image.height > 0 &&
           image.pixels.size() == std::size_t(image.width) * std::size_t(image.height);
}

}  // namespace

Color encoded(const Color& color) {
    const auto channel = [](float c) { return linear_to_srgb(std::clamp(c, 0.F, 1.F)); };
    return {channel(color.x), channel(color.y), channel(color.z)};
}

cv::Mat encoded(const cv::Mat& linear) {
    return mapped(linear, [](float c) { return linear_to_srgb(std::clamp(c, 0.F, 1.F)); });
}

cv::Mat mapped(const cv::Mat& image, const std::function<float(float)>& map) {
    cv::Mat result(image.size(), image.type());
    each_row(image.rows, [&](int y) {
        const auto* const from = image.ptr<float>(y);
        std::transform(from, from + 3 * std::ptrdiff_t(image.cols), result.ptr<float>(y), map);
    });
    return result;
}

cv::Mat view(const Image& image) {
    static_assert(sizeof(Color) == sizeof(cv::Vec3f));
    // cv::Mat has no read-only form; nothing writes through this one.
    return {image.height, image.width, CV_32FC3, const_cast<Color*>(image.pixels.data())};
}

bool alike(const cv::Vec3f& a, const cv::Vec3f& b, double step) {
    const auto near = [&](int i) { return std::abs(double(a[i]) - double(b[i])) <= step; };
    return near(0) && near(1) && near(2);
}

bool alike(float alpha, float other_alpha, double step) {
    return std::abs(double(alpha) - double(other_alpha)) <= step;
}

void Majority::count(const cv::Vec3f& encoded, float alpha) {
    ++counts_[{cvRound(encoded[0] * 255), cvRound(encoded[1] * 255), cvRound(encoded[2] * 255),
               cvRound(alpha * 255)}];
}

Background Majority::most() const {
    assert(!counts_.empty());
    const auto by_count = [](const auto& entry) { return entry.second; };
    const auto& most = std::ranges::max_element(counts_, {}, by_count)->first;
    const auto value = [&](std::size_t i) { return float(most[i]) / 255; };
    return {{value(0), value(1), value(2)}, value(3)};
}

double mean_square(const cv::Mat& a, const cv::Mat& b) {
    const double distance = cv::norm(a, b, cv::NORM_L2);
    return distance * distance / (a.channels() * double(a.total()));
}

std::vector<std::string> misfits(const Image& test, const Image& reference) {
    if (!well_formed(test)) return {"the test picture is empty"};
    if (!well_formed(reference)) return {"the reference picture is empty"};
    if (test.width != reference.width || test.height != reference.height)
        return {fmt::format("the pictures differ in size: the test picture is {}x{}, the reference "
                            "picture {}x{}",
                            test.width, test.height, reference.width, reference.height)};
    return {};
}

void check_fit(const Image& test, const Image& reference) {
    const std::vector<std::string> reasons = misfits(test, reference);
    if (!reasons.empty()) throw Error(Failure::usage, "", reasons.front());
}

}  // namespace penumbra::metrics
