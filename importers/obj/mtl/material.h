// MTL materials -> Materials.
#pragma once

#include "importers/obj/mtl/text.h"
#include "importers/shared/model_folders.h"

#include "penumbra/importers.h"

#include <string>
#include <vector>

namespace penumbra::obj {

/// Appends a material for each of `used`, the names in the model `file`.
void build_materials(const std::vector<Named>& used, const std::string& file,
                     const std::vector<MtlEntry>& entries, const ModelFolders& folders,
                     Illumination illumination, Imported& result);

}  // namespace penumbra::obj
