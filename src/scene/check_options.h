// What is asked of RenderOptions before anything is made with them.
#pragma once

#include "penumbra/render_options.h"

namespace penumbra {

/// Throws Error (usage) when there would be no picture: a side, the samples or the depth are less
/// than 1.
void check(const RenderOptions& options);

}  // namespace penumbra
