#include "importers/shared/file_names.h"

#include "base/text/decomposed.h"
#include "base/text/text.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

namespace penumbra {

namespace fs = std::filesystem;

std::string entry_of(const fs::path& folder, const std::string& name, Differ differ) {
    std::error_code error;
    if (fs::exists(folder / name, error)) return name;
    const std::string same = decomposed(name), folded = lower_case(same);
    // Those that only differ in spelling first, then in the order of their names.
    std::optional<std::pair<bool, std::string>> best;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        std::string entry = at->path().filename().string();
        const std::string own = decomposed(entry);
        const bool other_case = own != same;
        if (other_case && (differ == Differ::in_nothing || lower_case(own) != folded)) continue;
        std::pair found(other_case, std::move(entry));
        if (!best || found < *best) best = std::move(found);
    }
    return best ? best->second : "";
}

fs::path find_spelled(const ModelFolders& folders, const fs::path& file) {
    std::error_code error;
    if (fs::exists(file, error)) return file;
    fs::path way;
    bool found = false;  // the way is another than that of `file`
    for (const fs::path& step : file) {
        const fs::path folder = way.empty() ? fs::path(".") : way;
        const bool allowed = may_read(folders, folder);
        if (found && !allowed) return way;  // else the answer would tell what is there
        if (fs::exists(way / step, error)) {
            way /= step;
            continue;
        }
        if (!allowed) return file;
        const std::string entry = entry_of(folder, step.string(), Differ::in_nothing);
        if (entry.empty()) return file;
        way /= entry;
        found = true;
    }
    return way;
}

fs::path find_spelled(const fs::path& file) { return find_spelled({.own = "/"}, file); }

}  // namespace penumbra
