// Which files a model may read: what a model names ends up in a picture or in a report, which may
// be published, so that a stranger's model could ask for anything that its reader can open.
#pragma once

#include "file.h"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace penumbra {

/// The folders below which a model may name files.
struct ModelFolders {
    std::filesystem::path own = {};                   ///< the model's; empty: the current one
    std::vector<std::filesystem::path> allowed = {};  ///< further ones, by the user
};

/// What the user can do about a file that lies outside; to stand behind a reason.
inline constexpr const char* how_to_allow = "(--allow-path DIR lets models read files below DIR)";

/// Whether `file`, with all links followed, is or would be below one of the folders. A link to
/// nothing is not, so that the answer does not tell which files exist elsewhere.
bool may_read(const ModelFolders& folders, const std::filesystem::path& file);

/// The content of the regular file `file` if may_read(). What is opened is what was checked, even
/// if somebody replaces folders by links meanwhile. Throws Error (input).
std::vector<std::byte> read_allowed(const ModelFolders& folders, const std::filesystem::path& file,
                                    std::uintmax_t max = max_file_size);

}  // namespace penumbra
