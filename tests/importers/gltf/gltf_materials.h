// Small glTF files with one material, and pictures for them.
#pragma once

#include "importers/gltf/gltf_builder.h"

namespace test {

/// A triangle with texture coordinates and one material.
inline Gltf with_material(const json& material) {
    Gltf gltf = triangle();
    json& primitive = gltf.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] =
        gltf.accessor("VEC2", std::vector<float>{0, 0, 1, 0, 0, 0.25F});
    primitive["material"] = gltf.add("materials", material);
    return gltf;
}

inline penumbra::Material material_of(const json& material) {
    return read(with_material(material)).scene.materials.at(0);
}

inline json png_image(const std::string& png) {
    return {{"uri", "data:image/png;base64," + base64(png)}};
}

/// Two texels, the left one `left` and the right one black.
inline json picture(const penumbra::Color& left) {
    penumbra::Image image(2, 1);
    image.at(0, 0) = left;
    const auto png = encode_png(image);
    return png_image({reinterpret_cast<const char*>(png.data()), png.size()});
}

/// A row of texels, `channels` samples each; the same rows again up to `height`.
inline json pixels(int channels, const std::vector<int>& samples, int height = 1) {
    const TempDir folder;
    penumbra::Raster raster = {
        .width = int(samples.size()) / channels, .height = height, .channels = channels};
    for (int row = 0; row < height; ++row)
        for (const int sample : samples) raster.data.push_back(std::byte(sample));
    save_raster(folder / "a.png", raster);
    return png_image(read(folder / "a.png"));
}

/// The samples of a scene's texture.
inline std::vector<int> samples_of(const penumbra::Scene& scene, penumbra::Index texture) {
    std::vector<int> result;
    for (const std::byte sample : scene.textures.at(texture).raster.data)
        result.push_back(std::to_integer<int>(sample));
    return result;
}

}  // namespace test
