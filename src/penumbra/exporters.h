// Scene -> scene descriptions of other renderers: POV-Ray 3.7, which draws the same picture, and
// Tachyon 0.99, which draws a similar one.
//
// Precondition of all that take a NormalisedScene, asserted: its defects() are none. They throw
// Error (usage) where the RenderOptions make no picture.
#pragma once

#include "penumbra/error.h"
#include "penumbra/prepare.h"
#include "penumbra/render_options.h"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

enum class PovStyle {
    standalone,  ///< a scene to render
    include,     ///< the model alone, declared as an object, for a scene of one's own
};

struct ExportOptions {
    /// Never written to, by whatever name: Imported::files.
    std::vector<std::filesystem::path> inputs = {};
    bool replace = false;  ///< files too that are there already and not from an export
    // Of POV-Ray's files only:
    PovStyle pov_style = PovStyle::standalone;
    std::string source = {};   ///< for the header: the input files
    std::string command = {};  ///< for the header: the command line
    Losses losses = {};        ///< the importers', listed in the header beside the exporter's own
};

struct Exported {
    std::vector<std::filesystem::path> files = {};    ///< written, that of the given name first
    std::vector<std::filesystem::path> removed = {};  ///< of an earlier export of that name
    /// What the Scene says that the format cannot (without ExportOptions::losses).
    Losses losses = {};
};

/// A format that export_scene() writes.
struct ExportFormat {
    std::string name = {};                     ///< "POV-Ray 3.7"
    std::vector<std::string> extensions = {};  ///< ".pov", the usual one first
};

/// All of them. Throws nothing.
std::vector<ExportFormat> export_formats();

/// Writes `scene` in the format that the extension of `file` names: write_pov() or write_tachyon().
/// Nothing is written where any of the files is an input or, without ExportOptions::replace, there
/// already and not from an export; images of an earlier export of that name that are no longer
/// needed are removed. Throws Error (usage: see RenderOptions; input: not enough memory; output,
/// also where check_export_file() does).
Exported export_scene(const NormalisedScene& scene, const RenderOptions& render,
                      const std::filesystem::path& file, const ExportOptions& options = {});

/// Says early whether export_scene() takes a file of this name. Throws Error (output) when no
/// format has its extension, when it is not one that ExportOptions::pov_style allows, and when it
/// is there and may not be replaced.
void check_export_file(const std::filesystem::path& file, const ExportOptions& options = {});

/// See export_scene(). Writes FILE.pov, FILE.ini (`povray FILE.ini`, run in the file's folder,
/// renders the very picture that render() makes), FILE_geometry.inc and FILE_textures/. The bytes
/// depend on nothing but the arguments. Files are written beside their targets and renamed.
/// PovStyle::include writes one file and FILE_textures/: no .ini, no camera, no light and no
/// settings; all that it declares carries FILE's name, so that several can be included in one
/// scene. `file` must end in .pov, or in .inc for PovStyle::include, in letters of
/// either case. Precondition:
/// defects(scene.scene).empty(). Throws Error (usage: see RenderOptions; input: not enough memory;
/// output).
Exported write_pov(const NormalisedScene& scene, const RenderOptions& render,
                   const std::filesystem::path& file, const ExportOptions& options = {});

/// What write_pov() would say is lost, without writing anything. Precondition: that of write_pov().
/// Throws Error (usage).
Losses pov_losses(const NormalisedScene& scene, const RenderOptions& render);

/// The text of the .pov alone, for tests; `stem` is FILE without .pov. Precondition: that of
/// write_pov(). Throws Error (usage).
std::string pov_text(const NormalisedScene& scene, const RenderOptions& render,
                     const std::string& stem, const ExportOptions& options = {});

/// See export_scene(). Writes FILE.dat and the images of its planes, FILE-<number>.ppm. The bytes
/// depend on nothing but the arguments; files are written beside their targets and renamed, the
/// .dat last. `tachyon FILE.dat -shade_phong`, run in the file's folder, draws a similar picture in
/// linear light: the same view, geometry, shadows and depth of recursion, each virtual source being
/// a light; the losses say what Tachyon lacks. Instances are written out. Precondition: that of
/// write_pov(). Throws Error (usage: see RenderOptions; output: also when `file` does not end in
/// .dat, and when Tachyon could not read the names of its images, more than 80 bytes).
Exported write_tachyon(const NormalisedScene& scene, const RenderOptions& render,
                       const std::filesystem::path& file, const ExportOptions& options = {});

}  // namespace penumbra
