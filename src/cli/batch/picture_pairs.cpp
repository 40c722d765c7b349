#include "cli/batch/picture_pairs.h"

#include "base/text/text.h"

#include "penumbra/error.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;

constexpr auto extensions =
    std::to_array<std::string_view>({".png", ".jpg", ".jpeg", ".exr", ".tif", ".tiff", ".hdr",
                                     ".bmp", ".tga", ".webp", ".ppm", ".pgm", ".pfm"});

bool is_picture(const fs::path& file) {
    return std::ranges::find(extensions, lower_extension(file)) != extensions.end();
}

// Paths in the folder, in order.
std::vector<fs::path> pictures_in(const fs::path& folder) {
    std::vector<fs::path> result;
    std::error_code error;
    fs::recursive_directory_iterator entry(folder, error), end;
    for (; !error && entry != end; entry.increment(error))
        if (entry->is_regular_file(error) && is_picture(entry->path()))
            result.push_back(entry->path().lexically_relative(folder));
    if (error) throw Error(Failure::input, folder.string(), error.message());
    if (result.empty()) throw Error(Failure::input, folder.string(), "has no pictures in it");
    std::ranges::sort(result);
    return result;
}

fs::path bare(fs::path file) { return file.replace_extension(); }

// The pictures by their path without the extension; of several with the same one none.
std::map<fs::path, std::optional<fs::path>> by_bare_path(const std::vector<fs::path>& files) {
    std::map<fs::path, std::optional<fs::path>> result;
    for (const fs::path& file : files) {
        const auto [found, fresh] = result.try_emplace(bare(file), file);
        if (!fresh) found->second.reset();
    }
    return result;
}

}  // namespace

std::vector<PicturePair> picture_pairs(const fs::path& test, const fs::path& reference) {
    std::error_code ignored;
    const bool folder = fs::is_directory(test, ignored);
    if (folder != fs::is_directory(reference, ignored))
        throw Error(Failure::input, (folder ? reference : test).string(),
                    "is no folder, but the other one is: give two pictures or two folders");
    if (!folder)
        return {
            {test.filename().string() + " vs " + reference.filename().string(), test, reference}};
    std::vector<fs::path> left = pictures_in(reference);
    const auto by_bare = by_bare_path(left);
    const std::vector<fs::path> tests = pictures_in(test);
    const auto tests_by_bare = by_bare_path(tests);
    std::vector<PicturePair> pairs;
    for (const fs::path& file : tests) {
        PicturePair pair = {file.string(), test / file, {}};
        auto found = std::ranges::find(left, file);
        if (found == left.end() && tests_by_bare.at(bare(file))) {
            const auto other = by_bare.find(bare(file));
            if (other != by_bare.end() && other->second) {
                found = std::ranges::find(left, *other->second);
                pair.name = bare(file).string();
            }
        }
        if (found != left.end()) {
            pair.reference = reference / *found;
            left.erase(found);
        }
        pairs.push_back(std::move(pair));
    }
    for (const fs::path& file : left) pairs.push_back({file.string(), {}, reference / file});
    std::ranges::sort(pairs, {}, &PicturePair::name);
    return pairs;
}

}  // namespace penumbra::cli
