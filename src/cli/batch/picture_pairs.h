// Two pictures, or two folders of them -> pairs by name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::cli {

struct PicturePair {
    std::string name = {};  ///< path in the folders, without the extension where they differ in it
    std::filesystem::path test = {}, reference = {};  ///< empty: there is none
};

/// Every picture in the folders and below, in order of names. Pictures are the same by their path,
/// else by their path without the extension ("out/a.exr" and "golden/a.png"). Two files are one
/// pair. Throws Error (input) when only one of both is a folder, or the folders hold no picture.
std::vector<PicturePair> picture_pairs(const std::filesystem::path& test,
                                       const std::filesystem::path& reference);

}  // namespace penumbra::cli
