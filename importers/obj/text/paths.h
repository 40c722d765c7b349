// Names of files -> files.
#pragma once

#include "importers/shared/model_folders.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace penumbra::obj {

/// A file that a model names.
struct Found {
    std::filesystem::path file = {};  ///< empty: none; else the model's folder and the way from it
    std::string refusal = {};         ///< why the name was not followed as it stands; may be empty
};

/// Looks for `name`, as an OBJ or MTL file writes it, in the model's folder or below. `from` is
/// where the naming file lies, relative to that folder. Backslashes separate too. Where there is no
/// exact match, case is ignored, and whether letters and their marks are one character or two; a
/// name that was no UTF-8 is looked for as bytes, then in other encodings (see decodings()). A path
/// that leads to no allowed folder is refused; a file of the same name in the model's folder is
/// taken for it.
Found find_below(const ModelFolders& folders, const std::filesystem::path& from,
                 std::string_view name);

}  // namespace penumbra::obj
