#include "validation/report/markup.h"

#include "base/base64.h"
#include "base/text/number.h"
#include "base/text/utf8.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string_view>

namespace penumbra::markup {
namespace {

constexpr std::string_view replacement = "\xef\xbf\xbd";  // U+FFFD

// Char of XML 1.0, section 2.2, without the control characters that it merely discourages.
bool allowed(std::uint32_t code) {
    if (code == '\t' || code == '\n' || code == '\r') return true;
    return code >= 0x20 && !(code >= 0x7f && code < 0xa0) && code != 0xfffe && code != 0xffff;
}

}  // namespace

std::string clean(const std::string& text) {
    std::string result;
    for (std::string_view rest = text; !rest.empty();) {
        std::uint32_t code = 0;
        const std::size_t length = utf8_character(rest, code);
        result += length > 0 && allowed(code) ? rest.substr(0, length) : replacement;
        rest.remove_prefix(length > 0 ? length : 1);
    }
    return result;
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : clean(text)) {
        switch (c) {
        case '&': result += "&amp;"; break;
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '"': result += "&quot;"; break;
        case '\'': result += "&#39;"; break;
        default: result += c;
        }
    }
    return result;
}

std::string link(const std::string& path) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
    std::string result = path.starts_with('/') ? "" : "./";
    for (const char c : path) {
        if (plain.find(c) != std::string_view::npos)
            result += c;
        else
            result += fmt::format("%{:02X}", std::uint8_t(c));
    }
    // "//host" would be another machine.
    while (result.starts_with("//")) result.erase(0, 1);
    return result;
}

std::string png_uri(std::span<const std::byte> png) {
    return "data:image/png;base64," + to_base64(png);
}

std::string number(double value, int digits) {
    if (std::isnan(value)) return "\u2013";
    return fmt::format("{:.{}g}", value, digits);
}

std::string number(const Metric& metric) {
    if (std::isnan(metric.value)) return number(metric.value);
    return number_text(metric.value, metric.limit);
}

}  // namespace penumbra::markup
