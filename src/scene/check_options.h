// What is asked of RenderOptions before anything is made with them.
#pragma once

#include "penumbra/render_options.h"

namespace penumbra {

/// POV-Ray's limit.
inline constexpr int most_antialias_depth = 9;

/// Throws Error (usage) when there would be no picture: a side, the samples or the depth are less
/// than 1, or anti-aliasing has no such threshold or depth.
void check(const RenderOptions& options);

}  // namespace penumbra
