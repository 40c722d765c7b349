// Whether two pictures can be compared, where they differ, and what would explain it.
#include "metrics.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace penumbra::metrics {
namespace {

bool finite(const Color& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

// "" when all pixels of the picture called `name` are finite.
std::string not_finite(const Image& image, const std::string& name) {
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

// The colour that most pixels of the border have, to 8 bits.
cv::Vec3f border_color(const cv::Mat& image) {
    std::map<std::array<int, 3>, int> count;
    for (int x = 0; x < image.cols; ++x) {
        ++count[bytes(image.at<cv::Vec3f>(0, x))];
        ++count[bytes(image.at<cv::Vec3f>(image.rows - 1, x))];
    }
    for (int y = 0; y < image.rows; ++y) {
        ++count[bytes(image.at<cv::Vec3f>(y, 0))];
        ++count[bytes(image.at<cv::Vec3f>(y, image.cols - 1))];
    }
    const auto by_count = [](const auto& entry) { return entry.second; };
    const auto most = std::ranges::max_element(count, {}, by_count)->first;
    return {float(most[0]) / 255, float(most[1]) / 255, float(most[2]) / 255};
}

double mean_square(const cv::Mat& a, const cv::Mat& b) {
    const double distance = cv::norm(a, b, cv::NORM_L2);
    return distance * distance / (3 * double(a.total()));
}

// What one explanation would leave of the difference, as a fraction of its mean square.
struct Cause {
    double left = 1;
    std::string sentence = {};
};

cv::Mat mapped(const cv::Mat& image, const std::function<float(float)>& map) {
    cv::Mat result(image.size(), image.type());
    each_row(image.rows, [&](int y) {
        const auto* const from = image.ptr<float>(y);
        std::transform(from, from + 3 * image.cols, result.ptr<float>(y), map);
    });
    return result;
}

// The displacement within +-2 pixels that explains most.
Cause best_shift(const cv::Mat& test, const cv::Mat& reference) {
    Cause best;
    if (test.cols < 8 || test.rows < 8) return best;
    for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
            const cv::Size size(test.cols - std::abs(dx), test.rows - std::abs(dy));
            const cv::Rect to({std::max(dx, 0), std::max(dy, 0)}, size);
            const cv::Rect from({std::max(-dx, 0), std::max(-dy, 0)}, size);
            // The same part of the picture without the displacement is what it is held against.
            const double before = mean_square(test(to), reference(to));
            const double left = before > 0 ? mean_square(test(to), reference(from)) / before : 1;
            if (left < best.left)
                best = {left,
                        fmt::format("the test picture is shifted by ({:+}, {:+}) pixels", dx, dy)};
        }
    }
    return best;
}

// The brightness, one factor of the linear values, that explains most.
Cause best_gain(const Image& test, const Image& reference, double before) {
    double both = 0, own = 0;
    for (std::size_t i = 0; i < test.pixels.size(); ++i) {
        both += double(test.pixels[i].dot(reference.pixels[i]));
        own += double(test.pixels[i].dot(test.pixels[i]));
    }
    const double gain = both / own;
    if (!(gain > 0) || !std::isfinite(gain)) return {};
    Image scaled = test;
    for (Color& color : scaled.pixels) color *= float(gain);
    const double percent = 100 * (1 / gain - 1);
    return {mean_square(encoded(scaled), encoded(reference)) / before,
            fmt::format("the test picture is {:.2g} % {}", std::abs(percent),
                        percent > 0 ? "brighter" : "darker")};
}

}  // namespace

Color encoded(const Color& color) {
    const auto channel = [](float c) { return linear_to_srgb(std::clamp(c, 0.F, 1.F)); };
    return {channel(color.x), channel(color.y), channel(color.z)};
}

cv::Mat encoded(const Image& image) {
    return mapped(view(image), [](float c) { return linear_to_srgb(std::clamp(c, 0.F, 1.F)); });
}

cv::Mat view(const Image& image) {
    static_assert(sizeof(Color) == sizeof(cv::Vec3f));
    // cv::Mat has no read-only form; nothing writes through this one.
    return {image.height, image.width, CV_32FC3, const_cast<Color*>(image.pixels.data())};
}

