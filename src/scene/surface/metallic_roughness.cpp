// Metallic-roughness -> Phong.
#include "scene/surface/metallic_roughness.h"

#include "penumbra/light_model.h"

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
//
// What is not metal may reflect in a colour too (KHR_materials_specular, specular-glossiness). Then
// highlight and mirror are tinted by Material::specular_color T with metallic = 1. For one
// reflectance w of a white surface, f0 = w T, the lobe of strength w tinted by T is continuous with
// that of a white one. A metal is w = 1 and T = its base colour, and the rest of its law, the light
// that is scattered beside the lobe, is no dielectric's: that of w = 0.04 would brighten black
// plastic. Nothing that is clear has an index above 3, w = 0.25, and no metal reflects less than
// half in its strongest channel; between these a surface turns from one law to the other. So the
// same gold as a metal, by an index of 0 (infinite) and by specular-glossiness is the same surface.

// All of that is for a few lamps in the dark: then the even part of a metal stands for surroundings
// that are not there. Where light comes from all around (Illumination::environment) nothing has to
// stand for it, and what is reflected, all of it, is split over three terms of which each has the
// albedo 1 by itself:
//
// mirror      s, blurred by virtual mirrors of the roughness: what has a shape in the reflection.
// highlight   h = min(0.2, 4 r^2), K_S = h (n + 1) / 2, n = 1.25 / a^2 - 1: the lobe of the
//             environment's sources. It falls below the horizon at grazing angles, by up to a half,
//             so that no more than 0.2 lets a white rough metal in a white environment keep 0.9.
// even        e = min(1, 1.3 r^2), s = 1 - h - e. Least squares of the sRGB values of spheres in
//             three environments (studio, overcast, lamps at night) against multiple-scattering GGX
//             (energy by its directional albedo), with the mirrors as they are and h <= 0.2.
//
// The reflectance F at normal incidence tints mirror and highlight as Material::specular_color with
// metallic = 1; the curve of that tint rises to 1 in grazing light much as Schlick's does. Of a
// dielectric, which reflects 1/25, a blurred image would cost as many rays as that of a metal: from
// a roughness of 0.25 on it fades, and its part goes to the highlight. What is
// not metal loses by Material::conserve_energy what the mirror reflects; it scatters (1 - F) of its
// base colour and the even part of F.
//
// A rough surface reflects light that has met it several times, and a coloured one tints it each
// time. With the mean albedo E of single reflection, what comes back of a reflectance c is
//
//     c' = c E / (1 - c (1 - E)) = c / (1 + k (1 - c)),   k = 1 / E - 1
//
// (Kulla and Conty 2017, "Revisiting physically based shading", without Fresnel's rise). Of GGX, E
// is 0.968, 0.883, 0.737, 0.574, 0.409 at a roughness of 0.33, 0.5, 0.67, 0.83, 1, by integration,
// so that k = 1.445 r^3.45 within 0.02. The even part is what of c' the other two do not carry.

// A mirror image fainter than this is left out: nobody sees it, but it would cost a ray.
constexpr double faintest = 0.004;

namespace {

constexpr double sharpest = 0.1;             // of mirrors that are blurred: below nobody sees it
constexpr double dull = 0.25, duller = 0.4;  // where the image of a dielectric fades out

RoughnessLobe lobe_of_illumination(double r, double a, bool metal) {
    const double lobe = std::min(0.2, 4 * r * r), even = std::min(1.0, 1.3 * r * r);
    double highlight = std::min(lobe, 1 - even), sharp = 1 - even - highlight;
    if (!metal) {
        const double kept = std::clamp((duller - r) / (duller - dull), 0.0, 1.0);
        highlight += sharp * (1 - kept);
        sharp *= kept;
    }
    const double exponent = std::clamp(1.25 / (a * a) - 1, 1.0, 10000.0);
    constexpr double roughest = 1.445, power = 3.45;
    return {.highlight = highlight * (exponent + 1) / 2,
            .exponent = exponent,
            .sharp = sharp < 0.02 ? 0 : sharp,
            .roughness = r < sharpest ? 0 : r,
            .even = even,
            .absorbing = roughest * std::pow(r, power),
            .illumination = Illumination::environment};
}

double reflected_at_last(const RoughnessLobe& shape, double c) {
    return c / (1 + shape.absorbing * (1 - c));
}

// What a surface of the reflectance `f` at normal incidence scatters evenly of it.
Color even_part(const RoughnessLobe& shape, const Color& f) {
    Color result;
    for (int i = 0; i < 3; ++i) {
        const double c = std::clamp(double(f[i]), 0.0, 1.0);
        result[i] = float(std::max(0.0, reflected_at_last(shape, c) - (1 - shape.even) * c));
    }
    return result;
}

}  // namespace

