// Cases -> JUnit XML and Markdown.
#include "base/text/number.h"
#include "validation/compare/metric_table.h"
#include "validation/report/markup.h"
#include "validation/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace penumbra {
namespace {

using markup::clean;
using markup::escaped;

double total_seconds(const Case& one) {
    double total = 0;
    for (const auto& [step, seconds] : one.seconds) total += seconds;
    return total;
}

std::string sentences(const Case& one) {
    std::string result;
    for (const std::string& sentence : one.comparison.diagnosis) result += sentence + "\n";
    return result;
}

// What JUnit calls the outcome of a test; "" for one that passed.
std::string junit_outcome(const Case& one) {
    std::string element = "failure", message = broken_limits(one.comparison);
    switch (one.comparison.verdict) {
    case Verdict::pass:
    case Verdict::warn: return "";
    case Verdict::fail: break;
    case Verdict::not_comparable:
        message = one.comparison.diagnosis.empty() ? "" : one.comparison.diagnosis.front();
        break;
    case Verdict::error:
        element = "error";
        message = one.message;
        break;
    }
    return fmt::format("      <{0} type=\"{1}\" message=\"{2}\">{3}</{0}>\n", element,
                       to_string(one.comparison.verdict), escaped(message),
                       escaped(sentences(one)));
}

std::string junit_case(const Case& one) {
    std::string figures = to_string(one.comparison.verdict) + "\n";
    for (const Metric& metric : one.comparison.metrics)
        figures += fmt::format("{} {}{}\n", metric.name, markup::number(metric),
                               !metric.limit
                                   ? ""
                                   : fmt::format(" (limit {}{})", metric.at_least ? ">= " : "<= ",
                                                 limit_text(*metric.limit)));
    return fmt::format("    <testcase classname=\"penumbra\" name=\"{}\" time=\"{:.3f}\">\n{}"
                       "      <system-out>{}</system-out>\n    </testcase>\n",
                       escaped(one.name), total_seconds(one), junit_outcome(one), escaped(figures));
}

// ---- Markdown -----------------------------------------------------------------------------------

// Text that others wrote, in a cell of a table: one line, nothing of it markup.
std::string cell(const std::string& text) {
    std::string result;
    for (const char c : clean(text)) {
        if (c == '\n' || c == '\r' || c == '\t') {
            result += ' ';
            continue;
        }
        if (std::string_view("\\`*_{}[]<>()#+-!|~&@:").find(c) != std::string_view::npos)
            result += fmt::format("&#{};", int(c));
        else
            result += c;
    }
    return result;
}

std::string shown(Verdict verdict) {
    switch (verdict) {
    case Verdict::pass: return ":white_check_mark: pass";
    case Verdict::warn: return ":warning: warn";
    case Verdict::fail: return ":x: fail";
    case Verdict::not_comparable: return ":grey_question: not comparable";
    case Verdict::error: break;
    }
    return ":boom: error";
}

// The last sentence of a diagnosis names the cause, the ones before it what was measured.
std::string reason(const Case& one) {
    if (!one.message.empty()) return one.message;
    const auto& sentences = one.comparison.diagnosis;
    if (one.comparison.verdict == Verdict::pass || sentences.empty()) return "";
    return sentences.back();
}

std::string markdown_row(const Case& one) {
    const Comparison& comparison = one.comparison;
    return fmt::format("| {} | {} | {} | {} | {} | {} |\n", shown(comparison.verdict),
                       cell(one.name), markup::number(Metric{"parity", comparison.value("parity")}),
                       markup::number(comparison.value("ssim"), 4),
                       markup::number(comparison.value("flip"), 4), cell(reason(one)));
}

}  // namespace

std::string broken_limits(const Comparison& comparison) {
    std::string result;
    for (const Metric& metric : comparison.metrics) {
        if (metric.ok()) continue;
        if (!result.empty()) result += "; ";
        result += fmt::format("{} {}, limit {} {}", metric.name, markup::number(metric),
                              metric.at_least ? ">=" : "<=", limit_text(*metric.limit));
    }
    return result;
}

double severity(const Case& one) {
    switch (one.comparison.verdict) {
    case Verdict::error: return 3e6;
    case Verdict::not_comparable: return 2e6;
    default: break;
    }
    double worst = 0;
    for (const Metric& metric : one.comparison.metrics) {
        const double part = metrics::limit_use(metric);
        if (!metric.ok() || part > 0) worst = std::max(worst, part < 1e6 ? part : 1e6);
    }
    return worst;
}

std::string report_junit(const std::vector<Case>& cases) {
    const auto count = [&](auto... verdicts) {
        return std::ranges::count_if(
            cases, [&](const Case& one) { return ((one.comparison.verdict == verdicts) || ...); });
    };
    double seconds = 0;
    std::string body;
    for (const Case& one : cases) {
        seconds += total_seconds(one);
        body += junit_case(one);
    }
    const std::string totals =
        fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", cases.size(),
                    count(Verdict::fail, Verdict::not_comparable), count(Verdict::error), seconds);
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n"
                       "  <testsuite name=\"penumbra\" {0}>\n{1}  </testsuite>\n</testsuites>\n",
                       totals, body);
}

std::string report_markdown(const std::vector<Case>& cases) {
    std::map<Verdict, int> totals;
    for (const Case& one : cases) ++totals[one.comparison.verdict];
    std::string text = "### penumbra\n\n";
    for (const auto& [verdict, count] : totals)
        text += fmt::format("{}{} {}", text.ends_with("\n") ? "" : ", ", count, shown(verdict));
    text += "\n\n| verdict | scene | parity | SSIM | FLIP | why |\n| --- | --- | --: | --: | --: | "
            "--- |\n";
    std::vector<const Case*> order;
    for (const Case& one : cases) order.push_back(&one);
    std::ranges::stable_sort(order, std::greater(), [](const Case* one) { return severity(*one); });
    for (const Case* one : order) text += markdown_row(*one);
    return text;
}

}  // namespace penumbra
