#include "support/pictures.h"
#include "support/support.h"

#include "penumbra/compare.h"
#include "penumbra/image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace penumbra;
using test::constant;
using test::disc;
using test::has;
using test::joined;
using test::shifted;

namespace {

Limits only(const std::string& name, double limit) {
    Limits limits;
    limits.limits = {{name, limit}};
    return limits;
}

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

}  // namespace

TEST_CASE("Equal pictures are perfect in every figure") {
    const Image a = disc(96, 70);
    const Comparison result = compare(a, a);
    CHECK(result.verdict == Verdict::pass);
    CHECK(result.diagnosis.empty());
    CHECK(result.value("parity") == 1);
    CHECK(result.value("exactness") == 1);
    CHECK(result.value("max_error") == 0);
    CHECK(result.value("rmse") == 0);
    CHECK(result.value("psnr_db") == 999);
    CHECK(result.value("ssim") == Approx(1).margin(1e-7));
    CHECK(result.value("ssim_tile") == Approx(1).margin(1e-7));
    CHECK(result.value("flip") == 0);
    CHECK(result.value("flip_p99") == 0);
    CHECK(result.value("flip_tile") == 0);
    CHECK(result.value("bias") == 0);
    CHECK(result.flip_map.width == 96);
    CHECK(std::isnan(result.value("no such metric")));
}

TEST_CASE("Parity counts pixels within one step of 8 bits as displayed") {
    // sRGB is linear with slope 12.92 near black, so encoded = 12.92 c there.
    const Image black = constant(10, 10, Color(0));
    Image test = black;
    for (int x = 0; x < 10; ++x) test.at(x, 0).y = 0.99F / 255 / 12.92F;  // just within
    for (int x = 0; x < 10; ++x) test.at(x, 1).y = 1.01F / 255 / 12.92F;  // just beyond
    test.at(0, 2) = Color(-5);                                            // clamped away
    CompareOptions options;
    options.background = Color(1);
    const Comparison result = compare(test, black, options);
    CHECK(result.value("parity") == Approx(0.9));
    CHECK(has(joined(result.diagnosis),
              "10 of 100 pixels differ by more than 1/255 in sRGB, within (0, 1) to "
              "(9, 1)"));
}

TEST_CASE("Exactness is linear, unclamped and relative for bright values") {
    Image reference = constant(10, 10, Color(1000)), test = reference;
    test.at(0, 0).x += 0.099F;  // 1e-4 x 1000 = 0.1
    test.at(1, 0).x += 0.11F;
    reference.at(2, 0) = test.at(2, 0) = Color(0.5F);
    test.at(2, 0).z += 0.00009F;
    reference.at(3, 0) = test.at(3, 0) = Color(0.5F);
    test.at(3, 0).z += 0.00011F;
    CompareOptions options;
    options.background = Color(0);
    const Comparison result = compare(test, reference, options);
    CHECK(result.value("exactness") == Approx(0.98));
    CHECK(result.value("max_error") == Approx(0.11).margin(1e-4));
    CHECK(result.worst.x == 1);
    CHECK(result.worst.y == 0);
    CHECK(result.worst.test.x == 1000.11F);
    CHECK(result.worst.reference.x == 1000.F);
}

TEST_CASE("RMSE, PSNR and bias follow from the encoded values") {
    // 1/4 of the pixels are white in one picture and black in the other.
    const Image reference = constant(20, 20, Color(0));
    Image test = reference;
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 10; ++x) test.at(x, y) = Color(1);
    const Comparison result = compare(test, reference);
    CHECK(result.value("rmse") == Approx(0.5));
    CHECK(result.value("psnr_db") == Approx(20 * std::log10(2.0)));
    CHECK(result.value("bias") == Approx(0.25));
    CHECK(compare(reference, test).value("bias") == Approx(-0.25));
    CHECK(result.value("coverage") == Approx(0.25));

    // Blue alone has 0.0722 of the luma.
    const Comparison blue = compare(constant(4, 4, {0, 0, 1}), constant(4, 4, Color(0)));
    CHECK(blue.value("bias") == Approx(0.0722));
    CHECK(blue.value("rmse") == Approx(std::sqrt(1 / 3.0)));
}

