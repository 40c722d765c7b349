// How the nodes of a glTF file stand at one instant, and what that does to their meshes.
#pragma once

#include "penumbra/importers.h"

#include <ImathQuat.h>

#include <compare>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::gltf {

struct Document;
struct Reader;

/// Where a node stands relative to its parent, and how far its mesh is morphed.
struct Stance {
    Vec3 translation = Vec3(0), scale = Vec3(1);
    Imath::Quatd rotation = {};  ///< unit
    std::vector<double> weights = {};

    /// glTF 2.0, section 3.5.3: scaled first, then turned, then moved.
    Matrix matrix() const;
};

struct Pose {
    std::vector<Matrix> world = {};                 ///< by node: node to world
    std::vector<std::vector<double>> weights = {};  ///< by node: of its mesh's morph targets
};

/// A glTF mesh as a node shows it.
struct Form {
    int mesh = 0, skin = -1;
    std::vector<double> weights = {};
    auto operator<=>(const Form&) const = default;
};

/// A Mesh of the Scene. With `posed` a skin has placed its vertices in the world; the node's
/// transform has no meaning for them (glTF 2.0, section 3.7.3.3).
struct ShownMesh {
    Index mesh = 0;
    bool posed = false;
};

// ---- gltf_pose.cpp ----------------------------------------------------------------------------

/// The pose that the Reader's options ask for. Throws Error (usage, input).
Pose read_pose(Reader& reader);

/// A quaternion made unit, x y z w; none if it has no length.
std::optional<Imath::Quatd> unit_quaternion(const double* xyzw);

/// The one of `names` that is meant by `wanted`, a name or, where none is called so, a number from
/// 0 on. Throws Error (usage) that names `what` there is ("animation").
std::size_t choose(const Document& document, const std::string& wanted,
                   std::vector<std::string> names, const std::string& what);

// ---- gltf_instances.cpp ------------------------------------------------------------------------

/// The instances that EXT_mesh_gpu_instancing makes of a node's mesh: each to the node's space.
/// None where the node has no such extension. Throws Error (input).
std::optional<std::vector<Matrix>> read_instances(const Reader& reader, int node);

// ---- gltf_animation.cpp -----------------------------------------------------------------------

/// Gives the nodes that an animation moves their stances at the time asked for, if one is.
/// Throws Error (usage, input).
void animate(Reader& reader, std::vector<Stance>& stances);

// ---- gltf_skin.cpp ----------------------------------------------------------------------------

/// The matrices that take vertices of a skin from the mesh to the world, by joint; none for skin
/// -1. Throws Error (input).
std::vector<Matrix> joint_matrices(const Reader& reader, int skin);

}  // namespace penumbra::gltf
