#include "pictures.h"
#include "support.h"

#include "penumbra/image.h"
#include "penumbra/validation.h"

#include <algorithm>
#include <string>

using namespace penumbra;
using test::disc;
using test::has;
using test::joined;
using test::shifted;

TEST_CASE("The diagnosis names what explains the difference") {
    const Image reference = disc(80, 60, {0.9F, 0.4F, 0.1F});
    const auto diagnosis = [&](const Image& test) {
        const Comparison result = compare(test, reference);
        CHECK(result.verdict == Verdict::fail);
        return joined(result.diagnosis);
    };
    const auto changed = [&](auto change) {
        Image image = reference;
        for (Color& c : image.pixels) c = change(c);
        return image;
    };
    const auto moved = [&](auto source) {
        Image image = reference;
        for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 80; ++x) image.at(x, y) = source(x, y);
        return image;
    };
    const auto each = [](const Color& c, float (*f)(float)) {
        return Color(f(c.x), f(c.y), f(c.z));
    };
    CHECK(has(diagnosis(shifted(reference, 1, -2)), "shifted by (+1, -2) pixels"));
    CHECK(has(diagnosis(changed([](const Color& c) { return c * 1.1F; })),
              "the test picture is 10 % brighter"));
    CHECK(has(diagnosis(changed([](const Color& c) { return c * 0.8F; })),
              "the test picture is 20 % darker"));
    CHECK(has(diagnosis(changed([](const Color& c) { return Color(c.z, c.y, c.x); })),
              "red and blue are exchanged"));
    CHECK(has(diagnosis(changed([&](const Color& c) { return each(c, srgb_to_linear); })),
              "lacked the sRGB encoding"));
    CHECK(has(diagnosis(changed([&](const Color& c) { return each(c, linear_to_srgb); })),
              "sRGB-encoded twice"));
    CHECK(has(diagnosis(moved([&](int x, int y) { return reference.at(79 - x, y); })),
              "mirrored left to right"));
    CHECK(has(diagnosis(moved([&](int x, int y) { return reference.at(x, 59 - y); })),
              "upside down"));
    CHECK(has(diagnosis(moved([&](int x, int y) { return reference.at(79 - x, 59 - y); })),
              "turned by 180 degrees"));
    // Another object: no single cause.
    Image other = disc(80, 60, {0.1F, 0.9F, 0.1F});
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) other.at(x, y) = {0.7F, 0, 0.7F};
    CHECK_FALSE(has(diagnosis(other), "explains"));
}
