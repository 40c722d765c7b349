#include "cli/advice.h"

namespace penumbra::cli {
namespace {

const char* advice(const Error& error) {
    switch (error.remedy) {
    case Remedy::none: break;
    case Remedy::memory:
        return error.failure == Failure::povray ? " (allow it more with --max-memory)"
                                                : " (raise it with --max-memory)";
    case Remedy::time: return " (allow it more with --timeout)";
    case Remedy::program:
        return " (install the package povray, or name it with --povray or PENUMBRA_POVRAY)";
    case Remedy::restart:
        return "; repeat it as it was, start anew without --resume, or remove the checkpoint";
    case Remedy::replace: return " (or replace it with --force)";
    case Remedy::resume: return "; --resume goes on from its checkpoint";
    }
    return "";
}

}  // namespace

std::string with_advice(const Error& error) { return std::string(error.what()) + advice(error); }

}  // namespace penumbra::cli
