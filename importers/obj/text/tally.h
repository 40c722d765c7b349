// What of an OBJ file is left out.
#pragma once

#include "base/loss_tally.h"

#include "penumbra/math.h"

#include <string>

namespace penumbra::obj {

/// "chair.obj:7"
std::string place_of(const std::string& file, Index line);

/// What an OBJ file loses, by its lines. Beyond a thousand sentences all others are one.
struct Tally {
    std::string file = {};
    LossTally losses = LossTally(LossTally::times, 1000);

    /// `line` 0: the file as a whole.
    void add(Loss::Kind kind, const std::string& what, Index line) {
        if (!losses.add_again(what)) losses.add({kind, place_of(file, line), what});
    }
};

}  // namespace penumbra::obj
