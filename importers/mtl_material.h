// One MTL material under construction.
#pragma once

#include "gloss.h"
#include "obj.h"

namespace penumbra::obj {

/// What metallic_roughness() knows of a surface.
struct Polished {
    float metallic = 0, roughness = 1;
    float f0 = 0.04F;  ///< reflectance at normal incidence of what is not metal
};

/// Makes a Material of what an MTL file says, and says what of it is lost.
struct MaterialMaker {
    const MtlEntry& entry;
    const MtlValues& values;
    TextureReader& textures;
    MaterialTally& tally;
    Material material = {};
    std::optional<MapImage> base = {};      ///< of map_Kd
    std::vector<std::string> handled = {};  ///< keys of maps

    // ---- mtl.cpp
    void make();
    int illum() const;
    bool is_pbr() const;
    void highlight();
    void phong();
    void constant();
    void metallic_roughness();
    void mirror();
    void transparency();
    void filter(const Color& tf);
    void coat();

    // ---- mtl_images.cpp
    /// The image of the last statement with this key; none, and maybe a loss, if it cannot be had.
    std::optional<MapImage> image(std::string_view key);
    void color_image();
    void lay_base();
    void coverage_image();
    void emission_image();
    void normal_image();
    void specular_images();
    /// Makes the surface from images of metalness and roughness; false, and new numbers, if it is
    /// the same everywhere.
    bool polish_images(Polished& polished);
    /// Takes the mean of `source`, which is from `map`.
    void flatten(const std::optional<MapImage>& map, TexelSource& source, const char* why);
    void bake(PolishMaps& maps, const MapImage& frame, const MapImage& of_level);
    void name_other_maps();

    void lose(Index line, const std::string& what) { tally.add(entry, line, what); }
    bool opaque() const { return material.opacity == 1; }
};

}  // namespace penumbra::obj
