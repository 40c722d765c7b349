#include "obj.h"

#include <fmt/format.h>

#include <algorithm>
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

// The way from `folder` to `path` as it is on the disk; empty if it does not exist.
fs::path follow(const fs::path& folder, const fs::path& path) {
    fs::path result;
    for (const fs::path& step : path) {
        const std::string entry = entry_of(folder / result, step.string());
        if (entry.empty()) return {};
        result /= entry;
    }
    return result;
}

// Symbolic links are followed before the test, so that a link cannot lead out of the folder.
bool lies_below(const fs::path& folder, const fs::path& file) {
    std::error_code error;
    const fs::path top = fs::canonical(folder, error);
    if (error) return false;
    const fs::path target = fs::canonical(file, error);
    if (error) return false;
    return std::mismatch(top.begin(), top.end(), target.begin(), target.end()).first == top.end();
}

bool is_absolute(std::string_view name) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    return name.starts_with('/') || (name.size() > 1 && name[1] == ':' && letter(name[0]));
}

bool leads_out(const fs::path& path) { return !path.empty() && *path.begin() == ".."; }

// The file in the model's folder with the last part of a refused path as its name.
Found beside_model(const fs::path& folder, const std::string& name) {
    const std::string last = fs::path(name).filename().string();
    Found found = {.refusal = "lies outside the model's folder"};
    const bool usable = !last.empty() && last != "." && last != "..";
    const fs::path way = usable ? follow(folder, last) : fs::path();
    if (!way.empty() && lies_below(folder, folder / way)) {
        found.file = folder / way;
        found.refusal += fmt::format("; '{}' beside the model is used", printable(way.string()));
    }
    return found;
}

}  // namespace

Found find_below(const fs::path& model_folder, const fs::path& from, std::string_view name) {
    const fs::path folder = model_folder.empty() ? fs::path(".") : model_folder;
    std::string clean(trim(name));
    if (clean.size() > 1 && clean.front() == '"' && clean.back() == '"')
        clean = clean.substr(1, clean.size() - 2);
    std::replace(clean.begin(), clean.end(), '\\', '/');
    if (clean.empty()) return {};
    if (is_absolute(clean)) return beside_model(folder, clean);

    const fs::path way = (from / clean).lexically_normal();
    if (leads_out(way)) return beside_model(folder, clean);
    fs::path found = follow(folder, way);
    if (found.empty() && !from.empty()) found = follow(folder, fs::path(clean).lexically_normal());
    if (found.empty()) return {};
    if (!lies_below(folder, folder / found)) return {.refusal = "lies outside the model's folder"};
    return {.file = model_folder / found};
}

}  // namespace penumbra::obj
