// What all HTML pages of the report share: one file that needs no other, and runs one known script.
#include "validation/report/html.h"

#include "image/png_encoder.h"
#include "validation/metrics/maps.h"
#include "validation/report/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

namespace penumbra::html {
namespace {

constexpr std::string_view replacement = "\xef\xbf\xbd";  // U+FFFD

// Bidi_Control characters of Unicode that change the order of what is near them (UAX #9, table 4).
constexpr std::array<std::string_view, 12> direction_marks = {
    "\xd8\x9c",                      // U+061C
    "\xe2\x80\x8e", "\xe2\x80\x8f",  // U+200E, U+200F
    "\xe2\x80\xaa", "\xe2\x80\xab", "\xe2\x80\xac", "\xe2\x80\xad", "\xe2\x80\xae",  // U+202A...
    "\xe2\x81\xa6", "\xe2\x81\xa7", "\xe2\x81\xa8", "\xe2\x81\xa9"};                 // U+2066...

std::string image_element(std::span<const std::byte> png, const Image& image,
                          const std::string& attributes, const std::string& description) {
    return fmt::format("<img {} src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\">", attributes,
                       markup::png_uri(png), image.width, image.height, text(description));
}

}  // namespace

std::string text(const std::string& text) {
    std::string result = markup::escaped(text);
    for (const std::string_view mark : direction_marks)
        for (std::size_t at = 0; (at = result.find(mark, at)) != std::string::npos;)
            result.replace(at, mark.size(), replacement);
    return result;
}

std::string value(double value, int digits) {
    const double rest = 1 - value;
    if (!(rest > 0 && rest < 0.01)) return markup::number(value, digits);
    const int decimals = std::clamp(int(std::ceil(-std::log10(rest))) + 1, digits, 9);
    // Rounded down: what is not quite 1 must not be shown as 1.
    const double unit = std::pow(10, decimals);
    return markup::number(std::floor(value * unit + 1e-6) / unit, decimals);
}

std::string chip(Verdict verdict) {
    const std::string name = to_string(verdict);
    std::string shown = name;
    std::ranges::replace(shown, '_', ' ');
    return fmt::format("<span class=\"chip {}\">{}</span>", name, shown);
}

std::string document(const Document& parts) {
    // Nothing is loaded and nothing runs but the script with this hash. Thumbnails of the index are
    // files beside it.
    const std::string policy =
        fmt::format("default-src 'none'; img-src 'self' file: data:; style-src 'unsafe-inline'; "
                    "script-src '{}'; base-uri 'none'; form-action 'none'",
                    parts.script.hash);
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
           policy +
           "\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           "<meta name=\"referrer\" content=\"no-referrer\">\n"
           // An icon of its own keeps a browser from asking a server for one.
           "<link rel=\"icon\" href=\"data:,\">\n<title>" +
           text(parts.title) + " – penumbra</title>\n<style>" + std::string(report_style) +
           "</style>\n</head>\n<body>\n" + parts.body +
           "<footer>penumbra " PENUMBRA_VERSION "</footer>\n<script>" +
           std::string(parts.script.text) + "</script>\n</body>\n</html>\n";
}

bool has_pixels(const Image& image) { return image.width > 0 && !image.pixels.empty(); }

bool comparable_pictures(const Case& one) {
    return has_pixels(one.test) && one.test.width == one.reference.width &&
           one.test.height == one.reference.height;
}

std::string picture(const Image& image, const std::string& description,
                    const std::string& attributes) {
    return image_element(encode_png(image), image, attributes, description);
}

std::string heat_picture(const Image& flip_map, const std::string& attributes) {
    Raster levels = {flip_map.width, flip_map.height, 1, Depth::u8, {}};
    levels.data.reserve(flip_map.pixels.size());
    for (const Color& error : flip_map.pixels)
        levels.data.push_back(
            std::byte(error.x < 1 ? int(std::max(error.x, 0.F) * 255 + 0.5F) : 255));
    return image_element(encode_png(levels, false).file, flip_map, "class=\"heat\" " + attributes,
                         "FLIP, the perceived difference");
}

std::string heat_filter() {
    std::string functions;
    for (const auto& [channel, shift] :
         {std::pair("R", 16U), std::pair("G", 8U), std::pair("B", 0U)}) {
        std::string stops;
        for (const unsigned color : metrics::magma)
            stops += fmt::format("{}{:.4f}", stops.empty() ? "" : " ",
                                 double(color >> shift & 0xffU) / 255);
        functions += fmt::format("<feFunc{0} type=\"table\" tableValues=\"{1}\"></feFunc{0}>",
                                 channel, stops);
    }
    return "<svg class=\"unseen\" aria-hidden=\"true\" width=\"0\" height=\"0\"><filter "
           "id=\"magma\" color-interpolation-filters=\"sRGB\"><feComponentTransfer>" +
           functions + "</feComponentTransfer></filter></svg>\n";
}

}  // namespace penumbra::html
