// One glTF material under construction.
#pragma once

#include "importers/gltf/material/texture.h"
#include "importers/shared/specular_lobes.h"

#include <set>
#include <string>

namespace penumbra::gltf {

/// What reading a material for all of its primitives comes to.
struct Trial {
    std::vector<std::pair<Loss::Kind, std::string>> losses = {};  ///< not said yet
    bool averaged = false;  ///< images that one primitive may show a single value of
};

/// Reads one material and says what of it is lost. Its parts are read in the order of the members.
struct MaterialReader {
    /// A reference to a texture as the surface can have it.
    struct Map {
        enum class State { absent, unreadable, constant, laid };
        State state = State::absent;
        int texture = -1;
        int texcoord = 0;
        ImageMap laid = {};  ///< without its texture

        bool is_laid() const { return state == State::laid; }
    };

    /// What of a surface that is clear in places is read.
    enum class Look { whole, clear, scattering };

    Reader& reader;
    const tinygltf::Material& source;
    std::string pointer;
    int index = -1;                              ///< of the glTF material
    const tinygltf::Primitive* alone = nullptr;  ///< that wears it; none: all that do
    Trial* trial = nullptr;
    bool textured = true;  ///< else without images, and nothing is said
    bool one_set = false;  ///< only images with the texture coordinates of the first one; only
                           ///< what that loses is said
    Look look = Look::whole;
    bool all_metal = false;                 ///< of what scatters
    const TexelMask* clear_part = nullptr;  ///< of metallicRoughnessTexture, of what is clear
    std::set<std::string>* said = nullptr;  ///< of the material by its other look
    Material material = {};
    std::optional<int> texcoord = {};       ///< of the first image
    std::vector<OtherSet> other_sets = {};  ///< of images that have others
    Map base = {};
    double alpha = 1;
    float covered = 1;       ///< how much there is of the surface, by that alpha alone
    double transmitted = 0;  ///< of the light that the surface does not reflect
    float under_coat = 1;    ///< what a clear coat leaves of the light beneath it

    // ---- material/material.cpp
    void read();
    void read_base();
    void read_alpha();
    void read_sides();
    void cover(TexelSource texels);
    void lay_base();
    void read_emission();
    void read_normal();
    void name_the_rest();
    void make_unlit();

    // ---- material/blend.cpp
    /// Makes a surface with a Blend, if an image says where it is clear; else false.
    bool read_blend();
    MaterialReader part(Look of) const;

    // ---- material/metallic_roughness.cpp
    void read_metallic_roughness();
    /// Means over what the facets show.
    double mean_metallic();
    double mean_roughness();
    /// Whether any primitive that wears it has COLOR_0.
    bool has_vertex_colors() const;
    TexelSource metallic_roughness_source(int channel);
    /// What is reflected by what is not metal, without images.
    DielectricReflectance dielectric() const;

    // ---- material/transmission.cpp
    /// How much shines through; before the roughness.
    void read_transmission();
    /// What becomes of it; after the roughness.
    void read_volume();
    void name_clear();
    void read_sheen();
    bool has_thickness(const tinygltf::Value& volume);
    void read_diffuse_transmission();
    void read_transmitted_color(const tinygltf::Value& given);
    void read_clearcoat();

    // ---- for all
    const tinygltf::Value* extension(const std::string& name) const;
    bool opaque() const { return material.opacity == 1; }
    /// An image is replaced by one value, such as its mean.
    void note_mean(const std::string& what) const;
    void note_loss(Loss::Kind kind, const std::string& what) const;
    /// What `info` refers to; where it cannot be laid it is lost in the way `otherwise`: its mean
    /// is taken, or it is ignored.
    Map find(const TextureInfo& info, const std::string& name, Loss::Kind otherwise);
    /// The texels of a map's image that the facets show; nullptr: all, or who knows.
    const TexelMask* shown(int texture, int texcoord, const ImageMap& laid);
    /// `source` with these alone.
    TexelSource as_shown(TexelSource texels, const Map& map);
    /// Remembers the texture coordinates of an image that `member` returns.
    void note_set(const Map& map, ImageMap& (*member)(Material&));
    /// The mean of what `key` of an extension refers to, with a loss if that matters.
    Color mean_of(const tinygltf::Value& from, const std::string& key, bool srgb, int channel = 0);
};

Color color_of(const std::vector<double>& numbers);

}  // namespace penumbra::gltf
