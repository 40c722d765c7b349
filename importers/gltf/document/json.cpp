// JSON text -> JSON, without what nobody reads.
#include "base/memory.h"
#include "importers/gltf/document/checks.h"

#include "penumbra/limits.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace penumbra::gltf {
namespace {

using nlohmann::json;

// What glTF defines ends long before. Deeper are only extras, over which tinygltf recurses.
constexpr std::size_t max_nesting = 64;

// What nlohmann's structures take of memory, as they grow: a value in its array, an array or
// object, a member of an object with its key.
std::size_t parsed_size(std::string_view text) {
    const auto count = [&](char c) { return std::size_t(std::ranges::count(text, c)); };
    constexpr std::size_t container = 64, member = 112, growth = 3;
    const std::size_t containers = count('[') + count('{');
    return text.size() + (count(',') + containers) * growth * sizeof(json) +
           containers * container + count(':') * member;
}

std::string line_and_column(std::string_view text, std::size_t at) {
    const std::string_view before = text.substr(0, std::min(at, text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t start = before.rfind('\n') + 1;  // npos + 1 is 0
    return fmt::format("{}:{}", line, before.size() - start + 1);
}

// Builds the JSON value by value. nlohmann's own parser can leave things out as well, but then
// looks at all elements of an array behind each of them.
struct Builder : json::json_sax_t {
    std::string_view text;
    const std::string& file;
    json root = {};
    std::vector<json*> open = {};  // arrays and objects, the innermost last
    std::string member = {};       // of the innermost object, whose value is next
    std::size_t skipped = 0;       // arrays and objects that are open and left out
    bool skip_next = false, is_name = false, cut = false;

    Builder(std::string_view from, const std::string& name) : text(from), file(name) {}

    // Where `value` is now; nullptr if it is left out.
    json* add(json value) {
        const bool deep = open.size() + skipped > max_nesting;
        cut = cut || deep;
        if (std::exchange(skip_next, false) || skipped > 0 || deep) return nullptr;
        if (open.empty()) return &(root = std::move(value));
        if (open.back()->is_array()) return &open.back()->emplace_back(std::move(value));
        return &((*open.back())[member] = std::move(value));
    }
    bool leaf(json value) {
        add(std::move(value));
        return true;
    }
    bool begin(json empty) {
        json* const place = add(std::move(empty));
        if (place != nullptr)
            open.push_back(place);
        else
            ++skipped;
        return true;
    }
    bool end() {
        if (skipped > 0)
            --skipped;
        else
            open.pop_back();
        return true;
    }

    bool null() override { return leaf(nullptr); }
    bool boolean(bool value) override { return leaf(value); }
    bool number_integer(number_integer_t value) override { return leaf(value); }
    bool number_unsigned(number_unsigned_t value) override { return leaf(value); }
    bool number_float(number_float_t value, const string_t&) override { return leaf(value); }
    bool string(string_t& value) override {
        if (is_name && value.size() > max_name) value = kept_name(value);
        return leaf(std::move(value));
    }
    bool binary(binary_t&) override { return false; }  // JSON has none
    bool key(string_t& name) override {
        skip_next = name == "extras";
        is_name = name == "name";
        member = std::move(name);
        return true;
    }
    bool start_object(std::size_t) override { return begin(json::object()); }
    bool start_array(std::size_t) override { return begin(json::array()); }
    bool end_object() override { return end(); }
    bool end_array() override { return end(); }

    bool parse_error(std::size_t at, const std::string&,
                     const nlohmann::detail::exception& error) override {
        constexpr int out_of_range = 406;
        throw Error(Failure::input, file + ':' + line_and_column(text, at > 0 ? at - 1 : 0),
                    error.id == out_of_range ? "the number that ends here is out of range"
                                             : "the JSON cannot be parsed here");
    }
};

}  // namespace

json parse_json(std::string_view text, const std::string& file, Losses& losses) {
    // Some writers pad the JSON chunk with zeros instead of blanks.
    while (!text.empty() && text.back() == '\0') text.remove_suffix(1);
    const MemoryClaim claim(parsed_size(text), file);
    Builder builder(text, file);
    json::sax_parse(text, &builder);
    if (builder.cut)
        losses.push_back(
            {Loss::dropped, file,
             fmt::format("what is nested more than {} levels deep is ignored", max_nesting)});
    return std::move(builder.root);
}

}  // namespace penumbra::gltf
