// Images of metalness, roughness and reflectance -> Gloss.
#pragma once

#include "texels.h"

#include <vector>

namespace penumbra {

/// A surface in the terms of glTF 2.0, appendix B, all or some of them from images that are laid
/// over it in the same way.
struct PolishMaps {
    TexelSource base = {};       ///< colour
    TexelSource metallic = {};   ///< one channel
    TexelSource roughness = {};  ///< one channel
    TexelSource specular = {};   ///< reflectance of what is not metal, at normal incidence
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool bilinear = true;
    std::string place = {};  ///< for messages
};

/// Phong terms of such a surface. What is the same all over it has an empty image.
struct PolishImages {
    Raster scattered = {};  ///< sRGB; replaces the base colour, and K_D is 1
    Raster reflected = {};  ///< sRGB; for Gloss::color
    Raster level = {};      ///< linear; for Gloss::level
    std::vector<Lobe> lobes = {};
};

/// Whether the surface is more than one polish.
bool has_polish_maps(const PolishMaps& maps);

/// Whether the base colour stays as it is, so that its image may be laid in another way.
bool keeps_base(const PolishMaps& maps);

/// The law of set_metallic_roughness(), texel by texel; the images have the larger size of those
/// given. Where nothing is metal and the reflectance is constant the base colour stays as it is,
/// with a K_D of 1 - reflectance.
PolishImages bake_polish(const PolishMaps& maps);

/// Gives `material` a gloss from there, its textures and transforms set. `scattered` takes the
/// place of the base colour, if it has a texture; else nothing is metal and `f0` is the
/// reflectance.
void lay_polish(Material& material, Gloss gloss, const ImageMap& scattered, float f0);

}  // namespace penumbra
