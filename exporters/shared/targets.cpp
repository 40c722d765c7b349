#include "exporters/shared/targets.h"

#include "base/file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>

namespace penumbra {

namespace {

namespace fs = std::filesystem;

// The first bytes of a file; marks stand in them, behind what the file format wants first.
std::string beginning_of(const fs::path& file) {
    std::string text(4096, '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(text.data(), std::streamsize(text.size()));
    text.resize(std::size_t(in.gcount()));
    return text;
}

bool is_plain_file(const fs::path& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored);
}

}  // namespace

bool is_own_file(const fs::path& file) {
    if (!is_plain_file(file)) return false;
    const std::string begin = beginning_of(file);
    // How .ini, geometry and .ppm files have always begun.
    constexpr std::array<std::string_view, 3> headers = {"; Run in this folder: povray ",
                                                         "// Meshes of ", "P6\n# penumbra\n"};
    return begin.find(own_mark) != begin.npos ||
           std::ranges::any_of(headers, [&](auto header) { return begin.starts_with(header); });
}

void check_targets(std::span<const fs::path> targets, const ExportOptions& options) {
    for (const fs::path& target : targets) {
        check_not_input(target, options.inputs);
        if (options.replace || !is_plain_file(target) || is_own_file(target)) continue;
        throw Error(Failure::output, target.string(),
                    "is there already, and not from an export; give the scene another name",
                    Remedy::replace);
    }
}

std::vector<fs::path> remove_old_files(const fs::path& folder,
                                       const std::function<bool(const fs::path&)>& chosen,
                                       std::span<const fs::path> kept,
                                       const ExportOptions& options) {
    const auto is_old = [&](const fs::directory_entry& entry) {
        std::error_code ignored;
        const auto same = [&](const fs::path& file) { return is_same_file(entry.path(), file); };
        return chosen(entry.path()) && !entry.is_symlink(ignored) && is_own_file(entry.path()) &&
               std::ranges::none_of(kept, same) && std::ranges::none_of(options.inputs, same);
    };
    std::vector<fs::path> old;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (is_old(*at)) old.push_back(at->path());
    std::ranges::sort(old);
    std::erase_if(old, [&](const fs::path& file) { return !fs::remove(file, error); });
    return old;
}

}  // namespace penumbra
