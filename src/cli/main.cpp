// The program: command line -> one command -> exit status.
#include "cli/advice.h"
#include "cli/context.h"
#include "cli/interruption.h"
#include "cli/memory_bound.h"
#include "cli/options/parse.h"

#include "penumbra/image_module.h"

#include <tbb/global_control.h>

#include <exception>
#include <new>
#include <optional>

namespace penumbra::cli {

int exit_status(Failure failure) {
    switch (failure) {
    case Failure::usage: return exit_usage;
    case Failure::input: return exit_input;
    case Failure::output: return exit_output;
    case Failure::povray: return exit_povray;
    case Failure::interrupted: return exit_interrupted;
    }
    return exit_internal;
}

namespace {

int run(const Arguments& arguments, Console& console, Progress* progress) {
    const Interruption interruption;
    std::optional<tbb::global_control> limit;
    if (arguments.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(arguments.threads));
    const Context context = {arguments, console, interruption.token(), progress};
    switch (arguments.command) {
    case Command::render: return render(context);
    case Command::export_scene: return export_scene(context);
    case Command::validate: return validate(context);
    case Command::compare: return compare(context);
    case Command::calibrate: return calibrate(context);
    case Command::info: return info(context);
    }
    return exit_internal;
}

// Runs `work` and turns what it throws into a line and a status.
template <class Work>
int guarded(Console& console, Work work) {
    try {
        return work();
    } catch (const Error& error) {
        console.error(with_advice(error));
        return exit_status(error.failure);
    } catch (const std::bad_alloc&) {
        console.error(out_of_memory());
        return exit_input;
    } catch (const std::exception& error) {
        console.internal_error(error.what());
    } catch (...) {
        console.internal_error("unknown exception");
    }
    return exit_internal;
}

int program(int argc, const char* const* argv) {
    Parsed parsed;
    Console plain;
    const int status = guarded(plain, [&] {
        parsed = parse(argc, argv);
        if (!parsed.arguments) plain.result(parsed.text);
        return int(exit_success);
    });
    if (!parsed.arguments) return status;
    const Arguments& arguments = *parsed.arguments;
    bound_memory(arguments.max_memory);
    Console console({arguments.quiet, arguments.verbose, arguments.color});
    const auto whole = [&](Progress* progress) {
        const int ending = guarded(console, [&] { return run(arguments, console, progress); });
        wait_for_image_module();
        return ending;
    };
    const bool batch = arguments.command == Command::validate &&
                       (arguments.each || arguments.manifest.has_value());
    if (!batch) return whole(nullptr);
    return guarded(console, [&] {
        Progress progress;
        return supervise(progress, [&] { return whole(&progress); });
    });
}

}  // namespace
}  // namespace penumbra::cli

int main(int argc, char** argv) { return penumbra::cli::program(argc, argv); }
