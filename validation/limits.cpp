// Limits of the verdict: named ones, and those that known-good pairs suggest.
#include "penumbra/error.h"
#include "penumbra/validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {
namespace {

// Figures that a limit makes sense of for any pair; the others are parts of them or depend on what
// the picture shows.
constexpr std::array calibrated = {"parity",   "psnr_db",   "ssim",     "ssim_tile", "flip",
                                   "flip_p99", "flip_tile", "outliers", "bias"};

// More than float32 pictures that differ can have by much; equal pictures have 999.
constexpr double best_ratio = 100;  // dB

// Upwards to two significant digits, so that a limit reads well and still lets the pair pass.
double rounded_up(double error) {
    if (!(error > 0)) return 0;
    const double unit = std::pow(10, std::floor(std::log10(error)) - 1);
    // An error that is 0.25 but for its last bit must not become 0.26.
    return std::ceil(error / unit - 1e-9) * unit;
}

double limit_for(const Metric& worst, double margin) {
    if (worst.name == "psnr_db")
        return std::floor(10 * (std::min(worst.value, best_ratio) - 20 * std::log10(margin))) / 10;
    if (worst.at_least) return 1 - rounded_up(margin * (1 - worst.value));
    return rounded_up(margin * std::abs(worst.value));
}

bool worse(const Metric& one, const Metric& other) {
    return one.at_least ? one.value < other.value : std::abs(one.value) > std::abs(other.value);
}

}  // namespace

// Thresholds that separated equal scenes from scenes with a defect in an experiment with POV-Ray
// as both sides: 9 pairs that differ in anti-aliasing only, 59 with one of 20 defects.
Limits profile_limits(const std::string& name) {
    if (name == "strict")
        return {.limits = {{"parity", 0.9995},
                           {"psnr_db", 48},
                           {"ssim", 0.997},
                           {"ssim_tile", 0.98},
                           {"flip", 0.006},
                           {"flip_p99", 0.04},
                           {"flip_tile", 0.035},
                           {"outliers", 0.003},
                           {"bias", 0.001}}};
    if (name == "equivalent")
        return {.limits = {{"parity", 0.995},
                           {"psnr_db", 42},
                           {"ssim", 0.99},
                           {"ssim_tile", 0.96},
                           {"flip", 0.01},
                           {"flip_p99", 0.065},
                           {"flip_tile", 0.045},
                           {"outliers", 0.01},
                           {"bias", 0.003}}};
    // Every pixel of an approximated material may be off by more than 1/255: no limit of parity.
    if (name == "similar")
        return {.limits = {{"psnr_db", 32},
                           {"ssim", 0.96},
                           {"ssim_tile", 0.8},
                           {"flip", 0.045},
                           {"flip_p99", 0.25},
                           {"flip_tile", 0.25},
                           {"outliers", 0.04},
                           {"bias", 0.01}}};
    throw Error(Failure::usage, "",
                fmt::format("unknown profile '{}' (strict, equivalent or similar)", name));
}

Limits calibrated_limits(const std::vector<Comparison>& good, double margin) {
    Limits result;
    result.limits.clear();
    for (const char* const name : calibrated) {
        const Metric* worst = nullptr;
        for (const Comparison& pair : good) {
            if (pair.verdict == Verdict::not_comparable || pair.verdict == Verdict::error) continue;
            const auto found = std::ranges::find(pair.metrics, name, &Metric::name);
            if (found == pair.metrics.end() || !std::isfinite(found->value)) continue;
            if (worst == nullptr || worse(*found, *worst)) worst = &*found;
        }
        if (worst == nullptr) continue;
        const double limit = limit_for(*worst, margin);
        result.limits[name] = worst->name == "parity" ? std::max(limit, 0.0) : limit;
    }
    return result;
}

}  // namespace penumbra
