// Meshes -> the include file that declares them.
#pragma once

#include "exporters/pov/plan.h"

#include <string>

namespace penumbra::pov {

/// "Mesh_chair", the declaration of the mesh with that look.
std::string mesh_identifier(const Plan& plan, const MeshPlan& mesh, const Look& look);

/// FILE_geometry.inc, or that part of an include file; empty when the scene has no meshes.
std::string geometry_text(const Plan& plan);

}  // namespace penumbra::pov
