// The command line -> plain values.
#pragma once

#include "cli/options/arguments.h"

#include <optional>
#include <string>

namespace penumbra::cli {

/// Either what to do, or a text (help, version) to print instead.
struct Parsed {
    std::optional<Arguments> arguments = {};
    std::string text = {};
};

/// Reads the command line and the environment. Throws Error (usage).
Parsed parse(int argc, const char* const* argv);

}  // namespace penumbra::cli
