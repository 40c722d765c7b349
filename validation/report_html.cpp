// Cases -> one HTML page that needs nothing else: styles and pictures are inside, no scripts.
#include "markup.h"
#include "metrics.h"
#include "report.h"
#include "report_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace penumbra {
namespace {

using markup::escaped;
using markup::number;

std::string chip(Verdict verdict) {
    std::string text = to_string(verdict);
    std::string shown = text;
    std::ranges::replace(shown, '_', ' ');
    return fmt::format("<span class=\"chip {}\">{}</span>", text, shown);
}

// ---- pictures ---------------------------------------------------------------------------------

// Where the worst pixel is, in per cent of the picture.
std::string ring(const Case& one) {
    const PixelPair& worst = one.comparison.worst;
    if (!(one.comparison.value("max_error") > 0)) return "";
    return fmt::format("<span class=\"ring\" style=\"left:{:.3f}%;top:{:.3f}%\"></span>",
                       100 * (worst.x + 0.5) / one.test.width,
                       100 * (worst.y + 0.5) / one.test.height);
}

std::string figure(const Image& image, const std::string& caption, const std::string& over,
                   const std::string& below = "") {
    // Small pictures are shown enlarged, pixel by pixel.
    const char* const style = image.width < 480 ? " class=\"small\"" : "";
    return fmt::format("<figure><div class=\"frame\"><img{} src=\"{}\" width=\"{}\" height=\"{}\" "
                       "alt=\"{}\">{}</div><figcaption>{}</figcaption>{}</figure>\n",
                       style, markup::png_uri(encode_png(image)), image.width, image.height,
                       escaped(caption), over, escaped(caption), below);
}

std::string color_bar() {
    std::string stops;
    for (const unsigned color : metrics::magma)
        stops += fmt::format("{}#{:06x}", stops.empty() ? "" : ",", color);
    return fmt::format("<div class=\"bar\" style=\"background:linear-gradient(90deg,{})\"></div>"
                       "<div class=\"ticks\"><span>0 same</span><span>0.25</span><span>0.5</span>"
                       "<span>0.75</span><span>1 most different</span></div>",
                       stops);
}

bool has_pixels(const Image& image) { return image.width > 0 && !image.pixels.empty(); }

std::string pictures(const Case& one) {
    const bool both = has_pixels(one.test) && has_pixels(one.reference);
    const bool same_size =
        one.test.width == one.reference.width && one.test.height == one.reference.height;
    const std::string worst = both && same_size ? ring(one) : "";
    std::string result;
    if (has_pixels(one.test)) result += figure(one.test, one.test_name, worst);
    if (has_pixels(one.reference)) result += figure(one.reference, one.reference_name, worst);
    if (both && same_size)
        result += figure(difference(one.test, one.reference, 100), "difference × 100", worst);
    if (has_pixels(one.comparison.flip_map))
        result += figure(heat_map(one.comparison.flip_map), "FLIP, the perceived difference", worst,
                         color_bar());
    return result.empty() ? "" : "<div class=\"pictures\">\n" + result + "</div>\n";
}

// ---- tables -----------------------------------------------------------------------------------

const char* meaning(const std::string& metric) {
    static const std::map<std::string, const char*> meanings = {
        {"parity", "pixels that differ by at most 1/255 as displayed"},
        {"exactness", "pixels equal to 1e-4, linear"},
        {"max_error", "largest difference of a channel, linear"},
        {"rmse", "root mean square difference, sRGB in [0, 1]"},
        {"psnr_db", "peak signal to noise ratio; 999 when equal"},
        {"ssim", "structural similarity, mean"},
        {"ssim_tile", "structural similarity, worst tile of 32 × 32"},
        {"flip", "perceived difference, mean"},
        {"flip_p99", "perceived difference that 1 % of the pixels exceed"},
        {"flip_tile", "perceived difference, worst tile of 16 × 16"},
        {"bias", "mean difference of luma, with sign"},
        {"coverage", "pixels that are not background"}};
    const auto found = meanings.find(metric);
    return found == meanings.end() ? "" : found->second;
}

std::string metrics_table(const Comparison& comparison) {
    if (comparison.metrics.empty()) return "";
    std::string rows;
    for (const Metric& metric : comparison.metrics) {
        std::string limit, mark;
        if (metric.limit) {
            limit = (metric.at_least ? "≥ " : "≤ ") + number(*metric.limit);
            mark = metric.ok() ? "<span class=\"good\">✓<span class=\"word\"> yes</span></span>"
                               : "<span class=\"bad\">✗<span class=\"word\"> no</span></span>";
        }
        rows += fmt::format("<tr><th scope=\"row\">{}<small>{}</small></th><td>{}</td><td>{}</td>"
                            "<td>{}</td></tr>\n",
                            escaped(metric.name), meaning(metric.name), number(metric.value), limit,
                            mark);
    }
    return "<h3>Figures</h3>\n<table class=\"figures\"><thead><tr><th>figure</th><th>value</th>"
           "<th>limit</th><th><span class=\"word\">limit </span>met</th></tr></thead>\n<tbody>\n" +
           rows + "</tbody></table>\n";
}

std::string color_row(const std::string& name, const Color& color) {
    const Color shown = metrics::encoded(color);
    const auto byte = [&](int i) { return int(std::lround(shown[i] * 255)); };
    return fmt::format("<tr><th scope=\"row\"><span class=\"swatch\" style=\"background:"
                       "rgb({},{},{})\"></span>{}</th><td>{:.5g}</td><td>{:.5g}</td><td>{:.5g}</td>"
                       "</tr>\n",
                       byte(0), byte(1), byte(2), escaped(name), color.x, color.y, color.z);
}

std::string worst_pixel(const Case& one) {
    const PixelPair& worst = one.comparison.worst;
    if (!(one.comparison.value("max_error") > 0)) return "";
    return fmt::format(
        "<h3>Worst pixel ({}, {})</h3>\n<table><thead><tr><th>linear</th><th>red</th>"
        "<th>green</th><th>blue</th></tr></thead>\n<tbody>\n{}{}</tbody></table>\n",
        worst.x, worst.y, color_row(one.test_name, worst.test),
        color_row(one.reference_name, worst.reference));
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
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{:.2f} s</td></tr>\n", escaped(step),
                            found->second);
    }
    if (rows.empty()) return "";
    return fmt::format("<h3>Times</h3>\n<table><tbody>\n{}<tr class=\"sum\"><th scope=\"row\">"
                       "together</th><td>{:.2f} s</td></tr>\n</tbody></table>\n",
                       rows, total);
}

