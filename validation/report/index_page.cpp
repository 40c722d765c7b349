// Cases -> the list of all of them, the worst first. Its script sorts and filters it.
#include "validation/report/html.h"
#include "validation/report/markup.h"
#include "validation/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace penumbra {
namespace {

using html::text;
using markup::number;

constexpr std::array verdicts = {Verdict::error, Verdict::not_comparable, Verdict::fail,
                                 Verdict::warn, Verdict::pass};

struct Column {
    const char* name;
    const char* metric;  // "" when it is no metric
    bool descending;     // the worst have the largest values
};

constexpr std::array columns = {Column{"scene", "", false},
                                Column{"verdict", "", false},
                                Column{"cause", "", false},
                                Column{"parity", "parity", false},
                                Column{"ssim", "ssim", false},
                                Column{"flip", "flip", true},
                                Column{"flip_tile", "flip_tile", true},
                                Column{"psnr_db", "psnr_db", false},
                                Column{"seconds", "", true},
                                Column{"severity", "", true}};

std::ptrdiff_t count(const std::vector<Case>& cases, Verdict verdict) {
    return std::ranges::count_if(
        cases, [&](const Case& one) { return one.comparison.verdict == verdict; });
}

// ---- rows ---------------------------------------------------------------------------------------

// `key` is what the column is sorted by; an empty one comes last.
std::string cell(const char* column, const std::string& key, const std::string& shown,
                 const char* style = "") {
    return fmt::format("<td role=\"cell\" data-name=\"{}\" data-key=\"{}\"{}>{}</td>", column, key,
                       style, shown);
}

std::string key(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : ""; }

std::string metric_cell(const Column& column, const Comparison& comparison) {
    const auto found = std::ranges::find(comparison.metrics, column.metric, &Metric::name);
    if (found == comparison.metrics.end() || std::isnan(found->value))
        return cell(column.name, "", "–");
    return cell(column.name, key(found->value),
                html::value(found->value, 4) + (found->ok() ? "" : " ✗"),
                found->ok() ? "" : " class=\"bad\"");
}

// The sentence of the cause comes last; without one, the first says where the pictures differ.
std::string sentence(const Case& one) {
    const std::vector<std::string>& diagnosis = one.comparison.diagnosis;
    if (!one.message.empty()) return one.message;
    if (one.comparison.verdict == Verdict::pass || diagnosis.empty()) return "";
    const bool last = !one.comparison.cause.empty() || one.comparison.verdict == Verdict::warn;
    return last ? diagnosis.back() : diagnosis.front();
}

std::string cause_cell(const Case& one) {
    const std::string cause = text(one.comparison.cause), words = text(sentence(one));
    return cell("cause", cause.empty() ? words : cause,
                (cause.empty() ? "" : "<strong>" + cause + "</strong> ") + words,
                " class=\"cause\"");
}

std::string path_in(const Case& one, const char* file) {
    return markup::link(one.folder.empty() ? file : one.folder + "/" + file);
}

std::string row(const Case& one) {
    const Comparison& comparison = one.comparison;
    const Verdict verdict = comparison.verdict;
    double seconds = 0;
    for (const auto& [step, time] : one.seconds) seconds += time;
    const double rank = severity(one);
    const auto place = std::ranges::find(verdicts, verdict) - verdicts.begin();
    // A case that ended in an error has no pictures.
    const std::string strip =
        verdict == Verdict::error
            ? ""
            : fmt::format("<a href=\"{}\" tabindex=\"-1\" aria-hidden=\"true\"><img src=\"{}\" "
                          "alt=\"\" loading=\"lazy\" decoding=\"async\"></a>",
                          path_in(one, "index.html"), path_in(one, "thumbnails.png"));
    std::string cells = fmt::format("<td role=\"cell\" class=\"strip\">{}</td>", strip);
    cells +=
        fmt::format("<th role=\"rowheader\" scope=\"row\" data-name=\"scene\" data-key=\"{0}\">"
                    "<a href=\"{1}\"><bdi>{0}</bdi></a>{2}</th>",
                    text(one.name), path_in(one, "index.html"),
                    one.cached ? "<small>unchanged since an earlier run</small>" : "");
    cells += cell("verdict", std::to_string(place), html::chip(verdict));
    cells += cause_cell(one);
    for (const Column& column : columns)
        if (*column.metric != 0) cells += metric_cell(column, comparison);
    cells += cell("seconds", key(seconds), fmt::format("{:.1f}", seconds));
    const bool measured = verdict != Verdict::error && verdict != Verdict::not_comparable;
    cells += cell("severity", key(rank), measured ? number(rank, 3) : "–");
    return fmt::format("<tr role=\"row\" data-verdict=\"{}\">{}</tr>\n", to_string(verdict), cells);
}

// ---- around the rows
// ------------------------------------------------------------------------------

std::string headings() {
    std::string cells = "<td role=\"cell\"></td>";
    for (const Column& column : columns) {
        const bool sorted = std::string_view(column.name) == "severity";
        cells += fmt::format("<th role=\"columnheader\" scope=\"col\" data-first=\"{}\"{}>{}</th>",
                             column.descending ? "descending" : "ascending",
                             sorted ? " aria-sort=\"descending\"" : "", column.name);
    }
    return "<thead role=\"rowgroup\"><tr role=\"row\">" + cells + "</tr></thead>\n";
}

// How many of each verdict, as one bar.
std::string share_bar(const std::vector<Case>& cases) {
    std::string parts;
    double x = 0;
    for (std::size_t i = verdicts.size(); i-- > 0;) {
        const double width = 100 * double(count(cases, verdicts[i])) / double(cases.size());
        if (width > 0)
            parts += fmt::format("<rect class=\"{}\" x=\"{:.3f}\" width=\"{:.3f}\" height=\"4\"/>",
                                 to_string(verdicts[i]), x, width);
        x += width;
    }
    return "<svg class=\"shares\" viewBox=\"0 0 100 4\" preserveAspectRatio=\"none\" "
           "aria-hidden=\"true\">" +
           parts + "</svg>\n";
}

std::string filters(const std::vector<Case>& cases) {
    std::string boxes;
    for (const Verdict verdict : verdicts)
        if (const auto number = count(cases, verdict); number > 0)
            boxes += fmt::format("<label class=\"check\"><input type=\"checkbox\" "
                                 "name=\"verdict\" value=\"{}\" checked>{} {}</label>",
                                 to_string(verdict), html::chip(verdict), number);
    return "<div class=\"filters\" id=\"filters\" role=\"search\" hidden>"
           "<label class=\"find\">Find <input type=\"search\" id=\"find\" autocomplete=\"off\" "
           "placeholder=\"name or cause\"></label><fieldset><legend class=\"unseen\">Verdicts that "
           "are shown</legend>" +
           boxes + "</fieldset><output id=\"count\"></output></div>\n";
}

std::string summary(const std::vector<Case>& cases) {
    const auto good = count(cases, Verdict::pass) + count(cases, Verdict::warn);
    std::string parts;
    for (const Verdict verdict : verdicts) {
        std::string name = to_string(verdict);
        std::ranges::replace(name, '_', ' ');
        if (const auto number = count(cases, verdict); number > 0)
            parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", number, name);
    }
    const bool all = count(cases, Verdict::pass) == std::ptrdiff_t(cases.size());
    return fmt::format("{} of {} cases pass{}{}", good, cases.size(), all ? "" : ": ",
                       all ? "" : parts);
}

}  // namespace

std::string index_page(const std::vector<Case>& cases) {
    std::vector<const Case*> order;
    for (const Case& one : cases) order.push_back(&one);
    std::ranges::stable_sort(order, std::greater(), [](const Case* one) { return severity(*one); });
    std::string rows;
    for (const Case* one : order) rows += row(*one);

    html::Document parts;
    parts.title = summary(cases);
    parts.script = html::index_script;
    parts.body = "<header>\n<h1>penumbra report</h1>\n<p class=\"quiet\">" + summary(cases) +
                 "</p>\n</header>\n<main>\n";
    if (cases.empty())
        parts.body += "<p>There are no cases.</p>\n";
    else
        parts.body += share_bar(cases) + "<section class=\"card list\" aria-label=\"Cases\">\n" +
                      filters(cases) + "<table class=\"index\" role=\"table\" id=\"cases\">" +
                      headings() + "<tbody role=\"rowgroup\">\n" + rows +
                      "</tbody></table>\n<p id=\"none\" hidden>No case matches.</p>\n</section>\n";
    parts.body += "</main>\n";
    return html::document(parts);
}

}  // namespace penumbra