TEST_CASE("SSIM of constant pictures is its luminance term") {
    // Without variance SSIM = (2ab + C1) / (a^2 + b^2 + C1) on the scale of 0 to 255.
    const float low = srgb_to_linear(100 / 255.F), high = srgb_to_linear(150 / 255.F);
    const Comparison result = compare(constant(40, 40, Color(low)), constant(40, 40, Color(high)));
    const double expected = (2 * 100 * 150 + 6.5025) / (100 * 100 + 150 * 150 + 6.5025);
    CHECK(result.value("ssim") == Approx(expected).margin(1e-4));
    CHECK(result.value("ssim_tile") == Approx(expected).margin(1e-4));
}

TEST_CASE("SSIM agrees with its definition, window by window") {
    const Image test = disc(23, 19, {0.4F, 0.5F, 0.2F}), reference = shifted(disc(23, 19), 1, 1);
    double total = 0, weights = 0;
    const auto mirror = [](int i, int n) {
        while (i < 0 || i >= n) i = i < 0 ? -i : 2 * (n - 1) - i;
        return i;
    };
    const auto gauss = [](int i, int j) { return std::exp(-(i * i + j * j) / (2 * 1.5 * 1.5)); };
    for (int j = -5; j <= 5; ++j)
        for (int i = -5; i <= 5; ++i) weights += gauss(i, j);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 19; ++y)
            for (int x = 0; x < 23; ++x) {
                double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
                for (int j = -5; j <= 5; ++j)
                    for (int i = -5; i <= 5; ++i) {
                        const int u = mirror(x + i, 23), v = mirror(y + j, 19);
                        const double w = gauss(i, j) / weights;
                        const double p = 255.0 * linear_to_srgb(test.at(u, v)[c]);
                        const double q = 255.0 * linear_to_srgb(reference.at(u, v)[c]);
                        a += w * p, b += w * q, aa += w * p * p, bb += w * q * q, ab += w * p * q;
                    }
                total += (2 * a * b + 6.5025) * (2 * (ab - a * b) + 58.5225) /
                         ((a * a + b * b + 6.5025) * (aa - a * a + bb - b * b + 58.5225));
            }
    CHECK(compare(test, reference).value("ssim") == Approx(total / (3 * 23 * 19)).margin(2e-6));
}

TEST_CASE("Tiles find a small defect that the mean hides") {
    const Image reference = disc(320, 240);
    Image test = reference;
    for (int y = 100; y < 106; ++y)
        for (int x = 150; x < 156; ++x) test.at(x, y) = Color(1);
    const Comparison result = compare(test, reference);
    CHECK(result.value("ssim") > 0.99);
    CHECK(result.value("ssim_tile") < 0.9);
    CHECK(result.value("flip") < 0.01);
    CHECK(result.value("flip_tile") > 0.2);
    CHECK(result.verdict == Verdict::fail);  // by flip_tile alone
    for (const Metric& metric : result.metrics) CHECK(metric.ok() == (metric.name != "flip_tile"));
}

TEST_CASE("Tiles at the border are as large as the others") {
    // 40 = 32 + 8: a defect in the last 8 columns counts with 1/32 of the last 32, not 1/8 of 8.
    const Image reference = constant(40, 32, Color(0.2F));
    Image test = reference;
    for (int y = 0; y < 32; ++y) test.at(39, y) = Color(0.3F);
    CompareOptions options;
    options.background = Color(0);
    const Comparison result = compare(test, reference, options);
    CHECK(result.value("ssim_tile") > 0.7);
    CHECK(result.value("ssim_tile") < result.value("ssim"));
}

TEST_CASE("The 99th percentile of FLIP is that of the map") {
    const Comparison result = compare(disc(50, 40), shifted(disc(50, 40), 1, 0));
    std::vector<float> values;
    for (const Color& c : result.flip_map.pixels) values.push_back(c.x);
    std::ranges::sort(values);
    CHECK(result.value("flip_p99") == values[1979]);  // rank 0.99 x 2000
}

