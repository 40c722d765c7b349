#include "memory.h"
#include "obj.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra::obj {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_library_size = std::uintmax_t(256) << 20;

std::string library_text(const ModelFolders& folders, const fs::path& file) {
    const auto bytes = read_allowed(folders, file, max_library_size);
    return join_lines(
        to_utf8(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())));
}

// The folder of `file` seen from the model's; absolute where there is no way from that one.
fs::path folder_from(const fs::path& own, const fs::path& file) {
    const fs::path way = file.lexically_relative(own.empty() ? "." : own);
    return way.empty() ? file.parent_path() : way.parent_path();
}

void read_library(std::vector<MtlEntry>& entries, const fs::path& file, const ModelFolders& folders,
                  Losses& losses) {
    const std::string text = library_text(folders, file);
    const fs::path from = folder_from(folders.own, file);
    const std::string name = file.string();
    constexpr std::size_t most_of_a_byte = sizeof(Statement) / 4;  // "a b\n"
    const MemoryClaim claim(times(text.size(), most_of_a_byte), name);
    Index line = 0;
    bool inside = false, told = false;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        std::string_view rest = std::string_view(text).substr(at, end - at);
        at = end + 1;
        ++line;
        const std::string word(next_word(rest));
        const std::string key = lower_case(word);
        if (key.empty() || key.front() == '#') continue;
        if (key == "newmtl") {
            entries.push_back({.name = kept_name(name_without_comment(rest)),
                               .file = name,
                               .from = from,
                               .line = line});
            inside = true;
        } else if (inside) {
            entries.back().statements.push_back({key, word, std::string(trim(rest)), line});
        } else if (!std::exchange(told, true)) {
            losses.push_back({place_of(name, line), "what stands before newmtl is ignored"});
        }
    }
}

struct Library {
    std::string name = {};
    Found found = {};
};

// The names in a list; `blanks` lets a name go on to the next ".mtl".
std::vector<Library> listed(std::string_view operand, const ModelFolders& folders, bool blanks) {
    std::vector<Library> result;
    std::string name;
    for (auto word = next_word(operand); !word.empty(); word = next_word(operand)) {
        (name += name.empty() ? "" : " ") += word;
        if (blanks && !lower_case(word).ends_with(".mtl")) continue;
        result.push_back({name, find_below(folders, {}, name)});
        name.clear();
    }
    return result;
}

// The files that a mtllib means: one name with blanks, as most programs write it, if there is such
// a file; else a list of names, with blanks or, as the format defines it, without.
std::vector<Library> files_of(std::string_view operand, const ModelFolders& folders) {
    std::vector whole = {Library{std::string(operand), find_below(folders, {}, operand)}};
    const auto exists = [](const Library& library) { return !library.found.file.empty(); };
    for (const auto& names :
         {whole, listed(operand, folders, true), listed(operand, folders, false)})
        if (std::ranges::any_of(names, exists)) return names;
    return whole;
}

}  // namespace

std::vector<MtlEntry> read_libraries(const std::vector<Named>& libraries, const std::string& model,
                                     const ModelFolders& folders, Losses& losses) {
    std::vector<MtlEntry> entries;
    std::vector<fs::path> known;
    for (const Named& operand : libraries) {
        const auto lose = [&](const std::string& what) {
            losses.push_back({place_of(model, operand.line), "material library " + what});
        };
        const std::string_view names = name_without_comment(operand.name);
        for (const auto& [name, found] : files_of(names, folders)) {
            const std::string quoted = fmt::format("'{}'", printable(name));
            if (!found.refusal.empty())
                lose(fmt::format("{} {}", quoted, found.refusal));
            else if (found.file.empty())
                lose(fmt::format("{} is not found", quoted));
            if (found.file.empty() || std::ranges::find(known, found.file) != known.end()) continue;
            known.push_back(found.file);
            try {
                read_library(entries, found.file, folders, losses);
            } catch (const MemoryError&) {
                throw;
            } catch (const Error& error) {
                lose(fmt::format("is ignored: {}", error.what()));
            }
        }
    }
    return entries;
}

}  // namespace penumbra::obj
