#include "validation/compare/measure.h"

#include "validation/metrics/regions.h"

#include <atomic>
#include <cmath>

namespace penumbra::metrics {
namespace {

cv::Vec3f pixel(const Color& color) { return {color.x, color.y, color.z}; }

bool has_eight_bits(const cv::Vec3f& encoded) {
    const auto whole = [](float v) { return std::abs(v * 255 - std::round(v * 255)) < 1e-3F; };
    return whole(encoded[0]) && whole(encoded[1]) && whole(encoded[2]);
}

// Does every pixel come from a file of 8 bits?
bool has_eight_bits(const cv::Mat& linear) {
    std::atomic<bool> all = true;
    each_row(linear.rows, [&](int y) {
        for (int x = 0; x < linear.cols && all; ++x) {
            const auto& c = linear.at<cv::Vec3f>(y, x);
            const Color shown = encoded(Color(c[0], c[1], c[2]));
            if (!has_eight_bits(pixel(shown))) all = false;
        }
    });
    return all;
}

// What must be known of the whole pictures before any of their rows is measured.
struct Survey {
    bool test_has_eight_bits = true, reference_has_eight_bits = true;
    Background background = {};               // unless what is covered is known
    std::optional<Exposures> exposures = {};  // where HDR-FLIP is wanted
};

void count_border(const Span& span, int height, const Shown& rows, Majority& border) {
    const auto count = [&](int y, int x) {
        border.count(rows.color.at<cv::Vec3f>(y, x), rows.alpha_at(y, x));
    };
    const int last = rows.color.cols - 1;
    for (int y = span.first; y < span.last; ++y) {
        count(y - span.top, 0);
        count(y - span.top, last);
        const int times = int(y == 0) + int(y == height - 1);
        for (int i = 0; i < times; ++i)
            for (int x = 0; x <= last; ++x) count(y - span.top, x);
    }
}

std::size_t bright_pixels(const cv::Mat& linear) {
    return std::size_t(std::count_if(linear.begin<cv::Vec3f>(), linear.end<cv::Vec3f>(),
                                     [](const cv::Vec3f& c) { return markedly_bright(c); }));
}

Exposures exposures_of(const Pair& pair) {
    std::vector<double> luminances;
    luminances.reserve(pair.counted().total());
    pair.each_span(0, [&](const Span& span) {
        const Rows rows = pair.rows(span.first, span.last, 1);
        for (auto c = rows.reference.begin<cv::Vec3f>(); c != rows.reference.end<cv::Vec3f>(); ++c)
            if (const double y = luminance(*c); y > 0) luminances.push_back(y);
    });
    return exposures_for(luminances);
}

// Only the rows of a picture that may be of the border need be encoded for it.
Shown border_rows(const Span& span, const Rows& rows, int height) {
    const bool all = span.first == 0 || span.last == height;
    if (all) return {encoded(rows.reference), rows.reference_alpha};
    Shown result = {cv::Mat(rows.reference.size(), CV_32FC3), rows.reference_alpha};
    for (const int x : {0, rows.reference.cols - 1})
        encoded(cv::Mat(rows.reference.col(x).clone())).copyTo(result.color.col(x));
    return result;
}

Survey survey(const Pair& pair, const CompareOptions& options, float gain, bool always_hdr) {
    Survey result;
    Majority border;
    std::size_t test_bright = 0, reference_bright = 0;
    pair.each_span(0, [&](const Span& span) {
        Rows rows = pair.rows(span.first, span.last, 1);
        test_bright += bright_pixels(rows.test);
        reference_bright += bright_pixels(rows.reference);
        if (gain != 1) rows = pair.rows(span.first, span.last, gain);
        if (result.test_has_eight_bits) result.test_has_eight_bits = has_eight_bits(rows.test);
        if (result.reference_has_eight_bits)
            result.reference_has_eight_bits = has_eight_bits(rows.reference);
        if (!options.background && options.covered.empty())
            count_border(span, pair.height(), border_rows(span, rows, pair.height()), border);
    });
    if (options.background)
        result.background = {pixel(encoded(*options.background * gain)), 1};
    else if (options.covered.empty())
        result.background = border.most();
    const double enough = 0.001 * double(pair.counted().total());
    if (always_hdr || double(test_bright) > enough || double(reference_bright) > enough)
        result.exposures = exposures_of(pair);
    return result;
}

// ---- rows ---------------------------------------------------------------------------------------

// FLIP raises errors to a power below 1, which makes much of next to nothing: the rounding to 8
// bits of one picture alone has a mean of 0.01. What a picture of 8 bits cannot show is not its
// error.
cv::Mat but_for_rounding(const Rows& linear, const ShownRows& both) {
    cv::Mat result = linear.test.clone();
    each_row(result.rows, [&](int y) {
        for (int x = 0; x < result.cols; ++x)
            if (alike(both.test.color.at<cv::Vec3f>(y, x), both.reference.color.at<cv::Vec3f>(y, x),
                      display_step / 2))
                result.at<cv::Vec3f>(y, x) = linear.reference.at<cv::Vec3f>(y, x);
    });
    return result;
}

// Maps of a span, each of its inner rows.
struct Maps {
    cv::Mat counted = {}, covered = {}, edges = {}, either_edges = {}, alike = {}, flip = {},
            ssim = {};
};

// FLIP and SSIM of pictures over black; of those that are not opaque the worse of that and white.
void see(const Span& span, const Rows& linear, const ShownRows& both, bool rounded, Maps& maps) {
    const cv::Mat test = rounded ? but_for_rounding(linear, both) : linear.test;
    maps.flip = span.inner(flip_map(test, linear.reference)).clone();
    maps.ssim = span.inner(ssim_map(both.test.color, both.reference.color)).clone();
}

void see_over_both(const Span& span, const Rows& linear, const ShownRows& both, bool rounded,
                   Maps& maps) {
    see(span, linear, both, rounded, maps);
    const auto full = [](const cv::Mat& alpha) { return cv::countNonZero(alpha != 1) == 0; };
    if (linear.opaque() || (full(linear.test_alpha) && full(linear.reference_alpha))) return;
    const Rows bright = over_white(linear);
    Maps other;
    see(span, bright, shown(bright), rounded, other);
    cv::max(maps.flip, other.flip, maps.flip);
    cv::min(maps.ssim, other.ssim, maps.ssim);
}

void add(RegionSums& sums, const ShownRows& inner, const Maps& maps, const cv::Mat& region) {
    sums.pixels += std::size_t(cv::countNonZero(region));
    sums.alike += std::size_t(cv::countNonZero(maps.alike & region));
    const auto squared = [&](const cv::Mat& a, const cv::Mat& b) {
        return cv::norm(a, b, cv::NORM_L2SQR, region);
    };
    sums.squares += squared(inner.test.color, inner.reference.color);
    if (!inner.test.alpha.empty()) sums.squares += squared(inner.test.alpha, inner.reference.alpha);
    const double count = cv::countNonZero(region);
    sums.test += cv::mean(inner.test.color, region) * count;
    sums.reference += cv::mean(inner.reference.color, region) * count;
    sums.flip += cv::mean(maps.flip, region)[0] * count;
    sums.ssim += cv::mean(maps.ssim, region)[0] * count;
}

// exactness, max_error and the worst pixel: of linear values, not clamped, and of alpha.
void add_linear(Measured& result, const Rows& rows, int top) {
    for (int y = 0; y < rows.test.rows; ++y) {
        for (int x = 0; x < rows.test.cols; ++x) {
            const auto &a = rows.test.at<cv::Vec3f>(y, x), &b = rows.reference.at<cv::Vec3f>(y, x);
            const float a_alpha = rows.opaque() ? 1 : rows.test_alpha.at<float>(y, x);
            const float b_alpha = rows.opaque() ? 1 : rows.reference_alpha.at<float>(y, x);
            double largest = std::abs(double(a_alpha) - double(b_alpha));
            bool all_exact = largest <= 1e-4;
            for (int i = 0; i < 3; ++i) {
                const double d = std::abs(double(a[i]) - double(b[i]));
                largest = std::max(largest, d);
                if (!(d <= 1e-4 * std::max(1.0, std::abs(double(b[i]))))) all_exact = false;
            }
            if (!all_exact) ++result.inexact;
            if (largest > result.max_error) {
                result.max_error = largest;
                result.worst = {x,       top + y, {a[0], a[1], a[2]}, {b[0], b[1], b[2]},
                                a_alpha, b_alpha};
            }
        }
    }
}

void count_edges(EdgeCounts& counts, const Maps& maps) {
    const cv::Mat differing = ~maps.alike;
    counts.pixels += maps.alike.total();
    counts.beside += std::size_t(cv::countNonZero(maps.either_edges));
    counts.differing += std::size_t(cv::countNonZero(differing));
    counts.differing_beside += std::size_t(cv::countNonZero(differing & maps.either_edges));
}

Shown inner(const Span& span, const Shown& rows) {
    return {span.inner(rows.color), rows.alpha.empty() ? cv::Mat() : span.inner(rows.alpha)};
}

// How measure() goes about it.
struct Plan {
    float gain = 1;
    int radius = 1;                    // of outliers
    const std::vector<bool>& covered;  // as of CompareOptions
    Survey known = {};
};

void measure_span(Measured& result, const Pair& pair, const Plan& plan, const Span& span) {
    const Rows linear = pair.rows(span.top, span.bottom, plan.gain);
    const ShownRows both = shown(linear);
    Maps maps = {.counted = pair.counted().rowRange(span.first, span.last)};
    const bool rounded = plan.known.test_has_eight_bits != plan.known.reference_has_eight_bits;
    see_over_both(span, linear, both, rounded, maps);
    const ShownRows own = {inner(span, both.test), inner(span, both.reference)};
    maps.covered = plan.covered.empty()
                       ? covered_pixels(own.test, own.reference, plan.known.background)
                       : rows_of(plan.covered, pair.width(), span.first, span.last);
    maps.covered &= maps.counted;
    maps.edges = span.inner(edge_band(both.reference.color)).clone();
    maps.either_edges = span.inner(edge_band(both.test.color)) | maps.edges;
    maps.alike = matched_pixels(own.test, own.reference, 0, display_step);
    const cv::Mat near =
        span.inner(matched_pixels(both.test, both.reference, plan.radius, outlier_step));
    result.outliers += std::size_t(cv::countNonZero(~near & maps.counted));
    add(result.whole, own, maps, maps.counted);
    add(result.covered, own, maps, maps.covered);
    add(result.edges, own, maps, maps.edges & maps.counted);
    add(result.inside, own, maps, ~maps.edges & maps.counted);
    count_edges(result.either_edges, maps);
    maps.alike.copyTo(result.alike.rowRange(span.first, span.last));
    maps.flip.copyTo(result.flip.rowRange(span.first, span.last));
    maps.ssim.copyTo(result.ssim.rowRange(span.first, span.last));
}

double mean_hdr_flip(const Pair& pair, const Exposures& exposures) {
    double sum = 0;
    pair.each_span(flip_radius, [&](const Span& span) {
        const Rows rows = pair.rows(span.top, span.bottom, 1);
        const cv::Mat flip = span.inner(hdr_flip_map(rows.test, rows.reference, exposures)).clone();
        const cv::Mat counted = pair.counted().rowRange(span.first, span.last);
        sum += cv::mean(flip, counted)[0] * cv::countNonZero(counted);
    });
    return sum / cv::countNonZero(pair.counted());
}

}  // namespace

Measured measure(const Pair& pair, const CompareOptions& options, bool always_hdr) {
    Plan plan = {.gain = float(std::exp2(options.exposure)),
                 .radius = std::max(1, options.shift_tolerance),
                 .covered = options.covered};
    plan.known = survey(pair, options, plan.gain, always_hdr);
    Measured result;
    result.alike.create(pair.height(), pair.width(), CV_8U);
    result.flip.create(pair.height(), pair.width(), CV_32F);
    result.ssim.create(pair.height(), pair.width(), CV_32F);
    const int halo = std::max({flip_radius, ssim_radius, plan.radius});
    pair.each_span(halo, [&](const Span& span) { measure_span(result, pair, plan, span); });
    pair.each_span(0, [&](const Span& span) {
        add_linear(result, pair.rows(span.first, span.last, 1), span.first);
    });
    if (plan.known.exposures) result.hdr_flip = mean_hdr_flip(pair, *plan.known.exposures);
    return result;
}

}  // namespace penumbra::metrics
