#include "gltf_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace penumbra::gltf {
namespace {

// glTF 2.0, section 5.26 (sampler): without a filter the choice is ours.
struct Sampling {
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool bilinear = true;
};

Wrap wrap_of(int code) {
    switch (code) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE: return Wrap::clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT: return Wrap::mirror;
    default: return Wrap::repeat;
    }
}

Sampling sampling_of(const tinygltf::Model& model, const tinygltf::Texture& texture) {
    if (texture.sampler < 0) return {};
    const tinygltf::Sampler& sampler = model.samplers[std::size_t(texture.sampler)];
    return {.wrap_u = wrap_of(sampler.wrapS),
            .wrap_v = wrap_of(sampler.wrapT),
            .bilinear = sampler.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST};
}

// The images that a texture offers, the plain one first.
std::vector<int> candidates(const tinygltf::Texture& texture) {
    std::vector<int> images;
    if (texture.source >= 0) images.push_back(texture.source);
    const auto webp = texture.extensions.find("EXT_texture_webp");
    if (webp != texture.extensions.end()) {
        const int source = int(number(webp->second, "source", -1));
        if (source >= 0) images.push_back(source);
    }
    return images;
}

std::string image_name(const ImageSource& image, int index) {
    if (!image.name.empty()) return image.name;
    if (!image.uri.empty() && image.uri.size() < 256 && image.uri.find(':') == std::string::npos)
        return std::filesystem::path(image.uri).stem().string();
    return fmt::format("texture{}", index);
}

struct Picture {
    Raster raster = {};
    int image = -1;
};

std::optional<Picture> decode(Reader& reader, int texture_index) {
    const Document& document = reader.document;
    const auto images = candidates(document.model.textures[std::size_t(texture_index)]);
    std::string reason = "it has no image in a format that can be read";
    for (const int index : images) {
        const ImageSource& image = document.images[std::size_t(index)];
        try {
            const auto bytes = image_bytes(document, image, "");
            return Picture{decode_image(bytes, printable(image_name(image, index))), index};
        } catch (const Error& error) {
            reason = error.what();
        }
    }
    reader.lose(fmt::format("/textures/{}", texture_index), "the texture is left out: " + reason);
    return std::nullopt;
}

template <class T>
Color mean_of(const Raster& raster, bool srgb, double largest) {
    std::array<double, 3> sum = {};
    std::vector<float> linear;  // by 8-bit value
    for (int i = 0; i < 256; ++i) {
        const float value = float(i) / 255.0F;
        linear.push_back(srgb ? srgb_to_linear(value) : value);
    }
    const std::byte* at = raster.data.data();
    for (std::size_t i = 0; i < raster.texels();
         ++i, at += std::size_t(raster.channels) * sizeof(T))
        for (std::size_t c = 0; c < 3; ++c) {
            T sample;
            std::memcpy(&sample, at + (raster.channels >= 3 ? c : 0) * sizeof(T), sizeof sample);
            if constexpr (sizeof(T) == 1)
                sum[c] += double(linear[sample]);
            else if (srgb && largest > 1)
                sum[c] += double(srgb_to_linear(float(double(sample) / largest)));
            else
                sum[c] += double(sample) / largest;
        }
    const double n = double(raster.texels());
    return {float(sum[0] / n), float(sum[1] / n), float(sum[2] / n)};
}

template <class T>
bool any_below(const Raster& raster, T opaque) {
    const std::size_t channels = std::size_t(raster.channels);
    for (std::size_t i = 0; i < raster.texels(); ++i) {
        T alpha;
        std::memcpy(&alpha, raster.data.data() + (i * channels + channels - 1) * sizeof(T),
                    sizeof alpha);
        if (alpha < opaque) return true;
    }
    return false;
}

}  // namespace

double number(const tinygltf::Value& object, const std::string& key, double fallback) {
    if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsNumber()) return fallback;
    return object.Get(key).GetNumberAsDouble();
}

std::vector<double> numbers(const tinygltf::Value& object, const std::string& key,
                            std::vector<double> fallback) {
    if (!object.IsObject() || !object.Has(key)) return fallback;
    const tinygltf::Value& array = object.Get(key);
    if (array.ArrayLen() != fallback.size()) return fallback;
    for (std::size_t i = 0; i < fallback.size(); ++i)
        fallback[i] = array.Get(int(i)).GetNumberAsDouble();
    return fallback;
}

TextureInfo texture_info(int index, int texcoord, const tinygltf::ExtensionMap& extensions) {
    TextureInfo info = {.texture = index, .texcoord = texcoord};
    const auto transform = extensions.find("KHR_texture_transform");
    if (transform != extensions.end()) {
        info.transform = &transform->second;
        info.texcoord = int(number(transform->second, "texCoord", texcoord));
    }
    return info;
}

TextureInfo texture_info(const tinygltf::Value& extension, const std::string& key) {
    if (!extension.IsObject() || !extension.Has(key)) return {};
    const tinygltf::Value& value = extension.Get(key);
    TextureInfo info = {.texture = int(number(value, "index", -1)),
                        .texcoord = int(number(value, "texCoord", 0))};
    if (!value.Has("extensions") || !value.Get("extensions").Has("KHR_texture_transform"))
        return info;
    info.transform = &value.Get("extensions").Get("KHR_texture_transform");
    info.texcoord = int(number(*info.transform, "texCoord", info.texcoord));
    return info;
}

std::optional<Index> read_texture(Reader& reader, int index) {
    const tinygltf::Model& model = reader.document.model;
    const tinygltf::Texture& texture = model.textures[std::size_t(index)];
    const Sampling sampling = sampling_of(model, texture);
    const auto images = candidates(texture);
    const std::array<int, 4> key = {images.empty() ? -1 : images.front(), int(sampling.wrap_u),
                                    int(sampling.wrap_v), int(sampling.bilinear)};
    if (const auto known = reader.textures.find(key); known != reader.textures.end())
        return known->second;

    auto picture = decode(reader, index);
    if (!picture) return std::nullopt;
    const ImageSource& image = reader.document.images[std::size_t(picture->image)];
    const Index made = Index(reader.scene.textures.size());
    reader.scene.textures.push_back({.name = image_name(image, picture->image),
                                     .raster = std::move(picture->raster),
                                     .bilinear = sampling.bilinear,
                                     .wrap_u = sampling.wrap_u,
                                     .wrap_v = sampling.wrap_v});
    reader.textures.emplace(key, made);
    return made;
}

std::optional<Color> texture_mean(Reader& reader, int index, bool srgb) {
    const auto known = reader.means.find({index, srgb});
    if (known != reader.means.end()) return known->second;
    const auto picture = decode(reader, index);
    if (!picture || picture->raster.texels() == 0) return std::nullopt;
    Color mean(0);
    switch (picture->raster.depth) {
    case Depth::u8: mean = mean_of<std::uint8_t>(picture->raster, srgb, 255); break;
    case Depth::u16: mean = mean_of<std::uint16_t>(picture->raster, srgb, 65535); break;
    case Depth::f32: mean = mean_of<float>(picture->raster, srgb, 1); break;
    }
    return reader.means[{index, srgb}] = mean;
}

bool has_transparency(const Raster& raster) {
    if (raster.channels != 2 && raster.channels != 4) return false;
    switch (raster.depth) {
    case Depth::u8: return any_below<std::uint8_t>(raster, 255);
    case Depth::u16: return any_below<std::uint16_t>(raster, 65535);
    case Depth::f32: return any_below<float>(raster, 1);
    }
    return false;
}

}  // namespace penumbra::gltf
