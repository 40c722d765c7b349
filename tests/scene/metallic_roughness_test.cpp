// Metallic-roughness -> Phong.
#include "scene/surface/metallic_roughness.h"
#include "support/support.h"

#include "penumbra/light_model.h"
#include "penumbra/scene.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace penumbra;

namespace {

Material surface(const Color& color, float metallic, float roughness, float f0 = 0.04F) {
    Material material;
    material.color = color;
    set_metallic_roughness(material, metallic, roughness, f0);
    return material;
}

// What a coefficient gives at normal incidence, where POV-Ray's metallic curve is 0.
double tinted(const Material& m, double coefficient, int channel) {
    return coefficient * (1 + double(m.metallic) * (double(m.color[channel]) - 1));
}

// Share of the light that comes back at normal incidence, over all directions.
double albedo(const Material& m, int channel) {
    // The lobe by quadrature: 1/pi * integral over the hemisphere of K_S cos^n.
    double lobe = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const double theta = (i + 0.5) * std::acos(0.0) / steps;
        lobe += 2 * std::pow(std::cos(theta), double(m.shininess)) * std::sin(theta) *
                std::acos(0.0) / steps;
    }
    return double(m.diffuse * m.color[channel]) +
           tinted(m, double(m.specular) * lobe + double(m.reflection[channel]), channel);
}

}  // namespace

TEST_CASE("Phong, tints the highlight of a coloured reflectance and leaves a white one as it is") {
    const auto with = [](const DielectricReflectance& dielectric) {
        Material m;
        m.color = Color(0.01F);
        set_metallic_roughness(m, 0, 0.7F, dielectric);
        return m;
    };
    const Material white = surface(Color(0.01F), 0, 0.7F), grey = with({});
    CHECK_FALSE(grey.specular_color);
    CHECK(grey.specular == white.specular);
    CHECK(grey.diffuse == white.diffuse);

    const Material blue = with(dielectric_reflectance({0.004F, 0.0136F, 0.04F}, 0.04F));
    REQUIRE(blue.specular_color);
    CHECK((*blue.specular_color - Color(0.1F, 0.34F, 1)).length() < 1e-6F);
    CHECK(blue.specular == white.specular);  // as that of a white one, in its colour
    CHECK(blue.color == white.color);
    CHECK(blue.diffuse == white.diffuse);
}

TEST_CASE("Phong, turns from the law of what is clear to that of metals") {
    for (const float white : {0.04F, 0.25F}) CHECK(dielectric_reflectance(Color(white)).plain());
    CHECK(dielectric_reflectance(Color(0.375F)).metal == Approx(0.5));
    CHECK(dielectric_reflectance(Color(0.375F)).strength() == Approx(0.6875));
    CHECK(dielectric_reflectance(Color(0.5F)).metal == 1);
    Material silver, given;
    silver.color = Color(0.9F);
    given.color = Color(0);
    set_metallic_roughness(silver, 1, 0.4F);
    set_metallic_roughness(given, 0, 0.4F, dielectric_reflectance(Color(0.9F), 1.0F));
    CHECK(given.color.x == Approx(silver.color.x));
    CHECK(given.diffuse == Approx(silver.diffuse));
    CHECK(given.reflection.x == Approx(silver.reflection.x));
}

TEST_CASE("Phong, keeps a rough dielectric nearly matte") {
    const Material m = surface({0.8F, 0.4F, 0.2F}, 0, 1);
    CHECK(m.diffuse == Approx(0.96));
    CHECK(m.specular == Approx(0.01));
    CHECK(m.shininess == 1);
    CHECK(m.metallic == 0);
    CHECK(m.reflection == Color(0));
}

TEST_CASE("Phong, makes a smooth metal a mirror of its colour") {
    const Material m = surface({1, 0.5F, 0}, 1, 0);
    CHECK(m.diffuse == 0);
    CHECK(m.specular == 1);
    CHECK(m.shininess == 10000);
    for (int channel = 0; channel < 3; ++channel)
        CHECK(tinted(m, double(m.reflection[channel]), channel) ==
              Approx(double(m.color[channel])).margin(1e-6));
}

TEST_CASE("Phong, gives a rough metal its base colour as albedo") {
    const Color gold = {1, 0.77F, 0.34F};
    for (const float roughness : {0.6F, 0.8F, 1.0F}) {
        const Material m = surface(gold, 1, roughness);
        for (int channel = 0; channel < 3; ++channel)
            CHECK(albedo(m, channel) == Approx(double(gold[channel])).epsilon(0.01));
    }
}

