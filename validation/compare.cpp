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
    Kind{"parity", true},     Kind{"exactness", true}, Kind{"max_error", false},
    Kind{"rmse", false},      Kind{"psnr_db", true},   Kind{"ssim", true},
    Kind{"ssim_tile", true},  Kind{"flip", false},     Kind{"flip_p99", false},
    Kind{"flip_tile", false}, Kind{"bias", false},     Kind{"coverage", true}};

void check_names(const Limits& limits) {
    for (const auto& [name, limit] : limits.limits) {
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

// exactness, max_error and the worst pixel: of linear values, not clamped.
void measure_linear(Comparison& result, const Image& test, const Image& reference) {
    std::size_t exact = 0;
    double worst = -1;
    for (int y = 0; y < test.height; ++y) {
        for (int x = 0; x < test.width; ++x) {
            const Color &a = test.at(x, y), &b = reference.at(x, y);
            double largest = 0;
            bool all_exact = true;
            for (int i = 0; i < 3; ++i) {
                const double d = std::abs(double(a[i]) - double(b[i]));
                largest = std::max(largest, d);
                if (!(d <= 1e-4 * std::max(1.0, std::abs(double(b[i]))))) all_exact = false;
            }
            if (all_exact) ++exact;
            if (largest > worst) {
                worst = largest;
                result.worst = {x, y, a, b};
            }
        }
    }
    metric(result, "exactness").value = double(exact) / double(test.pixels.size());
    metric(result, "max_error").value = worst;
}

// parity, rmse, psnr_db and bias: of values as a display shows them.
void measure_encoded(Comparison& result, const cv::Mat& test, const cv::Mat& reference) {
    std::size_t same = 0;
    double squares = 0, luma = 0;
    for (int y = 0; y < test.rows; ++y) {
        const auto* const a = test.ptr<cv::Vec3f>(y);
        const auto* const b = reference.ptr<cv::Vec3f>(y);
        for (int x = 0; x < test.cols; ++x) {
            const cv::Vec3d d = cv::Vec3d(a[x]) - cv::Vec3d(b[x]);
            if (alike(a[x], b[x])) ++same;
            squares += d.dot(d);
            luma += 0.2126 * d[0] + 0.7152 * d[1] + 0.0722 * d[2];  // ITU-R BT.709
        }
    }
    const auto count = double(test.total());
    const double rmse = std::sqrt(squares / (3 * count));
    metric(result, "parity").value = double(same) / count;
    metric(result, "rmse").value = rmse;
    // Equal pictures have no finite ratio; 999 dB is more than float32 values that differ can have.
    metric(result, "psnr_db").value = rmse == 0 ? 999 : -20 * std::log10(rmse);
    metric(result, "bias").value = luma / count;
}

void measure_perceived(Comparison& result, const cv::Mat& flip, const cv::Mat& ssim) {
    metric(result, "ssim").value = cv::mean(ssim)[0];
    metric(result, "ssim_tile").value = worst_tile(ssim, 32, Worst::smallest);
    metric(result, "flip").value = cv::mean(flip)[0];
    metric(result, "flip_p99").value = quantile(flip, 0.99);
    metric(result, "flip_tile").value = worst_tile(flip, 16, Worst::largest);
    result.flip_map = Image(flip.cols, flip.rows);
    std::transform(flip.begin<float>(), flip.end<float>(), result.flip_map.pixels.begin(),
                   [](float error) { return Color(error); });
}

// Has more than 80 % of the error that the limit allows.
bool close_to_limit(const Metric& metric) {
    if (!metric.limit || metric.name == "coverage") return false;
    if (metric.name == "psnr_db") return metric.value < *metric.limit + 20 * std::log10(1 / 0.8);
    return metric.at_least ? 1 - metric.value > 0.8 * (1 - *metric.limit)
                           : std::abs(metric.value) > 0.8 * *metric.limit;
}

void judge(Comparison& result) {
    result.verdict = Verdict::pass;
    for (const Metric& metric : result.metrics) {
        if (!close_to_limit(metric) || !metric.ok()) continue;
        result.verdict = Verdict::warn;
        result.diagnosis.push_back(fmt::format("{} {:.6g} is within 20 % of its limit {:.6g}",
                                               metric.name, metric.value, *metric.limit));
    }
    if (!std::ranges::all_of(result.metrics, &Metric::ok)) result.verdict = Verdict::fail;
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

// Thresholds that separated equal scenes from scenes with a defect in an experiment with POV-Ray
// as both sides: 9 pairs that differ in anti-aliasing only, 59 with one of 20 defects.
Limits profile_limits(const std::string& name) {
    if (name == "strict")
        return {{{"parity", 0.9995},
                 {"psnr_db", 48},
                 {"ssim", 0.997},
                 {"ssim_tile", 0.98},
                 {"flip", 0.006},
                 {"flip_p99", 0.04},
                 {"flip_tile", 0.035},
                 {"bias", 0.001}}};
    if (name == "equivalent")
        return {{{"parity", 0.995},
                 {"psnr_db", 42},
                 {"ssim", 0.99},
                 {"ssim_tile", 0.96},
                 {"flip", 0.01},
                 {"flip_p99", 0.065},
                 {"flip_tile", 0.045},
                 {"bias", 0.003}}};
    // Every pixel of an approximated material may be off by more than 1/255: no limit of parity.
    if (name == "similar")
        return {{{"psnr_db", 32},
                 {"ssim", 0.96},
                 {"ssim_tile", 0.8},
                 {"flip", 0.045},
                 {"flip_p99", 0.25},
                 {"flip_tile", 0.25},
                 {"bias", 0.01}}};
    throw Error(Failure::usage, "",
                fmt::format("unknown profile '{}' (strict, equivalent or similar)", name));
}

Comparison compare(const Image& test, const Image& reference, const CompareOptions& options) {
    check_names(options.limits);
    Comparison result;
    result.metrics = blank_metrics(options.limits);
    result.verdict = Verdict::not_comparable;
    result.diagnosis = obstacles(test, reference);
    if (!result.diagnosis.empty()) return result;

    const cv::Mat a = encoded(test), b = encoded(reference);
    measure_linear(result, test, reference);
    measure_encoded(result, a, b);
    measure_perceived(result, flip_map(test, reference), ssim_map(a, b));
    Metric& covered = metric(result, "coverage");
    covered.value = coverage(a, b, options.background);
    if (!covered.ok()) {
        result.diagnosis = {
            fmt::format("only {:.2g} % of the picture shows something else than the "
                        "background, at least {:.2g} % must: point the camera at "
                        "the scene",
                        100 * covered.value, 100 * *covered.limit)};
        return result;
    }
    result.diagnosis = differing_area(a, b);
    judge(result);
    if (result.verdict == Verdict::fail)
        for (std::string& sentence : likely_cause(test, reference))
            result.diagnosis.push_back(std::move(sentence));
    return result;
}

}  // namespace penumbra
