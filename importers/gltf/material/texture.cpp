#include "importers/gltf/material/texture.h"

#include "base/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

int extension_source(const tinygltf::Texture& texture, const char* extension) {
    const auto found = texture.extensions.find(extension);
    return found == texture.extensions.end() ? -1 : int(number(found->second, "source", -1));
}

// The images that a texture offers and that might be read, the preferred one first.
std::vector<int> candidates(const tinygltf::Texture& texture) {
    std::vector<int> images = {extension_source(texture, "EXT_texture_webp"),
                               extension_source(texture, "EXT_texture_avif"), texture.source};
    std::erase_if(images, [](int image) { return image < 0; });
    return images;
}

std::string image_name(const ImageSource& image, int index) {
    if (!image.name.empty()) return image.name;
    if (!image.uri.empty() && image.uri.size() < 256 && image.uri.find(':') == std::string::npos)
        return std::filesystem::path(image.uri).stem().string();
    return fmt::format("texture{}", index);
}

constexpr const char* ktx2 = "KTX2 images (KHR_texture_basisu) cannot be read";

// The KTX 2.0 specification, section 3.1: how such a file begins.
bool is_ktx2(const std::vector<std::byte>& file) {
    constexpr std::string_view start = "\xabKTX 20\xbb";
    return file.size() > start.size() && std::memcmp(file.data(), start.data(), start.size()) == 0;
}

Raster decode(const Document& document, int index) {
    const ImageSource& image = document.images[std::size_t(index)];
    const auto bytes = image_bytes(document, image, "");
    if (is_ktx2(bytes)) throw Error(Failure::input, "", ktx2);
    return decode_image(bytes, printable(image_name(image, index)));
}

