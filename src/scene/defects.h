// Which rules a part of a scene breaks, also before it is complete: for preconditions.
#pragma once

#include "penumbra/scene.h"

namespace penumbra {

/// What defects() finds in the materials and meshes.
std::vector<std::string> surface_defects(const Scene& scene);

/// What defects() finds in `camera`.
std::vector<std::string> camera_defects(const Camera& camera);

/// What defects() finds in the environment, and in what makes lights of it: images and cameras.
std::vector<std::string> environment_defects(const Scene& scene);

/// Has every facet its vertices, and every instance its mesh?
bool indices_in_range(const Mesh& mesh);
bool indices_in_range(const Scene& scene);

/// Has also everything its material?
bool all_indices_in_range(const Scene& scene);

}  // namespace penumbra
