// How a caller follows and stops long work.
#pragma once

#include <functional>
#include <stop_token>

namespace penumbra {

/// Passed to everything that takes long. When `stop` is requested the work ends within a fraction
/// of a second by throwing Error (interrupted).
struct Watch {
    /// Fraction in [0, 1]; one call at a time. render() first says 0, when its search trees stand.
    std::function<void(double done)> progress = {};
    std::stop_token stop = {};
};

}  // namespace penumbra
