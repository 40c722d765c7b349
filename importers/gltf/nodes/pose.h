// The nodes of a glTF file -> how they stand at one instant.
#pragma once

#include "importers/gltf/reader/pose_types.h"

#include "penumbra/importers.h"
#include "penumbra/math.h"

#include <ImathQuat.h>

#include <optional>
#include <string>
#include <vector>

namespace penumbra::gltf {

struct Document;
struct Reader;

/// Where a node stands relative to its parent, and how far its mesh is morphed.
struct Trs {
    Vec3 translation = Vec3(0), scale = Vec3(1);
    Imath::Quatd rotation = {};  ///< unit
    std::vector<double> weights = {};

    /// glTF 2.0, section 3.5.3: scaled first, then turned, then moved.
    Matrix matrix() const;
};

// ---- nodes/pose.cpp ---------------------------------------------------------------------------

/// The pose that the Reader's options ask for. Throws Error (usage, input).
Pose read_pose(Reader& reader);

/// A quaternion made unit, x y z w; none if it has no length.
std::optional<Imath::Quatd> unit_quaternion(const double* xyzw);

/// The one of `names` that is meant by `wanted`, a name or, where none is called so, a number from
/// 0 on. Throws Error (usage) that names `what` there is ("animation").
std::size_t choose(const Document& document, const std::string& wanted,
                   std::vector<std::string> names, const std::string& what);

// ---- nodes/instances.cpp ----------------------------------------------------------------------

/// The instances that EXT_mesh_gpu_instancing makes of a node's mesh: each to the node's space.
/// None where the node has no such extension. Throws Error (input).
std::optional<std::vector<Matrix>> read_instances(const Reader& reader, int node);

// ---- nodes/animation.cpp ----------------------------------------------------------------------

/// The animation that is asked for; none when no instant is, or when the file has none. Throws
/// Error (usage).
std::optional<std::size_t> chosen_animation(const Document& document, const ModelOptions& options);

/// Gives the nodes that an animation moves their Trs at the time asked for, if one is.
/// Throws Error (usage, input).
void animate(Reader& reader, std::vector<Trs>& transforms);

// ---- nodes/skin.cpp ---------------------------------------------------------------------------

/// The matrices that take vertices of a skin from the mesh to the world, by joint; none for skin
/// -1. Throws Error (input).
std::vector<Matrix> joint_matrices(const Reader& reader, int skin);

}  // namespace penumbra::gltf
