// URI -> bytes.
#pragma once

#include "importers/shared/model_folders.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::gltf {

/// The bytes that `uri` stands for: a data: URI, or a file in `folders`. Throws Error (input).
std::vector<std::byte> fetch(const std::string& uri, const ModelFolders& folders,
                             const std::string& place);

/// Where the file is that `uri` means; none where it is a data: URI. Throws Error (input).
std::optional<std::filesystem::path> file_of(const std::string& uri, const ModelFolders& folders,
                                             const std::string& place);
/// The file that `uri` names; none for a data: URI, and where it may not be read.
std::optional<std::filesystem::path> named_file(const std::string& uri,
                                                const ModelFolders& folders);

}  // namespace penumbra::gltf
