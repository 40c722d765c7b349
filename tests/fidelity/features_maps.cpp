// Features: images that vary more than the colour of a surface.
#include "fidelity/features_stage.h"

namespace test {
namespace {

const std::string file = "picture.png";

// `shape` with one material; `dress` adds the images to it.
template <class Dress>
Feature mapped(const std::string& name, const std::string& image, const Shape& shape,
               Dress&& dress) {
    Gltf gltf = showing(shape, {{"pbrMetallicRoughness",
                                 {{"baseColorFactor", {0.8, 0.6, 0.4, 1}},
                                  {"metallicFactor", 0},
                                  {"roughnessFactor", 0.5}}}});
    dress(gltf, gltf.root["materials"][0]);
    Feature feature = staged(name, gltf, marked_stage());
    feature.files[file] = image;
    return feature;
}

Feature emission() {
    return mapped("emission map", png(), egg(), [](Gltf& gltf, json& material) {
        material["emissiveTexture"] = texture(gltf, file);
        material["emissiveFactor"] = {0.9, 0.6, 0.3};
    });
}

Feature metallic_roughness() {
    Feature feature =
        mapped("metallic-roughness map", png(), egg(), [](Gltf& gltf, json& material) {
            json& pbr = material["pbrMetallicRoughness"];
            pbr["metallicRoughnessTexture"] = texture(gltf, file);
            pbr["metallicFactor"] = pbr["roughnessFactor"] = 1;
        });
    feature.loss = "texture: mixed from";
    return feature;
}

Feature colored_metal() {
    Feature feature =
        mapped("colour and metallic-roughness maps", png(), egg(), [](Gltf& gltf, json& material) {
            json& pbr = material["pbrMetallicRoughness"];
            pbr["metallicRoughnessTexture"] = texture(gltf, file);
            pbr["baseColorTexture"] = pbr["metallicRoughnessTexture"];
            pbr["metallicFactor"] = 1;
            pbr["roughnessFactor"] = 0.8;
        });
    feature.loss = "texture: mixed from";
    return feature;
}

Feature normals() {
    Feature feature = mapped("normal map", normal_png(6), board(), [](Gltf& gltf, json& material) {
        material["normalTexture"] = texture(gltf, file);
        material["normalTexture"]["scale"] = 0.8;
    });
    feature.loss = "its normal map is baked into vertex normals";
    return feature;
}

Feature alpha(const std::string& name, const json& mode) {
    return mapped(name, png(4), board(), [&](Gltf& gltf, json& material) {
        material["pbrMetallicRoughness"]["baseColorTexture"] = texture(gltf, file);
        material.update(mode);
    });
}

// The emission lies by a second set of texture coordinates, which is the first one turned.
Feature two_sets() {
    return mapped("maps by two sets of texture coordinates", png(), board(3),
                  [](Gltf& gltf, json& material) {
                      std::vector<float> second;
                      const Shape shape = board(3);
                      for (std::size_t i = 0; i < shape.texcoords.size(); i += 2)
                          second.insert(second.end(), {0.4F * shape.texcoords[i + 1] + 0.1F,
                                                       0.2F - 0.4F * shape.texcoords[i]});
                      gltf.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
                          gltf.accessor("VEC2", second);
                      const json image = texture(gltf, file);
                      material["pbrMetallicRoughness"]["baseColorTexture"] = image;
                      material["emissiveTexture"] = image;
                      material["emissiveTexture"]["texCoord"] = 1;
                      material["emissiveFactor"] = {0.5, 0.4, 0.3};
                  });
}

Feature faded_vertices() {
    const Shape shape = egg();
    return mapped("alpha of vertices", png(), shape, [&](Gltf& gltf, json& material) {
        std::vector<float> colors;
        for (std::size_t i = 0; i < shape.vertices(); ++i)
            colors.insert(colors.end(), {1, 0.8F, 0.5F, 0.2F + 0.2F * float(i / 3 % 5)});
        gltf.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
            gltf.accessor("VEC4", colors);
        material["alphaMode"] = "BLEND";
        material["doubleSided"] = true;
    });
}

Feature mtl(const std::string& name, const std::string& values, const std::string& image,
            const std::string& loss = {}) {
    Feature feature = staged(name, obj_of(egg()), "newmtl look\n" + values, marked_stage());
    feature.files[file] = image;
    feature.loss = loss;
    return feature;
}

// Roughness from an image, colour from a factor.
Feature tinted_lobes() {
    Feature feature =
        mapped("roughness map and specular colour", png(), egg(), [](Gltf& gltf, json& material) {
            json& pbr = material["pbrMetallicRoughness"];
            pbr["metallicRoughnessTexture"] = texture(gltf, file);
            pbr["baseColorTexture"] = pbr["metallicRoughnessTexture"];
            const std::string extension = "KHR_materials_specular";
            gltf.root["extensionsUsed"].push_back(extension);
            material["extensions"][extension]["specularColorFactor"] = {4, 1, 0.2};
        });
    feature.loss = "texture: mixed from";
    return feature;
}

std::vector<Feature> mtl_maps() {
    const std::string highlight = "Ks 0.3 0.3 0.3\nNs 60\nillum 2\n";
    return {
        mtl("map_Kd, map_Ke",
            "Kd 0.5 0.7 0.6\nKe 0.8 0.7 0.6\nillum 1\nmap_Kd picture.png\n"
            "map_Ke -s 2 1 1 picture.png\n",
            png()),
        mtl("coloured Ks", "Kd 0.2 0.3 0.5\nKs 0.9 0.5 0.2\nNs 40\nillum 3\nmap_Kd picture.png\n",
            png(), "it becomes white in grazing light"),
        mtl("map_d", "Kd 0.8 0.5 0.3\n" + highlight + "map_d picture.png\n", png(1)),
        mtl("map_Pr", "Kd 0.9 0.6 0.3\nPm 1\nmap_Pr picture.png\n", png(1), "images: mixed from"),
        mtl("norm", "Kd 0.9 0.6 0.3\n" + highlight + "norm picture.png\n", normal_png(4),
            "its normal map is baked into vertex normals")};
}

}  // namespace

std::vector<Feature> map_features() {
    std::vector<Feature> all = {emission(),
                                metallic_roughness(),
                                colored_metal(),
                                tinted_lobes(),
                                normals(),
                                alpha("alpha mask", {{"alphaMode", "MASK"}, {"alphaCutoff", 0.55}}),
                                alpha("alpha blend", {{"alphaMode", "BLEND"}}),
                                faded_vertices(),
                                two_sets()};
    for (Feature& feature : mtl_maps()) all.push_back(std::move(feature));
    return all;
}

}  // namespace test
