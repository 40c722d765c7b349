#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/tracer.h"

#include <cmath>

using namespace penumbra;

namespace {

// A matte square that fills the middle of the picture, lit from far along the line of sight.
Scene lit_square(double light, float albedo = 1) {
    Scene scene = test::empty_scene();
    scene.materials = {test::matte(albedo)};
    test::add_quad(scene, {-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0});
    scene.lights = {
        {.type = Light::Type::directional, .direction = {0, 0, -1}, .intensity = light}};
    return scene;
}

double meter(const Scene& scene, RenderOptions options = {}) {
    return metered_exposure(test::as_is(scene), options);
}

}  // namespace

TEST_CASE("metered exposure, brings an even surface to a middle grey") {
    CHECK(meter(lit_square(1, 0.25F)) == 0);
    CHECK(meter(lit_square(1)) == -2);
    CHECK(meter(lit_square(100, 0.01F)) == -2);
}

TEST_CASE("metered exposure, falls by one EV when the light doubles") {
    for (const double light : {1e-6, 0.3, 5.0, 4e4, 1e8}) {
        CHECK(meter(lit_square(2 * light)) == meter(lit_square(light)) - 1);
    }
}

TEST_CASE("metered exposure, is a multiple of a quarter") {
    for (const double light : {0.11, 0.37, 1.9, 7.3}) {
        const double stops = meter(lit_square(light));
        CHECK(stops * 4 == std::round(stops * 4));
        CHECK(std::abs(std::log2(light) + stops - std::log2(0.25)) <= 0.125);
    }
}

TEST_CASE("metered exposure, is 0 for a picture without light") {
    CHECK(meter(lit_square(0)) == 0);
    Scene empty = test::empty_scene();
    empty.background = Color(0.5F);
    CHECK(meter(empty) == 0);
}

TEST_CASE("metered exposure, keeps highlights from being clipped by more than one EV") {
    Scene scene = lit_square(1, 0.01F);
    scene.materials.push_back(test::matte(1));
    test::add_quad(scene, {-1, -1, 0.1F}, {1, -1, 0.1F}, {1, 1, 0.1F}, {-1, 1, 0.1F}, 1);
    CHECK(meter(scene) == 1);  // a quarter of the square is white already
    SECTION("in whatever channel they are") {
        scene.materials[1].color = Color(0, 0, 1);
        CHECK(meter(scene) == 1);
    }
    SECTION("unless they are tiny") {
        scene.instances[1].transform.setScale(0.02);
        CHECK(meter(scene) > 3);
    }
}

TEST_CASE("metered exposure, looks at the scene and not at what is behind it") {
    Scene scene = lit_square(1, 0.25F);
    scene.background = Color(9);
    CHECK(meter(scene) == 0);
}

TEST_CASE("metered exposure, does not depend on the picture's size nor on penumbrae") {
    Scene scene = lit_square(3, 0.3F);
    const double stops = meter(scene);
    CHECK(meter(scene, {.width = 1920, .height = 1080, .samples = 3}) == stops);
    CHECK(meter(scene, {.width = 5, .height = 3000}) == stops);
    scene.lights[0].penumbra.delta = 0.01;
    CHECK(meter(scene) == stops);
}
