// glTF materials -> Materials.
#pragma once

#include "penumbra/math.h"

namespace tinygltf {
struct Primitive;
}

namespace penumbra::gltf {

struct Reader;

/// Which texture coordinates a material's images are laid by; all of them have the same ones.
struct TextureUse {
    bool used = false;
    int texcoord = 0;  ///< TEXCOORD_n
};

/// What the functions below call glTF material `index` on a primitive that wears it: `index`, or
/// the number of one of its own where all primitives together would show the mean of an image.
int material_on(Reader& reader, int index, const tinygltf::Primitive& primitive);

/// The Scene's material for glTF material `index`, made on first use.
Index read_material(Reader& reader, int index);

/// What the images need that read_material() gave to glTF material `index`.
TextureUse texture_use(const Reader& reader, int index);

/// glTF material `index` without its images.
Index untextured(Reader& reader, int index);

/// glTF material `index` without the images that are laid by other texture coordinates than the
/// first one.
Index with_one_set(Reader& reader, int index);

}  // namespace penumbra::gltf
