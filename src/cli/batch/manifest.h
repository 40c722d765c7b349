// A list of scenes to validate: models x sidecars x cameras.
#pragma once

#include "cli/options/arguments.h"

namespace penumbra::cli {

/// One scene of a manifest.
struct ManifestCase {
    std::string name = {};
    std::vector<std::filesystem::path> inputs = {};
    LoadOptions load = {};
    Judging judging = {};
};

/// Reads a manifest (docs/validation.md). What it does not set is as `arguments` says. Paths are
/// relative to the manifest. Throws Error (input).
std::vector<ManifestCase> read_manifest(const std::filesystem::path& file,
                                        const Arguments& arguments);

}  // namespace penumbra::cli
