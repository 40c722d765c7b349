#include "base/toml/section.h"

#include "base/text/suggest.h"
#include "base/text/text.h"

#include "penumbra/math.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace penumbra {

namespace {

std::string type_of(const toml::node& node) {
    switch (node.type()) {
    case toml::node_type::table: return "a table";
    case toml::node_type::array: return "a list";
    case toml::node_type::string: return "a string";
    case toml::node_type::integer:
    case toml::node_type::floating_point: return "a number";
    case toml::node_type::boolean: return "a boolean";
    default: return "a date or time";
    }
}

std::string must(const Range& range) {
    const bool below = std::isfinite(range.low), above = std::isfinite(range.high);
    if (below && above)
        return range.open_low || range.open_high
                   ? fmt::format("must be {} {} and {} {}", range.open_low ? "above" : "at least",
                                 range.low, range.open_high ? "below" : "at most", range.high)
                   : fmt::format("must be from {} to {}", range.low, range.high);
    if (below && range.open_low) return fmt::format("must be greater than {}", range.low);
    if (below) return fmt::format("must be {} or more", range.low);
    return "must be finite";
}

std::optional<double> as_number(const toml::node& node) {
    if (const auto* whole = node.as_integer()) return double(whole->get());
    if (const auto* real = node.as_floating_point()) return real->get();
    return std::nullopt;
}

std::optional<Color> from_hex(std::string_view text) {
    std::uint32_t value = 0;
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    const auto [end, failure] = std::from_chars(text.data() + 1, text.data() + 7, value, 16);
    if (failure != std::errc{} || end != text.data() + 7) return std::nullopt;
    const auto channel = [&](int shift) {
        return srgb_to_linear(float((value >> shift) & 255U) / 255.0F);
    };
    return Color(channel(16), channel(8), channel(0));
}

constexpr const char* color_form = R"([r, g, b] or "#rrggbb")";

}  // namespace

bool Range::contains(double value) const {
    return std::isfinite(value) && (open_low ? value > low : value >= low) &&
           (open_high ? value < high : value <= high);
}

Section::Section(const Layer& layer, const toml::table& table, std::string title)
    : source_(&layer), content_(&table), heading_(std::move(title)) {}

std::string Section::place(const toml::source_region& region) const {
    if (source_->setting || region.begin.line == 0) return source_->name;
    return fmt::format("{}:{}:{}", source_->name, region.begin.line, region.begin.column);
}

const toml::node* Section::find(const std::string& key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
    return content_->get(key);
}

bool Section::has(const std::string& key) { return find(key) != nullptr; }

void Section::fail(const std::string& key, const std::string& problem) const {
    const toml::node* node = content_->get(key);
    throw Error(source_->setting ? Failure::usage : Failure::input,
                place(node != nullptr ? node->source() : content_->source()), problem);
}

void Section::wrong(const std::string& key, const toml::node& node,
                    const std::string& problem) const {
    throw Error(source_->setting ? Failure::usage : Failure::input, place(node.source()),
                fmt::format("'{}' in {} {}", printable(key), heading_, problem));
}

void Section::reject(const std::string& key, const std::string& problem) const {
    fail(key, fmt::format("'{}' in {} {}", printable(key), heading_, problem));
}

void Section::require(const std::string& key) {
    if (!has(key)) fail(key, fmt::format("{} needs '{}'", heading_, key));
}

void Section::finish() const {
    for (const auto& [key, node] : *content_) {
        const std::string word(key.str());
        if (std::find(known_.begin(), known_.end(), word) != known_.end()) continue;
        throw Error(source_->setting ? Failure::usage : Failure::input, place(key.source()),
                    fmt::format("unknown key '{}' {}{}", printable(word),
                                heading_.empty() ? "at the top level" : "in " + heading_,
                                hint(word, known_, "known keys")));
    }
}

double Section::number(const std::string& key, const toml::node& node, const Range& range) const {
    const auto value = as_number(node);
    if (!value) wrong(key, node, "must be a number, not " + type_of(node));
    if (!std::isfinite(*value)) wrong(key, node, fmt::format("must be finite, not {}", *value));
    if (!range.contains(*value)) wrong(key, node, fmt::format("{}, not {}", must(range), *value));
    return *value;
}

// Products of a few of them must neither overflow nor vanish.
double Section::measure(const std::string& key, const toml::node& node, const Range& range) const {
    const double value = number(key, node, range), size = std::abs(value);
    if (size > 1e30) wrong(key, node, fmt::format("is too large: {}", value));
    if (size > 0 && size < 1e-30) wrong(key, node, fmt::format("is too small: {}", value));
    return value;
}

int Section::whole(const std::string& key, const toml::node& node, const Range& range) const {
    const auto value = as_number(node);
    if (!value) wrong(key, node, "must be a whole number, not " + type_of(node));
    if (*value != std::floor(*value))
        wrong(key, node, fmt::format("must be a whole number, not {}", *value));
    return int(number(key, node, range));
}

void Section::numbers(const std::string& key, const toml::node& node, std::span<double> values,
                      const std::string& form) const {
    const auto* list = node.as_array();
    if (list == nullptr) wrong(key, node, fmt::format("must be {}, not {}", form, type_of(node)));
    if (list->size() != values.size())
        wrong(key, node,
              fmt::format("must be {}: {} numbers, not {}", form, values.size(), list->size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!as_number((*list)[i]))
            wrong(key, (*list)[i],
                  fmt::format("must be {} of numbers, not {}", form, type_of((*list)[i])));
        values[i] = measure(key, (*list)[i], any_number);
    }
}

