// Files by names that are spelled in another way than on the disk.
#pragma once

#include "importers/shared/model_folders.h"

#include <filesystem>
#include <string>

namespace penumbra {

/// What two names of files may differ in besides the spelling of their letters in Unicode (see
/// decomposed()).
enum class Differ { in_nothing, in_case };

/// The entry of `folder` called `name`, exactly if there is one; "" if there is none.
/// Precondition: `folder` may be read.
std::string entry_of(const std::filesystem::path& folder, const std::string& name, Differ differ);

/// `file`, or where there is none the one whose path is that but for the spelling of its letters.
/// Only folders that may be read are searched, but may_read() has to be asked about what is found.
/// Precondition: may_read(folders, file).
std::filesystem::path find_spelled(const ModelFolders& folders, const std::filesystem::path& file);

/// The same of a file that the user names, who may read everything.
std::filesystem::path find_spelled(const std::filesystem::path& file);

}  // namespace penumbra
