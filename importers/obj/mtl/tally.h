// What materials lose.
#pragma once

#include "base/loss_tally.h"
#include "importers/obj/mtl/text.h"

#include <string>

namespace penumbra::obj {

/// What one material loses.
struct MtlLoss {
    Loss::Kind kind = Loss::dropped;
    Index line = 0;
    std::string what = {};
    std::string key = {};  ///< of a statement of which the first sentence is enough
};

/// Counts materials: the same sentence about several of them becomes one Loss, at the first.
void note_loss(LossTally& tally, const MtlEntry& entry, const MtlLoss& loss);

}  // namespace penumbra::obj
