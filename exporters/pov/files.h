// What stands beside a .pov: its .ini and its textures.
#pragma once

#include "exporters/pov/plan.h"

#include "penumbra/exporters.h"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::pov {

/// Throws Error (output) unless a file of this style may have this name.
void check_name(const std::filesystem::path& file, PovStyle style);

/// The options that make POV-Ray render the file of that stem and extension as the tracer does.
std::string ini_text(const RenderOptions& render, const std::string& stem,
                     const std::string& extension);

/// The samples that are written to the texture's file: RGB, no grey, no alpha.
Raster baked(const Texture& texture, const TextureFile& file);

/// The files of the textures in use below `folder`, each once.
std::vector<std::filesystem::path> texture_files(const Plan& plan,
                                                 const std::filesystem::path& folder);

/// All files that an export to `file` writes.
std::vector<std::filesystem::path> target_files(const Plan& plan, const std::filesystem::path& file,
                                                PovStyle style);

/// Writes the textures and appends their paths to `files`. Throws Error (output).
void write_textures(const Plan& plan, const std::filesystem::path& folder,
                    std::vector<std::filesystem::path>& files);

/// Removes those of an earlier export of that name, unless an export of the same stem but with
/// another extension than `file` may need them. Returns the files.
std::vector<std::filesystem::path> remove_old_textures(const Plan& plan,
                                                       const std::filesystem::path& file,
                                                       const ExportOptions& options);

}  // namespace penumbra::pov
