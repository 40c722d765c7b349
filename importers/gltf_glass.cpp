// What lies over or under the polish: transmission, volume, clear coat.
#include "gltf_material.h"
#include "phong.h"

#include <algorithm>
#include <cmath>

namespace penumbra::gltf {
namespace {

constexpr double visibly_rough = 0.1;
constexpr float darkest_absorption = 1e-4F;
constexpr double coat_f0 = 0.04;  // KHR_materials_clearcoat: ior 1.5

}  // namespace

// KHR_materials_transmission: of the light that is neither reflected nor a metal's, the part t goes
// on, tinted by the base colour, and only the rest is scattered. With an alpha a below 1 light also
// passes untinted: behind = (1 - a) + a t P, which is (1 - opacity) (1 - T + T P).
void MaterialReader::read_transmission() {
    const auto* given = extension("KHR_materials_transmission");
    if (given == nullptr) return;
    const double factor = number(*given, "transmissionFactor", 0);
    if (factor == 0) return;
    const Color mean = mean_of(*given, "transmissionTexture", false);
    transmitted = std::clamp(factor * double(mean.x) * (1 - mean_metallic()), 0.0, 1.0);
    if (transmitted == 0) return;
    const double a = double(material.opacity);
    material.opacity = float(a * (1 - transmitted));
    material.transmission = float(a * transmitted / (1 - a * (1 - transmitted)));
    if (mean_roughness() > visibly_rough)
        lose("transmission is approximate: a rough surface is shown as clear");
}

// KHR_materials_volume: a surface without thickness is a pane, which does not bend the light, and
// keeps the reflection of its material; others are the outside of a body.
void MaterialReader::read_volume() {
    const auto* given = extension("KHR_materials_volume");
    if (given == nullptr || transmitted == 0 || number(*given, "thicknessFactor", 0) <= 0) return;
    const auto* ior = extension("KHR_materials_ior");
    const double n = ior != nullptr ? number(*ior, "ior", 1.5) : 1.5;
    if (n > 1) {
        const double f0 = std::pow((n - 1) / (n + 1), 2);
        material.ior = float(n);
        material.fresnel = true;
        material.metallic = 0;
        const Color mirror = full_lobe(mean_roughness(), 1, f0).reflection;
        material.reflection = mirror * dielectric_f0() / float(f0);
    }
    const double distance = number(*given, "attenuationDistance", 0);
    const Color color = color_of(numbers(*given, "attenuationColor", {1, 1, 1}));
    if (distance <= 0 || color == Color(1)) return;
    Absorption absorption = {.distance = distance};
    for (int i = 0; i < 3; ++i)
        absorption.color[i] = std::clamp(color[i], darkest_absorption, 1.0F);
    material.absorption = absorption;
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
    if (material.gloss) {
        for (Lobe& lobe : material.gloss->lobes) add_coat(lobe, coat_f0 * coat, roughness);
    } else {
        Lobe lobe = {material.specular, material.shininess, material.reflection};
        add_coat(lobe, coat_f0 * coat, roughness);
        material.specular = lobe.specular;
        material.shininess = lobe.shininess;
        material.reflection = lobe.reflection;
    }
    lose("clearcoat is approximate: its mirror image is added, the stronger highlight stays");
    if (texture_info(*given, "clearcoatNormalTexture").texture >= 0)
        lose("clearcoatNormalTexture is ignored");
}

}  // namespace penumbra::gltf
