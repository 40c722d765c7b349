// The table of metrics; docs/json.md defines them.
#include "validation/compare/metric_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::metrics {
namespace {

constexpr auto none = std::nullopt;

// The limits are thresholds that separated equal scenes from scenes with a defect in an experiment
// with POV-Ray as both sides: 9 pairs that differ in anti-aliasing only, 59 with one of 20 defects.
// Every pixel of an approximated material may be off by more than 1/255: the last profile, similar,
// has no limit of parity.
constexpr MetricKind kinds[] = {
    {.name = "parity",
     .at_least = true,
     .scale = Scale::share,
     .description = "pixels that differ by at most 1/255 as displayed",
     .limits = {0.9995, 0.995, none},
     .by_default = true},
    {.name = "exactness",
     .at_least = true,
     .scale = Scale::share,
     .description = "pixels equal to 1e-4, linear"},
    {.name = "max_error",
     .at_least = false,
     .description = "largest difference of a channel, linear"},
    {.name = "rmse",
     .at_least = false,
     .description = "root mean square difference, sRGB in [0, 1]"},
    {.name = "psnr_db",
     .at_least = true,
     .scale = Scale::decibel,
     .description = "peak signal to noise ratio; 999 when equal",
     .limits = {48, 42, 32}},
    {.name = "ssim",
     .at_least = true,
     .description = "structural similarity, mean",
     .limits = {0.997, 0.99, 0.96},
     .by_default = true},
    {.name = "ssim_tile",
     .at_least = true,
     .description = "structural similarity, worst tile of 32 × 32",
     .limits = {0.98, 0.96, 0.8}},
    {.name = "flip",
     .at_least = false,
     .description = "perceived difference, mean",
     .limits = {0.006, 0.01, 0.045},
     .by_default = true},
    {.name = "flip_p99",
     .at_least = false,
     .description = "perceived difference that 1 % of the pixels exceed",
     .limits = {0.04, 0.065, 0.25}},
    {.name = "flip_tile",
     .at_least = false,
     .description = "perceived difference, worst tile of 16 × 16",
     .limits = {0.035, 0.045, 0.25},
     .by_default = true},
    {.name = "bias",
     .at_least = false,
     .description = "mean difference of luma, with sign",
     .limits = {0.001, 0.003, 0.01}},
    {.name = "coverage",
     .at_least = true,
     .scale = Scale::no_error,
     .description = "pixels that show an object; of picture files: that are not background",
     .always = 0.01},
    {.name = "outliers",
     .at_least = false,
     .scale = Scale::share,
     .description = "pixels that differ by more than 8/255 from any near one",
     .limits = {0.003, 0.01, 0.04}},
    {.name = "parity_covered", .at_least = true, .scale = Scale::share, .part = Part::covered},
    {.name = "rmse_covered", .at_least = false, .part = Part::covered},
    {.name = "psnr_db_covered", .at_least = true, .scale = Scale::decibel, .part = Part::covered},
    {.name = "ssim_covered", .at_least = true, .part = Part::covered},
    {.name = "flip_covered", .at_least = false, .part = Part::covered},
    {.name = "bias_covered", .at_least = false, .part = Part::covered},
    {.name = "edges",
     .at_least = false,
     .scale = Scale::share,
     .part = Part::edges,
     .description = "pixels beside an edge of the reference"},
    {.name = "parity_edges",
     .at_least = true,
     .scale = Scale::share,
     .part = Part::edges,
     .description = "parity of the pixels beside an edge"},
    {.name = "flip_edges",
     .at_least = false,
     .part = Part::edges,
     .description = "perceived difference beside edges, mean"},
    {.name = "parity_inside",
     .at_least = true,
     .scale = Scale::share,
     .part = Part::edges,
     .description = "parity of the pixels away from edges"},
    {.name = "hdr_flip",
     .at_least = false,
     .description = "perceived difference over a range of exposures, mean"},
};

}  // namespace

std::span<const MetricKind> metric_kinds() { return kinds; }

const MetricKind* metric_kind(std::string_view name) {
    const auto* const found = std::ranges::find(kinds, name, &MetricKind::name);
    return found == std::end(kinds) ? nullptr : found;
}

double limit_use(const Metric& metric) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const MetricKind* const kind = metric_kind(metric.name);
    const Scale scale = kind ? kind->scale : Scale::number;
    if (!metric.limit || scale == Scale::no_error) return nan;
    if (scale == Scale::decibel) return std::pow(10, (*metric.limit - metric.value) / 20);
    const double error = metric.at_least ? 1 - metric.value : std::abs(metric.value);
    return error / (metric.at_least ? 1 - *metric.limit : *metric.limit);
}

}  // namespace penumbra::metrics
