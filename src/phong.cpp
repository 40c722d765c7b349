// Metallic-roughness -> Phong.
#include "phong.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

// The target is the model of glTF 2.0, appendix B: a GGX highlight of width a = roughness^2 whose
// strength at normal incidence is F = lerp(f0, base colour, metallic), over a Lambert base
// (1 - metallic) (1 - f0). It is split over the terms that a Phong surface has:
//
// highlight   GGX at its centre is F / (4 pi a^2) per unit irradiance (Walter et al. 2007,
//             "Microfacet models for refraction through rough surfaces", for N = V = L); our terms
//             have no 1/pi, so K_S = F / (4 a^2), at most 1. The exponent of the cosine lobe about
//             the mirrored ray that fits D best by least squares over the solid angle is
//             n = 0.676 / a^2 - 1.17.
// mirror      what is sharp enough to be seen as a reflection: F s, s = (1 - roughness / 0.6)^2.
// diffuse     a rough metal under a few point sources would be nearly black, as most of its light
//             comes from the surroundings. So of what is reflected but not sharply, 1 - s, the part
//             that the lobe does not carry is scattered evenly. The lobe's albedo is
//             1/pi * integral of K_S cos^n = 2 K_S / (n + 1); with roughness 1 all sums to F.
//
// Highlight and mirror are tinted by Material::metallic: at normal incidence a coefficient k gives
// k (1 - metallic + metallic P). To give F the coefficient must be F over that.

// A mirror image fainter than this is left out: nobody sees it, but it would cost a ray.
constexpr double faintest = 0.004;

Polish polish_of(double roughness) {
    const double r = std::clamp(roughness, 0.0, 1.0);
    const double a = std::pow(std::max(r, 0.045), 2);
    return {.highlight = 1 / (4 * a * a),
            .exponent = std::clamp(0.676 / (a * a) - 1.17, 1.0, 10000.0),
            .sharp = std::pow(std::max(0.0, 1 - r / 0.6), 2)};
}

double scattered(const Polish& polish, double metallic, double f0, double highlight) {
    const double lobe = 2 * highlight / (polish.exponent + 1), blurred = 1 - polish.sharp;
    return (1 - metallic) * (1 - f0) + blurred * std::max(0.0, metallic * blurred - lobe);
}

Lobe full_lobe(double roughness, double limit, double strongest) {
    const Polish polish = polish_of(roughness);
    const bool mirrors = strongest * polish.sharp >= faintest;
    return {.specular = float(std::min(polish.highlight, limit)),
            .shininess = float(polish.exponent),
            .reflection = Color(mirrors ? float(polish.sharp) : 0.0F)};
}

void add_coat(Lobe& lobe, double f0, double roughness) {
    const Polish polish = polish_of(roughness);
    if (f0 * polish.sharp >= faintest) lobe.reflection += Color(float(f0 * polish.sharp));
    const float highlight = float(std::min(f0 * polish.highlight, 1.0));
    if (highlight <= lobe.specular) return;
    lobe.specular = highlight;
    lobe.shininess = float(polish.exponent);
}

void set_metallic_roughness(Material& material, float metallic, float roughness, float f0) {
    const double m = std::clamp(double(metallic), 0.0, 1.0);
    const double dielectric = std::clamp(double(f0), 0.0, 1.0);
    const Polish polish = polish_of(double(roughness));

    // F over the tint, for one channel of the base colour.
    const auto untinted = [&](double base) {
        const double fresnel = dielectric + m * (base - dielectric);
        const double tint = 1 - m + m * base;
        return tint > 1e-6 ? std::min(fresnel / tint, 1.0) : 1.0;
    };
    const Color& base = material.color;
    const double strongest = untinted(double(std::max({base.x, base.y, base.z})));
    const double highlight = std::min(strongest * polish.highlight, 1.0);

    material.metallic = float(m);
    material.specular = float(highlight);
    material.shininess = float(polish.exponent);
    material.diffuse = float(scattered(polish, m, dielectric, highlight));
    for (int channel = 0; channel < 3; ++channel) {
        const double b = double(base[channel]);
        const double fresnel = dielectric + m * (b - dielectric);
        material.reflection[channel] =
            fresnel * polish.sharp < faintest ? 0.0F : float(untinted(b) * polish.sharp);
    }
}

}  // namespace penumbra
