// What the command line says, as plain values.
#pragma once

#include "penumbra/compare.h"
#include "penumbra/exporters.h"
#include "penumbra/importers.h"
#include "penumbra/povray.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::cli {

enum class Command { render, export_scene, validate, compare, calibrate, info };

/// A further renderer: what --renderer says.
struct OtherRenderer {
    std::string name = {};
    std::vector<std::string> words = {};  ///< with {pov}, {scene}, {out}, {width}, {height} in them
};

/// How pictures are compared: what a manifest may set for a case of its own.
struct Judging {
    Limits limits = {};
    std::optional<std::filesystem::path> mask = {};
    std::vector<PixelBox> ignored = {};
    int shift_tolerance = 0;
};

struct Arguments {
    Command command = Command::render;
    /// compare: two pictures or folders; calibrate: pairs of them.
    std::vector<std::filesystem::path> inputs = {};
    LoadOptions load = {};
    /// What the user typed for each of load.settings that is not from --set: "--camera Top".
    std::map<std::string, std::string> origins = {};

    std::optional<std::filesystem::path> output = {};  ///< -o
    std::optional<std::filesystem::path> report = {};  ///< folder
    PovStyle pov_style = PovStyle::standalone;
    int bits = 8;  ///< of an integer picture's channels
    bool resume = false;
    bool force = false;              ///< over files that are there and not from an earlier run
    double checkpoint_interval = 5;  ///< seconds; 0: none
    int threads = 0;                 ///< 0: as many as the machine has
    std::size_t max_memory = 0;      ///< bytes; 0: three quarters of what is free

    bool each = false;   ///< validate: every input is a scene of its own
    bool fresh = false;  ///< validate: nothing is taken from an earlier run
    int jobs = 1;        ///< cases at once
    std::optional<std::filesystem::path> manifest = {};
    PovrayOptions povray = {};
    std::vector<OtherRenderer> renderers = {};
    Judging judging = {};
    std::optional<Color> background = {};  ///< compare: for coverage
    double exposure = 0;                   ///< compare: EV, of both pictures
    bool ignore_alpha = false;             ///< compare, calibrate: colours alone
    double margin = 1.5;                   ///< calibrate: allowed error over that of the worst pair

    bool json = false, markdown = false, quiet = false, verbose = false, strict = false;
    std::optional<bool> color = {};
    std::vector<std::string> words = {};  ///< the whole command line, "penumbra" first
};

}  // namespace penumbra::cli
