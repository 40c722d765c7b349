// Limits of the verdict: named ones, and those that known-good pairs suggest.
#include "validation/compare/metric_table.h"

#include "penumbra/compare.h"
#include "penumbra/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {
namespace {

using namespace metrics;

struct Profile {
    std::string_view name;
    std::optional<double> ProfileLimits::* limit;
};

constexpr std::array profiles = {Profile{"strict", &ProfileLimits::strict},
                                 Profile{"equivalent", &ProfileLimits::equivalent},
                                 Profile{"similar", &ProfileLimits::similar}};

// More than float32 pictures that differ can have by much; equal pictures have 999.
constexpr double best_ratio = 100;  // dB

// Upwards to two significant digits, so that a limit reads well and still lets the pair pass.
double rounded_up(double error) {
    if (!(error > 0)) return 0;
    const double unit = std::pow(10, std::floor(std::log10(error)) - 1);
    // An error that is 0.25 but for its last bit must not become 0.26.
    return std::ceil(error / unit - 1e-9) * unit;
}

double limit_for(const MetricKind& kind, double worst, double margin) {
    if (kind.scale == Scale::decibel)
        return std::floor(10 * (std::min(worst, best_ratio) - 20 * std::log10(margin))) / 10;
    if (!kind.at_least) return rounded_up(margin * std::abs(worst));
    const double limit = 1 - rounded_up(margin * (1 - worst));
    return kind.scale == Scale::share ? std::max(limit, 0.0) : limit;
}

bool worse(const Metric& one, const Metric& other) {
    return one.at_least ? one.value < other.value : std::abs(one.value) > std::abs(other.value);
}

}  // namespace

std::map<std::string, double> default_limits() {
    std::map<std::string, double> limits;
    for (const MetricKind& kind : metric_kinds())
        if (kind.by_default) limits.emplace(kind.name, kind.limits.equivalent.value());
    return limits;
}

Limits profile_limits(const std::string& name) {
    const auto profile = std::ranges::find(profiles, name, &Profile::name);
    if (profile == profiles.end())
        throw Error(Failure::usage, "",
                    fmt::format("unknown profile '{}' (strict, equivalent or similar)", name));
    Limits result;
    result.limits.clear();
    for (const MetricKind& kind : metric_kinds())
        if (const auto limit = kind.limits.*profile->limit)
            result.limits.emplace(kind.name, *limit);
    return result;
}

Limits calibrated_limits(const std::vector<Comparison>& good, double margin) {
    Limits result;
    result.limits.clear();
    for (const MetricKind& kind : metric_kinds()) {
        if (!kind.limits.equivalent) continue;
        const Metric* worst = nullptr;
        for (const Comparison& pair : good) {
            if (pair.verdict == Verdict::not_comparable || pair.verdict == Verdict::error) continue;
            const auto found = std::ranges::find(pair.metrics, kind.name, &Metric::name);
            if (found == pair.metrics.end() || !std::isfinite(found->value)) continue;
            if (worst == nullptr || worse(*found, *worst)) worst = &*found;
        }
        if (worst) result.limits.emplace(kind.name, limit_for(kind, worst->value, margin));
    }
    return result;
}

}  // namespace penumbra