RoughnessLobe lobe_of_roughness(double roughness, Illumination illumination, bool metal) {
    const double r = std::clamp(roughness, 0.0, 1.0);
    const double a = std::pow(std::max(r, 0.045), 2);
    if (illumination == Illumination::environment) return lobe_of_illumination(r, a, metal);
    return {.highlight = 1 / (4 * a * a),
            .exponent = std::clamp(0.676 / (a * a) - 1.17, 1.0, 10000.0),
            .sharp = std::pow(std::max(0.0, 1 - r / 0.6), 2)};
}

double scattered(const RoughnessLobe& shape, double metallic, double f0, double highlight) {
    const double lobe = 2 * highlight / (shape.exponent + 1), blurred = 1 - shape.sharp;
    return (1 - metallic) * (1 - f0) + blurred * std::max(0.0, metallic * blurred - lobe);
}

SpecularLobe full_lobe(double roughness, double limit, double strongest,
                       Illumination illumination) {
    const bool metal = strongest > 0.2;
    const RoughnessLobe shape = lobe_of_roughness(roughness, illumination, metal);
    if (illumination == Illumination::environment)
        return {.specular = float(shape.highlight),
                .shininess = float(shape.exponent),
                .reflection = Color(float(shape.sharp)),
                .roughness = float(shape.roughness)};
    const bool mirrors = strongest * shape.sharp >= faintest;
    return {.specular = float(std::min(shape.highlight, limit)),
            .shininess = float(shape.exponent),
            .reflection = Color(mirrors ? float(shape.sharp) : 0.0F)};
}

Coat clear_coat(double part, double roughness) {
    constexpr double f0 = 0.04;
    const RoughnessLobe shape = lobe_of_roughness(roughness, Illumination::environment);
    return {.specular = float(part * f0 * shape.highlight),
            .shininess = float(shape.exponent),
            .reflection = float(part * f0 * shape.sharp),
            .grazing = float(part * shape.sharp),
            .roughness = float(shape.roughness)};
}

void add_coat(SpecularLobe& lobe, double f0, double roughness) {
    const RoughnessLobe shape = lobe_of_roughness(roughness, Illumination::lamps);
    if (f0 * shape.sharp >= faintest) lobe.reflection += Color(float(f0 * shape.sharp));
    const float highlight = float(std::min(f0 * shape.highlight, 1.0));
    if (highlight <= lobe.specular) return;
    lobe.specular = highlight;
    lobe.shininess = float(shape.exponent);
}

namespace {

constexpr double clearest_metal = 0.25, dullest_metal = 0.5;

bool is_grey(const Color& c) { return c.x == c.y && c.y == c.z; }

double largest(const Color& c) { return double(std::max({c.x, c.y, c.z})); }

// What the lobe of a metal leaves to be scattered, in its tint.
double beside_lobe(const RoughnessLobe& shape, double highlight) {
    const double blurred = 1 - shape.sharp;
    return blurred * std::max(0.0, blurred - 2 * highlight / (shape.exponent + 1));
}

}  // namespace

bool DielectricReflectance::plain() const { return is_grey(f0) && metal == 0; }

double DielectricReflectance::strength() const {
    return double(white) + double(metal) * (1 - double(white));
}

Color DielectricReflectance::tint() const {
    return white > 0 ? f0 * float(1 / strength()) : Color(1);
}

DielectricReflectance dielectric_reflectance(const Color& f0, std::optional<float> white) {
    const double w = white ? double(*white) : largest(f0);
    const double metal = (w - clearest_metal) / (dullest_metal - clearest_metal);
    return {f0, float(w), float(std::clamp(metal, 0.0, 1.0))};
}

Color scattered_color(const RoughnessLobe& shape, const Color& base, double metallic,
                      const DielectricReflectance& dielectric, double highlight) {
    const double f0 = std::clamp(largest(dielectric.f0), 0.0, 1.0);
    if (shape.illumination == Illumination::environment)
        return base * float((1 - metallic) * (1 - f0)) + even_part(shape, base) * float(metallic) +
               even_part(shape, dielectric.f0) * float(1 - metallic);
    const Color own = base * float(scattered(shape, metallic, f0, highlight));
    if (dielectric.metal == 0) return own;
    const double metal = (1 - metallic) * double(dielectric.metal);
    return own + dielectric.tint() * float(metal * beside_lobe(shape, highlight));
}

