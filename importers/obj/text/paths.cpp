#include "importers/obj/text/paths.h"

#include "base/text/ascii.h"
#include "importers/obj/text/encoding.h"
#include "importers/obj/text/words.h"
#include "importers/shared/file_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace penumbra::obj {

namespace {

namespace fs = std::filesystem;

// What of `path` is on the disk.
struct Way {
    fs::path path = {};      // from the model's folder; empty: nothing
    bool leads_out = false;  // a link on it does
};

// No link out is followed, and nothing is looked up in a folder that is not allowed, so that the
// answer tells nothing of other folders.
Way follow(const ModelFolders& folders, const fs::path& folder, const fs::path& path) {
    Way way;
    for (const fs::path& step : path) {
        if (!folders.own_allowed && !may_read(folders, folder / way.path / step))
            return {.leads_out = true};
        const std::string entry = entry_of(folder / way.path, step.string(), Differ::in_case);
        if (entry.empty()) return {};
        way.path /= entry;
        if (!may_read(folders, folder / way.path)) return {.leads_out = true};
    }
    return way;
}

// "C:/models/chair.mtl", of a Windows program.
bool names_drive(std::string_view name) {
    return name.size() > 1 && name[1] == ':' && is_letter(name[0]);
}

bool leads_out(const fs::path& path) { return !path.empty() && *path.begin() == ".."; }

std::string outside(const ModelFolders& folders) { return "lies outside " + folders.description(); }

// The file in the model's folder with the last part of a refused path as its name.
Found beside_model(const ModelFolders& folders, const fs::path& folder, const std::string& name) {
    const std::string last = fs::path(name).filename().string();
    const bool usable = !last.empty() && last != "." && last != "..";
    const fs::path way = usable ? follow(folders, folder, last).path : fs::path();
    if (way.empty())
        return {.refusal = names_drive(name) && folders.own_allowed
                               ? "lies outside the model's folder"
                               : outside(folders)};
    return {.file = folder / way,
            .refusal = fmt::format("lies outside the model's folder; '{}' beside the model is used",
                                   printable(way.string()))};
}

// A path that leaves the model's folder is followed as it stands, and only where the user allows
// it.
Found find_outside(const ModelFolders& folders, const fs::path& folder, const fs::path& path) {
    std::error_code ignored;
    const fs::path file = folder / path;
    if (!folders.allowed.empty() && may_read(folders, file) && fs::exists(file, ignored))
        return {.file = file};
    return beside_model(folders, folder, path.string());
}

void use_slashes(std::string& name) { std::replace(name.begin(), name.end(), '\\', '/'); }

// Looks for `name` as it is spelled.
Found find_name(const ModelFolders& folders, const fs::path& from, const std::string& name) {
    const fs::path folder = folders.own.empty() ? fs::path(".") : folders.own;
    if (name.empty()) return {};
    if (std::ranges::any_of(name, [](unsigned char c) { return c < 0x20; }))
        return {.refusal = "has a control character in its name"};
    if (names_drive(name)) return beside_model(folders, folder, name);
    if (name.starts_with('/')) return find_outside(folders, folder, name);

    const fs::path way = (from / name).lexically_normal();
    if (leads_out(way) || way.is_absolute()) return find_outside(folders, folder, way);
    Way found = follow(folders, folder, way);
    if (found.path.empty() && !from.empty())
        found = follow(folders, folder, fs::path(name).lexically_normal());
    // An allowed folder may lie below one that is not.
    if (found.leads_out && !folders.own_allowed) return find_outside(folders, folder, way);
    if (found.leads_out) return {.refusal = outside(folders)};
    if (found.path.empty()) return {};
    return {.file = folders.own / found.path};
}

// What a name in another encoding than UTF-8 may be on the disk: first its bytes, as programs on
// Linux write them, then in UTF-8. Only what is a character of its own is a backslash.
std::vector<std::string> other_spellings(const std::string& name) {
    std::vector<Decoded> decoded = decodings(name);
    std::vector<std::string> result;
    if (!decoded.empty()) use_slashes(result.emplace_back(as_bytes(name)));
    for (Decoded& in : decoded) {
        use_slashes(in.text);
        result.push_back(encoded(in));
    }
    for (Decoded& in : decoded) result.push_back(std::move(in.text));
    return result;
}

}  // namespace

Found find_below(const ModelFolders& folders, const fs::path& from, std::string_view name) {
    std::string written(trim(name));
    if (written.size() > 1 && written.front() == '"' && written.back() == '"')
        written = written.substr(1, written.size() - 2);
    std::string plain = written;
    use_slashes(plain);
    Found best = find_name(folders, from, plain);
    for (const std::string& other : other_spellings(written)) {
        if (!best.file.empty() && best.refusal.empty()) break;
        Found found = find_name(folders, from, other);
        const bool better = !found.file.empty() && (best.file.empty() || found.refusal.empty());
        if (better) best = std::move(found);
    }
    return best;
}

}  // namespace penumbra::obj
