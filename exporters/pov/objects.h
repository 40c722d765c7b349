// Instances, spheres and planes -> the objects of a POV-Ray scene.
#pragma once

#include "exporters/pov/plan.h"

#include <cstddef>
#include <string>

namespace penumbra::pov {

bool is_drawn(const MeshPlan& mesh);

/// All objects, two for a surface that looks otherwise in mirrors, or that shows no backs and casts
/// their shadow.
std::string objects_text(const Plan& plan);

/// How many that are.
std::size_t object_count(const Plan& plan);

}  // namespace penumbra::pov