// The image of a texture that can be read, decoded; -1, and a loss, if there is none.
int decode(Reader& reader, int texture_index) {
    const Document& document = reader.document;
    const auto& texture = document.model.textures[std::size_t(texture_index)];
    std::string reason = "it has no image in a format that can be read";
    if (extension_source(texture, "KHR_texture_basisu") >= 0) reason = ktx2;
    for (const int index : candidates(texture)) {
        const std::string name = std::to_string(index);
        try {
            if (reader.cache.store.find(reader.scene, name) == nullptr)
                reader.cache.store.add(name, decode(document, index));
            return index;
        } catch (const MemoryError& error) {
            throw MemoryError(Failure::input, document.place(fmt::format("/images/{}", index)),
                              error.what());
        } catch (const Error& error) {
            reason = error.what();
            if (index == extension_source(texture, "EXT_texture_avif"))
                reason = "its AVIF image (EXT_texture_avif) cannot be read here: " + reason;
        }
    }
    reader.note_loss(Loss::dropped, fmt::format("/textures/{}", texture_index),
                     "the texture is left out, grey stands for its colours: " + reason);
    return -1;
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

// glTF's v' = 1 - v: with u' = a u + c v + e and v' = b u + d v + f there, where scale comes first,
// then rotation, then offset. A positive angle turns u towards -v.
std::array<double, 6> transform_of(const TextureInfo& info) {
    if (info.transform == nullptr) return ImageMap().transform;
    const auto offset = numbers(*info.transform, "offset", {0, 0});
    const auto scale = numbers(*info.transform, "scale", {1, 1});
    const double angle = number(*info.transform, "rotation", 0);
    const double cos = std::cos(angle), sin = std::sin(angle);
    const double a = scale[0] * cos, b = -scale[0] * sin, c = scale[1] * sin, d = scale[1] * cos;
    return {a, -c, c + offset[0], -b, d, 1 - d - offset[1]};
}

std::string key_of(const Reader& reader, int index) {
    const tinygltf::Texture& texture = reader.document.model.textures[std::size_t(index)];
    const Sampling sampling = sampling_of(reader.document.model, texture);
    const auto images = candidates(texture);
    return fmt::format("{}:{}{}{}", images.empty() ? -1 : images.front(), int(sampling.wrap_u),
                       int(sampling.wrap_v), int(sampling.bilinear));
}

Texture frame_of(const Reader& reader, int index) {
    const tinygltf::Model& model = reader.document.model;
    const Sampling sampling = sampling_of(model, model.textures[std::size_t(index)]);
    const auto image = reader.cache.images.find(index);
    const int source = image == reader.cache.images.end() ? -1 : image->second;
    return {.name = source < 0 ? fmt::format("texture{}", index)
                               : image_name(reader.document.images[std::size_t(source)], source),
            .bilinear = sampling.bilinear,
            .wrap_u = sampling.wrap_u,
            .wrap_v = sampling.wrap_v};
}

void expect_images(Reader& reader) {
    const Document& document = reader.document;
    const auto expect = [&](int texture) {
        if (texture < 0) return;
        const auto images = candidates(document.model.textures[std::size_t(texture)]);
        if (images.empty()) return;
        reader.cache.store.expect(
            std::to_string(images.front()),
            [&document, image = images.front()] { return decode(document, image); });
    };
    for (const tinygltf::Material& material : document.model.materials) {
        expect(material.pbrMetallicRoughness.baseColorTexture.index);
        expect(material.pbrMetallicRoughness.metallicRoughnessTexture.index);
        expect(material.emissiveTexture.index);
        expect(material.normalTexture.index);
    }
}

const Raster* raster_of(Reader& reader, int index) {
    MaterialCache& cache = reader.cache;
    const auto known = cache.images.find(index);
    if (known != cache.images.end() && known->second < 0) return nullptr;
    if (known != cache.images.end())
        if (const Raster* raster = cache.store.find(reader.scene, std::to_string(known->second)))
            return raster;
    const int image = cache.images[index] = decode(reader, index);
    return image < 0 ? nullptr : cache.store.find(reader.scene, std::to_string(image));
}

Index read_texture(Reader& reader, int index, bool srgb) {
    MaterialCache& cache = reader.cache;
    const std::string key = key_of(reader, index) + (srgb ? " color" : " data");
    if (const auto known = cache.textures.find(key); known != cache.textures.end())
        return known->second;
    if (raster_of(reader, index) == nullptr)  // the file has changed meanwhile
        throw Error(Failure::input, reader.document.place(fmt::format("/textures/{}", index)),
                    "its image cannot be read again");
    Texture frame = frame_of(reader, index);
    frame.srgb = srgb;
    const std::string image = std::to_string(cache.images[index]);
    return cache.textures[key] = cache.store.place(reader.scene, image, std::move(frame));
}

Index derived_texture(Reader& reader, int index, const std::string& use, bool srgb,
                      const std::function<Raster()>& make) {
    const std::string key = key_of(reader, index) + ' ' + use;
    if (const auto known = reader.cache.textures.find(key); known != reader.cache.textures.end())
        return known->second;
    Texture texture = frame_of(reader, index);
    texture.name += '_' + use.substr(0, use.find(' '));
    texture.srgb = srgb;
    const auto image = reader.cache.images.find(index);
    MemoryClaim claim;
    if (image != reader.cache.images.end() && image->second >= 0)
        claim = MemoryClaim(raster_of(reader, index)->data.size(),
                            reader.document.place(fmt::format("/textures/{}", index)));
    texture.raster = make();
    reader.scene.textures.push_back(std::move(texture));
    return reader.cache.textures[key] = Index(reader.scene.textures.size() - 1);
}

std::optional<Color> texture_mean(Reader& reader, int index, bool srgb) {
    const auto known = reader.cache.means.find({index, srgb});
    if (known != reader.cache.means.end()) return known->second;
    const Raster* raster = raster_of(reader, index);
    if (raster == nullptr) return std::nullopt;
    return reader.cache.means[{index, srgb}] = mean_of({.raster = raster, .srgb = srgb});
}

}  // namespace penumbra::gltf
