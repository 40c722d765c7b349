// The pictures of a case. They stand in the page as images; its script takes them over into a
// viewer, whose controls are here too but hidden until then.
#include "validation/metrics/maps.h"
#include "validation/metrics/picture.h"
#include "validation/report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace penumbra::html {
namespace {

// Only picture sizes below this are shown enlarged by default.
constexpr int small_width = 480;

std::string magma_stops() {
    std::string stops;
    for (const unsigned color : metrics::magma)
        stops += fmt::format("{}#{:06x}", stops.empty() ? "" : ",", color);
    return stops;
}

std::string color_bar() {
    return fmt::format("<div class=\"scale\"><div class=\"bar\" style=\"background:linear-gradient("
                       "90deg,{})\"></div><div class=\"ticks\"><span>0 same</span><span>0.25</span>"
                       "<span>0.5</span><span>0.75</span><span>1 most different</span></div></div>",
                       magma_stops());
}

std::string figure(const std::string& image, const std::string& caption) {
    return "<figure><div class=\"frame\">" + image + "</div><figcaption>" + caption +
           "</figcaption></figure>\n";
}

std::string figure(const Image& image, const std::string& id, const std::string& name) {
    const char* const style = image.width < small_width ? "class=\"pixels\" " : "";
    return figure(picture(image, name, fmt::format("{}id=\"{}\"", style, id)), text(name));
}

std::string mode(const std::string& value, const std::string& name, bool checked = false) {
    return fmt::format("<label><input type=\"radio\" name=\"mode\" value=\"{}\"{}><span>{}</span>"
                       "</label>",
                       value, checked ? " checked" : "", name);
}

std::string toolbar(const Case& one) {
    std::string modes =
        mode("slider", "Slider", true) + mode("blink", "Blink") + mode("side", "Side by side");
    if (comparable_pictures(one)) modes += mode("difference", "Difference");
    if (has_pixels(one.comparison.flip_map)) modes += mode("flip", "FLIP");
    return "<div class=\"toolbar\"><fieldset class=\"modes\"><legend class=\"unseen\">How the "
           "pictures are compared</legend>" +
           modes +
           "</fieldset>\n<div class=\"zoom\" role=\"group\" aria-label=\"Zoom\">"
           "<button type=\"button\" data-zoom=\"out\" aria-label=\"Zoom out\">−</button>"
           "<output id=\"zoom\" aria-live=\"off\">100 %</output>"
           "<button type=\"button\" data-zoom=\"in\" aria-label=\"Zoom in\">+</button>"
           "<button type=\"button\" data-zoom=\"fit\">Fit</button>"
           "<button type=\"button\" data-zoom=\"one\" title=\"One to one\">1:1</button>"
           "</div></div>\n";
}

// What only one mode needs.
std::string mode_controls(const Case& one) {
    std::string gains;
    for (const int gain : {1, 2, 4, 8, 16, 32, 64, 128})
        gains += fmt::format("<option value=\"{0}\"{1}>× {0}</option>", gain,
                             gain == 16 ? " selected" : "");
    return fmt::format(
        "<div class=\"controls\">"
        "<div data-mode=\"slider\"><label for=\"split\">Divider</label><input type=\"range\" "
        "id=\"split\" min=\"0\" max=\"100\" step=\"0.5\" value=\"50\"></div>\n"
        "<div data-mode=\"blink\" hidden><button type=\"button\" id=\"blink\" "
        "aria-pressed=\"false\">Blink</button><button type=\"button\" id=\"swap\">Show the other"
        "</button><output id=\"shown\" aria-live=\"off\"></output></div>\n"
        "<div data-mode=\"difference\" hidden><label for=\"gain\">Gain</label><select id=\"gain\">"
        "{}</select><span class=\"quiet small\">of the difference of each channel in sRGB, 8 bit"
        "</span></div>\n<div data-mode=\"flip\" hidden>{}</div>\n"
        "<div class=\"aims\">{}<label class=\"check\"{}><input type=\"checkbox\" id=\"mark\"> Mark "
        "the worst tiles</label></div></div>\n",
        gains, color_bar(),
        one.comparison.value("max_error") > 0
            ? "<button type=\"button\" id=\"worst\">Go to the worst pixel</button>"
            : "",
        one.comparison.worst_tiles.empty() ? " hidden" : "");
}

std::string inspector(const Case& one) {
    const auto row = [](const std::string& id, const std::string& name) {
        return fmt::format(
            "<tr id=\"{}\"><th scope=\"row\"><div><span class=\"swatch\"></span>{}</div></th>"
            "<td></td><td></td><td></td><td class=\"hex\"></td></tr>\n",
            id, text(name));
    };
    return "<div class=\"inspector\"><table><caption id=\"where\">Pixel</caption><thead><tr>"
           "<th scope=\"col\">sRGB, 8 bit</th><th scope=\"col\">red</th><th scope=\"col\">green"
           "</th><th scope=\"col\">blue</th><th scope=\"col\" class=\"hex\">hex</th></tr></thead>"
           "\n<tbody>\n" +
           row("of-test", one.test_name) + row("of-reference", one.reference_name) +
           row("of-difference", "difference") +
           (has_pixels(one.comparison.flip_map) ? "<tr id=\"of-flip\"><th scope=\"row\"><div><span "
                                                  "class=\"swatch\"></span>FLIP</div></th>"
                                                  "<td colspan=\"4\"></td></tr>\n"
                                                : "") +
           "</tbody></table>\n<p class=\"quiet small\" id=\"keys\">Point at a pixel, or move with "
           "the arrow keys (Shift: by ten). Wheel, pinch, <kbd>+</kbd> and <kbd>−</kbd> zoom, "
           "<kbd>0</kbd> fits, <kbd>1</kbd> is one to one, <kbd>Space</kbd> changes pictures when "
           "blinking. Zoomed in far, pixels show their values.</p>"
           "<p class=\"unseen\" id=\"said\" aria-live=\"polite\"></p></div>\n";
}

std::string tile_list(const std::vector<Tile>& tiles) {
    std::string list;
    for (const Tile& tile : tiles)
        list += fmt::format("{}{},{},{}", list.empty() ? "" : ";", tile.x, tile.y, tile.side);
    return list;
}

// ---- worst tiles ------------------------------------------------------------------------------

// The part of `from` that a tile covers.
Image crop(const Image& from, const Tile& tile) {
    const int width = std::clamp(from.width - tile.x, 0, tile.side);
    const int height = std::clamp(from.height - tile.y, 0, tile.side);
    Image part(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) part.at(x, y) = from.at(tile.x + x, tile.y + y);
    return part;
}

// The pixels of a tile with the largest differences as displayed, the worst first.
std::vector<PixelPair> worst_of(const Case& one, const Tile& tile) {
    struct Ranked {
        double error;
        PixelPair pixel;
    };
    std::vector<Ranked> all;
    for (int y = tile.y; y < std::min(tile.y + tile.side, one.test.height); ++y)
        for (int x = tile.x; x < std::min(tile.x + tile.side, one.test.width); ++x) {
            const PixelPair pixel = {x, y, one.test.at(x, y), one.reference.at(x, y)};
            const Color d = metrics::encoded(pixel.test) - metrics::encoded(pixel.reference);
            all.push_back({std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}), pixel});
        }
    std::ranges::stable_sort(all, std::greater(), &Ranked::error);
    std::vector<PixelPair> worst;
    for (const Ranked& ranked : all)
        if (worst.size() < 4) worst.push_back(ranked.pixel);
    return worst;
}

