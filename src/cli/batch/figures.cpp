#include "cli/batch/figures.h"

#include "base/text/number.h"
#include "base/text/text.h"
#include "cli/context.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::cli {
namespace {

std::string color_text(const Color& c) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", c.x, c.y, c.z);
}

// "8,294,400".
std::string grouped(std::size_t number) {
    const std::string digits = fmt::format("{}", number);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
        text += digits[i];
    }
    return text;
}

// What a share of the pixels comes to, where it is not all of them.
std::string pixels_of(const Comparison& comparison, const Metric& metric) {
    const bool agree = metric.name == "parity" || metric.name == "exactness";
    if ((!agree && metric.name != "outliers") || comparison.pixels == 0) return "";
    const double share = agree ? 1 - metric.value : metric.value;
    const auto count = std::size_t(std::llround(share * double(comparison.pixels)));
    if (count == 0) return "";
    return fmt::format("   {} of {} pixels {}", grouped(count), grouped(comparison.pixels),
                       agree ? (count == 1 ? "differs" : "differ")
                             : (count == 1 ? "is one" : "are"));
}

std::string metric_line(const Comparison& comparison, const Metric& metric) {
    std::string line =
        fmt::format("  {:<15} {:>12}", metric.name, number_text(metric.value, metric.limit));
    if (metric.limit)
        line += fmt::format("   {} {:<8} {:<7}",
                            metric.at_least ? ">=" : "<=", limit_text(*metric.limit),
                            metric.ok() ? "ok" : "NOT MET");
    line += pixels_of(comparison, metric);
    line.resize(line.find_last_not_of(' ') + 1);
    return line + '\n';
}

std::string pixel_text(const Comparison& comparison, const Color& color, float alpha) {
    if (comparison.alpha != Alpha::counted) return color_text(color);
    return fmt::format("{} alpha {:.6g}", color_text(color), alpha);
}

// Six decimals, and more where they would make what differs look like 1.
std::string parity_text(double parity) {
    std::string text = fmt::format("{:.6f}", parity);
    return parity < 1 && text == "1.000000" ? number_text(parity) : text;
}

}  // namespace

std::string figures(const Case& result) {
    const Comparison& comparison = result.comparison;
    std::string text =
        fmt::format("{}: {}\n", one_line(result.name), to_string(comparison.verdict));
    if (!result.message.empty()) text += fmt::format("  {}\n", one_line(result.message));
    for (const Metric& metric : comparison.metrics)
        if (metric.limit || !std::isnan(metric.value)) text += metric_line(comparison, metric);
    if (!comparison.metrics.empty() && comparison.verdict != Verdict::not_comparable)
        text += fmt::format(
            "  worst pixel ({}, {}): {} {}, {} {}\n", comparison.worst.x, comparison.worst.y,
            result.test_name,
            pixel_text(comparison, comparison.worst.test, comparison.worst.test_alpha),
            result.reference_name,
            pixel_text(comparison, comparison.worst.reference, comparison.worst.reference_alpha));
    if (result.sampling) text += fmt::format("  both with {}\n", to_string(*result.sampling));
    for (const std::string& sentence : comparison.diagnosis)
        text += fmt::format("  {}\n", one_line(sentence));
    if (const std::string alpha = alpha_sentence(comparison); !alpha.empty())
        text += fmt::format("  {}\n", alpha);
    return text;
}

std::string overview(const std::vector<Case>& cases) {
    std::size_t width = 0;
    for (const Case& result : cases) width = std::max(width, one_line(result.name).size());
    std::string text;
    std::map<std::string, int> totals;
    for (const Case& result : cases) {
        const Comparison& comparison = result.comparison;
        ++totals[to_string(comparison.verdict)];
        text += fmt::format("{:<14} {:<{}}", to_string(comparison.verdict), one_line(result.name),
                            width);
        if (result.message.empty())
            text += fmt::format("  parity {}  ssim {:.6f}  flip {:.6f}",
                                parity_text(comparison.value("parity")), comparison.value("ssim"),
                                comparison.value("flip"));
        else
            text += "  " + one_line(result.message);
        text += '\n';
    }
    text += fmt::format("{} scene{}:", cases.size(), cases.size() == 1 ? "" : "s");
    for (const auto& [verdict, count] : totals) text += fmt::format(" {} {}", count, verdict);
    return text + '\n';
}

int verdict_status(Verdict verdict) {
    switch (verdict) {
    case Verdict::pass:
    case Verdict::warn: return exit_success;
    case Verdict::fail: return exit_different;
    case Verdict::not_comparable: return exit_not_comparable;
    case Verdict::error: break;
    }
    return exit_internal;
}

}  // namespace penumbra::cli
