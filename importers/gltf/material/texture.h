// glTF textures -> Textures.
#pragma once

#include "image/texels.h"
#include "importers/gltf/material/used_texels.h"
#include "importers/gltf/reader/reader.h"

#include <functional>
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

/// Where the image is looked up: KHR_texture_transform for coordinates whose v runs up.
std::array<double, 6> transform_of(const TextureInfo& info);

/// The name and the sampling of glTF texture `index`, without samples.
Texture frame_of(const Reader& reader, int index);

/// Has the images of materials decoded ahead, in the order in which they will be asked for.
void expect_images(Reader& reader);

/// The decoded image of glTF texture `index`; none, and a loss, if it cannot be read. It stays as
/// ImageStore says.
const Raster* raster_of(Reader& reader, int index);

/// The Scene's texture for glTF texture `index`. Precondition: raster_of() gives its image.
Index read_texture(Reader& reader, int index, bool srgb);

/// A texture that `make` derives from that image; `use`, whose first word ends its name, and `srgb`
/// tell it from others.
Index derived_texture(Reader& reader, int index, const std::string& use, bool srgb,
                      const std::function<Raster()>& make);

/// The mean of a texture's RGB, linear; none, and a loss, if its image cannot be read.
std::optional<Color> texture_mean(Reader& reader, int index, bool srgb);

/// What tells the images and samplings of textures apart.
std::string key_of(const Reader& reader, int index);

}  // namespace penumbra::gltf