TEST_CASE("Coverage compares with the background") {
    Image a = constant(100, 100, {0.2F, 0.4F, 0.6F}), b = a;
    for (int x = 20; x < 60; ++x) a.at(x, 50) = Color(1);  // 40 pixels
    for (int x = 40; x < 80; ++x) b.at(x, 50) = Color(1);  // 20 of them others
    CompareOptions options;
    options.limits.limits["coverage"] = 0.006;
    CHECK(compare(a, b, options).value("coverage") == Approx(0.006));
    CHECK(compare(a, b, options).verdict == Verdict::fail);

    // By default the most frequent colour of the reference's border is the background.
    const Comparison sparse = compare(a, b);
    CHECK(sparse.verdict == Verdict::not_comparable);
    CHECK(joined(sparse.diagnosis) ==
          "only 0.6 % of the picture shows something else than the background, at least 1 % must: "
          "point the camera at the scene\n");
    options.background = Color(0);
    CHECK(compare(a, b, options).value("coverage") == 1);
}

TEST_CASE("An empty picture is not comparable, not equal") {
    const Image black = constant(64, 64, Color(0));
    const Comparison result = compare(black, black);
    CHECK(result.verdict == Verdict::not_comparable);
    CHECK(result.value("parity") == 1);
    CHECK(result.value("coverage") == 0);
}

TEST_CASE("Pictures of other sizes are not comparable") {
    const Comparison result = compare(disc(64, 48), disc(64, 47));
    CHECK(result.verdict == Verdict::not_comparable);
    CHECK(joined(result.diagnosis) == "the pictures differ in size: the test picture is 64x48, the "
                                      "reference picture 64x47\n");
    for (const Metric& metric : result.metrics) {
        CHECK(std::isnan(metric.value));
        CHECK(metric.ok() == !metric.limit);
    }
    CHECK(compare(Image(), Image()).verdict == Verdict::not_comparable);
    CHECK(joined(compare(Image(), Image()).diagnosis) == "the test picture is empty\n");
    CHECK(joined(compare(disc(8, 8), Image()).diagnosis) == "the reference picture is empty\n");
}

TEST_CASE("NaN and infinity are not comparable and never pass") {
    constexpr float infinite = std::numeric_limits<float>::infinity();
    for (const float bad : {nan_value, infinite, -infinite}) {
        Image image = disc(64, 48);
        image.at(7, 3).y = bad;
        image.at(9, 30).z = bad;
        const Comparison test = compare(image, disc(64, 48));
        CHECK(test.verdict == Verdict::not_comparable);
        CHECK(joined(test.diagnosis) ==
              "2 of the test picture's 3072 pixels are NaN or infinite, the first at (7, 3)\n");
        CHECK(
            joined(compare(disc(64, 48), image).diagnosis) ==
            "2 of the reference picture's 3072 pixels are NaN or infinite, the first at (7, 3)\n");
        CHECK(compare(image, image).verdict == Verdict::not_comparable);
    }
}

TEST_CASE("A metric of NaN is never ok, and a maximum limits the magnitude") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(Metric{"parity", nan, 0.5, true}.ok());
    CHECK_FALSE(Metric{"flip", nan, 0.5, false}.ok());
    CHECK(Metric{"parity", nan, std::nullopt, true}.ok());
    CHECK(Metric{"parity", 0.5, 0.5, true}.ok());
    CHECK_FALSE(Metric{"parity", 0.49, 0.5, true}.ok());
    CHECK(Metric{"bias", -0.003, 0.003, false}.ok());
    CHECK_FALSE(Metric{"bias", -0.0031, 0.003, false}.ok());
    CHECK_FALSE(Metric{"bias", 0.0031, 0.003, false}.ok());
}

