// Which files a model may read: what a model names ends up in a picture or in a report, which may
// be published, so that a stranger's model could ask for anything that its reader can open.
#pragma once

#include "base/file.h"

#include "penumbra/importers.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

/// The folders below which a model may name files.
struct ModelFolders {
    std::filesystem::path own = {};  ///< the model's, where relative names begin; empty: the
                                     ///< current one
    std::vector<std::filesystem::path> allowed = {};  ///< further ones, by the user
    std::string how_to_allow = {};                    ///< ModelOptions::how_to_allow
    bool own_allowed = true;  ///< else only names begin there: the model came from memory

    /// What a file lies outside of that may_read() refuses, and what can be done about it.
    std::string description() const;
};

/// Those of a model on the disk.
ModelFolders folders_of(const std::filesystem::path& file, const ModelOptions& options);

/// Those of a model in memory: nobody has put it into the folder of its name, so that this alone
/// allows nothing.
ModelFolders folders_in_memory(const std::filesystem::path& name, const ModelOptions& options);

/// Whether `file`, with all links followed, is or would be below one of the folders. A link to
/// nothing is not, so that the answer does not tell which files exist elsewhere.
bool may_read(const ModelFolders& folders, const std::filesystem::path& file);

/// The content of the regular file `file` if may_read(). What is opened is what was checked, even
/// if somebody replaces folders by links meanwhile. Throws Error (input).
std::vector<std::byte> read_allowed(const ModelFolders& folders, const std::filesystem::path& file,
                                    std::uintmax_t max = max_file_size);

}  // namespace penumbra