std::string tile_picture(const std::string& image, const std::string& name) {
    return "<figure>" + image + "<figcaption>" + text(name) + "</figcaption></figure>";
}

std::string tile_picture(const Image& image, const Tile& tile, const std::string& name) {
    return tile_picture(picture(crop(image, tile), name, "class=\"pixels\""), name);
}

std::string tile_card(const Case& one, const Tile& tile, std::size_t number) {
    const std::vector<PixelPair> worst = worst_of(one, tile);
    if (worst.empty()) return "";
    std::string rows;
    for (const PixelPair& pixel : worst)
        rows += fmt::format("<tr><th scope=\"row\">{}, {}</th>{}{}</tr>\n", pixel.x, pixel.y,
                            color_cell(pixel.test), color_cell(pixel.reference));
    return fmt::format(
        "<div class=\"tile\"><h3>{}. x {} to {}, y {} to {}: FLIP {:.3g}</h3>\n"
        "<div class=\"crops\">{}{}{}</div>\n<table><thead><tr><th scope=\"col\">pixel</th>"
        "<th scope=\"col\">{}</th><th "
        "scope=\"col\">{}</th></tr></thead>\n<tbody>\n{}</tbody></table>\n<button type=\"button\" "
        "class=\"go\" "
        "data-tile=\"{},{},{}\" data-pixel=\"{},{}\" hidden>See all its values in the viewer"
        "</button></div>\n",
        number, tile.x, tile.x + tile.side - 1, tile.y, tile.y + tile.side - 1, tile.flip,
        tile_picture(one.test, tile, one.test_name),
        tile_picture(one.reference, tile, one.reference_name),
        tile_picture(heat_picture(crop(one.comparison.flip_map, tile)), "FLIP"),
        text(one.test_name), text(one.reference_name), rows, tile.x, tile.y, tile.side, worst[0].x,
        worst[0].y);
}

}  // namespace

