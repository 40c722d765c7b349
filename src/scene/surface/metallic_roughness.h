// Metallic-roughness -> the terms of a Phong surface, for one point of it.
#pragma once

#include "penumbra/light_model.h"
#include "penumbra/scene.h"

#include <optional>

namespace penumbra {

/// What follows from the roughness alone; scene/surface/metallic_roughness.cpp explains the terms.
struct RoughnessLobe {
    double highlight = 0;  ///< K_S of a surface that reflects all, not limited
    double exponent = 1;   ///< N
    double sharp = 0;      ///< the part of what is reflected that is seen as a mirror image
    double roughness = 0;  ///< of that image: see Material::roughness
    double even = 0;       ///< the part that is scattered evenly, where light is all around
    double absorbing = 0;  ///< k: see reflected_at_last() in metallic_roughness.cpp
    Illumination illumination = Illumination::lamps;
};
/// `metal`: of what reflects strongly; else the faint blurred image of a rough dielectric is left
/// to its other terms.
RoughnessLobe lobe_of_roughness(double roughness, Illumination illumination, bool metal = true);

/// What a surface that is not metal reflects at normal incidence.
struct DielectricReflectance {
    Color f0 = Color(0.04F);
    float white = 0.04F;  ///< what it would reflect if that had no colour; f0 is no more
    float metal = 0;      ///< [0, 1]: how much of a metal it is, whatever the file calls it

    /// Whether the highlight needs no colour of its own.
    bool plain() const;
    /// Strength of its lobes, and the tint that makes it f0.
    double strength() const;
    Color tint() const;
};

/// Of one that would reflect `white` if it had no colour; without that, the largest channel of f0.
DielectricReflectance dielectric_reflectance(const Color& f0, std::optional<float> white = {});

/// The colour that such a surface scatters evenly; `highlight` is K_S over the tint.
Color scattered_color(const RoughnessLobe& shape, const Color& base, double metallic,
                      const DielectricReflectance& dielectric, double highlight);

/// As in light_model.h, for any reflectance. One that is part of a metal adds to material.color,
/// which must be all of the base colour then.
void set_metallic_roughness(Material& material, float metallic, float roughness,
                            const DielectricReflectance& dielectric,
                            Illumination illumination = Illumination::lamps);

/// K_D: how much of the base colour is scattered evenly. `highlight` is K_S over the base colour.
double scattered(const RoughnessLobe& shape, double metallic, double f0, double highlight);

/// Highlight and mirror of a surface that reflects all, to be tinted by what it does reflect, which
/// is at most `strongest`. The highlight is at most `limit`.
SpecularLobe full_lobe(double roughness, double limit, double strongest, Illumination illumination);

/// Lays a clear coat of the reflectance `f0` over `lobe`: its mirror image is added, of the two
/// highlights the stronger one stays.
void add_coat(SpecularLobe& lobe, double f0, double roughness);

/// A clear coat of ior 1.5 that covers a part of the surface, in light from all around.
Coat clear_coat(double part, double roughness);

}  // namespace penumbra
