// What lies over or under the roughness: transmission, volume, clear coat, sheen.
#include "importers/gltf/material/material_reader.h"
#include "scene/surface/metallic_roughness.h"

#include <algorithm>
#include <cmath>

namespace penumbra::gltf {
namespace {

constexpr double visibly_rough = 0.1;
constexpr float unreadable_grey = 0.5F;
constexpr float darkest_absorption = 1e-4F;
constexpr double coat_f0 = 0.04;  // KHR_materials_clearcoat: ior 1.5

}  // namespace

// KHR_materials_transmission: of the light that is neither reflected nor a metal's, the part t goes
// on, tinted by the base colour, and only the rest is scattered. With an alpha a below 1 light also
// passes untinted: behind = (1 - a) + a t P, which is (1 - opacity) (1 - T + T P).
void MaterialReader::read_transmission() {
    const auto* given = extension("KHR_materials_transmission");
    if (given == nullptr || look == Look::scattering) return;
    const double factor = number(*given, "transmissionFactor", 0);
    if (factor == 0) return;
    const double mean =
        look == Look::clear ? 1 / factor : double(mean_of(*given, "transmissionTexture", false).x);
    transmitted = std::clamp(factor * mean * (1 - mean_metallic()), 0.0, 1.0);
    if (transmitted == 0) return;
    const double a = double(material.opacity);
    material.opacity = float(a * (1 - transmitted));
    material.transmission = float(a * transmitted / (1 - a * (1 - transmitted)));
}

void MaterialReader::name_clear() {
    if (transmitted > 0 && mean_roughness() > visibly_rough &&
        (look == Look::clear || !frosts(material)))
        note_loss(Loss::approximated,
                  "transmission is approximate: a rough surface is shown as clear");
}

// The thickness is that of the body: all that its image can tell is where there is none.
bool MaterialReader::has_thickness(const tinygltf::Value& volume) {
    if (number(volume, "thicknessFactor", 0) <= 0) return false;
    const TextureInfo info = texture_info(volume, "thicknessTexture");
    if (!textured || info.texture < 0) return true;
    Map map = {.texture = info.texture, .texcoord = info.texcoord};
    map.laid.transform = transform_of(info);
    const TexelSource texels =
        as_shown({.raster = raster_of(reader, info.texture), .channel = 1, .single = true}, map);
    const auto [least, most] = range_of(texels);
    if (least <= 0 && most > 0)
        note_mean("thicknessTexture is taken as nowhere 0: a surface is a pane or the outside of a "
                  "body as a whole");
    return most > 0;
}

// KHR_materials_volume: a surface without thickness is a pane, which does not bend the light, and
// keeps the reflection of its material; others are the outside of a body.
void MaterialReader::read_volume() {
    const auto* given = extension("KHR_materials_volume");
    if (given == nullptr || transmitted == 0 || !has_thickness(*given)) return;
    const auto* ior = extension("KHR_materials_ior");
    const double n = ior != nullptr ? number(*ior, "ior", 1.5) : 1.5;
    if (n > 1) {
        const double f0 = std::pow((n - 1) / (n + 1), 2);
        material.ior = float(n);
        material.fresnel = true;
        if (mean_roughness() > visibly_rough) material.roughness = float(mean_roughness());
        const Illumination illumination = reader.options.illumination;
        const Color mirror = full_lobe(mean_roughness(), 1, f0, illumination).reflection;
        const DielectricReflectance reflects = dielectric();
        if (illumination == Illumination::environment) {
            // Fresnel's term takes the place of a tint that rises in grazing light.
            material.specular *= float(reflects.strength());
            if (reflects.plain())
                material.specular_color.reset();
            else
                material.specular_color = reflects.tint();
        }
        if (material.specular_color) {
            material.reflection = mirror * float(reflects.strength() / f0);
        } else {
            material.metallic = 0;
            material.reflection = mirror * reflects.f0 / float(f0);
        }
    }
    const double distance = number(*given, "attenuationDistance", 0);
    const Color color = color_of(numbers(*given, "attenuationColor", {1, 1, 1}));
    if (distance <= 0 || color == Color(1)) return;
    Absorption absorption = {.distance = distance};
    for (int i = 0; i < 3; ++i)
        absorption.color[i] = std::clamp(color[i], darkest_absorption, 1.0F);
    material.absorption = absorption;
}

// KHR_materials_diffuse_transmission: of the light that what is not metal does not reflect, a part
// is scattered to the other side, in a colour of its own, and the less to this side.
void MaterialReader::read_diffuse_transmission() {
    const auto* given = extension("KHR_materials_diffuse_transmission");
    if (given == nullptr) return;
    double part = number(*given, "diffuseTransmissionFactor", 0);
    if (part == 0) return;
    part *= double(mean_of(*given, "diffuseTransmissionTexture", false, 3).x);
    const DielectricReflectance reflects = dielectric();
    const double most = double(std::max({reflects.f0.x, reflects.f0.y, reflects.f0.z}));
    const double own = (1 - mean_metallic()) * (1 - std::min(most, 1.0));
    if (part * own == 0) return;
    // Without images of metalness K_D is that and what a metal's lobe leaves.
    const bool mixed = std::holds_alternative<ImageMap>(material.pattern) &&
                       material.specular_lobes && material.diffuse == 1;
    material.diffuse *= float(
        1 - part * (mixed ? 1 - mean_metallic() : std::min(own / double(material.diffuse), 1.0)));
    material.diffuse_transmission =
        color_of(numbers(*given, "diffuseTransmissionColorFactor", {1, 1, 1})) * float(part * own);
    read_transmitted_color(*given);
    const auto* volume = extension("KHR_materials_volume");
    if (volume != nullptr && transmitted == 0 && number(*volume, "attenuationDistance", 0) > 0)
        note_loss(Loss::dropped, "the volume behind its diffuse transmission absorbs nothing");
}

void MaterialReader::read_transmitted_color(const tinygltf::Value& given) {
    const std::string name = "diffuseTransmissionColorTexture";
    const TextureInfo info = texture_info(given, name);
    if (!opaque()) {
        material.diffuse_transmission *= mean_of(given, name, true);
        return;
    }
    Map map = find(info, name, Loss::approximated);
    if (map.state == Map::State::absent) return;
    if (map.is_laid()) {
        map.laid.texture = read_texture(reader, map.texture, true);
        material.diffuse_transmission_map = map.laid;
        note_set(map, [](Material& m) -> ImageMap& { return *m.diffuse_transmission_map; });
        return;
    }
    material.diffuse_transmission *=
        map.state == Map::State::unreadable
            ? Color(unreadable_grey)
            : texture_mean(reader, map.texture, true).value_or(Color(1));
}

void MaterialReader::read_sheen() {
    const auto* given = extension("KHR_materials_sheen");
    if (given == nullptr) return;
    Color color = color_of(numbers(*given, "sheenColorFactor", {0, 0, 0}));
    if (color == Color(0)) return;
    if (material.opacity < 1) return note_loss(Loss::dropped, "sheen is ignored");
    color *= mean_of(*given, "sheenColorTexture", true);
    if (texture_info(*given, "sheenRoughnessTexture").texture >= 0)
        note_loss(Loss::approximated, "sheenRoughnessTexture is left out: its factor stands alone");
    material.sheen = {
        .color = Color(std::clamp(color.x, 0.0F, 1.0F), std::clamp(color.y, 0.0F, 1.0F),
                       std::clamp(color.z, 0.0F, 1.0F)),
        .roughness = std::clamp(float(number(*given, "sheenRoughnessFactor", 0)), 0.0F, 1.0F)};
    note_loss(Loss::approximated, "sheen is approximate: its fibres scatter as a matte surface");
}

void MaterialReader::read_clearcoat() {
    const auto* given = extension("KHR_materials_clearcoat");
    if (given == nullptr) return;
    double coat = number(*given, "clearcoatFactor", 0);
    if (coat == 0) return;
    coat *= double(mean_of(*given, "clearcoatTexture", false).x);
    const double roughness = number(*given, "clearcoatRoughnessFactor", 0) *
                             double(mean_of(*given, "clearcoatRoughnessTexture", false).y);
    if (coat == 0) return;
    if (reader.options.illumination == Illumination::environment) {
        material.coat = clear_coat(coat, roughness);
        return;
    }
    // What is beneath is left 1 - coat x F of its light, its own too (KHR_materials_clearcoat,
    // layering and emission). A Phong surface has no angle for that: F is that of normal incidence.
    under_coat = float(1 - coat_f0 * coat);
    material.diffuse *= under_coat;
    material.ambient *= under_coat;
    material.diffuse_transmission *= under_coat;
    const auto cover = [&](SpecularLobe& lobe) {
        lobe.specular *= under_coat;
        lobe.reflection *= under_coat;
        add_coat(lobe, coat_f0 * coat, roughness);
    };
    if (material.specular_lobes) {
        for (SpecularLobe& lobe : material.specular_lobes->lobes) cover(lobe);
    } else {
        SpecularLobe lobe = {material.specular, material.shininess, material.reflection};
        cover(lobe);
        material.specular = lobe.specular;
        material.shininess = lobe.shininess;
        material.reflection = lobe.reflection;
    }
    note_loss(Loss::approximated,
              "clearcoat is approximate: its mirror image is added, the stronger highlight stays, "
              "and it dims what is beneath as at normal incidence");
    if (texture_info(*given, "clearcoatNormalTexture").texture >= 0)
        note_loss(Loss::dropped, "clearcoatNormalTexture is ignored");
}

}  // namespace penumbra::gltf
