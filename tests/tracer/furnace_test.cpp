// White surfaces in light that is the same from everywhere.
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/light_model.h"
#include "penumbra/prepare.h"
#include "penumbra/tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace penumbra;

namespace {

// A sphere that wears `material`, before the same white as all around it.
Image in_furnace(const Material& material) {
    Scene scene;
    scene.materials = {material};
    scene.spheres.push_back({.radius = 1, .material = 0});
    scene.cameras.push_back({.position = {0, 0, 5}, .direction = {0, 0, -1}, .fov = 0.45});
    scene.camera = 0;
    set_uniform_environment(scene, Color(1)).sources = 256;
    RenderOptions options;
    options.width = 64;
    options.height = 48;
    return render(normalise(scene, options), options);
}

Material white(float metallic, float roughness) {
    Material material;
    material.color = Color(1);
    material.ambient = Color(0);
    set_metallic_roughness(material, metallic, roughness, 0.04F, Illumination::environment);
    return material;
}

}  // namespace

TEST_CASE("furnace, a rough white metal returns all light but for a tenth") {
    for (const float roughness : {0.0F, 0.15F, 0.3F, 0.45F, 0.6F, 0.8F, 1.0F}) {
        const Image image = in_furnace(white(1, roughness));
        std::size_t dim = 0;
        float least = 1, most = 0;
        for (const Color& c : image.pixels) {
            least = std::min(least, c.x);
            most = std::max(most, c.x);
            dim += c.x < 0.9F;
        }
        INFO("roughness " << roughness << ": " << least << " to " << most << ", " << dim << " dim");
        CHECK(most <= 1.01F);
        // At the last pixel of the rim displaced normals point away from the eye.
        CHECK(dim <= 4);
        CHECK(least >= 0.85F);
    }
}

TEST_CASE("furnace, cloth scatters no more than it gets") {
    Material material = white(0, 1);
    material.reflection = Color(0);
    material.specular = 0;
    material.diffuse = 1;
    material.sheen = Sheen{.color = Color(1), .roughness = 0.5F};
    const Image image = in_furnace(material);
    for (const Color& c : image.pixels) CHECK((c.x > 0.97F && c.x < 1.02F));
}

TEST_CASE("sheen, covers the more the flatter it is seen, by its colour's largest channel") {
    const auto cover = sheen_cover({.color = Color(1), .roughness = 0.5F});
    CHECK(std::ranges::is_sorted(cover, std::greater<>()));
    CHECK(cover.back() > 0);
    CHECK(cover.front() <= 1);
    const auto half = sheen_cover({.color = Color(0.5F, 0.25F, 0), .roughness = 0.5F});
    CHECK(std::abs(half.back() - cover.back() / 2) < 1e-6F);
    CHECK(sheen_tint({.color = Color(0.5F, 0.25F, 0)}) == Color(1, 0.5F, 0));
}

TEST_CASE("sheen, covers head on what the integral along one turn says") {
    // With v = n and roughness 1, D = 3 sin(t / 2) / (2 pi) for l at the angle t, and V = 1 / 4.
    double sum = 0;
    const int steps = 100000;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) / steps * std::numbers::pi / 2;
        sum += std::sin(t / 2) * std::cos(t) * std::sin(t);
    }
    const double wanted = 0.75 * sum * std::numbers::pi / 2 / steps;
    CHECK(std::abs(double(sheen_cover({.color = Color(1), .roughness = 1}).back()) - wanted) <
          2e-3);
}
