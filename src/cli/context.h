// The subcommands. Each returns the exit status of success or of a finding, and throws Error.
#pragma once

#include "cli/console.h"
#include "cli/options/arguments.h"
#include "cli/supervisor.h"

#include <stop_token>

namespace penumbra::cli {

enum ExitStatus : int {
    exit_success = 0,
    exit_different = 1,
    exit_usage = 2,
    exit_input = 3,
    exit_output = 4,
    exit_povray = 5,
    exit_not_comparable = 6,
    exit_internal = 70,
    exit_interrupted = 130,
};

/// The exit status of a program that ends with this failure.
int exit_status(Failure failure);

/// What every command works with.
struct Context {
    const Arguments& arguments;
    Console& console;
    std::stop_token stop;
    Progress* progress = nullptr;  ///< of a supervised batch
};

int render(const Context& context);
int export_scene(const Context& context);
int validate(const Context& context);
int compare(const Context& context);
int calibrate(const Context& context);
int info(const Context& context);

}  // namespace penumbra::cli
