#include "importers/shared/formats.h"

#include "base/text/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>

namespace penumbra {

namespace {

using Reader = Imported (*)(const std::filesystem::path&, const ModelOptions&);

struct Entry {
    Format format = {};
    Reader read = nullptr;
};

const std::vector<Entry>& table() {
    static const std::vector<Entry> entries = {
        {{.name = "glTF 2.0", .extensions = {".gltf", ".glb"}}, read_gltf},
        {{.name = "OBJ", .extensions = {".obj"}}, read_obj},
    };
    return entries;
}

// nullptr: of none of them.
const Entry* entry_of(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    const auto found = std::ranges::find_if(table(), [&](const Entry& entry) {
        return std::ranges::count(entry.format.extensions, extension) > 0;
    });
    return found == table().end() ? nullptr : &*found;
}

}  // namespace

std::span<const Format> formats() {
    static const std::vector<Format> all = [] {
        std::vector<Format> result;
        for (const Entry& entry : table()) result.push_back(entry.format);
        return result;
    }();
    return all;
}

bool is_model(const std::filesystem::path& file) { return entry_of(file) != nullptr; }

Imported read_model(const std::filesystem::path& file, const ModelOptions& options) {
    const Entry* const entry = entry_of(file);
    assert(entry != nullptr);
    return entry->read(file, options);
}

std::vector<std::string> model_extensions() {
    std::vector<std::string> all;
    for (const Format& format : formats())
        all.insert(all.end(), format.extensions.begin(), format.extensions.end());
    return all;
}

std::string listed(const std::vector<std::string>& words, std::string_view last) {
    assert(!words.empty());
    if (words.size() == 1) return words.front();
    return fmt::format("{} {} {}", fmt::join(words.begin(), words.end() - 1, ", "), last,
                       words.back());
}

}  // namespace penumbra
