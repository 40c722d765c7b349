// What stands beside a .pov: its .ini and its textures.
#pragma once

#include "pov_plan.h"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::pov {

/// The options that make POV-Ray render stem.pov as the tracer does.
std::string ini_text(const RenderOptions& render, const std::string& stem);

/// Writes the textures in use below `folder` and appends their paths to `files`.
/// Throws Error (output).
void write_textures(const Plan& plan, const std::filesystem::path& folder,
                    std::vector<std::filesystem::path>& files);

}  // namespace penumbra::pov
