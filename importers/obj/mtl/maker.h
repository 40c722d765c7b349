// One MTL material under construction.
#pragma once

#include "importers/obj/mtl/map.h"
#include "importers/obj/mtl/tally.h"
#include "importers/obj/mtl/values.h"
#include "importers/shared/specular_lobes.h"

namespace penumbra::obj {

/// What metallic_roughness() knows of a surface.
struct MetallicRoughness {
    float metallic = 0, roughness = 1;
    float f0 = 0.04F;  ///< reflectance at normal incidence of what is not metal
};

/// Makes a Material of what an MTL file says, and says what of it is lost.
struct MaterialMaker {
    const MtlEntry& entry;
    const MtlValues& values;
    TextureReader& textures;
    LossTally& tally;
    Illumination illumination = Illumination::lamps;
    Material material = {};
    std::optional<MapImage> base = {};      ///< of map_Kd
    std::vector<std::string> handled = {};  ///< keys of maps

    // ---- mtl/material.cpp
    void make();
    int illum() const;
    bool is_pbr() const;
    void highlight();
    void phong();
    void constant();
    /// The part of Ka that is shown: none where an environment stands for it.
    float ambience() const { return illumination == Illumination::environment ? 0 : 0.1F; }
    void metallic_roughness();
    void mirror();
    void transparency();
    void filter(const Color& tf);
    void coat();

    // ---- mtl/images.cpp
    /// The image of the last statement with this key; none, and maybe a loss, if it cannot be had.
    std::optional<MapImage> image(std::string_view key);
    void color_image();
    void lay_base();
    void alpha_image();
    void emission_image();
    void normal_image();
    void specular_images();
    /// Makes the surface from images of metalness and roughness; false, and new numbers, if it is
    /// the same everywhere.
    bool lobe_images(MetallicRoughness& surface);
    /// Takes the mean of `source`, which is from `map`.
    void flatten(const std::optional<MapImage>& map, TexelSource& source, const char* why);
    void bake(LobeMaps& maps, const MapImage& frame, const MapImage& of_level);
    void name_other_maps();

    void note_loss(Loss::Kind kind, Index line, const std::string& what) {
        obj::note_loss(tally, entry, {kind, line, what});
    }
    bool opaque() const { return material.opacity == 1; }
};

}  // namespace penumbra::obj
