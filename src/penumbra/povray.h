// Runs POV-Ray.
#pragma once

#include "penumbra/error.h"
#include "penumbra/image.h"
#include "penumbra/watch.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

struct PovrayOptions {
    std::string binary = {};  ///< empty: PENUMBRA_POVRAY, else "povray" found in PATH
    int threads = 0;          ///< 0: as many as the machine has
    std::chrono::seconds timeout{600};
    std::size_t memory = 0;  ///< bytes that it may take; 0: memory_limit()
    bool keep_exr = true;    ///< keep the file that POV-Ray itself writes
};

struct PovrayRun {
    Image image = {};                       ///< its raw float32 pixels
    std::string log = {};                   ///< what it printed
    std::vector<std::string> command = {};  ///< the argument vector
    std::filesystem::path folder = {};      ///< where it ran
    double seconds = 0;                     ///< wall time
    double cpu_seconds = 0;                 ///< user + system
};

/// Runs POV-Ray on an .ini that write_pov() wrote, as a child process without a shell, in the
/// file's folder, and reads the pixels from its render-state file (EXR if there is none). The child
/// and its children are killed on time-out and on stop. Throws Error: povray, when it is missing,
/// fails, takes too long or too much memory, or leaves no picture of that size, and when the .ini
/// cannot be read or names no picture; output, when the folder cannot be written to; interrupted.
PovrayRun run_povray(const std::filesystem::path& ini, int width, int height,
                     const PovrayOptions& options = {}, const Watch& watch = {});

/// The first line of `povray --version`, such as "POV-Ray 3.7.0.10". Throws Error (povray) when it
/// is missing or says something else.
std::string povray_version(const PovrayOptions& options = {});

}  // namespace penumbra
