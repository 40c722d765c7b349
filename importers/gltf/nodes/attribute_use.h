// The accessor of an attribute or of a morph target -> numbers of vertices.
#pragma once

#include "importers/gltf/nodes/mesh.h"

#include <cstddef>
#include <string>

namespace penumbra::gltf {

/// An accessor that is used for an attribute or a morph target of it.
struct Use {
    const Part& part;
    std::string name, below;  ///< "NORMAL", "/targets/0/NORMAL"
    int index = -1;

    /// Checks its type, the type of its numbers (`delta`: of a morph target) and its count. Throws
    /// Error (input).
    void check(Types types, bool delta) const;
};

/// Says that its whole numbers should be marked as normalized, if so.
void note_unnormalized(const Use& use);

/// The numbers of an attribute or of a target, `width` of each vertex. Only positions must all be
/// finite: the others are repaired once they are morphed. Throws Error (input).
void read_use(const Use& use, const Elements& range, int width, float* out);

/// Puts `instead` in the place of what is not finite; of how many vertices it was something.
std::size_t replace_not_finite(float* numbers, std::size_t vertices, std::size_t width,
                               float instead);

/// Numbers of vertices: `width` of each that lie side by side, `stride` from one to the next.
struct Vertices {
    float* first;
    int width, stride;
};

/// Adds what the primitive's targets have for an attribute, by the key's weights. Throws Error
/// (input).
void morph(const Part& part, const std::string& name, const Elements& range, const Vertices& out);

}  // namespace penumbra::gltf