// ---- lists ------------------------------------------------------------------------------------

std::string diagnosis(const Case& one) {
    std::string items;
    if (!one.message.empty()) items += "<li>" + escaped(one.message) + "</li>\n";
    for (const std::string& sentence : one.comparison.diagnosis)
        items += "<li>" + escaped(sentence) + "</li>\n";
    return items.empty() ? "" : "<ul class=\"diagnosis\">\n" + items + "</ul>\n";
}

std::string losses(const Case& one) {
    if (one.losses.empty())
        return "<h3>Losses</h3>\n<p class=\"quiet\">None: everything was carried over.</p>\n";
    std::string rows;
    for (const CountedLoss& loss : counted(one.losses))
        rows += fmt::format("<li><code>{}</code> {}{}</li>\n", escaped(loss.loss.place),
                            escaped(loss.loss.what),
                            loss.count > 1 ? fmt::format(" ({} times)", loss.count) : "");
    return "<h3>Losses</h3>\n<ul>\n" + rows + "</ul>\n";
}

std::string files(const Case& one) {
    std::string items;
    for (const auto& [role, file] : one.files)
        items += fmt::format("<li>{}: <a href=\"{}\">{}</a></li>\n", escaped(role),
                             markup::link(file), escaped(file));
    return items.empty() ? "" : "<h3>Files</h3>\n<ul>\n" + items + "</ul>\n";
}

std::string commands(const Case& one) {
    std::string text;
    for (const std::string& command : one.commands) text += escaped(command) + "\n";
    return text.empty() ? "" : "<h3>Commands that repeat it</h3>\n<pre>" + text + "</pre>\n";
}

std::string log(const Case& one) {
    if (one.povray_log.empty()) return "";
    return "<details><summary>POV-Ray's log</summary><pre>" + escaped(one.povray_log) +
           "</pre></details>\n";
}

// ---- the page ---------------------------------------------------------------------------------

std::string section(const Case& one, std::size_t index) {
    return fmt::format("<section id=\"case-{}\">\n<h2>{} {}</h2>\n", index, escaped(one.name),
                       chip(one.comparison.verdict)) +
           diagnosis(one) + pictures(one) + "<div class=\"columns\">\n<div>\n" +
           metrics_table(one.comparison) + "</div>\n<div>\n" + worst_pixel(one) + losses(one) +
           times(one) + files(one) + "</div>\n</div>\n" + commands(one) + log(one) + "</section>\n";
}

std::string index_list(const std::vector<Case>& cases) {
    if (cases.size() < 2) return "";
    std::string rows;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Comparison& comparison = cases[i].comparison;
        rows += fmt::format("<tr><td>{}</td><th scope=\"row\"><a href=\"#case-{}\">{}</a></th>"
                            "<td>{}</td><td>{}</td><td>{}</td></tr>\n",
                            chip(comparison.verdict), i + 1, escaped(cases[i].name),
                            number(comparison.value("parity")), number(comparison.value("ssim"), 4),
                            number(comparison.value("flip"), 4));
    }
    return "<nav><table class=\"index\"><thead><tr><th>verdict</th><th>scene</th><th>parity</th>"
           "<th>ssim</th><th>flip</th></tr></thead>\n<tbody>\n" +
           rows + "</tbody></table></nav>\n";
}

std::string summary(const std::vector<Case>& cases) {
    if (cases.empty()) return "no scenes";
    const auto passed = std::ranges::count_if(cases, [](const Case& one) {
        const Verdict verdict = one.comparison.verdict;
        return verdict == Verdict::pass || verdict == Verdict::warn;
    });
    if (cases.size() == 1)
        return escaped(cases[0].test_name) + " against " + escaped(cases[0].reference_name);
    return fmt::format("{} of {} scenes pass", passed, cases.size());
}

}  // namespace

std::string report_html(const std::vector<Case>& cases) {
    std::string title = cases.size() == 1
                            ? escaped(cases[0].name) + ": " + to_string(cases[0].comparison.verdict)
                            : summary(cases);
    std::string page =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
        "style-src 'unsafe-inline'\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
        title + " – penumbra</title>\n<style>\n" + report_style + "</style>\n</head>\n<body>\n" +
        "<header><h1>penumbra report</h1><p>" + summary(cases) + "</p></header>\n<main>\n" +
        index_list(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) page += section(cases[i], i + 1);
    return page + "</main>\n<footer>penumbra " PENUMBRA_VERSION "</footer>\n</body>\n</html>\n";
}

}  // namespace penumbra
