// Pictures as a display shows them, and whether two of them can be compared.
#include "metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace penumbra::metrics {
namespace {

bool finite(const Color& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

// "" when all pixels of the picture called `name` are finite.
std::string not_finite(const Image& image, const char* name) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = image.pixels.size(); i-- > 0;) {
        if (finite(image.pixels[i])) continue;
        ++count;
        first = i;
    }
    if (count == 0) return "";
    const auto width = std::size_t(image.width);
    return fmt::format(
        "{} of the {} picture's {} pixels are NaN or infinite, the first at ({}, {})", count, name,
        image.pixels.size(), first % width, first / width);
}

bool well_formed(const Image& image) {
    return image.width > 0 && image.height > 0 &&
           image.pixels.size() == std::size_t(image.width) * std::size_t(image.height);
}

std::array<int, 3> bytes(const cv::Vec3f& c) {
    return {cvRound(c[0] * 255), cvRound(c[1] * 255), cvRound(c[2] * 255)};
}

}  // namespace

Color encoded(const Color& color) {
    const auto channel = [](float c) { return linear_to_srgb(std::clamp(c, 0.F, 1.F)); };
    return {channel(color.x), channel(color.y), channel(color.z)};
}

cv::Mat encoded(const Image& image) {
    return mapped(view(image), [](float c) { return linear_to_srgb(std::clamp(c, 0.F, 1.F)); });
}

cv::Mat mapped(const cv::Mat& image, const std::function<float(float)>& map) {
    cv::Mat result(image.size(), image.type());
    each_row(image.rows, [&](int y) {
        const auto* const from = image.ptr<float>(y);
        std::transform(from, from + 3 * image.cols, result.ptr<float>(y), map);
    });
    return result;
}

cv::Mat view(const Image& image) {
    static_assert(sizeof(Color) == sizeof(cv::Vec3f));
    // cv::Mat has no read-only form; nothing writes through this one.
    return {image.height, image.width, CV_32FC3, const_cast<Color*>(image.pixels.data())};
}

Image brightened(const Image& image, double stops) {
    Image result = image;
    const auto gain = float(std::exp2(stops));
    for (Color& color : result.pixels) color *= gain;
    return result;
}

bool alike(const cv::Vec3f& a, const cv::Vec3f& b, double step) {
    const auto near = [&](int i) { return std::abs(double(a[i]) - double(b[i])) <= step; };
    return near(0) && near(1) && near(2);
}

cv::Vec3f border_color(const cv::Mat& encoded) {
    std::map<std::array<int, 3>, int> count;
    for (int x = 0; x < encoded.cols; ++x) {
        ++count[bytes(encoded.at<cv::Vec3f>(0, x))];
        ++count[bytes(encoded.at<cv::Vec3f>(encoded.rows - 1, x))];
    }
    for (int y = 0; y < encoded.rows; ++y) {
        ++count[bytes(encoded.at<cv::Vec3f>(y, 0))];
        ++count[bytes(encoded.at<cv::Vec3f>(y, encoded.cols - 1))];
    }
    const auto by_count = [](const auto& entry) { return entry.second; };
    const auto most = std::ranges::max_element(count, {}, by_count)->first;
    return {float(most[0]) / 255, float(most[1]) / 255, float(most[2]) / 255};
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

std::vector<std::string> not_finite(const Image& test, const Image& reference) {
    std::vector<std::string> result;
    for (std::string& sentence :
         std::array{not_finite(test, "test"), not_finite(reference, "reference")})
        if (!sentence.empty()) result.push_back(std::move(sentence));
    return result;
}

}  // namespace penumbra::metrics
