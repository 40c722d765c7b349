#include "obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <system_error>

namespace penumbra::obj {

namespace {

namespace fs = std::filesystem;

// The entry of `folder` called `name`, exactly or but for case; "" if there is none.
std::string entry_of(const fs::path& folder, const std::string& name) {
    std::error_code error;
    if (fs::exists(folder / name, error)) return name;
    const std::string wanted = lower_case(name);
    std::vector<std::string> similar;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        std::string entry = at->path().filename().string();
        if (lower_case(entry) == wanted) similar.push_back(std::move(entry));
    }
    return similar.empty() ? "" : *std::min_element(similar.begin(), similar.end());
}

// What of `path` is on the disk.
struct Way {
    fs::path path = {};      // from the model's folder; empty: nothing
    bool leads_out = false;  // a link on it does
};

// No link out is followed, so that the answer tells nothing of other folders.
Way follow(const ModelFolders& folders, const fs::path& folder, const fs::path& path) {
    Way way;
    for (const fs::path& step : path) {
        const std::string entry = entry_of(folder / way.path, step.string());
        if (entry.empty()) return {};
        way.path /= entry;
        if (!may_read(folders, folder / way.path)) return {.leads_out = true};
    }
    return way;
}

// "C:/models/chair.mtl", of a Windows program.
bool names_drive(std::string_view name) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    return name.size() > 1 && name[1] == ':' && letter(name[0]);
}

bool leads_out(const fs::path& path) { return !path.empty() && *path.begin() == ".."; }

std::string outside() { return fmt::format("lies outside the model's folder {}", how_to_allow); }

// The file in the model's folder with the last part of a refused path as its name.
Found beside_model(const ModelFolders& folders, const fs::path& folder, const std::string& name) {
    const std::string last = fs::path(name).filename().string();
    const bool usable = !last.empty() && last != "." && last != "..";
    const fs::path way = usable ? follow(folders, folder, last).path : fs::path();
    if (way.empty())
        return {.refusal = names_drive(name) ? "lies outside the model's folder" : outside()};
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

}  // namespace

Found find_below(const ModelFolders& folders, const fs::path& from, std::string_view name) {
    const fs::path folder = folders.own.empty() ? fs::path(".") : folders.own;
    std::string clean(trim(name));
    if (clean.size() > 1 && clean.front() == '"' && clean.back() == '"')
        clean = clean.substr(1, clean.size() - 2);
    std::replace(clean.begin(), clean.end(), '\\', '/');
    if (clean.empty()) return {};
    if (std::ranges::any_of(clean, [](unsigned char c) { return c < 0x20; }))
        return {.refusal = "has a control character in its name"};
    if (names_drive(clean)) return beside_model(folders, folder, clean);
    if (clean.starts_with('/')) return find_outside(folders, folder, clean);

    const fs::path way = (from / clean).lexically_normal();
    if (leads_out(way) || way.is_absolute()) return find_outside(folders, folder, way);
    Way found = follow(folders, folder, way);
    if (found.path.empty() && !from.empty())
        found = follow(folders, folder, fs::path(clean).lexically_normal());
    if (found.leads_out) return {.refusal = outside()};
    if (found.path.empty()) return {};
    return {.file = folders.own / found.path};
}

}  // namespace penumbra::obj