TEST_CASE("Phong, never gives back more light than it gets") {
    for (float metallic = 0; metallic <= 1; metallic += 0.125F)
        for (float roughness = 0; roughness <= 1; roughness += 0.05F) {
            const Material m = surface({1, 0.5F, 0.02F}, metallic, roughness);
            INFO("metallic " << metallic << ", roughness " << roughness);
            for (int channel = 0; channel < 3; ++channel) CHECK(albedo(m, channel) < 1.02);
            CHECK(m.specular >= 0);
            CHECK(m.specular <= 1);
        }
}

TEST_CASE("Phong, narrows the highlight as the surface gets smoother") {
    // Least-squares fits of cos^n to GGX that the formula must come near.
    CHECK(surface(Color(1), 0, 0.2F).shininess == Approx(422).epsilon(0.01));
    CHECK(surface(Color(1), 0, 0.3F).shininess == Approx(82).epsilon(0.01));
    CHECK(surface(Color(1), 0, 0.5F).shininess == Approx(9.6).epsilon(0.02));
}

TEST_CASE("Phong, tints the highlight of a metal and not that of a dielectric") {
    // F / (4 a^2) with a = 0.36: F is the base colour's for a metal.
    const Material metal = surface({0.5F, 0.1F, 0}, 1, 0.6F);
    CHECK(tinted(metal, double(metal.specular), 0) == Approx(0.5));  // at most 1, tinted
    const Material plastic = surface({0.5F, 0.1F, 0}, 0, 0.6F, 0.08F);
    CHECK(plastic.specular == Approx(0.08 / (4 * 0.36 * 0.36)));
    const Material half = surface({0.5F, 0.5F, 0.5F}, 0.5F, 0.9F);
    CHECK(tinted(half, double(half.specular), 0) == Approx(0.27 / (4 * std::pow(0.9, 4))));
}

TEST_CASE("Phong, drops reflections that nobody sees") {
    CHECK(surface(Color(1), 0, 0.35F).reflection.x == Approx(0.04 * std::pow(1 - 0.35 / 0.6, 2)));
    CHECK(surface(Color(1), 0, 0.45F).reflection == Color(0));
}

TEST_CASE(
    "Phong, of a metal in light from all around absorbs with each bounce between its facets") {
    // Mean albedo of GGX (Smith, height-correlated) that reflects all, by integration.
    const std::array<std::array<double, 2>, 5> albedos = {
        {{0.33, 0.968}, {0.5, 0.882}, {0.67, 0.737}, {0.83, 0.575}, {1, 0.409}}};
    const Color copper = {0.95F, 0.55F, 0.2F};
    for (const auto& [roughness, e] : albedos) {
        Material m;
        m.color = copper;
        set_metallic_roughness(m, 1, float(roughness), 0.04F, Illumination::environment);
        CHECK(m.specular_color.value_or(m.color) == copper);  // what tints mirror and highlight
        for (int channel = 0; channel < 3; ++channel) {
            CAPTURE(roughness, channel);
            const double c = double(copper[channel]);
            const double lobe = 2 * double(m.specular) / (double(m.shininess) + 1);
            const double mirror = double(m.reflection[channel]);
            CHECK(c * (lobe + mirror) + double(m.diffuse * m.color[channel]) ==
                  Approx(c * e / (1 - c * (1 - e))).epsilon(0.02));
        }
    }
}

TEST_CASE("Phong, of a rough dielectric in light from all around scatters its reflectance too") {
    Material black;
    black.color = Color(0);
    set_metallic_roughness(black, 0, 1, 0.04F, Illumination::environment);
    const double e = 0.409;
    CHECK(double(black.diffuse * black.color.x) ==
          Approx(0.04 * e / (1 - 0.04 * (1 - e))).epsilon(0.01));
    Material white;
    white.color = Color(1);
    set_metallic_roughness(white, 0, 1, 0.04F, Illumination::environment);
    CHECK(white.color == Color(1));
    CHECK(double(white.diffuse) <= 1);
    Material polished;
    polished.color = {0.5F, 0.3F, 0.1F};
    set_metallic_roughness(polished, 0, 0, 0.04F, Illumination::environment);
    CHECK(polished.color == Color(0.5F, 0.3F, 0.1F));
    CHECK(polished.diffuse == Approx(0.96));
    Material glass;  // its colour tints what shines through
    glass.color = {0.5F, 0.3F, 0.1F};
    glass.opacity = 0.2F;
    set_metallic_roughness(glass, 0, 0.6F, 0.04F, Illumination::environment);
    CHECK(glass.color == Color(0.5F, 0.3F, 0.1F));
}
