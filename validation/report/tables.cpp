// Tables and lists of the page of one case.
#include "base/loss_tally.h"
#include "base/text/number.h"
#include "validation/compare/metric_table.h"
#include "validation/metrics/picture.h"
#include "validation/report/html.h"
#include "validation/report/markup.h"
#include "validation/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::html {
namespace {

using markup::number;

using metrics::limit_use;
using metrics::Part;

// A bar that is full at the limit, with a mark where the band of warnings begins.
std::string gauge(const Metric& metric, double warn_band) {
    const double part = limit_use(metric);
    if (!std::isfinite(part)) return "";
    const char* kind = !metric.ok() ? "bad" : part > 1 - warn_band ? "warn" : "good";
    const std::string percent =
        part < 9.995 ? fmt::format("{:.0f} %", part * 100) : fmt::format("× {}", number(part, 3));
    return fmt::format(
        "<span class=\"gauge {}\"><svg viewBox=\"0 0 100 8\" preserveAspectRatio=\"none\" "
        "aria-hidden=\"true\"><rect class=\"rail\" width=\"100\" height=\"8\"/><rect "
        "class=\"used\" width=\"{:.1f}\" height=\"8\"/><rect class=\"mark\" x=\"{:.1f}\" "
        "width=\"1.5\" height=\"8\"/></svg>{}</span>",
        kind, std::clamp(part * 100, 0.0, 100.0), 100 * (1 - warn_band), percent);
}

std::string met(const Metric& metric, double warn_band) {
    if (!metric.limit) return "";
    if (!metric.ok()) return "<span class=\"bad\">✗<span class=\"word\"> no</span></span>";
    return limit_use(metric) > 1 - warn_band
               ? "<span class=\"warn\">!<span class=\"word\"> close</span></span>"
               : "<span class=\"good\">✓<span class=\"word\"> yes</span></span>";
}

std::string figure_rows(const Comparison& comparison, Part part, const char* title) {
    std::string rows;
    for (const Metric& metric : comparison.metrics) {
        const metrics::MetricKind* const known = metrics::metric_kind(metric.name);
        const metrics::MetricKind kind = known ? *known : metrics::MetricKind();
        // What was not measured and need not be is left out.
        if (kind.part != part || (std::isnan(metric.value) && !metric.limit)) continue;
        rows += fmt::format(
            "<tr role=\"row\"><th role=\"rowheader\" scope=\"row\">{}<small>{}</small></th>"
            "<td role=\"cell\">{}</td><td role=\"cell\">{}</td><td role=\"cell\">{}</td>"
            "<td role=\"cell\">{}</td></tr>\n",
            text(metric.name), kind.description, number(metric),
            metric.limit ? (metric.at_least ? "≥ " : "≤ ") + limit_text(*metric.limit) : "",
            gauge(metric, comparison.warn_band), met(metric, comparison.warn_band));
    }
    if (rows.empty()) return "";
    return fmt::format(
        "<tbody role=\"rowgroup\"><tr role=\"row\" class=\"part\"><th "
        "role=\"rowheader\" scope=\"rowgroup\" colspan=\"5\">{}</th></tr>\n{}</tbody>\n",
        title, rows);
}

// The part of `file`, a path relative to the report, that leads there from the page of the case.
std::string from_page(const Case& one, const std::string& file) {
    if (one.folder.empty()) return file;
    const std::filesystem::path relative =
        std::filesystem::path(file).lexically_relative(std::filesystem::path(one.folder));
    return relative.empty() ? file : relative.generic_string();
}

}  // namespace

std::string figures(const Comparison& comparison) {
    if (comparison.metrics.empty()) return "";
    const std::string parts = figure_rows(comparison, Part::whole, "The whole picture") +
                              figure_rows(comparison, Part::covered, "What is covered") +
                              figure_rows(comparison, Part::edges, "Beside and away from edges");
    return fmt::format(
        "<section class=\"card\">\n<h2>Figures</h2>\n<div class=\"wide\" tabindex=\"0\" "
        "role=\"region\" aria-label=\"Figures\"><table role=\"table\" class=\"figures\">"
        "<thead role=\"rowgroup\"><tr role=\"row\"><th role=\"columnheader\" scope=\"col\">figure"
        "</th><th role=\"columnheader\" scope=\"col\">value</th><th role=\"columnheader\" "
        "scope=\"col\">limit</th><th role=\"columnheader\" scope=\"col\">error used</th><th "
        "role=\"columnheader\" scope=\"col\">met</th></tr></thead>\n"
        "{}</table></div>\n<p class=\"quiet small\">Used: the part of the error that the "
        "limit allows. From {:.6g} % on, the mark on the bar, a pass is a "
        "warning.</p>\n</section>\n",
        parts, 100 * (1 - comparison.warn_band));
}

