// A cube map of radiance -> an equirectangular image.
#pragma once

#include "penumbra/image.h"
#include "penumbra/math.h"
#include "penumbra/scene.h"

#include <array>
#include <vector>

namespace penumbra::gltf {

/// Six square faces of one size: +x, -x, +y, -y, +z, -z.
struct LightCube {
    /// How the faces of a file stand, beside OpenGL's cube maps (OpenGL 4.6, table 8.19).
    struct Flip {
        bool columns = false, rows = false;
    };

    int size = 0;
    std::array<std::vector<Color>, 6> faces = {};
    Flip flip = {};

    /// The texel in a direction.
    const Color& at(const Vec3& direction) const;
};

/// The faces of `cube` turned over in the one way of four in which their edges meet best: writers
/// do not agree. Where several are equal, with their rows from the bottom.
void set_flip(LightCube& cube);

/// As Sky has it; each pixel is the mean of the directions in it, over area.
Texture equirectangular(const LightCube& cube, const std::string& name);

}  // namespace penumbra::gltf