namespace {

// The colour is split into P and K_D so that a black base leaves a metal's P, and with it what
// ambient light shows.
void set_scattered(Material& material, const RoughnessLobe& shape, double metallic,
                   const DielectricReflectance& dielectric, double highlight) {
    const double f0 = std::clamp(largest(dielectric.f0), 0.0, 1.0),
                 share = double(dielectric.metal);
    const double own = scattered(shape, metallic, f0, highlight);
    material.diffuse = float(own);
    if (share == 0) return;
    const Color base = material.color;
    const double whole = own * (1 - share + share * largest(base)) +
                         (1 - metallic) * share * beside_lobe(shape, highlight);
    const Color sum = scattered_color(shape, base, metallic, dielectric, highlight);
    material.diffuse = float(whole);
    material.color = whole > 1e-6
                         ? sum * float(1 / whole)
                         : base + (dielectric.tint() - base) * float(share * (1 - metallic));
}

// In light from all around: K_D is that of a white surface, the colour that of what is scattered as
// far as it is another than the base colour. Where light shines through the surface the colour
// tints that, and stays.
void set_surrounded_scattered(Material& material, const RoughnessLobe& shape, double metallic,
                              const DielectricReflectance& dielectric) {
    const Color white = scattered_color(shape, Color(1), metallic, dielectric, 0);
    const double whole = largest(white);
    material.diffuse = float(whole);
    if (shape.even > 0 && whole > 1e-6 && material.opacity >= 1)
        material.color =
            scattered_color(shape, material.color, metallic, dielectric, 0) * float(1 / whole);
}

void set_surrounded(Material& material, double metallic, double roughness,
                    const DielectricReflectance& dielectric) {
    const bool metal = metallic > 0 || dielectric.metal > 0;
    const RoughnessLobe shape = lobe_of_roughness(roughness, Illumination::environment, metal);
    const Color base = material.color;
    material.specular = float(shape.highlight);
    material.shininess = float(shape.exponent);
    material.reflection = Color(float(shape.sharp));
    material.roughness = float(shape.roughness);
    material.metallic = 1;
    material.conserve_energy = metallic == 0 && dielectric.metal == 0;
    set_surrounded_scattered(material, shape, metallic, dielectric);
    material.specular_color.reset();
    const Color reflected =
        metallic == 1 ? base : dielectric.f0 + (base - dielectric.f0) * float(metallic);
    if (reflected != material.color) material.specular_color = reflected;
}

}  // namespace

void set_metallic_roughness(Material& material, float metallic, float roughness,
                            const DielectricReflectance& dielectric, Illumination illumination) {
    const double m = std::clamp(double(metallic), 0.0, 1.0);
    if (illumination == Illumination::environment)
        return set_surrounded(material, m, double(roughness), dielectric);
    if (dielectric.plain() || m == 1)
        return set_metallic_roughness(material, metallic, roughness, float(largest(dielectric.f0)),
                                      illumination);
    const RoughnessLobe shape = lobe_of_roughness(double(roughness), illumination);
    const double strength = dielectric.strength() + m * (1 - dielectric.strength());
    const Color reflected = dielectric.f0 + (material.color - dielectric.f0) * float(m);
    const double highlight = std::min(strength * shape.highlight, 1.0);
    material.specular_color = reflected * float(1 / strength);
    material.metallic = 1;
    material.specular = float(highlight);
    material.shininess = float(shape.exponent);
    for (int c = 0; c < 3; ++c)
        material.reflection[c] =
            double(reflected[c]) * shape.sharp < faintest ? 0.0F : float(strength * shape.sharp);
    set_scattered(material, shape, m, dielectric, highlight);
}

void set_metallic_roughness(Material& material, float metallic, float roughness, float f0,
                            Illumination illumination) {
    const double m = std::clamp(double(metallic), 0.0, 1.0);
    const double dielectric = std::clamp(double(f0), 0.0, 1.0);
    if (illumination == Illumination::environment)
        return set_surrounded(material, m, double(roughness),
                              dielectric_reflectance(Color(float(dielectric))));
    const RoughnessLobe shape = lobe_of_roughness(double(roughness), illumination);

    // F over the tint, for one channel of the base colour.
    const auto untinted = [&](double base) {
        const double fresnel = dielectric + m * (base - dielectric);
        const double tint = 1 - m + m * base;
        return tint > 1e-6 ? std::min(fresnel / tint, 1.0) : 1.0;
    };
    const Color& base = material.color;
    const double strongest = untinted(double(std::max({base.x, base.y, base.z})));
    const double highlight = std::min(strongest * shape.highlight, 1.0);

    material.metallic = float(m);
    material.specular = float(highlight);
    material.shininess = float(shape.exponent);
    material.diffuse = float(scattered(shape, m, dielectric, highlight));
    for (int channel = 0; channel < 3; ++channel) {
        const double b = double(base[channel]);
        const double fresnel = dielectric + m * (b - dielectric);
        material.reflection[channel] =
            fresnel * shape.sharp < faintest ? 0.0F : float(untinted(b) * shape.sharp);
    }
}

}  // namespace penumbra
