#include "scene/texture/noise.h"
#include "support/support.h"

using namespace penumbra;

// The expected values are what POV-Ray 3.7 prints for f_noise_generator(x, y, z, 3).
TEST_CASE("noise, equals POV-Ray's generator 3 to 15 digits") {
    CHECK(perlin_noise({.5, .5, .5}) == Approx(0.672103843552658).epsilon(1e-14));
    CHECK(perlin_noise({1.25, -2.5, 3.75}) == Approx(0.636436165558896).epsilon(1e-14));
    CHECK(perlin_noise({0, 0, 0}) == Approx(0.511354305373036).epsilon(1e-14));
    CHECK(perlin_noise({10.1, 20.2, 30.3}) == Approx(0.205951245661094).epsilon(1e-14));
}

TEST_CASE("noise, weighs octaves by halves and scales with its size and origin") {
    Noise noise;
    noise.size = 2;
    noise.octaves = 3;
    noise.origin = {1, 0, 0};
    const Vec3 p(3, 1, -4);
    const Vec3 q = (p - noise.origin) * 0.5;
    const double expected =
        (perlin_noise(q) + perlin_noise(q * 2.0) / 2 + perlin_noise(q * 4.0) / 4) / 1.75;
    CHECK(noise_value(noise, p) == Approx(expected).epsilon(1e-14));
}
