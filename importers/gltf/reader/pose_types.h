// How the nodes of a glTF file stand at one instant, and what that does to their meshes.
#pragma once

#include "penumbra/math.h"

#include <compare>
#include <vector>

namespace penumbra::gltf {

struct Pose {
    std::vector<Matrix> world = {};                 ///< by node: node to world
    std::vector<std::vector<double>> weights = {};  ///< by node: of its mesh's morph targets
};

/// A glTF mesh as a node shows it.
struct MeshKey {
    int mesh = 0, skin = -1;
    std::vector<double> weights = {};
    auto operator<=>(const MeshKey&) const = default;
};

/// A Mesh of the Scene. With `posed` a skin has placed its vertices in the world; the node's
/// transform has no meaning for them (glTF 2.0, section 3.7.3.3).
struct ShownMesh {
    Index mesh = 0;
    bool posed = false;
    Vec3 origin = Vec3(0);  ///< where its vertices are counted from: of what is posed in the world,
                            ///< else in the node's space
};

}  // namespace penumbra::gltf
