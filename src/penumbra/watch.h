// How a caller follows and stops long work.
#pragma once

#include <functional>
#include <stop_token>

namespace penumbra {

/// Passed to everything that takes long. When `stop` is requested the work ends within a fraction
/// of a second by throwing Error (interrupted).
struct Watch {
    std::function<void(double done)> progress = {};  ///< fraction in [0, 1]; one call at a time
    std::stop_token stop = {};
};

}  // namespace penumbra
