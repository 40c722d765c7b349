#include "base/text/number.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace penumbra {
namespace {

constexpr int usual = 6, all = 17;  // significant digits; all that a double has

double read_back(const std::string& text) {
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

bool same_side(double value, double shown, double of) {
    return (value < of) == (shown < of) && (value > of) == (shown > of);
}

}  // namespace

std::string number_text(double value, std::optional<double> limit) {
    std::string text;
    for (int digits = usual; digits <= all; ++digits) {
        text = fmt::format("{:.{}g}", value, digits);
        const double shown = read_back(text);
        const bool told = same_side(value, shown, 1) &&
                          (!limit || same_side(std::abs(value), std::abs(shown), *limit));
        if (!std::isfinite(value) || told) break;
    }
    return text;
}

std::string limit_text(double limit) {
    std::string text = fmt::format("{:.{}g}", limit, usual);
    return read_back(text) == limit ? text : fmt::format("{}", limit);
}

}  // namespace penumbra
