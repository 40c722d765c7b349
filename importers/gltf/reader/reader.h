// A Document on its way to a Scene: what its meshes, nodes and materials are read with.
#pragma once

#include "base/loss_tally.h"
#include "importers/gltf/document/document.h"
#include "importers/gltf/reader/material_cache.h"
#include "importers/gltf/reader/pose_types.h"

#include "penumbra/importers.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace penumbra::gltf {

/// " (in 3 primitives)"
std::string in_primitives(std::size_t count);

/// What reading has produced so far, and what of the file it came from.
struct Reader {
    const Document& document;
    Scene& scene;
    LossTally& losses;
    const ModelOptions& options;
    MaterialCache cache = {};
    Pose pose = {};                                         ///< of all nodes
    std::map<MeshKey, std::vector<ShownMesh>> meshes = {};  ///< one Mesh a primitive
    LossTally primitive_losses = LossTally(in_primitives);  ///< said after all others

    void note_loss(Loss::Kind kind, const std::string& pointer, const std::string& what) {
        losses.add_alone({kind, document.place(pointer), what});
    }
    /// The same sentence for several materials becomes one loss with their number.
    void note_loss_in_material(Loss::Kind kind, const std::string& pointer,
                               const std::string& what);
    /// The same sentence for several primitives becomes one loss.
    void note_loss_in_primitive(Loss::Kind kind, const std::string& pointer,
                                const std::string& what);
    /// `count` things, such as a "point", are ignored in a primitive; they are added up.
    void ignore_in_primitive(const std::string& pointer, const std::string& thing,
                             std::size_t count);
};

}  // namespace penumbra::gltf
