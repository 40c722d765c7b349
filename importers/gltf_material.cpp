// glTF materials -> Materials.
#include "gltf_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::gltf {
namespace {

const tinygltf::Value* extension(const tinygltf::Material& material, const std::string& name) {
    const auto found = material.extensions.find(name);
    return found == material.extensions.end() ? nullptr : &found->second;
}

const tinygltf::Material& source_of(const Reader& reader, int index) {
    // glTF 2.0, section 3.7.2.1: what a primitive without a material has.
    static const tinygltf::Material standard;
    return index < 0 ? standard : reader.document.model.materials[std::size_t(index)];
}

Color color_of(const std::vector<double>& numbers) {
    return {float(numbers[0]), float(numbers[1]), float(numbers[2])};
}

// What of a material is read from one of two places: the core or
// KHR_materials_pbrSpecularGlossiness.
struct Base {
    std::vector<double> factor = {1, 1, 1, 1};
    TextureInfo texture = {};
};

Base base_of(const tinygltf::Material& source) {
    if (const auto* glossy = extension(source, "KHR_materials_pbrSpecularGlossiness"))
        return {numbers(*glossy, "diffuseFactor", {1, 1, 1, 1}),
                texture_info(*glossy, "diffuseTexture")};
    const auto& pbr = source.pbrMetallicRoughness;
    return {pbr.baseColorFactor,
            texture_info(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord,
                         pbr.baseColorTexture.extensions)};
}

// Reads one material and says what it leaves aside.
struct MaterialReader {
    Reader& reader;
    const tinygltf::Material& source;
    std::string pointer;

    void lose(const std::string& what) const { reader.lose(pointer, what); }
    float dielectric_f0() const;
    void surface(Material& material) const;
    void glossy_surface(Material& material, const tinygltf::Value& glossy) const;
    void emission(Material& material) const;
    void transparency(Material& material, double alpha) const;
};

// Reflectance at normal incidence: Schlick's F0 of KHR_materials_ior, scaled as
// KHR_materials_specular says.
float MaterialReader::dielectric_f0() const {
    double f0 = 0.04;
    if (const auto* ior = extension(source, "KHR_materials_ior")) {
        const double n = number(*ior, "ior", 1.5);
        f0 = std::pow((n - 1) / (n + 1), 2);
    }
    if (const auto* specular = extension(source, "KHR_materials_specular")) {
        const auto tint = numbers(*specular, "specularColorFactor", {1, 1, 1});
        const auto [least, most] = std::minmax_element(tint.begin(), tint.end());
        if (*least != *most) lose("specularColorFactor is replaced by its largest channel");
        f0 = std::min(f0 * *most, 1.0) * number(*specular, "specularFactor", 1);
        for (const char* texture : {"specularTexture", "specularColorTexture"})
            if (texture_info(*specular, texture).texture >= 0)
                lose(fmt::format("{} is ignored", texture));
    }
    return float(f0);
}

void MaterialReader::surface(Material& material) const {
    const auto& pbr = source.pbrMetallicRoughness;
    double metallic = pbr.metallicFactor, roughness = pbr.roughnessFactor;
    if (pbr.metallicRoughnessTexture.index >= 0) {
        // Roughness is in green and metalness in blue.
        if (const auto mean = texture_mean(reader, pbr.metallicRoughnessTexture.index, false)) {
            metallic *= double(mean->z);
            roughness *= double(mean->y);
        }
        lose(fmt::format("metallicRoughnessTexture is replaced by its mean: metallic {:.2f}, "
                         "roughness {:.2f}",
                         metallic, roughness));
    }
    set_metallic_roughness(material, float(metallic), float(roughness), dielectric_f0());
}

void MaterialReader::glossy_surface(Material& material, const tinygltf::Value& glossy) const {
    const auto specular = numbers(glossy, "specularFactor", {1, 1, 1});
    const auto [least, most] = std::minmax_element(specular.begin(), specular.end());
    if (*least != *most) lose("specularFactor is replaced by its largest channel");
    double f0 = *most, glossiness = number(glossy, "glossinessFactor", 1);
    const int texture = texture_info(glossy, "specularGlossinessTexture").texture;
    if (texture >= 0) {
        if (const auto mean = texture_mean(reader, texture, true))
            f0 *= double(std::max({mean->x, mean->y, mean->z}));
        lose("specularGlossinessTexture is replaced by its mean colour");
    }
    set_metallic_roughness(material, 0, float(1 - glossiness), float(f0));
}

void MaterialReader::emission(Material& material) const {
    if (source.emissiveFactor.size() == 3) material.emission = color_of(source.emissiveFactor);
    if (const auto* strength = extension(source, "KHR_materials_emissive_strength"))
        material.emission *= float(number(*strength, "emissiveStrength", 1));
    if (source.emissiveTexture.index < 0 || material.emission == Color(0)) return;
    // Where it cannot be read nothing shines, rather than everything.
    material.emission *=
        texture_mean(reader, source.emissiveTexture.index, true).value_or(Color(0));
    lose("emissiveTexture is replaced by its mean");
}

void MaterialReader::transparency(Material& material, double alpha) const {
    if (source.alphaMode == "OPAQUE") return;
    if (const auto* map = std::get_if<ImageMap>(&material.pattern);
        map != nullptr && has_transparency(reader.scene.textures[map->texture].raster))
        lose("the transparency in its base colour texture is ignored");
    else if (source.alphaMode == "MASK" && alpha < source.alphaCutoff)
        alpha = 0;
    if (source.alphaMode == "MASK" && alpha > 0) return;
    material.opacity = float(alpha);
    if (alpha > 0) return;
    material.specular = 0;
    material.reflection = Color(0);
}

// KHR_materials_unlit: the base colour whatever the light. As full ambience rather than as
// emission, which would leave out textures and vertex colours.
void make_unlit(Material& material) {
    material.ambient = Color(1);
    material.emission = Color(0);
    material.reflection = Color(0);
    material.diffuse = material.specular = material.metallic = 0;
}

}  // namespace

