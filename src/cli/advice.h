// What the user can do about an error, in the words of the command line: the library names none of
// its options.
#pragma once

#include "penumbra/error.h"

#include <string>

namespace penumbra::cli {

/// error.what(), and the option that may help.
std::string with_advice(const Error& error);

}  // namespace penumbra::cli