TEST_CASE("A result close to its limit passes with a warning") {
    const Image reference = disc(100, 100);
    Image test = reference;
    for (int x = 0; x < 9; ++x) test.at(40 + x, 40) = Color(1);  // parity 0.9991
    CompareOptions options;
    options.limits = only("parity", 0.999);
    CHECK(compare(test, reference, options).verdict == Verdict::warn);
    CHECK(has(joined(compare(test, reference, options).diagnosis),
              "parity 0.9991 is within 20 % of its limit 0.999\n"));
    options.limits = only("parity", 0.998);
    CHECK(compare(test, reference, options).verdict == Verdict::pass);
    options.limits = only("parity", 0.9992);
    CHECK(compare(test, reference, options).verdict == Verdict::fail);

    const double bias = compare(test, reference).value("bias");
    REQUIRE(bias > 0);
    options.limits = only("bias", bias * 1.1);
    CHECK(compare(reference, test, options).verdict == Verdict::warn);  // bias is negative here
    options.limits = only("bias", bias * 1.3);
    CHECK(compare(reference, test, options).verdict == Verdict::pass);
    options.limits = only("bias", bias * 0.9);
    CHECK(compare(reference, test, options).verdict == Verdict::fail);

    const double psnr = compare(test, reference).value("psnr_db");
    options.limits = only("psnr_db", psnr - 1.9);  // 20 log10(1 / 0.8) = 1.938
    CHECK(compare(test, reference, options).verdict == Verdict::warn);
    options.limits = only("psnr_db", psnr - 2);
    CHECK(compare(test, reference, options).verdict == Verdict::pass);
    options.limits = only("exactness", 1);
    CHECK(compare(reference, reference, options).verdict == Verdict::pass);
}

TEST_CASE("The warn band is what the limits say") {
    const Image reference = disc(100, 100);
    Image test = reference;
    for (int x = 0; x < 9; ++x) test.at(40 + x, 40) = Color(1);  // parity 0.9991
    CompareOptions options;
    options.limits = only("parity", 0.998);
    options.limits.warn_band = 0.6;
    CHECK(compare(test, reference, options).verdict == Verdict::warn);
    CHECK(has(joined(compare(test, reference, options).diagnosis),
              "parity 0.9991 is within 60 % of its limit 0.998\n"));
    options.limits = only("parity", 0.9991);
    options.limits.warn_band = 0;
    CHECK(compare(test, reference, options).verdict == Verdict::pass);
}

TEST_CASE("The difference picture is the magnified magnitude") {
    Image a = constant(2, 1, {0.5F, 0.25F, 1}), b = constant(2, 1, {0.25F, 0.5F, 1});
    const Image d = difference(a, b, 100);
    CHECK(d.at(1, 0) == Color(25, 25, 0));
}

TEST_CASE("Pictures of other sizes have no difference picture and no masked reference") {
    const Image a = constant(2, 1, Color(1)), b = constant(1, 2, Color(1));
    const std::string sizes =
        "the pictures differ in size: the test picture is 2x1, the reference picture 1x2";
    CHECK(test::message_of([&] { difference(a, b, 1); }) == sizes);
    CHECK(test::message_of([&] { masked_reference(a, b, {}); }) == sizes);
    CHECK(test::message_of([&] { difference(Image(), a, 1); }) == "the test picture is empty");
    CompareOptions options;
    options.mask = b;
    const std::string mask = "the mask has 1x2 pixels, the pictures have 2x1";
    CHECK(test::message_of([&] { masked_reference(a, a, options); }) == mask);
    CHECK(test::message_of([&] { compare(a, a, options); }) == mask);
}

TEST_CASE("The heat map runs through magma") {
    Image map(6, 1);
    const float values[] = {0, 1, 8 / 15.F, 2, -1, nan_value};
    for (int x = 0; x < 6; ++x) map.at(x, 0) = Color(values[x]);
    const Image heat = heat_map(map);
    const auto byte = [&](int x, int c) {
        return int(std::lround(linear_to_srgb(heat.at(x, 0)[c]) * 255));
    };
    const auto rgb = [&](int x) { return byte(x, 0) << 16 | byte(x, 1) << 8 | byte(x, 2); };
    CHECK(rgb(0) == 0x000004);
    CHECK(rgb(1) == 0xfcfdbf);
    CHECK(rgb(2) == 0xc43c75);
    CHECK(rgb(3) == 0xfcfdbf);
    CHECK(rgb(4) == 0x000004);
    CHECK(rgb(5) == 0xfcfdbf);  // NaN shows
}

TEST_CASE("Verdicts have the names of the report") {
    CHECK(to_string(Verdict::pass) == "pass");
    CHECK(to_string(Verdict::warn) == "warn");
    CHECK(to_string(Verdict::fail) == "fail");
    CHECK(to_string(Verdict::not_comparable) == "not_comparable");
    CHECK(to_string(Verdict::error) == "error");
}
