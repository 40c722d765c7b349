// Images of metalness, roughness and reflectance -> SpecularLobes.
#pragma once

#include "image/texels.h"
#include "scene/surface/metallic_roughness.h"

#include "penumbra/scene.h"

#include <vector>

namespace penumbra {

/// A surface in the terms of glTF 2.0, appendix B, all or some of them from images that are laid
/// over it in the same way.
struct LobeMaps {
    TexelSource base = {};       ///< colour
    TexelSource metallic = {};   ///< one channel
    TexelSource roughness = {};  ///< one channel
    TexelSource specular = {};   ///< reflectance of what is not metal, at normal incidence
    /// The reflectance that it would have if it were white; none: the largest channel of
    /// `specular`.
    std::optional<float> white = {};
    Illumination illumination = Illumination::lamps;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool bilinear = true;
    std::string place = {};  ///< for messages
};

/// Phong terms of such a surface. What is the same all over it has an empty image.
struct LobeImages {
    Raster scattered = {};  ///< sRGB; replaces the base colour, and K_D is 1
    Raster reflected = {};  ///< sRGB; for SpecularLobes::color
    Raster level = {};      ///< linear; for SpecularLobes::level
    std::vector<SpecularLobe> lobes = {};
};

/// Whether the surface is more than one roughness.
bool has_lobe_maps(const LobeMaps& maps);

/// Whether a metal of one roughness makes of its image of the base colour what no factor can: under
/// an environment the darker of two colours loses more.
bool dulls_base(const LobeMaps& maps);

/// The reflectance of what is not metal, if that is the same everywhere.
std::optional<DielectricReflectance> reflectance_of(const LobeMaps& maps);

/// Whether the base colour stays as it is, so that its image may be laid in another way.
bool keeps_base(const LobeMaps& maps);

/// The law of set_metallic_roughness(), texel by texel; the images have the larger size of those
/// given. Where nothing is metal and the reflectance is constant the base colour stays as it is,
/// with a K_D of 1 - reflectance, and a reflectance in colour tints the lobes.
LobeImages bake_specular_lobes(const LobeMaps& maps);

/// set_metallic_roughness() for one metalness and roughness. With `multiplied` an image or colours
/// of vertices multiply material.color: of a metal under an environment, whose law is not linear in
/// it, what they multiply is white.
void set_constant_lobes(Material& material, float metallic, float roughness,
                        const DielectricReflectance& dielectric, Illumination illumination,
                        bool multiplied);

/// Gives `material` specular lobes from there, its textures and transforms set. `scattered` takes
/// the place of the base colour, if it has a texture; else nothing is metal and `dielectric`
/// is the reflectance.
void lay_specular_lobes(Material& material, SpecularLobes specular_lobes, const ImageMap& scattered,
                        const DielectricReflectance& dielectric, Illumination illumination);

}  // namespace penumbra
