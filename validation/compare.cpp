// Every figure of the parity rule, and the verdict.
#include "metrics.h"

#include "penumbra/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {
namespace {

using namespace metrics;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double least_coverage = 0.01;

struct Kind {
    const char* name;
    bool at_least;
};

// The order in which figures are shown.
constexpr std::array kinds = {
    Kind{"parity", true},          Kind{"exactness", true},      Kind{"max_error", false},
    Kind{"rmse", false},           Kind{"psnr_db", true},        Kind{"ssim", true},
    Kind{"ssim_tile", true},       Kind{"flip", false},          Kind{"flip_p99", false},
    Kind{"flip_tile", false},      Kind{"bias", false},          Kind{"coverage", true},
    Kind{"outliers", false},       Kind{"parity_covered", true}, Kind{"rmse_covered", false},
    Kind{"psnr_db_covered", true}, Kind{"ssim_covered", true},   Kind{"flip_covered", false},
    Kind{"bias_covered", false},   Kind{"edges", false},         Kind{"parity_edges", true},
    Kind{"flip_edges", false},     Kind{"parity_inside", true},  Kind{"hdr_flip", false}};

void check_names(const Limits& limits) {
    for (const auto& entry : limits.limits) {
        const std::string& name = entry.first;
        const auto same = [&](const Kind& kind) { return kind.name == name; };
        if (std::ranges::any_of(kinds, same)) continue;
        std::string known;
        for (const Kind& kind : kinds)
            known += (known.empty() ? "" : ", ") + std::string(kind.name);
        throw Error(Failure::usage, "",
                    fmt::format("unknown metric '{}' (known: {})", name, known));
    }
}

// All figures, not yet known.
std::vector<Metric> blank_metrics(const Limits& limits) {
    std::vector<Metric> result;
    for (const Kind& kind : kinds) {
        Metric metric = {kind.name, nan, std::nullopt, kind.at_least};
        if (metric.name == "coverage") metric.limit = least_coverage;
        const auto limit = limits.limits.find(metric.name);
        if (limit != limits.limits.end()) metric.limit = limit->second;
        result.push_back(std::move(metric));
    }
    return result;
}

Metric& metric(Comparison& comparison, const std::string& name) {
    return *std::ranges::find(comparison.metrics, name, &Metric::name);
}

void set(Comparison& comparison, const std::string& name, double value) {
    metric(comparison, name).value = value;
}

// Fraction of `region`'s pixels that are in `part`; `otherwise` when it has none.
double share(const cv::Mat& part, const cv::Mat& region, double otherwise) {
    const int all = cv::countNonZero(region);
    return all > 0 ? double(cv::countNonZero(part & region)) / all : otherwise;
}

// A pair that had to be changed before it is measured.
struct Pair {
    Image test, reference;
};

// The pictures of a pair, wherever they are kept.
struct Both {
    const Image &test, &reference;
};

// Both pictures with no difference and no NaN where they are ignored.
Pair without_ignored(const Image& test, const Image& reference, const cv::Mat& counted) {
    Pair result = {test, reference};
    for (int y = 0; y < test.height; ++y)
        for (int x = 0; x < test.width; ++x) {
            if (counted.at<uchar>(y, x) != 0) continue;
            Color& color = result.reference.at(x, y);
            if (!std::isfinite(color.x + color.y + color.z)) color = Color(0);
            result.test.at(x, y) = color;
        }
    return result;
}

// exactness, max_error and the worst pixel: of linear values, not clamped. Ignored pixels do not
// differ.
void measure_linear(Comparison& result, const Both& pair, const cv::Mat& counted) {
    std::size_t inexact = 0;
    double worst = -1;
    for (int y = 0; y < pair.test.height; ++y) {
        for (int x = 0; x < pair.test.width; ++x) {
            const Color &a = pair.test.at(x, y), &b = pair.reference.at(x, y);
            double largest = 0;
            bool all_exact = true;
            for (int i = 0; i < 3; ++i) {
                const double d = std::abs(double(a[i]) - double(b[i]));
                largest = std::max(largest, d);
                if (!(d <= 1e-4 * std::max(1.0, std::abs(double(b[i]))))) all_exact = false;
            }
            if (!all_exact) ++inexact;
            if (largest > worst) {
                worst = largest;
                result.worst = {x, y, a, b};
            }
        }
    }
    set(result, "exactness", 1 - double(inexact) / cv::countNonZero(counted));
    set(result, "max_error", worst);
}

// rmse, psnr_db and bias over a region, of values as a display shows them.
void measure_encoded(Comparison& result, const cv::Mat& test, const cv::Mat& reference,
                     const cv::Mat& region, const std::string& suffix) {
    const double distance = cv::norm(test, reference, cv::NORM_L2, region);
    const double rmse = distance / std::sqrt(3.0 * cv::countNonZero(region));
    const cv::Scalar a = cv::mean(test, region), b = cv::mean(reference, region);
    set(result, "rmse" + suffix, rmse);
    // Equal pictures have no finite ratio; 999 dB is more than float32 values that differ can have.
    set(result, "psnr_db" + suffix, rmse == 0 ? 999 : -20 * std::log10(rmse));
    set(result, "bias" + suffix,  // ITU-R BT.709
        0.2126 * (a[0] - b[0]) + 0.7152 * (a[1] - b[1]) + 0.0722 * (a[2] - b[2]));
}

// What the figures are made of.
struct Maps {
    cv::Mat test = {}, reference = {};  ///< encoded
    cv::Mat counted = {}, covered = {}, edges = {};
    cv::Mat alike = {};  ///< pixels that are
    cv::Mat flip = {}, ssim = {};
};

void measure_whole(Comparison& result, const Maps& maps) {
    measure_encoded(result, maps.test, maps.reference, maps.counted, "");
    set(result, "parity", share(maps.alike, maps.counted, nan));
    set(result, "ssim", cv::mean(maps.ssim, maps.counted)[0]);
    set(result, "ssim_tile", worst_tile(maps.ssim, maps.counted, 32, Worst::smallest));
    set(result, "flip", cv::mean(maps.flip, maps.counted)[0]);
    set(result, "flip_p99", quantile(maps.flip, maps.counted, 0.99));
    set(result, "flip_tile", worst_tile(maps.flip, maps.counted, 16, Worst::largest));
    result.worst_tiles = worst_tiles(maps.flip, maps.counted, 16, 4);
    result.flip_map = Image(maps.flip.cols, maps.flip.rows);
    std::transform(maps.flip.begin<float>(), maps.flip.end<float>(), result.flip_map.pixels.begin(),
                   [](float error) { return Color(error); });
}

// In a part without pixels nothing differs.
void measure_parts(Comparison& result, const Maps& maps) {
    if (cv::countNonZero(maps.covered) > 0) {
        measure_encoded(result, maps.test, maps.reference, maps.covered, "_covered");
        set(result, "parity_covered", share(maps.alike, maps.covered, nan));
        set(result, "ssim_covered", cv::mean(maps.ssim, maps.covered)[0]);
        set(result, "flip_covered", cv::mean(maps.flip, maps.covered)[0]);
    }
    const cv::Mat edges = maps.edges & maps.counted, inside = ~maps.edges & maps.counted;
    set(result, "edges", share(edges, maps.counted, nan));
    set(result, "parity_edges", share(maps.alike, edges, 1));
    set(result, "flip_edges", cv::mean(maps.flip, edges)[0]);
    set(result, "parity_inside", share(maps.alike, inside, 1));
}

// Has more than 1 - band of the error that the limit allows.
bool close_to_limit(const Metric& metric, double band) {
    if (!metric.limit || metric.name == "coverage") return false;
    const double most = 1 - band;
    if (metric.name.starts_with("psnr_db"))
        return metric.value < *metric.limit + 20 * std::log10(1 / most);
    return metric.at_least ? 1 - metric.value > most * (1 - *metric.limit)
                           : std::abs(metric.value) > most * *metric.limit;
}

void judge(Comparison& result, double band) {
    result.verdict = Verdict::pass;
    for (const Metric& metric : result.metrics) {
        if (!close_to_limit(metric, band) || !metric.ok()) continue;
        result.verdict = Verdict::warn;
        result.diagnosis.push_back(fmt::format("{} {:.6g} is within {:.3g} % of its limit {:.6g}",
                                               metric.name, metric.value, 100 * band,
                                               *metric.limit));
    }
    if (!std::ranges::all_of(result.metrics, &Metric::ok)) result.verdict = Verdict::fail;
}

void diagnose(Comparison& result, const Both& shown, const Maps& maps) {
    Finding finding = likely_cause(shown.test, shown.reference);
    const bool explained = finding.convincing();
    if (!explained) finding = only_edges(maps.test, maps.reference);
    result.cause = finding.cause;
    if (finding.cause.empty()) return;
    result.diagnosis.push_back(explained ? said(finding) : finding.sentence);
}

// Does it come from a file of 8 bits?
bool has_eight_bits(const cv::Mat& encoded) {
    return std::all_of(encoded.begin<cv::Vec3f>(), encoded.end<cv::Vec3f>(), [](const auto& c) {
        const auto whole = [](float v) { return std::abs(v * 255 - std::round(v * 255)) < 1e-3F; };
        return whole(c[0]) && whole(c[1]) && whole(c[2]);
    });
}

// FLIP raises errors to a power below 1, which makes much of next to nothing: the rounding to 8
// bits of one picture alone has a mean of 0.01. What a picture of 8 bits cannot show is not its
// error.
cv::Mat flip_but_for_rounding(const Both& shown, const cv::Mat& test, const cv::Mat& reference) {
    if (has_eight_bits(test) == has_eight_bits(reference))
        return flip_map(shown.test, shown.reference);
    Image rounded = shown.test;
    for (int y = 0; y < test.rows; ++y)
        for (int x = 0; x < test.cols; ++x)
            if (alike(test.at<cv::Vec3f>(y, x), reference.at<cv::Vec3f>(y, x), display_step / 2))
                rounded.at(x, y) = shown.reference.at(x, y);
    return flip_map(rounded, shown.reference);
}

Maps maps_of(const Both& shown, const CompareOptions& options, const cv::Mat& counted) {
    Maps maps = {
        .test = encoded(shown.test), .reference = encoded(shown.reference), .counted = counted};
    maps.flip = flip_but_for_rounding(shown, maps.test, maps.reference);
    maps.ssim = ssim_map(maps.test, maps.reference);
    std::optional<Color> background = options.background;
    if (background) *background *= float(std::exp2(options.exposure));
    maps.covered = covered_pixels(maps.test, maps.reference, background) & counted;
    maps.edges = edge_band(maps.reference);
    maps.alike = matched_pixels(maps.test, maps.reference, 0, display_step);
    return maps;
}

bool needs_hdr_flip(Comparison& result, const Both& pair) {
    return metric(result, "hdr_flip").limit || markedly_bright(pair.test) ||
           markedly_bright(pair.reference);
}

void measure(Comparison& result, const Both& pair, const Maps& maps, int shift_tolerance) {
    measure_linear(result, pair, maps.counted);
    measure_whole(result, maps);
    measure_parts(result, maps);
    const int radius = std::max(1, shift_tolerance);
    const cv::Mat near = matched_pixels(maps.test, maps.reference, radius, outlier_step);
    set(result, "outliers", share(~near, maps.counted, nan));
    if (needs_hdr_flip(result, pair)) {
        const cv::Mat flip = hdr_flip_map(pair.test, pair.reference);
        set(result, "hdr_flip", cv::mean(flip, maps.counted)[0]);
    }
    set(result, "coverage", share(maps.covered, maps.counted, nan));
}

std::string too_empty(const Metric& coverage) {
    return fmt::format("only {:.2g} % of the picture shows something else than the background, at "
                       "least {:.2g} % must: point the camera at the scene",
                       100 * coverage.value, 100 * *coverage.limit);
}

// The test picture with the reference's own pixels where both have each other's colour near by:
// then all figures take them for equal.
Image settled(const Both& pair, const CompareOptions& options) {
    const float gain = float(std::exp2(options.exposure));
    const auto shown = [&](const Image& image) {
        return gain == 1 ? encoded(image) : encoded(brightened(image, options.exposure));
    };
    const cv::Mat matched = matched_pixels(shown(pair.test), shown(pair.reference),
                                           options.shift_tolerance, display_step);
    Image result = pair.test;
    for (int y = 0; y < result.height; ++y)
        for (int x = 0; x < result.width; ++x)
            if (matched.at<uchar>(y, x) != 0) result.at(x, y) = pair.reference.at(x, y);
    return result;
}

bool ignores_some(const CompareOptions& options) {
    return !options.mask.pixels.empty() || !options.ignored.empty();
}

}  // namespace

