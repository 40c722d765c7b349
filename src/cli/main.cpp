// The program: command line -> one command -> exit status.
#include "commands.h"
#include "interruption.h"

#include <exception>
#include <new>

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

int run(const Arguments& arguments, Console& console) {
    const Interruption interruption;
    const Context context = {arguments, console, interruption.token()};
    switch (arguments.command) {
    case Command::render: return render(context);
    case Command::export_scene: return export_scene(context);
    case Command::validate: return validate(context);
    case Command::compare: return compare(context);
    case Command::info: return info(context);
    }
    return exit_internal;
}

struct Ending {
    int status = exit_success;
    std::string message = {};
};

// Runs `work` and turns what it throws into a message and a status.
template <class Work> Ending ending_of(Work work) {
    const auto internal = [](const std::string& what) {
        return Ending{exit_internal, "internal error: " + what};
    };
    try {
        return {work()};
    } catch (const Error& error) {
        return {exit_status(error.failure), std::string("error: ") + error.what()};
    } catch (const std::bad_alloc&) {
        return internal("not enough memory");
    } catch (const std::exception& error) {
        return internal(error.what());
    } catch (...) {
        return internal("unknown exception");
    }
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
    Console console({arguments.quiet, arguments.verbose, arguments.color});
    return guarded(console, [&] { return run(arguments, console); });
}

}  // namespace
}  // namespace penumbra::cli

int main(int argc, char** argv) { return penumbra::cli::program(argc, argv); }
