#include "importers/obj/mtl/text.h"

#include "base/memory.h"
#include "importers/obj/text/encoding.h"
#include "importers/obj/text/paths.h"
#include "importers/obj/text/tally.h"
#include "importers/obj/text/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace penumbra::obj {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_library_size = std::uintmax_t(256) << 20;

std::string library_text(const ModelFolders& folders, const fs::path& file) {
    const auto bytes = read_allowed(folders, file, max_library_size);
    return to_lines(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
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
    bool inside = false, noted = false;
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
        } else if (!std::exchange(noted, true)) {
            losses.push_back(
                {Loss::dropped, place_of(name, line), "what stands before newmtl is ignored"});
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

// Reads what a model names, and says what it does not get.
struct Reader {
    const std::string& model;
    const ModelFolders& folders;
    Imported& result;
    std::vector<MtlEntry> entries = {};
    std::vector<fs::path> known = {};

    void note(Loss::Kind kind, Index line, const std::string& what) {
        result.losses.push_back({kind, place_of(model, line), "material library " + what});
    }

    void read(const fs::path& file, Index line) {
        if (std::ranges::find(known, file) != known.end()) return;
        known.push_back(file);
        result.files.push_back(file);
        try {
            read_library(entries, file, folders, result.losses);
        } catch (const MemoryError&) {
            throw;
        } catch (const Error& error) {
            note(Loss::dropped, line, fmt::format("is ignored: {}", error.what()));
        }
    }

    void read_named(const Named& operand, const fs::path& substitute) {
        for (const auto& [name, found] : files_of(name_without_comment(operand.name), folders)) {
            const bool missing = found.file.empty();
            if (missing || !found.refusal.empty()) {  // another file may be used
                std::string what =
                    fmt::format("'{}' {}", printable(name),
                                found.refusal.empty() ? "is not found" : found.refusal);
                if (missing && !substitute.empty())
                    what += fmt::format("; '{}' beside the model is used",
                                        printable(substitute.filename().string()));
                const bool lost = missing && substitute.empty();
                note(lost ? Loss::dropped : Loss::approximated, operand.line, what);
            }
            const fs::path& file = missing ? substitute : found.file;
            if (!file.empty()) read(file, operand.line);
        }
    }
};

// The library that is called as the model is, where none is found that it names: programs write a
// name that it no longer has, or in an encoding that nobody knows. Empty: there is none.
fs::path library_of_the_same_name(const std::vector<Named>& libraries, const std::string& model,
                                  const ModelFolders& folders) {
    for (const Named& operand : libraries)
        for (const Library& library : files_of(name_without_comment(operand.name), folders))
            if (!library.found.file.empty()) return {};
    const Found found = find_below(folders, {}, fs::path(model).stem().string() + ".mtl");
    return found.refusal.empty() ? found.file : fs::path();
}

}  // namespace

std::vector<MtlEntry> read_libraries(const std::vector<Named>& libraries, const std::string& model,
                                     const ModelFolders& folders, Imported& result) {
    const fs::path substitute =
        libraries.empty() ? fs::path() : library_of_the_same_name(libraries, model, folders);
    Reader reader = {.model = model, .folders = folders, .result = result};
    for (const Named& operand : libraries) reader.read_named(operand, substitute);
    return std::move(reader.entries);
}

}  // namespace penumbra::obj
