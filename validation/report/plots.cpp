// How the differences of a pair of pictures are spread: a histogram, the share of the pixels that
// is within a difference, and the same as a table.
#include "validation/metrics/picture.h"
#include "validation/report/html.h"
#include "validation/report/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::html {
namespace {

// A pixel's difference is that of its worst channel as displayed, in steps of 1/255. Each class
// reaches up to its edge; renderers differ by rounding far below one step, so the classes do too.
constexpr std::array edges = {0.001, 0.01, 0.1, 1., 2., 4., 8., 16., 32., 64., 128., 255.};
constexpr std::size_t parity_class = 3;
constexpr double rounding = 255e-6;  // that of the parity rule

struct Spread {
    std::array<std::size_t, edges.size()> counts = {};
    std::size_t total = 0;

    // Share of the pixels that differ by no more than the edge of class `i`.
    double share(std::size_t i) const {
        std::size_t within = 0;
        for (std::size_t k = 0; k <= i; ++k) within += counts[k];
        return double(within) / double(total);
    }
};

Spread spread_of(const Image& test, const Image& reference) {
    Spread result;
    result.total = test.pixels.size();
    for (std::size_t i = 0; i < result.total; ++i) {
        std::size_t kind = 0;
        if (test.pixels[i] != reference.pixels[i]) {
            const Color a = metrics::encoded(test.pixels[i]);
            const Color b = metrics::encoded(reference.pixels[i]);
            // Written so that NaN ends in the last class.
            const auto within = [&](double edge) {
                return 255 * std::abs(a.x - b.x) <= edge && 255 * std::abs(a.y - b.y) <= edge &&
                       255 * std::abs(a.z - b.z) <= edge;
            };
            while (kind + 1 < edges.size() && !within(edges[kind] + rounding)) ++kind;
        }
        ++result.counts[kind];
    }
    return result;
}

// ---- drawing ----------------------------------------------------------------------------------

constexpr double left = 54, right = 356, top = 22, bottom = 176, step = (right - left) / 12;

std::string label(double x, double y, const char* anchor, const std::string& words) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor,
                       words);
}

std::string grid_line(double y, const std::string& words) {
    return fmt::format("<path class=\"grid\" d=\"M{} {:.1f}H{}\"/>", left, y, right) +
           label(left - 5, y + 3.5, "end", words);
}

// 3, 45, 1.2k, 478k, 1.5M: four characters find room above a bar.
std::string brief(std::size_t count) {
    if (count < 1000) return std::to_string(count);
    const bool millions = count >= 999'500;
    const double scaled = double(count) / (millions ? 1e6 : 1e3);
    return fmt::format("{:.{}f}{}", scaled, scaled < 9.95 && scaled > 1 ? 1 : 0,
                       millions ? "M" : "k");
}

std::string edge_name(double edge) { return markup::number(edge); }

std::string frame(const std::string& id, const std::string& title, const std::string& content) {
    std::string axis;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        std::string name = edge_name(edges[i]);
        if (name.starts_with("0.")) name.erase(0, 1);
        axis += label(left + step * (double(i) + 0.5), bottom + 14, "middle", name);
    }
    axis += label((left + right) / 2, bottom + 31, "middle",
                  "difference up to, in steps of 1/255 as displayed");
    return fmt::format("<figure><svg class=\"plot\" viewBox=\"0 0 360 212\" role=\"img\" "
                       "aria-labelledby=\"{0}\"><title id=\"{0}\">{1}</title>{2}{3}</svg>"
                       "<figcaption>{1}</figcaption></figure>\n",
                       id, title, content, axis);
}

std::string histogram(const Spread& spread) {
    // Logarithmic: one pixel of a million is what a reader looks for.
    const double decades = std::log10(double(spread.total)) + 0.3;
    const auto height = [&](double count) {
        return (std::log10(count) + 0.3) / decades * (bottom - top);
    };
    std::string content;
    const double sparse = spread.total > 100'000 ? 100 : 10;
    for (double count = 1; count <= double(spread.total); count *= sparse)
        content += grid_line(bottom - height(count), brief(std::size_t(count)));
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (spread.counts[i] == 0) continue;
        const double x = left + step * double(i), h = height(double(spread.counts[i]));
        content +=
            fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                        "height=\"{:.1f}\"/>",
                        i <= parity_class ? "within" : "beyond", x + 2, bottom - h, step - 4, h);
        content += label(x + step / 2, bottom - h - 4, "middle", brief(spread.counts[i]));
    }
    content += fmt::format("<path class=\"axis\" d=\"M{} {}H{}\"/>", left, bottom, right);
    return frame("histogram", "Pixels by their difference", content);
}

std::string cumulative(const Spread& spread, const Comparison& comparison) {
    // By the number of nines: 90 %, 99 %, 99.9 %, so that the last pixels can be told apart.
    const double all = std::log10(double(spread.total)) + 0.3;
    const auto level = [&](double share) {
        const double nines = share < 1 ? std::min(-std::log10(1 - share), all) : all;
        return bottom - nines / all * (bottom - top);
    };
    std::string content = grid_line(bottom, "0") + grid_line(top, "100 %");
    double share = 0.9;
    for (int nines = 1; nines < all - 0.5; ++nines, share = 1 - (1 - share) / 10)
        content +=
            grid_line(level(share), fmt::format("{:.{}f} %", 100 * share, std::max(0, nines - 2)));
    for (const Metric& metric : comparison.metrics)
        if (metric.name == "parity" && metric.limit && *metric.limit < 1)
            content +=
                fmt::format("<path class=\"limit\" d=\"M{0} {1:.1f}H{2:.1f}V{3}\"/>{4}", left,
                            level(*metric.limit), left + step * (parity_class + 0.5), bottom,
                            label(left + 4, level(*metric.limit) - 4, "start",
                                  "limit " + markup::number(100 * *metric.limit) + " %"));
    std::string line, dots;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const double x = left + step * (double(i) + 0.5), y = level(spread.share(i));
        line += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", x, y);
        dots += fmt::format("<circle class=\"dot\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\"/>", x, y);
    }
    content += fmt::format("<path class=\"curve\" d=\"{}\"/>{}", line, dots);
    return frame("cumulative", "Share of the pixels within a difference", content);
}

std::string table(const Spread& spread) {
    std::string rows;
    for (std::size_t i = 0; i < edges.size(); ++i)
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{} %</td></tr>\n",
                            edge_name(edges[i]), spread.counts[i],
                            markup::number(100 * spread.share(i), 7));
    return "<details><summary>The same as a table</summary><table><thead><tr><th scope=\"col\">"
           "difference up to (1/255)</th><th scope=\"col\">pixels</th><th scope=\"col\">within"
           "</th></tr></thead>\n<tbody>\n" +
           rows + "</tbody></table></details>\n";
}

}  // namespace

std::string plots(const Case& one) {
    if (!comparable_pictures(one)) return "";
    const Spread spread = spread_of(one.test, one.reference);
    return "<section class=\"card\">\n<h2>Differences</h2>\n<div class=\"plots\">\n" +
           histogram(spread) + cumulative(spread, one.comparison) + "</div>\n" + table(spread) +
           "</section>\n";
}

}  // namespace penumbra::html
