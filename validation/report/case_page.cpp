// A case -> its page.
#include "validation/report/html.h"
#include "validation/report/markup.h"
#include "validation/report/report.h"

#include <fmt/format.h>

#include <array>
#include <string>

namespace penumbra {
namespace {

using html::text;

// "parity 0.9998, ssim 0.9991, ...": what a verdict is judged by first.
std::string headline(const Comparison& comparison) {
    constexpr std::array names = {"parity", "ssim", "flip", "flip_tile", "psnr_db"};
    std::string items;
    for (const std::string name : names)
        for (const Metric& metric : comparison.metrics)
            if (metric.name == name)
                items += fmt::format("<div{}><dt>{}</dt><dd>{}</dd></div>",
                                     metric.ok() ? "" : " class=\"bad\"", name,
                                     html::value(metric.value, 5));
    return items.empty() ? "" : "<dl class=\"headline\">" + items + "</dl>\n";
}

std::string sizes(const Case& one) {
    const auto size = [](const Image& image) {
        return fmt::format("{} × {}", image.width, image.height);
    };
    if (!html::has_pixels(one.test) || !html::has_pixels(one.reference)) return "";
    if (html::comparable_pictures(one)) return ", " + size(one.test) + " pixels";
    return ", " + size(one.test) + " and " + size(one.reference) + " pixels";
}

std::string sampling(const Case& one) {
    return one.sampling ? ", " + to_string(*one.sampling) : "";
}

std::string header(const Case& one, const std::string& index_link) {
    const std::string back =
        index_link.empty() ? ""
                           : fmt::format("<nav aria-label=\"Report\"><a href=\"{}\">← All cases"
                                         "</a></nav>\n",
                                         markup::link(index_link));
    return fmt::format("<header>\n{}<h1><bdi>{}</bdi> {}</h1>\n<p class=\"quiet\"><bdi>{}</bdi> "
                       "against <bdi>{}</bdi>{}{}</p>\n</header>\n",
                       back, text(one.name), html::chip(one.comparison.verdict),
                       text(one.test_name), text(one.reference_name), sizes(one), sampling(one));
}

std::string diagnosis(const Case& one) {
    std::string items;
    if (!one.message.empty()) items += "<li class=\"message\">" + text(one.message) + "</li>\n";
    for (const std::string& sentence : one.comparison.diagnosis)
        items += "<li>" + text(sentence) + "</li>\n";
    const std::string alpha = alpha_sentence(one.comparison);
    const std::string cause =
        one.comparison.cause.empty()
            ? ""
            : "<p>Cause: <strong>" + text(one.comparison.cause) + "</strong></p>\n";
    if (items.empty() && cause.empty() && one.comparison.verdict == Verdict::pass)
        items = "<li>Every limit is met.</li>\n";
    if (!alpha.empty()) items += "<li>" + text(alpha) + "</li>\n";
    return cause + (items.empty() ? "" : "<ul class=\"diagnosis\">\n" + items + "</ul>\n");
}

}  // namespace

std::string case_page(const Case& one, const std::string& index_link) {
    const std::string verdict = to_string(one.comparison.verdict);
    html::Document parts;
    parts.title = one.name + ": " + verdict;
    parts.script = html::case_script;
    parts.body = html::heat_filter() + header(one, index_link) +
                 fmt::format("<main>\n<section class=\"card verdict {}\" aria-label=\"Verdict\">\n",
                             verdict) +
                 diagnosis(one) + headline(one.comparison) + "</section>\n" + html::viewer(one) +
                 "<div class=\"columns\">\n<div>\n" + html::figures(one.comparison) +
                 "</div>\n<div>\n" + html::plots(one) + html::worst_pixel(one) + html::losses(one) +
                 html::times(one) + html::files(one) + "</div>\n</div>\n" + html::worst_tiles(one) +
                 html::commands(one) + html::log(one) + "</main>\n";
    return html::document(parts);
}

}  // namespace penumbra