std::string to_string(Verdict verdict) {
    switch (verdict) {
    case Verdict::pass: return "pass";
    case Verdict::warn: return "warn";
    case Verdict::fail: return "fail";
    case Verdict::not_comparable: return "not_comparable";
    case Verdict::error: break;
    }
    return "error";
}

double Comparison::value(const std::string& name) const {
    const auto found = std::ranges::find(metrics, name, &Metric::name);
    return found == metrics.end() ? nan : found->value;
}

Comparison compare(const Image& test, const Image& reference, const CompareOptions& options) {
    check_names(options.limits);
    Comparison result;
    result.metrics = blank_metrics(options.limits);
    result.verdict = Verdict::not_comparable;
    result.diagnosis = misfits(test, reference);
    if (!result.diagnosis.empty()) return result;

    const cv::Mat counted = counted_pixels(options, test.width, test.height);
    if (cv::countNonZero(counted) == 0) {
        result.diagnosis = {"the mask and the ignored boxes leave no pixel to compare"};
        return result;
    }
    Pair kept, exposed;
    if (ignores_some(options)) kept = without_ignored(test, reference, counted);
    const Both given =
        ignores_some(options) ? Both{kept.test, kept.reference} : Both{test, reference};
    result.diagnosis = not_finite(given.test, given.reference);
    if (!result.diagnosis.empty()) return result;
    Image tolerated;
    if (options.shift_tolerance > 0) tolerated = settled(given, options);
    const Both pair = options.shift_tolerance > 0 ? Both{tolerated, given.reference} : given;
    if (options.exposure != 0)
        exposed = {brightened(pair.test, options.exposure),
                   brightened(pair.reference, options.exposure)};
    const Both shown = options.exposure != 0 ? Both{exposed.test, exposed.reference} : pair;

    const Maps maps = maps_of(shown, options, counted);
    measure(result, pair, maps, options.shift_tolerance);
    if (!metric(result, "coverage").ok()) {
        result.diagnosis = {too_empty(metric(result, "coverage"))};
        return result;
    }
    result.diagnosis = differing_area(maps.alike, counted);
    result.warn_band = options.limits.warn_band;
    judge(result, result.warn_band);
    if (result.verdict == Verdict::fail) diagnose(result, shown, maps);
    return result;
}

}  // namespace penumbra
