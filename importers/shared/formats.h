// The formats of models, in one table: a new one is a reader, a line in formats.cpp and its tests.
#pragma once

#include "penumbra/importers.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// True for a file that read_model() can read, by its extension.
bool is_model(const std::filesystem::path& file);

/// Reads a model in the format of its extension. Throws Error (input, usage), as the readers do.
/// Precondition: is_model(file).
Imported read_model(const std::filesystem::path& file, const ModelOptions& options);

/// The extensions of all formats.
std::vector<std::string> model_extensions();

/// ".gltf, .glb and .obj" with "and" for `last`. Precondition: `words` is not empty.
std::string listed(const std::vector<std::string>& words, std::string_view last);

}  // namespace penumbra
