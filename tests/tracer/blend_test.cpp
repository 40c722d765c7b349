// Two looks of a mesh.
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/tracer.h"

#include <algorithm>

using namespace penumbra;

namespace {

Material glass() {
    Material m = test::matte();
    m.name = "glass";
    m.opacity = 0.1F;
    m.transmission = 0.7F;
    m.color = {0.9F, 0.6F, 0.4F};
    m.specular = 0.4F;
    m.shininess = 5;
    m.reflection = Color(0.2F);
    return m;
}

Material metal() {
    Material m = test::matte();
    m.name = "metal";
    m.color = {0.3F, 0.5F, 0.8F};
    m.diffuse = 0.3F;
    m.specular = 0.8F;
    m.shininess = 12;
    m.metallic = 1;
    m.reflection = Color(0.5F);
    return m;
}

constexpr int side = 80;

// A sheet of that material, over a floor that it shades.
Image picture(const Material& worn, bool floor = false) {
    Scene scene = test::empty_scene();
    scene.background = {0.1F, 0.2F, 0.4F};
    scene.textures = {{.name = "share", .srgb = false}};
    scene.textures[0].raster = {.width = 1, .height = 1, .channels = 1};
    scene.textures[0].raster.data = {std::byte(51)};  // 0.2
    test::add_quad(scene, {-2, -1, 1}, {2, -1, 0}, {2, 2, 0}, {-2, 2, 1}, 1);
    scene.meshes[0].texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    if (floor) scene.planes = {{"floor", {0, -2, 0}, {0, 1, 0}, 0}};
    scene.materials.push_back(worn);
    scene.lights = {{.position = {3, 6, 5}}};
    RenderOptions options;
    options.width = options.height = side;
    return render(test::as_is(scene), options);
}

}  // namespace

TEST_CASE("blend, shows each look by its share") {
    Material both = glass();
    both.blend = Blend{.map = {.texture = 0}, .other = {metal()}};
    const Image clear = picture(glass()), dull = picture(metal()), mixed = picture(both);
    CHECK(test::share_off(clear, dull) > 0.1);
    float most = 0;
    for (std::size_t i = 0; i < mixed.pixels.size(); ++i) {
        const Color expected = clear.pixels[i] * 0.2F + dull.pixels[i] * 0.8F;
        most = std::max(most, (mixed.pixels[i] - expected).length());
    }
    CHECK(most < 1e-5F);
}

TEST_CASE("blend, lets light pass where either look does") {
    Material both = metal();
    both.blend = Blend{.map = {.texture = 0}, .other = {glass()}};
    CHECK_FALSE(opaque(both));
    const Image clear = picture(glass(), true), dull = picture(metal(), true);
    const Image mixed = picture(both, true);
    float most = 0, shaded = 0;
    for (int y = 54; y < side; ++y)  // below the sheet
        for (int x = 0; x < side; ++x) {
            const Color expected = dull.at(x, y) * 0.2F + clear.at(x, y) * 0.8F;
            most = std::max(most, (mixed.at(x, y) - expected).length());
            shaded = std::max(shaded, (clear.at(x, y) - dull.at(x, y)).length());
        }
    CHECK(shaded > 0.2F);
    CHECK(most < 1e-5F);
}
