// Metallic-roughness -> Phong.
#include "penumbra/scene.h"

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
void set_metallic_roughness(Material& material, float metallic, float roughness, float f0) {
    const double m = std::clamp(double(metallic), 0.0, 1.0);
    const double r = std::clamp(double(roughness), 0.0, 1.0);
    const double dielectric = std::clamp(double(f0), 0.0, 1.0);
    const double a = std::pow(std::max(r, 0.045), 2);
    const double sharp = std::pow(std::max(0.0, 1 - r / 0.6), 2);

    // F over the tint, for one channel of the base colour.
    const auto untinted = [&](double base) {
        const double fresnel = dielectric + m * (base - dielectric);
        const double tint = 1 - m + m * base;
        return tint > 1e-6 ? std::min(fresnel / tint, 1.0) : 1.0;
    };
    const Color& base = material.color;
    const double strongest = untinted(double(std::max({base.x, base.y, base.z})));
    const double highlight = std::min(strongest / (4 * a * a), 1.0);
    const double exponent = std::clamp(0.676 / (a * a) - 1.17, 1.0, 10000.0);
    const double lobe = 2 * highlight / (exponent + 1);

    material.metallic = float(m);
    material.specular = float(highlight);
    material.shininess = float(exponent);
    material.diffuse =
        float((1 - m) * (1 - dielectric) + (1 - sharp) * std::max(0.0, m * (1 - sharp) - lobe));
    for (int channel = 0; channel < 3; ++channel) {
        const double b = double(base[channel]);
        const double fresnel = dielectric + m * (b - dielectric);
        // A mirror that nobody sees would still cost a ray.
        material.reflection[channel] = fresnel * sharp < 0.004 ? 0.0F : float(untinted(b) * sharp);
    }
}

}  // namespace penumbra