Color Section::color(const std::string& key, const toml::node& node) const {
    if (const auto* text = node.as_string()) {
        const auto value = from_hex(text->get());
        if (!value)
            wrong(key, node,
                  fmt::format("must be {}, not \"{}\"", color_form, printable(text->get())));
        return *value;
    }
    std::array<double, 3> channels = {};
    numbers(key, node, channels, color_form);
    for (const double channel : channels)
        if (!(channel >= 0 && channel <= std::numeric_limits<float>::max()))
            wrong(key, node, fmt::format("must have channels of 0 or more, not {}", channel));
    return {float(channels[0]), float(channels[1]), float(channels[2])};
}

bool Section::read(const std::string& key, double& value, const Range& range) {
    const toml::node* node = find(key);
    if (node != nullptr) value = measure(key, *node, range);
    return node != nullptr;
}

bool Section::read(const std::string& key, float& value, const Range& range) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const double wide = number(key, *node, range);
    if (!std::isfinite(float(wide))) wrong(key, *node, fmt::format("is too large: {}", wide));
    if (!range.contains(double(float(wide))))
        wrong(key, *node, fmt::format("is too near to the end of its range: {}", wide));
    value = float(wide);
    return true;
}

bool Section::read(const std::string& key, int& value, const Range& range) {
    const toml::node* node = find(key);
    if (node != nullptr) value = whole(key, *node, range);
    return node != nullptr;
}

bool Section::read(const std::string& key, std::array<int, 2>& value, const Range& range) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const auto* list = node->as_array();
    if (list == nullptr || list->size() != 2)
        wrong(key, *node, "must be a list of two whole numbers");
    for (std::size_t i = 0; i < 2; ++i) value[i] = whole(key, (*list)[i], range);
    return true;
}

bool Section::read(const std::string& key, bool& value) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    if (!node->is_boolean()) wrong(key, *node, "must be true or false, not " + type_of(*node));
    value = node->as_boolean()->get();
    return true;
}

bool Section::read(const std::string& key, std::vector<std::string>& value) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const auto* list = node->as_array();
    if (list == nullptr) wrong(key, *node, "must be a list of strings, not " + type_of(*node));
    value.clear();
    for (const toml::node& entry : *list) {
        const auto* text = entry.as_string();
        if (text == nullptr)
            wrong(key, entry, "must be a list of strings, not of " + type_of(entry));
        value.push_back(text->get());
    }
    return true;
}

bool Section::read_rows(const std::string& key, std::size_t count,
                        std::vector<std::vector<double>>& rows, const std::string& form) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const auto* list = node->as_array();
    if (list == nullptr)
        wrong(key, *node, fmt::format("must be a list of {}, not {}", form, type_of(*node)));
    rows.assign(list->size(), std::vector<double>(count));
    for (std::size_t i = 0; i < rows.size(); ++i) numbers(key, (*list)[i], rows[i], form);
    return true;
}

std::vector<std::string> Section::keys() {
    std::vector<std::string> result;
    for (const auto& [key, node] : *content_) result.emplace_back(key.str());
    known_ = result;
    return result;
}

bool Section::read(const std::string& key, std::string& value) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    if (const auto* text = node->as_string()) {
        value = text->get();
    } else if (source_->setting && !node->is_table() && !node->is_array()) {
        value = source_->text;  // a name such as 7 or true needs no quotes there
    } else {
        wrong(key, *node, "must be a string, not " + type_of(*node));
    }
    return true;
}

bool Section::read(const std::string& key, std::optional<Reference>& value) {
    std::string name;
    if (!read(key, name)) return false;
    value = Reference{.failure = source_->setting ? Failure::usage : Failure::input,
                      .place = place(content_->get(key)->source()),
                      .name = name};
    return true;
}

bool Section::read_numbers(const std::string& key, std::span<double> values,
                           const std::string& form) {
    const toml::node* node = find(key);
    if (node != nullptr) numbers(key, *node, values, form);
    return node != nullptr;
}

bool Section::read(const std::string& key, Vec3& value) {
    return read_numbers(key, {&value.x, 3}, "[x, y, z]");
}

bool Section::read_scale(const std::string& key, Vec3& value) {
    if (!is_number(key)) return read_numbers(key, {&value.x, 3}, "a number or [x, y, z]");
    value = Vec3(number(key, *find(key), any_number));
    return true;
}

bool Section::read_angle(const std::string& key, double& value, const Range& range) {
    double angle = 0;
    const bool given = read(key, angle, range);
    if (given) value = radians(angle);
    return given;
}

bool Section::read_color(const std::string& key, Color& value) {
    const toml::node* node = find(key);
    if (node != nullptr) value = color(key, *node);
    return node != nullptr;
}

bool Section::read_factor(const std::string& key, Color& value) {
    if (!is_number(key)) {
        const toml::node* node = find(key);
        if (node != nullptr && !node->is_array() && !node->is_string())
            wrong(key, *node,
                  fmt::format("must be a number, {}, not {}", color_form, type_of(*node)));
        return read_color(key, value);
    }
    float all = 0;
    read(key, all, non_negative);
    value = Color(all);
    return true;
}

bool Section::read_colors(const std::string& key, std::array<Color, 2>& value) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const auto* list = node->as_array();
    if (list == nullptr || list->size() != 2) wrong(key, *node, "must be a list of two colours");
    value = {color(key, (*list)[0]), color(key, (*list)[1])};
    return true;
}

std::optional<std::size_t> Section::choose(const std::string& key,
                                           const std::vector<std::string>& words) {
    std::string word;
    if (!read(key, word)) return std::nullopt;
    const auto found = std::find(words.begin(), words.end(), word);
    if (found != words.end()) return std::size_t(found - words.begin());
    reject(key, fmt::format("must be one of \"{}\", not \"{}\"", fmt::join(words, "\", \""),
                            printable(word)));
}

}  // namespace penumbra
