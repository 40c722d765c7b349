#include "validation/compare/pair.h"

#include "image/texels.h"
#include "validation/metrics/regions.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace penumbra::metrics {
namespace {

bool finite(const Color& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

std::optional<LinearSamples> samples_of(const Raster& alpha) {
    if (alpha.data.empty()) return {};
    return LinearSamples(alpha, false);
}

// "" when all pixels of the picture called `name` that count are finite.
std::string not_finite(const Source& picture, const cv::Mat& counted, const char* name) {
    const auto alpha = samples_of(picture.alpha);
    const auto width = std::size_t(picture.colors.width);
    std::size_t count = 0, first = 0;
    for (std::size_t i = picture.colors.pixels.size(); i-- > 0;) {
        if (finite(picture.colors.pixels[i]) && (!alpha || std::isfinite((*alpha)[i]))) continue;
        if (counted.at<uchar>(int(i / width), int(i % width)) == 0) continue;
        ++count;
        first = i;
    }
    if (count == 0) return "";
    return fmt::format(
        "{} of the {} picture's {} pixels are NaN or infinite, the first at ({}, {})", count, name,
        picture.colors.pixels.size(), first % width, first / width);
}

cv::Mat white_behind(const cv::Mat& linear, const cv::Mat& alpha) {
    if (alpha.empty()) return linear;
    cv::Mat result(linear.size(), CV_32FC3);
    each_row(result.rows, [&](int y) {
        for (int x = 0; x < result.cols; ++x)
            result.at<cv::Vec3f>(y, x) =
                linear.at<cv::Vec3f>(y, x) + cv::Vec3f::all(1 - alpha.at<float>(y, x));
    });
    return result;
}

}  // namespace

ShownRows shown(const Rows& linear) {
    return {{encoded(linear.test), linear.test_alpha},
            {encoded(linear.reference), linear.reference_alpha}};
}

Rows over_white(const Rows& rows) {
    return {white_behind(rows.test, rows.test_alpha),
            white_behind(rows.reference, rows.reference_alpha)};
}

Pair::Pair(const Source& test, const Source& reference, const cv::Mat& counted)
    : test_(test), reference_(reference), counted_(counted) {}

std::vector<std::string> Pair::not_finite() const {
    std::vector<std::string> result;
    for (std::string& sentence : std::array{metrics::not_finite(test_, counted_, "test"),
                                            metrics::not_finite(reference_, counted_, "reference")})
        if (!sentence.empty()) result.push_back(std::move(sentence));
    return result;
}

void Pair::tolerate_shifts(int tolerance, float gain) {
    cv::Mat settled(height(), width(), CV_8U);
    each_span(tolerance, [&](const Span& span) {
        const ShownRows both = shown(rows(span.top, span.bottom, gain));
        const cv::Mat matched = matched_pixels(both.test, both.reference, tolerance, display_step);
        span.inner(matched).copyTo(settled.rowRange(span.first, span.last));
    });
    settled_ = settled;
}

Rows Pair::rows(int first, int last, float gain) const {
    const cv::Size size(width(), last - first);
    Rows result;
    result.test.create(size, CV_32FC3);
    result.reference.create(size, CV_32FC3);
    if (!opaque()) {
        result.test_alpha.create(size, CV_32F);
        result.reference_alpha.create(size, CV_32F);
    }
    each_row(size.height, [&](int y) { fill_row(first + y, y, gain, result); });
    return result;
}

void Pair::fill_row(int y, int to, float gain, Rows& rows) const {
    const auto test_alpha = samples_of(test_.alpha), reference_alpha = samples_of(reference_.alpha);
    const auto alpha_at = [](const std::optional<LinearSamples>& alpha, std::size_t i) {
        return alpha ? (*alpha)[i] : 1.F;
    };
    const auto start = std::size_t(y) * std::size_t(width());
    for (int x = 0; x < width(); ++x) {
        const std::size_t i = start + std::size_t(x);
        const bool counts = counted_.at<uchar>(y, x) != 0;
        const bool same = !counts || (!settled_.empty() && settled_.at<uchar>(y, x) != 0);
        Color b = reference_.colors.pixels[i];
        float b_alpha = alpha_at(reference_alpha, i);
        // No difference and no NaN where they are ignored.
        if (!counts && !(finite(b) && std::isfinite(b_alpha))) {
            b = Color(0);
            b_alpha = 1;
        }
        const Color a = same ? b : test_.colors.pixels[i];
        rows.test.at<cv::Vec3f>(to, x) = {a.x * gain, a.y * gain, a.z * gain};
        rows.reference.at<cv::Vec3f>(to, x) = {b.x * gain, b.y * gain, b.z * gain};
        if (opaque()) continue;
        rows.test_alpha.at<float>(to, x) = same ? b_alpha : alpha_at(test_alpha, i);
        rows.reference_alpha.at<float>(to, x) = b_alpha;
    }
}

}  // namespace penumbra::metrics
