// Model -> meshes.
#pragma once

#include "importers/obj/parse.h"

#include "penumbra/scene.h"

namespace penumbra::obj {

// ---- normals.cpp ------------------------------------------------------------------------------

/// Gives corners without a normal that of their smoothing group, and takes unusable ones away;
/// what is left without one (no_index) is flat.
void resolve_normals(Model& model, Tally& tally);

// ---- mesh.cpp ---------------------------------------------------------------------------------

/// Appends one mesh and instance per part. The scene's materials go with Model::materials.
void build_meshes(Model model, Scene& scene, Tally& tally);

}  // namespace penumbra::obj