bool alike(const cv::Vec3f& a, const cv::Vec3f& b) {
    constexpr double tolerance = 1.0 / 255 + 1e-6;
    const auto near = [&](int i) { return std::abs(double(a[i]) - double(b[i])) <= tolerance; };
    return near(0) && near(1) && near(2);
}

std::vector<std::string> obstacles(const Image& test, const Image& reference) {
    if (!well_formed(test)) return {"the test picture is empty"};
    if (!well_formed(reference)) return {"the reference picture is empty"};
    if (test.width != reference.width || test.height != reference.height)
        return {fmt::format("the pictures differ in size: the test picture is {}x{}, the reference "
                            "picture {}x{}",
                            test.width, test.height, reference.width, reference.height)};
    std::vector<std::string> result;
    for (std::string& sentence :
         std::array{not_finite(test, "test"), not_finite(reference, "reference")})
        if (!sentence.empty()) result.push_back(std::move(sentence));
    return result;
}

double coverage(const cv::Mat& test_encoded, const cv::Mat& reference_encoded,
                const std::optional<Color>& background) {
    cv::Vec3f empty = border_color(reference_encoded);
    if (background) {
        const Color color = encoded(*background);
        empty = {color.x, color.y, color.z};
    }
    std::size_t covered = 0;
    for (int y = 0; y < test_encoded.rows; ++y)
        for (int x = 0; x < test_encoded.cols; ++x)
            if (!alike(test_encoded.at<cv::Vec3f>(y, x), empty) ||
                !alike(reference_encoded.at<cv::Vec3f>(y, x), empty))
                ++covered;
    return double(covered) / double(test_encoded.total());
}

std::vector<std::string> differing_area(const cv::Mat& test_encoded,
                                        const cv::Mat& reference_encoded) {
    std::size_t count = 0;
    cv::Rect area;
    for (int y = 0; y < test_encoded.rows; ++y) {
        for (int x = 0; x < test_encoded.cols; ++x) {
            if (alike(test_encoded.at<cv::Vec3f>(y, x), reference_encoded.at<cv::Vec3f>(y, x)))
                continue;
            area |= cv::Rect(x, y, 1, 1);
            ++count;
        }
    }
    if (count == 0) return {};
    return {fmt::format("{} of {} pixels differ by more than 1/255 in sRGB, within ({}, {}) to "
                        "({}, {})",
                        count, test_encoded.total(), area.x, area.y, area.br().x - 1,
                        area.br().y - 1)};
}

std::vector<std::string> likely_cause(const Image& test, const Image& reference) {
    const cv::Mat a = encoded(test), b = encoded(reference);
    const double before = mean_square(a, b);
    if (!(before > 0)) return {};

    std::vector<Cause> causes = {best_shift(a, b), best_gain(test, reference, before)};
    const auto suppose = [&](const cv::Mat& changed, const std::string& sentence) {
        causes.push_back({mean_square(changed, b) / before, sentence});
    };
    const auto flipped = [&](int axes) {
        cv::Mat result;
        cv::flip(a, result, axes);
        return result;
    };
    suppose(flipped(1), "the test picture is mirrored left to right");
    suppose(flipped(0), "the test picture is upside down");
    suppose(flipped(-1), "the test picture is turned by 180 degrees");
    cv::Mat swapped;
    cv::cvtColor(a, swapped, cv::COLOR_RGB2BGR);
    suppose(swapped, "red and blue are exchanged");
    suppose(mapped(a, linear_to_srgb), "the test picture looks as if it lacked the sRGB encoding");
    suppose(mapped(a, srgb_to_linear), "the test picture looks as if it were sRGB-encoded twice");

    // A quarter of the mean square is half of the root mean square.
    const Cause best = *std::ranges::min_element(causes, {}, &Cause::left);
    if (!(best.left < 0.25)) return {};
    return {fmt::format("{}: that explains {:.0f} % of the mean square error", best.sentence,
                        100 * (1 - best.left))};
}

}  // namespace penumbra::metrics
