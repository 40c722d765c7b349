// The strip of thumbnails of a case.
#pragma once

#include "penumbra/report.h"

namespace penumbra::html {

/// Both pictures and their FLIP errors side by side, each at most 144 x 108. Precondition: at least
/// one of the pictures has pixels.
Image thumbnails(const Case& one);

}  // namespace penumbra::html
