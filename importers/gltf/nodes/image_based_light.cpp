#include "importers/gltf/nodes/image_based_light.h"

#include "base/memory.h"
#include "image/texels.h"
#include "importers/gltf/material/texture.h"
#include "importers/gltf/nodes/light_cube.h"
#include "importers/gltf/nodes/pose.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra::gltf {

namespace {

constexpr const char* extension = "EXT_lights_image_based";

const tinygltf::Value* member(const tinygltf::ExtensionMap& extensions, const char* key) {
    const auto found = extensions.find(extension);
    if (found == extensions.end() || !found->second.Has(key)) return nullptr;
    return &found->second.Get(key);
}

// The specification, "RGBD": of a PNG with alpha the colours, once linear, are divided by it.
std::vector<Color> radiance(const Raster& raster) {
    const TexelReader colors({.raster = &raster, .srgb = true});
    const TexelReader divisors({.raster = &raster, .channel = 3, .single = true});
    std::vector<Color> result;
    result.reserve(raster.texels());
    for (int y = 0; y < raster.height; ++y)
        for (int x = 0; x < raster.width; ++x) {
            const float divisor =
                raster.channels == 4 ? std::max(divisors.value(x, y), 1 / 255.0F) : 1;
            result.push_back(colors.color(x, y) / divisor);
        }
    return result;
}

// `claim` is for what it holds. Throws Error (input).
LightCube cube_of(const Reader& reader, const tinygltf::Value& faces, MemoryClaim& claim) {
    if (faces.ArrayLen() != 6)
        throw Error(Failure::input, "", "its first cube map must have 6 faces");
    LightCube cube;
    for (std::size_t i = 0; i < 6; ++i) {
        const auto index = std::size_t(faces.Get(int(i)).GetNumberAsInt());
        const auto bytes = image_bytes(reader.document, reader.document.images[index], "");
        const Raster raster = decode_image(bytes, fmt::format("image {}", index));
        if (raster.width != raster.height || (i > 0 && raster.width != cube.size))
            throw Error(Failure::input, "",
                        "the faces of its cube map must be squares of one size");
        if (i == 0) claim = MemoryClaim(6 * raster.texels() * sizeof(Color), "image-based light");
        cube.size = raster.width;
        cube.faces[i] = radiance(raster);
    }
    set_flip(cube);
    return cube;
}

}  // namespace

void read_image_based_light(Reader& reader, const tinygltf::Scene& scene) {
    const tinygltf::Value* index = member(scene.extensions, "light");
    const tinygltf::Value* lights = member(reader.document.model.extensions, "lights");
    if (index == nullptr || lights == nullptr) return;
    const tinygltf::Value& light = lights->Get(index->GetNumberAsInt());
    const std::string pointer =
        fmt::format("/extensions/{}/lights/{}", extension, index->GetNumberAsInt());
    try {
        if (!light.Has("specularImages") || light.Get("specularImages").ArrayLen() == 0)
            throw Error(Failure::input, "", "it has no cube map");
        const std::string name = light.Has("name") ? light.Get("name").Get<std::string>()
                                                   : std::string("image-based light");
        MemoryClaim claim;
        const LightCube cube = cube_of(reader, light.Get("specularImages").Get(0), claim);
        Scene& to = reader.scene;
        to.textures.push_back(equirectangular(cube, name));
        Environment& environment = set_environment(to, Index(to.textures.size() - 1), name);
        environment.intensity = number(light, "intensity", 1);
        const std::vector<double> turn = numbers(light, "rotation", {0, 0, 0, 1});
        if (const auto rotation = unit_quaternion(turn.data()))
            environment.rotation = rotation->toMatrix44();
    } catch (const MemoryError& error) {
        throw MemoryError(Failure::input, reader.document.place(pointer), error.what());
    } catch (const Error& error) {
        reader.note_loss(Loss::dropped, pointer,
                         fmt::format("the light is left out: {}", error.what()));
    }
}

}  // namespace penumbra::gltf
