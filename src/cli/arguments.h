// The command line -> plain values.
#pragma once

#include "penumbra/exporters.h"
#include "penumbra/importers.h"
#include "penumbra/validation.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::cli {

enum class Command { render, export_scene, validate, compare, info };

struct Arguments {
    Command command = Command::render;
    std::vector<std::filesystem::path> inputs = {};  ///< compare: the two pictures
    LoadOptions load = {};
    /// What the user typed for each of load.settings that is not from --set: "--camera Top".
    std::map<std::string, std::string> origins = {};

    std::optional<std::filesystem::path> output = {};  ///< -o
    std::optional<std::filesystem::path> report = {};  ///< folder
    PovStyle pov_style = PovStyle::standalone;
    int bits = 8;     ///< of an integer picture's channels
    int threads = 0;  ///< 0: as many as the machine has

    bool each = false;  ///< validate: every input is a scene of its own
    int jobs = 1;       ///< validate --each: scenes at once
    PovrayOptions povray = {};
    Limits limits = {};
    std::optional<Color> background = {};  ///< compare: for coverage

    bool json = false, quiet = false, verbose = false, strict = false;
    std::optional<bool> color = {};
    std::vector<std::string> words = {};  ///< the whole command line, "penumbra" first
};

/// Either what to do, or a text (help, version) to print instead.
struct Parsed {
    std::optional<Arguments> arguments = {};
    std::string text = {};
};

/// Reads the command line and the environment. Throws Error (usage).
Parsed parse(int argc, const char* const* argv);

}  // namespace penumbra::cli
