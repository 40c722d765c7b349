// Scene -> POV-Ray 3.7 scene description.
#pragma once

#include "penumbra/error.h"
#include "penumbra/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

enum class PovStyle {
    standalone,  ///< a scene to render
    include,     ///< the model alone, declared as an object, for a scene of one's own
};

struct PovOptions {
    PovStyle style = PovStyle::standalone;
    std::string source = {};   ///< for the header: the input files
    std::string command = {};  ///< for the header: the command line
    Losses losses = {};        ///< the importers', listed in the header beside the exporter's own
};

struct Exported {
    std::vector<std::filesystem::path> files = {};  ///< written, the .pov first
    Losses losses = {};  ///< what the Scene says that POV-Ray cannot (without PovOptions::losses)
};

/// Writes FILE.pov, FILE.ini (`povray FILE.ini`, run in the file's folder, renders the very picture
/// that render() makes), FILE_geometry.inc and FILE_textures/. The bytes depend on nothing but the
/// arguments. Files are written beside their targets and renamed.
/// PovStyle::include writes no .ini, no camera, no light and no settings. `file` must end in .pov,
/// or in .inc for PovStyle::include. Throws Error (output).
Exported write_pov(const NormalisedScene& scene, const RenderOptions& render,
                   const std::filesystem::path& file, const PovOptions& options = {});

/// What write_pov() would say is lost, without writing anything.
Losses pov_losses(const NormalisedScene& scene, const RenderOptions& render);

/// The text of the .pov alone, for tests; `stem` is FILE without .pov.
std::string pov_text(const NormalisedScene& scene, const RenderOptions& render,
                     const std::string& stem, const PovOptions& options = {});

}  // namespace penumbra
