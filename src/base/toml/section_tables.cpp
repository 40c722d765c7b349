// The tables inside a table of a sidecar.
#include "base/text/text.h"
#include "base/toml/section.h"

#include <fmt/format.h>

#include <charconv>

namespace penumbra {

namespace {

std::string numbering(const std::string& key, std::size_t count, std::string_view things) {
    if (count == 0) return fmt::format("the scene has no {}", things);
    if (count == 1) return fmt::format("the scene has only {}.0", key);
    return fmt::format("the scene has {0}.0 to {0}.{1}", key, count - 1);
}

}  // namespace

std::optional<Section> Section::table(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const std::string title =
        heading_.empty() ? fmt::format("[{}]", key) : fmt::format("{} of {}", key, heading_);
    const auto* inner = node->as_table();
    if (inner == nullptr) fail(key, title + " must be a table");
    return Section(*source_, *inner, title);
}

std::vector<Section> Section::list(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr || (source_->setting && node->is_table())) return {};
    const auto* items = node->as_array();
    if (items == nullptr) fail(key, fmt::format("'{0}' must be a list of tables: [[{0}]]", key));
    std::vector<Section> sections;
    for (const toml::node& item : *items) {
        const auto* inner = item.as_table();
        if (inner == nullptr)
            fail(key, fmt::format("'{0}' must be a list of tables: [[{0}]]", key));
        sections.emplace_back(*source_, *inner, fmt::format("[[{}]]", key));
    }
    return sections;
}

std::vector<std::pair<Index, Section>> Section::edits(const std::string& key, std::size_t count,
                                                      std::string_view things) {
    const toml::node* node = find(key);
    const auto* items = source_->setting && node != nullptr ? node->as_table() : nullptr;
    if (items == nullptr) return {};
    std::vector<std::pair<Index, Section>> sections;
    for (const auto& [word, item] : *items) {
        const std::string name(word.str());
        const char* const end = name.data() + name.size();
        Index index = 0;
        const auto [rest, failure] = std::from_chars(name.data(), end, index);
        if (failure != std::errc{} || rest != end)
            fail(key, fmt::format("'{}' must be followed by a number: {}.0", key, key));
        if (index >= count)
            fail(key, fmt::format("no {}.{} ({})", key, index, numbering(key, count, things)));
        const auto* inner = item.as_table();
        if (inner == nullptr)
            fail(key, fmt::format("'{0}.{1}' must be followed by a key: {0}.{1}.KEY", key, index));
        sections.emplace_back(index, Section(*source_, *inner, fmt::format("[[{}]]", key)));
    }
    return sections;
}

std::vector<std::pair<std::string, Section>> Section::named(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return {};
    const auto* items = node->as_table();
    if (items == nullptr) fail(key, fmt::format("'{0}' must be tables: [{0}.NAME]", key));
    std::vector<std::pair<std::string, Section>> sections;
    for (const auto& [word, item] : *items) {
        const std::string name(word.str());
        const auto* inner = item.as_table();
        if (inner == nullptr)
            Section(*source_, *items, fmt::format("[{}]", key))
                .reject(name, fmt::format("must be a table: [{}.NAME]", key));
        sections.emplace_back(
            name, Section(*source_, *inner, fmt::format("[{}.{}]", key, printable(name))));
    }
    return sections;
}

bool Section::is_string(const std::string& key) {
    const toml::node* node = find(key);
    return node != nullptr && node->is_string();
}

bool Section::is_number(const std::string& key) {
    const toml::node* node = find(key);
    return node != nullptr && node->is_number();
}

bool Section::is_table(const std::string& key) {
    const toml::node* node = find(key);
    return node != nullptr && node->is_table();
}

bool Section::is_false(const std::string& key) {
    const toml::node* node = find(key);
    const auto* truth = node != nullptr ? node->as_boolean() : nullptr;
    return truth != nullptr && !truth->get();
}

}  // namespace penumbra
