#include "figures.h"

#include "commands.h"
#include "plain_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::cli {
namespace {

std::string number(double value) { return fmt::format("{:.6g}", value); }

std::string color_text(const Color& c) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", c.x, c.y, c.z);
}

std::string metric_line(const Metric& metric) {
    std::string line = fmt::format("  {:<15} {:>12}", metric.name, number(metric.value));
    if (metric.limit)
        line += fmt::format("   {} {:<8} {}", metric.at_least ? ">=" : "<=", number(*metric.limit),
                            metric.ok() ? "ok" : "NOT MET");
    return line + '\n';
}

}  // namespace

std::string figures(const Case& result) {
    const Comparison& comparison = result.comparison;
    std::string text =
        fmt::format("{}: {}\n", one_line(result.name), to_string(comparison.verdict));
    if (!result.message.empty()) text += fmt::format("  {}\n", one_line(result.message));
    for (const Metric& metric : comparison.metrics)
        if (metric.limit || !std::isnan(metric.value)) text += metric_line(metric);
    if (!comparison.metrics.empty() && comparison.verdict != Verdict::not_comparable)
        text += fmt::format("  worst pixel ({}, {}): {} {}, {} {}\n", comparison.worst.x,
                            comparison.worst.y, result.test_name, color_text(comparison.worst.test),
                            result.reference_name, color_text(comparison.worst.reference));
    for (const std::string& sentence : comparison.diagnosis)
        text += fmt::format("  {}\n", one_line(sentence));
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
            text +=
                fmt::format("  parity {:.6f}  ssim {:.6f}  flip {:.6f}", comparison.value("parity"),
                            comparison.value("ssim"), comparison.value("flip"));
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
