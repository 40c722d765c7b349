// The images that a material looks up, in one place.
#pragma once

#include "penumbra/scene.h"

#include <variant>

namespace penumbra {

/// What an image varies.
enum class MapUse { pattern, emission, transmission, alpha, lobe_color, lobe_level, normal, blend };

/// Calls visit(map, use) for every ImageMap of a Material, const or not, those without a texture
/// included, and those of a Blend's other look too. Structs are taken apart by name, so that a new
/// member is an error here until it has been looked at.
template <class AnyMaterial, class Visit>
void each_image_map(AnyMaterial& material, Visit visit) {
    auto& [name, color, pattern, ambient, diffuse, specular, shininess, metallic, specular_color,
           reflection, roughness, mirrors, conserve_energy, emission, diffuse_transmission, opacity,
           transmission, ior, fresnel, smooth, absorption, coat, sheen, sides, emission_map,
           diffuse_transmission_map, alpha_map, specular_lobes, normal_map, blend] = material;
    static_assert(std::variant_size_v<Pattern> == 4, "has the new kind of pattern an image?");
    if (auto* map = std::get_if<ImageMap>(&pattern)) visit(*map, MapUse::pattern);
    if (emission_map) visit(*emission_map, MapUse::emission);
    if (diffuse_transmission_map) visit(*diffuse_transmission_map, MapUse::transmission);
    if (alpha_map) {
        auto& [map, cutoff] = *alpha_map;
        visit(map, MapUse::alpha);
    }
    if (specular_lobes) {
        auto& [tint, level, lobes, mixed] = *specular_lobes;
        visit(tint, MapUse::lobe_color);
        visit(level, MapUse::lobe_level);
    }
    if (normal_map) {
        auto& [map, scale] = *normal_map;
        visit(map, MapUse::normal);
    }
    if (blend) {
        auto& [map, other] = *blend;
        visit(map, MapUse::blend);
        for (auto& second : other) each_image_map(second, visit);
    }
}

}  // namespace penumbra