TextureUse base_texture_use(const Reader& reader, int index) {
    const auto made = reader.materials.find(index);
    const bool used =
        made != reader.materials.end() &&
        std::holds_alternative<ImageMap>(reader.scene.materials[made->second].pattern);
    if (!used) return {};
    const TextureInfo info = base_of(source_of(reader, index)).texture;
    TextureUse use = {.used = true, .texcoord = info.texcoord};
    if (info.transform == nullptr) return use;

    // KHR_texture_transform: scale, then rotate, then move. A positive angle turns u towards -v.
    const auto offset = numbers(*info.transform, "offset", {0, 0});
    const auto scale = numbers(*info.transform, "scale", {1, 1});
    const double angle = number(*info.transform, "rotation", 0);
    const double c = std::cos(angle), s = std::sin(angle);
    use.transformed = true;
    use.transform = {scale[0] * c, -scale[0] * s, scale[1] * s, scale[1] * c, offset[0], offset[1]};
    return use;
}

Index read_material(Reader& reader, int index) {
    if (const auto known = reader.materials.find(index); known != reader.materials.end())
        return known->second;
    const tinygltf::Material& source = source_of(reader, index);
    const MaterialReader read = {reader, source, fmt::format("/materials/{}", index)};

    Material material;
    material.name = index < 0             ? "default"
                    : source.name.empty() ? fmt::format("material{}", index)
                                          : source.name;
    const Base base = base_of(source);
    material.color = color_of(base.factor);
    material.ambient = Color(0.1F);
    if (base.texture.texture >= 0)
        if (const auto texture = read_texture(reader, base.texture.texture))
            material.pattern = ImageMap{.texture = *texture};

    const bool unlit = extension(source, "KHR_materials_unlit") != nullptr;
    if (unlit) {
        make_unlit(material);
    } else {
        if (const auto* glossy = extension(source, "KHR_materials_pbrSpecularGlossiness"))
            read.glossy_surface(material, *glossy);
        else
            read.surface(material);
        read.emission(material);
        if (source.normalTexture.index >= 0) read.lose("normalTexture is ignored");
        if (source.occlusionTexture.index >= 0) read.lose("occlusionTexture is ignored");
    }
    read.transparency(material, base.factor[3]);

    const Index made = Index(reader.scene.materials.size());
    reader.scene.materials.push_back(std::move(material));
    reader.materials.emplace(index, made);
    return made;
}

Index untextured(Reader& reader, Index material) {
    const auto [known, fresh] =
        reader.untextured.try_emplace(material, Index(reader.scene.materials.size()));
    if (fresh) {
        Material plain = reader.scene.materials[material];
        plain.pattern = std::monostate();
        reader.scene.materials.push_back(std::move(plain));
    }
    return known->second;
}

}  // namespace penumbra::gltf