std::string color_cell(const Color& linear) {
    const Color shown = metrics::encoded(linear);
    const auto byte = [&](int i) {
        return std::isnan(shown[i]) ? 0 : int(std::lround(shown[i] * 255));
    };
    return fmt::format(
        "<td><svg class=\"swatch\" viewBox=\"0 0 1 1\" aria-hidden=\"true\"><rect width=\"1\" "
        "height=\"1\" fill=\"#{:02x}{:02x}{:02x}\"/></svg>{} {} {}</td>",
        byte(0), byte(1), byte(2), byte(0), byte(1), byte(2));
}

std::string worst_pixel(const Case& one) {
    const PixelPair& worst = one.comparison.worst;
    if (!(one.comparison.value("max_error") > 0)) return "";
    const auto row = [](const std::string& name, const Color& color) {
        return fmt::format("<tr><th scope=\"row\">{}</th>{}<td class=\"wraps\">{:.5g} {:.5g} "
                           "{:.5g}</td></tr>\n",
                           text(name), color_cell(color), color.x, color.y, color.z);
    };
    return fmt::format(
        "<section class=\"card\">\n<h2>Worst pixel ({}, {})</h2>\n<table><thead><tr><td></td>"
        "<th scope=\"col\">sRGB, 8 bit</th><th scope=\"col\">linear</th></tr></thead>\n<tbody>\n"
        "{}{}</tbody></table>\n</section>\n",
        worst.x, worst.y, row(one.test_name, worst.test), row(one.reference_name, worst.reference));
}

std::string losses(const Case& one) {
    std::string rows;
    for (const Loss& loss : merged(one.losses))
        rows += fmt::format("<li><code>{}</code> {}</li>\n", text(loss.place), text(loss.what));
    // Pictures that were only compared had nothing to be carried over.
    if (rows.empty() && !one.seconds.contains("export")) return "";
    if (rows.empty())
        return "<section class=\"card\">\n<h2>Losses</h2>\n<p class=\"quiet\">None: everything was "
               "carried over.</p>\n</section>\n";
    return "<section class=\"card\">\n<h2>Losses</h2>\n<ul>\n" + rows + "</ul>\n</section>\n";
}

std::string times(const Case& one) {
    std::string rows;
    double total = 0;
    // In the order of the work, then whatever else there may be.
    std::vector<std::string> order = {"import", "render", "export", "povray", "compare"};
    for (const auto& [step, seconds] : one.seconds)
        if (std::ranges::find(order, step) == order.end()) order.push_back(step);
    for (const std::string& step : order) {
        const auto found = one.seconds.find(step);
        if (found == one.seconds.end()) continue;
        total += found->second;
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{:.2f} s</td></tr>\n", text(step),
                            found->second);
    }
    if (rows.empty()) return "";
    return fmt::format("<section class=\"card\">\n<h2>Times</h2>\n<table><tbody>\n{}<tr "
                       "class=\"sum\"><th scope=\"row\">together</th><td>{:.2f} s</td></tr>\n"
                       "</tbody></table>\n{}</section>\n",
                       rows, total,
                       one.cached ? "<p class=\"quiet small\">Of an earlier run: nothing has "
                                    "changed since.</p>\n"
                                  : "");
}

std::string files(const Case& one) {
    std::string items;
    for (const auto& [role, file] : one.files)
        items += fmt::format("<li>{}: <a href=\"{}\">{}</a></li>\n", text(role),
                             markup::link(from_page(one, file)), text(from_page(one, file)));
    if (items.empty()) return "";
    return "<section class=\"card\">\n<h2>Files</h2>\n<ul>\n" + items + "</ul>\n</section>\n";
}

std::string commands(const Case& one) {
    std::string lines;
    for (const std::string& command : one.commands) lines += text(command) + "\n";
    if (lines.empty()) return "";
    return "<section class=\"card\">\n<h2>Commands that repeat it</h2>\n<pre tabindex=\"0\" "
           "role=\"region\" aria-label=\"Commands\">" +
           lines + "</pre>\n</section>\n";
}

std::string log(const Case& one) {
    if (one.povray_log.empty()) return "";
    // What went wrong is in it, so it is open then.
    const bool open = one.comparison.verdict == Verdict::error;
    return fmt::format("<details class=\"card\"{}><summary>{}</summary><pre tabindex=\"0\" "
                       "role=\"region\" aria-label=\"Log\">{}</pre></details>\n",
                       open ? " open" : "",
                       text(one.reference_name.empty() ? "Log" : one.reference_name + "’s log"),
                       text(one.povray_log));
}

}  // namespace penumbra::html
