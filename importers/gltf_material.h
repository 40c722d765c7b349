// One glTF material under construction.
#pragma once

#include "gloss.h"
#include "gltf_texture.h"

namespace penumbra::gltf {

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

    Reader& reader;
    const tinygltf::Material& source;
    std::string pointer;
    bool textured = true;  ///< else without images, and nothing is said
    bool one_set = false;  ///< only images with the texture coordinates of the first one; only
                           ///< what that loses is said
    Material material = {};
    std::optional<int> texcoord = {};       ///< of the first image
    std::vector<OtherSet> other_sets = {};  ///< of images that have others
    Map base = {};
    double alpha = 1;
    double transmitted = 0;  ///< of the light that the surface does not reflect

    // ---- gltf_material.cpp
    void read();
    void read_base();
    void read_alpha();
    void cover(TexelSource texels);
    void lay_base();
    void read_emission();
    void read_normal();
    void name_the_rest();
    void make_unlit();

    // ---- gltf_polish.cpp
    void read_polish();
    double mean_metallic();
    double mean_roughness();
    /// The reflectance at normal incidence of what is not metal, without images.
    Color dielectric_f0() const;

    // ---- gltf_glass.cpp
    /// How much shines through; before the polish.
    void read_transmission();
    /// What becomes of it; after the polish.
    void read_volume();
    void read_clearcoat();

    // ---- for all
    const tinygltf::Value* extension(const std::string& name) const;
    bool opaque() const { return material.opacity == 1; }
    void lose(const std::string& what) const;
    /// What `info` refers to; where it cannot be laid `instead` says what happens ("is ignored").
    Map find(const TextureInfo& info, const std::string& name, const std::string& instead);
    /// Remembers the texture coordinates of an image that `member` returns.
    void note_set(const Map& map, ImageMap& (*member)(Material&));
    /// The mean of what `key` of an extension refers to, with a loss if that matters.
    Color mean_of(const tinygltf::Value& from, const std::string& key, bool srgb);
};

Color color_of(const std::vector<double>& numbers);

}  // namespace penumbra::gltf
