// What of a glTF file's materials has been made so far.
#pragma once

#include "image/texels.h"
#include "importers/shared/image_store.h"

#include "penumbra/scene.h"

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tinygltf {
struct Primitive;
}

namespace penumbra::gltf {

/// The images of one surface that bake_specular_lobes() made, for all materials with the same ones.
struct BakedLobes {
    Index scattered = no_index;         ///< into Scene::textures; none: the base colour stays
    SpecularLobes specular_lobes = {};  ///< without transforms
};

/// An image of a material that is laid by other texture coordinates than the first one.
struct OtherSet {
    int texcoord = 0;  ///< n of TEXCOORD_n
    ImageMap& (*map)(Material&) = nullptr;
};

/// A map from texture coordinates to others, as ImageMap::transform.
using Lookup = std::array<double, 6>;

/// A material whose OtherSets are looked up by the first texture coordinates.
struct Relaid {
    Index original = no_index, material = no_index;
    std::vector<Lookup> lookups = {};
};

/// Texture coordinates of a facet's corners, with v running up.
using LaidFacet = std::array<Vec2f, 3>;

/// A glTF material as one primitive shows it, without the parts of its images that others show.
struct Alone {
    int material = -1;
    const tinygltf::Primitive* primitive = nullptr;
};

/// What the materials have come to so far. What is said to be by glTF index is by that of `alone`
/// too, which is -2 - n for its n-th entry.
struct MaterialCache {
    std::map<int, Index> materials = {};   ///< by glTF index; -1: the default one
    std::map<int, Index> untextured = {};  ///< the same without images
    std::map<int, Index> one_set = {};     ///< the same with the images of the first TEXCOORD_n
    std::map<Index, Index> fading = {};    ///< by material: the same with an alpha map
    std::map<int, std::vector<OtherSet>> other_sets = {};  ///< by glTF index
    std::vector<Relaid> relaid = {};
    std::map<int, int> texcoords = {};  ///< n of TEXCOORD_n by glTF index; absent: no images
    std::map<std::string, Index> textures = {};  ///< by image, sampling and use
    std::map<std::string, BakedLobes> baked_lobes = {};
    ImageStore store = {};           ///< by number
    std::map<int, int> images = {};  ///< by texture: the one that can be read; -1: none
    std::map<std::string, TexelMask> shown = {};  ///< by material, texture and how it is laid
    /// The facets that wear a material, of all primitives or of one, by TEXCOORD_`texcoord`; none
    /// where that cannot be told.
    std::function<std::optional<std::vector<LaidFacet>>(const Alone& worn, int texcoord)> facets =
        {};
    std::vector<Alone> alone = {};
    std::map<const tinygltf::Primitive*, int> alone_on = {};  ///< into `alone`, as above
    std::map<int, bool> divided = {};  ///< by glTF index: it is read for each primitive alone
    /// The primitives that wear glTF material `material`.
    std::function<std::vector<const tinygltf::Primitive*>(int material)> wearers = {};
    std::map<std::pair<int, bool>, Color> means = {};  ///< by texture, and whether it is sRGB
};

}  // namespace penumbra::gltf
