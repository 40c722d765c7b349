#include "support/pictures.h"
#include "support/support.h"

#include "penumbra/compare.h"
#include "penumbra/image.h"

#include <algorithm>
#include <cmath>
#include <functional>
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

namespace {

// Three discs and a slope, seen through one sample a pixel; `zoom` magnifies about the middle and
// (dx, dy) moves what is seen.
Image discs(double dx, double dy, double zoom = 1) {
    const int w = 160, h = 120;
    Image image(w, h);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const double u = (x - 79.5 - dx) / zoom, v = (y - 59.5 - dy) / zoom;
            Color c(0.05F);
            if (std::hypot(u + 30, v + 10) < 32) c = {0.7F, 0.3F, 0.1F};
            if (std::hypot(u - 28, v - 18) < 21) c = {0.1F, 0.4F, 0.6F};
            if (std::hypot(u - 40, v + 30) < 12) c = Color(0.9F);
            image.at(x, y) = c * (0.7F + 0.002F * float(u));
        }
    return image;
}

Comparison compared(const Image& test, const Image& reference) {
    CompareOptions options;
    options.limits = profile_limits("strict");
    return compare(test, reference, options);
}

std::string cause_of(const Image& test, const Image& reference) {
    return compared(test, reference).cause;
}

Image mapped(Image image, const std::function<Color(const Color&)>& map) {
    for (Color& c : image.pixels) c = map(c);
    return image;
}

}  // namespace

TEST_CASE("Shifts by fractions of a pixel are told") {
    const Comparison half = compared(discs(0.5, 0), discs(0, 0));
    INFO(joined(half.diagnosis));
    CHECK(half.cause == "shift");
    CHECK(has(joined(half.diagnosis), "the test picture is shifted by (+0.5, +0) pixels"));
    CHECK(has(joined(compared(discs(-0.5, 0.5), discs(0, 0)).diagnosis),
              "shifted by (-0.5, +0.5) pixels"));
    CHECK(has(joined(compared(discs(0, 0), discs(1.5, -1)).diagnosis),
              "shifted by (-1.5, +1) pixels"));
    CHECK(has(joined(compared(discs(6, 0), discs(0, 0)).diagnosis), "shifted by (+6, +0) pixels"));
}

TEST_CASE("Another field of view is told from the pictures") {
    const Comparison larger = compared(discs(0, 0, 1.04), discs(0, 0));
    CHECK(larger.cause == "fov");
    INFO(joined(larger.diagnosis));
    CHECK(has(joined(larger.diagnosis), "shows everything 4 % larger"));
    CHECK(has(joined(compared(discs(0, 0), discs(0, 0, 1.02)).diagnosis), "2 % smaller"));
}

TEST_CASE("Colours that were changed are told") {
    const Image picture = discs(0, 0);
    const auto power = [](const Color& c) {
        const auto channel = [](float v) { return srgb_to_linear(std::pow(v, 1 / 2.2F)); };
        return Color(channel(c.x), channel(c.y), channel(c.z));
    };
    const Comparison gamma = compared(picture, mapped(picture, power));
    CHECK(gamma.cause == "gamma_22");
    CHECK(has(joined(gamma.diagnosis), "the reference looks as if it were encoded with a gamma"));
    const Comparison reverse = compared(mapped(picture, power), picture);
    CHECK(reverse.cause == "gamma_22");
    CHECK(has(joined(reverse.diagnosis), "the test picture looks as if it were encoded"));

    const auto steeper = [](const Color& c) {
        const auto channel = [](float v) {
            return srgb_to_linear(std::pow(linear_to_srgb(v), 1.2F));
        };
        return Color(channel(c.x), channel(c.y), channel(c.z));
    };
    const Comparison other = compared(picture, mapped(picture, steeper));
    CHECK(other.cause == "gamma");
    CHECK(has(joined(other.diagnosis), "to the power of 1.2 are"));

    const auto tinted = [](const Color& c) { return c * Color(1.1F, 1, 0.8F); };
    const Comparison tint = compared(picture, mapped(picture, tinted));
    CHECK(tint.cause == "tint");
    CHECK(has(joined(tint.diagnosis), "1.1, 1 and 0.8 times the red"));

    const Comparison gain =
        compared(mapped(picture, [](const Color& c) { return c * 0.5F; }), picture);
    CHECK(gain.cause == "gain");
    CHECK(has(joined(gain.diagnosis), "50 % darker (-1.00 EV)"));
}

TEST_CASE("Channels in any order are told") {
    const Image picture = discs(0, 0);
    const auto cycled = [](const Color& c) { return Color(c.y, c.z, c.x); };
    const auto greener = [](const Color& c) { return Color(c.y, c.x, c.z); };
    const Comparison cycle = compared(mapped(picture, cycled), picture);
    CHECK(cycle.cause == "channels");
    CHECK(has(joined(cycle.diagnosis), "the channels green, blue, red where"));
    CHECK(has(joined(compared(mapped(picture, greener), picture).diagnosis),
              "red and green are exchanged"));
}

TEST_CASE("Another background is told from the pictures") {
    Image test = disc(90, 70), reference = disc(90, 70);
    for (Color& c : reference.pixels)
        if (c == Color(0)) c = {0.1F, 0.2F, 0.3F};
    const Comparison result = compared(test, reference);
    CHECK(result.cause == "background");
    CHECK(has(joined(result.diagnosis), "is (0, 0, 0) in the test picture and (89, 124, 149)"));
}

TEST_CASE("A difference of edges alone is told") {
    Image test = discs(0, 0), reference = test;
    const auto edge = [&](int x, int y) {
        return std::abs(test.at(x, y).x - test.at(x + 1, y).x) > 0.05F;
    };
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 159; ++x)
            if (edge(x, y)) reference.at(x, y) = (test.at(x, y) + test.at(x + 1, y)) * 0.5F;
    const Comparison result = compared(test, reference);
    CHECK(result.verdict == Verdict::fail);
    CHECK(result.cause == "edges");
    CHECK(has(joined(result.diagnosis), "only edges differ: 100 %"));
}

TEST_CASE("What looks like nothing known has no cause") {
    Image other = disc(80, 60, {0.1F, 0.9F, 0.1F});
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) other.at(x, y) = {0.7F, 0, 0.7F};
    CHECK(cause_of(other, disc(80, 60, {0.9F, 0.4F, 0.1F})).empty());
    CHECK(cause_of(other, other).empty());
}
