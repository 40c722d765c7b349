// Every figure of the parity rule, and the verdict.
#include "penumbra/compare.h"

#include "base/luminance.h"
#include "base/memory.h"
#include "base/text/number.h"
#include "validation/compare/measure.h"
#include "validation/compare/metric_table.h"
#include "validation/diagnosis/finding.h"
#include "validation/metrics/figures.h"
#include "validation/metrics/picture.h"
#include "validation/metrics/regions.h"

#include "penumbra/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace penumbra {
namespace {

using namespace metrics;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void check_names(const Limits& limits) {
    for (const auto& entry : limits.limits) {
        const std::string& name = entry.first;
        if (metric_kind(name)) continue;
        std::string known;
        for (const MetricKind& kind : metric_kinds())
            known += (known.empty() ? "" : ", ") + std::string(kind.name);
        throw Error(Failure::usage, "",
                    fmt::format("unknown metric '{}' (known: {})", name, known));
    }
}

// All figures, not yet known.
std::vector<Metric> blank_metrics(const Limits& limits) {
    std::vector<Metric> result;
    for (const MetricKind& kind : metric_kinds()) {
        Metric metric = {std::string(kind.name), nan, kind.always, kind.at_least};
        const auto limit = limits.limits.find(metric.name);
        if (limit != limits.limits.end()) metric.limit = limit->second;
        result.push_back(std::move(metric));
    }
    return result;
}

Metric& metric(Comparison& comparison, const std::string& name) {
    const auto found = std::ranges::find(comparison.metrics, name, &Metric::name);
    assert(found != comparison.metrics.end());
    return *found;
}

void set(Comparison& comparison, const std::string& name, double value) {
    metric(comparison, name).value = value;
}

// The part `count` of `all`; `otherwise` when there is nothing.
double share(std::size_t count, std::size_t all, double otherwise) {
    return all > 0 ? double(count) / double(all) : otherwise;
}

double mean(double sum, const RegionSums& region) {
    return region.pixels > 0 ? sum / double(region.pixels) : 0;
}

// rmse, psnr_db and bias over a region, of values as a display shows them.
void set_encoded(Comparison& result, const RegionSums& sums, const std::string& suffix) {
    const double rmse = std::sqrt(sums.squares / (3.0 * double(sums.pixels)));
    const auto bias = [&](int i) { return mean(sums.test[i] - sums.reference[i], sums); };
    set(result, "rmse" + suffix, rmse);
    // Equal pictures have no finite ratio; 999 dB is more than float32 values that differ can have.
    set(result, "psnr_db" + suffix, rmse == 0 ? 999 : -20 * std::log10(rmse));
    set(result, "bias" + suffix, penumbra::luminance(Vec3(bias(0), bias(1), bias(2))));
}

void set_whole(Comparison& result, const Measured& measured, const cv::Mat& counted) {
    const RegionSums& whole = measured.whole;
    set_encoded(result, whole, "");
    set(result, "exactness", 1 - share(measured.inexact, whole.pixels, nan));
    set(result, "max_error", measured.max_error);
    result.worst = measured.worst;
    result.pixels = whole.pixels;
    result.differing = whole.pixels - whole.alike;
    set(result, "parity", share(whole.alike, whole.pixels, nan));
    set(result, "ssim", mean(whole.ssim, whole));
    set(result, "ssim_tile", worst_tile(measured.ssim, counted, 32, Worst::smallest));
    set(result, "flip", mean(whole.flip, whole));
    set(result, "flip_tile", worst_tile(measured.flip, counted, 16, Worst::largest));
    result.worst_tiles = worst_tiles(measured.flip, counted, 16, 4);
    set(result, "outliers", share(measured.outliers, whole.pixels, nan));
    set(result, "coverage", share(measured.covered.pixels, whole.pixels, nan));
    if (measured.hdr_flip) set(result, "hdr_flip", *measured.hdr_flip);
}

// In a part without pixels nothing differs.
void set_parts(Comparison& result, const Measured& measured) {
    const RegionSums &covered = measured.covered, &edges = measured.edges;
    if (covered.pixels > 0) {
        set_encoded(result, covered, "_covered");
        set(result, "parity_covered", share(covered.alike, covered.pixels, nan));
        set(result, "ssim_covered", mean(covered.ssim, covered));
        set(result, "flip_covered", mean(covered.flip, covered));
    }
    set(result, "edges", share(edges.pixels, measured.whole.pixels, nan));
    set(result, "parity_edges", share(edges.alike, edges.pixels, 1));
    set(result, "flip_edges", mean(edges.flip, edges));
    set(result, "parity_inside", share(measured.inside.alike, measured.inside.pixels, 1));
}

Image image_of(const cv::Mat& errors) {
    Image result(errors.cols, errors.rows);
    std::transform(errors.begin<float>(), errors.end<float>(), result.pixels.begin(),
                   [](float error) { return Color(error); });
    return result;
}

void judge(Comparison& result, double band) {
    result.verdict = Verdict::pass;
    for (const Metric& metric : result.metrics) {
        if (!(limit_use(metric) > 1 - band) || !metric.ok()) continue;
        result.verdict = Verdict::warn;
        result.diagnosis.push_back(fmt::format("{} {} is within {:.3g} % of its limit {}",
                                               metric.name, number_text(metric.value, metric.limit),
                                               100 * band, limit_text(*metric.limit)));
    }
    if (!std::ranges::all_of(result.metrics, &Metric::ok)) result.verdict = Verdict::fail;
}

LinearRows displayed(const Pair& pair, float gain, cv::Mat Rows::* which) {
    return {pair.width(), pair.height(),
            [&pair, gain, which](int y) { return pair.rows(y, y + 1, gain).*which; }};
}

void diagnose(Comparison& result, const Pair& pair, float gain, const EdgeCounts& edges) {
    Finding finding =
        likely_cause(displayed(pair, gain, &Rows::test), displayed(pair, gain, &Rows::reference));
    const bool explained = finding.convincing();
    if (!explained) finding = only_edges(edges);
    result.cause = finding.cause;
    if (finding.cause.empty()) return;
    result.diagnosis.push_back(explained ? said(finding) : finding.sentence);
}

std::string too_empty(const Metric& coverage, bool by_objects) {
    return fmt::format("only {:.2g} % of the picture shows {}, at least {:.2g} % must: point the "
                       "camera at the scene",
                       100 * coverage.value,
                       by_objects ? "an object" : "something else than the background",
                       100 * *coverage.limit);
}

void check_covered(const CompareOptions& options, const Image& test) {
    const std::size_t given = options.covered.size();
    if (given == 0 || given == test.pixels.size()) return;
    throw Error(Failure::usage, "",
                fmt::format("what is covered must have a value for each of the {} pixels, not {}",
                            test.pixels.size(), given));
}

// Throws where there is not what a comparison takes beside the pictures at most: while it looks for
// the cause of a difference both of them encoded, before that a span with the maps of it.
void check_memory(const Pair& pair) {
    constexpr std::size_t pixel = 18, span_pixel = 280;  // bytes
    const MemoryClaim claim(
        pair.counted().total() * pixel + pair.most_in_span(flip_radius) * span_pixel,
        fmt::format("comparing pictures of {}x{} pixels", pair.width(), pair.height()));
}

void compare_sources(Comparison& result, const Source& test, const Source& reference,
                     const CompareOptions& options) {
    result.diagnosis = misfits(test.colors, reference.colors);
    if (!result.diagnosis.empty()) return;
    check_covered(options, test.colors);
    const cv::Mat counted = counted_pixels(options, test.colors.width, test.colors.height);
    if (cv::countNonZero(counted) == 0) {
        result.diagnosis = {"the mask and the ignored boxes leave no pixel to compare"};
        return;
    }
    Pair pair(test, reference, counted);
    check_memory(pair);
    result.diagnosis = pair.not_finite();
    if (!result.diagnosis.empty()) return;
    const auto gain = float(std::exp2(options.exposure));
    if (options.shift_tolerance > 0) pair.tolerate_shifts(options.shift_tolerance, gain);

    Measured measured = measure(pair, options, metric(result, "hdr_flip").limit.has_value());
    set_whole(result, measured, counted);
    set_parts(result, measured);
    measured.ssim.release();
    set(result, "flip_p99", quantile(measured.flip, counted, 0.99));
    if (!metric(result, "coverage").ok()) {
        result.diagnosis = {too_empty(metric(result, "coverage"), !options.covered.empty())};
    } else {
        result.diagnosis =
            differing_area(measured.alike, counted, pair.opaque() ? "sRGB" : "sRGB or alpha");
        measured.alike.release();
        result.warn_band = options.limits.warn_band;
        judge(result, result.warn_band);
        if (result.verdict == Verdict::fail) diagnose(result, pair, gain, measured.either_edges);
    }
    result.flip_map = image_of(measured.flip);
}

Comparison compared(const Source& test, const Source& reference, const CompareOptions& options) {
    check_names(options.limits);
    Comparison result;
    result.metrics = blank_metrics(options.limits);
    result.verdict = Verdict::not_comparable;
    with_own_errors([&] { compare_sources(result, test, reference, options); });
    return result;
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

std::string alpha_sentence(const Comparison& comparison) {
    switch (comparison.alpha) {
    case Alpha::none: break;
    case Alpha::counted:
        return "alpha is compared, and colours count as much as it covers: none where it is 0";
    case Alpha::ignored: return "alpha is ignored, and colours are compared as if it were 1";
    }
    return "";
}

double Comparison::value(const std::string& name) const {
    const auto found = std::ranges::find(metrics, name, &Metric::name);
    return found == metrics.end() ? nan : found->value;
}

Comparison compare(const Image& test, const Image& reference, const CompareOptions& options) {
    const Raster opaque;
    return compared({test, opaque}, {reference, opaque}, options);
}

Comparison compare(const Picture& test, const Picture& reference, const CompareOptions& options) {
    Comparison result =
        compared({test.colors, test.alpha}, {reference.colors, reference.alpha}, options);
    result.alpha = test.use != Alpha::none ? test.use : reference.use;
    return result;
}

}  // namespace penumbra