std::string viewer(const Case& one) {
    std::string pictures;
    const bool test = has_pixels(one.test), reference = has_pixels(one.reference);
    if (test) pictures += figure(one.test, "test", one.test_name);
    if (reference) pictures += figure(one.reference, "reference", one.reference_name);
    if (has_pixels(one.comparison.flip_map))
        pictures += figure(heat_picture(one.comparison.flip_map, "id=\"flip\""),
                           "FLIP, the perceived difference" + color_bar());
    if (pictures.empty()) return "";
    pictures = "<section class=\"card pictures\" id=\"pictures\" aria-label=\"Pictures\">\n" +
               pictures + "</section>\n";
    if (!test || !reference) return pictures;
    const PixelPair& worst = one.comparison.worst;
    return fmt::format("<section class=\"card viewer\" id=\"viewer\" aria-label=\"Viewer\" "
                       "data-worst=\"{},{}\" data-tiles=\"{}\" data-magma=\"{}\" hidden>\n",
                       worst.x, worst.y, tile_list(one.comparison.worst_tiles), magma_stops()) +
           toolbar(one) + mode_controls(one) +
           "<div class=\"bench\"><div class=\"stage\" id=\"stage\"><canvas id=\"canvas\" "
           "tabindex=\"0\" role=\"application\" aria-label=\"Pictures with a pixel inspector\" "
           "aria-describedby=\"keys\"></canvas><span class=\"tag\" id=\"tag-a\"></span>"
           "<span class=\"tag\" id=\"tag-b\"></span></div>\n" +
           inspector(one) + "</div></section>\n" + pictures;
}

std::string worst_tiles(const Case& one) {
    if (!comparable_pictures(one) || !has_pixels(one.comparison.flip_map)) return "";
    std::string cards;
    std::size_t number = 0;
    for (const Tile& tile : one.comparison.worst_tiles)
        if (tile.flip > 0) cards += tile_card(one, tile, ++number);
    if (cards.empty()) return "";
    return "<section class=\"card\">\n<h2>Worst tiles</h2>\n<p class=\"quiet small\">Enlarged, "
           "with "
           "the pixels that differ most: red, green and blue in sRGB, 8 bit.</p>\n"
           "<div class=\"tiles\">\n" +
           cards + "</div>\n</section>\n";
}

}  // namespace penumbra::html
