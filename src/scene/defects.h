// Which rules a scene breaks before it is complete.
#pragma once

#include "penumbra/scene.h"

namespace penumbra {

/// What defects() finds in the materials and meshes.
std::vector<std::string> surface_defects(const Scene& scene);

}  // namespace penumbra
