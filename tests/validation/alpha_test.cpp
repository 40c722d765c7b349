// What alpha does to a comparison, and what a pixel or two are called.
#include "support/pictures.h"
#include "support/support.h"

#include "penumbra/compare.h"

#include <cmath>

using namespace penumbra;
using test::constant;
using test::disc;
using test::has;
using test::joined;

namespace {

// `colors` as they are stored, straight, with an alpha of 8 bits.
Picture with_alpha(const Image& colors, const std::vector<int>& alpha) {
    Picture result = {.colors = colors, .use = Alpha::counted};
    result.alpha = {colors.width, colors.height, 1, Depth::u8, {}};
    for (std::size_t i = 0; i < alpha.size(); ++i) {
        result.alpha.data.push_back(std::byte(alpha[i]));
        result.colors.pixels[i] *= float(alpha[i]) / 255;
    }
    return result;
}

Picture with_hole(const Image& colors, int value) {
    std::vector<int> alpha(colors.pixels.size(), 255);
    for (int y = 20; y < 40; ++y)
        for (int x = 20; x < 60; ++x) alpha[std::size_t(y * colors.width + x)] = value;
    return with_alpha(colors, alpha);
}

}  // namespace

TEST_CASE("A hole differs from a surface, of whatever colour it is") {
    for (const Color& color : {Color(0), Color(0.2F, 0.5F, 0.9F), Color(1)}) {
        Image image = disc(96, 70);
        for (int y = 15; y < 45; ++y)
            for (int x = 15; x < 65; ++x) image.at(x, y) = color;
        const Comparison result = compare(with_hole(image, 0), with_hole(image, 255));
        CHECK(result.verdict == Verdict::fail);
        CHECK(result.alpha == Alpha::counted);
        CHECK(result.value("parity") == Approx(1 - 800.0 / (96 * 70)));
        CHECK(result.differing == 800);
        CHECK(result.pixels == 96 * 70);
        CHECK(result.value("exactness") == Approx(1 - 800.0 / (96 * 70)));
        CHECK(result.value("max_error") == 1);
        // Over black or over white it shows.
        CHECK(result.value("flip_tile") > 0.3);
        CHECK(result.value("ssim_tile") < 0.8);
        CHECK(has(joined(result.diagnosis), "differ by more than 1/255 in sRGB or alpha"));
    }
}

TEST_CASE("Pictures with the same alpha are as alike as what shows of them") {
    const Image one = disc(96, 70);
    Image other = one;
    for (int y = 20; y < 40; ++y)
        for (int x = 20; x < 60; ++x) other.at(x, y) = {0.9F, 0, 0.9F};
    const Comparison hidden = compare(with_hole(one, 0), with_hole(other, 0));
    CHECK(hidden.verdict == Verdict::pass);
    CHECK(hidden.value("parity") == 1);
    CHECK(hidden.value("flip") == 0);
    CHECK(hidden.value("max_error") == 0);
    CHECK(compare(with_hole(one, 128), with_hole(other, 128)).verdict == Verdict::fail);
    CHECK(compare(with_hole(one, 128), with_hole(one, 129)).value("parity") == 1);
    CHECK(compare(with_hole(one, 128), with_hole(one, 130)).value("parity") < 1);
}

TEST_CASE("A black shape on nothing is not an empty picture") {
    const Picture shape = with_hole(constant(96, 70, Color(0)), 255);
    Picture cut = shape;
    for (std::size_t i = 0; i < cut.alpha.data.size(); ++i) {
        const auto x = int(i % 96), y = int(i / 96);
        if (x < 20 || x >= 60 || y < 20 || y >= 40) cut.alpha.data[i] = std::byte(0);
    }
    CHECK(compare(shape, shape).verdict == Verdict::not_comparable);
    const Comparison result = compare(cut, cut);
    CHECK(result.verdict == Verdict::pass);
    CHECK(result.value("coverage") == Approx(800.0 / (96 * 70)));
}

TEST_CASE("Alpha that is 1 everywhere changes no figure") {
    const Image one = disc(96, 70), other = disc(96, 70, {0.5F, 0.31F, 0.1F});
    const std::vector<int> full(one.pixels.size(), 255);
    const Comparison plain = compare(one, other);
    const Comparison opaque = compare(with_alpha(one, full), with_alpha(other, full));
    CHECK(plain.alpha == Alpha::none);
    for (std::size_t i = 0; i < plain.metrics.size(); ++i) {
        INFO(plain.metrics[i].name);
        const double a = plain.metrics[i].value, b = opaque.metrics[i].value;
        CHECK((a == b || (std::isnan(a) && std::isnan(b))));
    }
}

TEST_CASE("A pixel or two say nothing of edges") {
    const Image reference = disc(160, 120);
    Image test = reference;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 159; ++x)
            if (reference.at(x, y).x == 0 && reference.at(x + 1, y).x > 0) {
                test.at(x, y) = Color(1);
                y = 120;
                break;
            }
    CompareOptions options;
    options.limits.limits = {{"parity", 1}};
    const Comparison result = compare(test, reference, options);
    CHECK(result.verdict == Verdict::fail);
    CHECK(result.differing == 1);
    CHECK(result.cause.empty());
    REQUIRE(result.diagnosis.size() == 1);
    CHECK(has(result.diagnosis[0], "1 of 19200 pixels differs by more than 1/255 in sRGB, within"));
}

TEST_CASE("Figures of pictures of many spans are those of the whole") {
    // Spans end within the tall one and not within the flat one.
    const auto picture = [](int w, int h, float red) {
        Image image(w, h);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                image.at(x, y) = {red * float((x * 7 + y * 13) % 97) / 97, float(x % 16) / 20,
                                  float(y % 16) / 20};
        return image;
    };
    const auto turned = [](const Image& from) {
        Image image(from.height, from.width);
        for (int y = 0; y < from.height; ++y)
            for (int x = 0; x < from.width; ++x) image.at(y, x) = from.at(x, y);
        return image;
    };
    const Image one = picture(96, 512, 1), other = picture(96, 512, 0.97F);
    const Comparison tall = compare(one, other), flat = compare(turned(one), turned(other));
    for (const Metric& metric : tall.metrics) {
        INFO(metric.name);
        if (std::isnan(metric.value)) continue;
        CHECK(metric.value == Approx(flat.value(metric.name)).epsilon(1e-5).margin(1e-6));
    }
}
