// glTF textures -> Textures.
#pragma once

#include "gltf.h"

#include <optional>

namespace penumbra::gltf {

/// A reference to a texture, as materials and their extensions make it.
struct TextureInfo {
    int texture = -1;  ///< into Model::textures; -1: none
    int texcoord = 0;
    const tinygltf::Value* transform = nullptr;  ///< KHR_texture_transform
};

TextureInfo texture_info(int index, int texcoord, const tinygltf::ExtensionMap& extensions);
/// From the member `key` of an extension.
TextureInfo texture_info(const tinygltf::Value& extension, const std::string& key);

/// The numbers of an extension's member; `fallback` where it is absent.
double number(const tinygltf::Value& object, const std::string& key, double fallback);
std::vector<double> numbers(const tinygltf::Value& object, const std::string& key,
                            std::vector<double> fallback);

/// The Scene's texture for glTF texture `index`; none, and a loss, if no image of it can be read.
std::optional<Index> read_texture(Reader& reader, int index);

/// The mean of a texture's RGB, linear; none, and a loss, if no image of it can be read.
std::optional<Color> texture_mean(Reader& reader, int index, bool srgb);

/// True when some texel is not opaque.
bool has_transparency(const Raster& raster);

}  // namespace penumbra::gltf
