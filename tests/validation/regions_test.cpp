// What of a picture counts: masks, tolerances, the covered part, edges, tiles.
#include "support/pictures.h"
#include "support/support.h"

#include "penumbra/compare.h"

#include <cmath>
#include <limits>

using namespace penumbra;
using test::constant;
using test::disc;
using test::has;
using test::joined;
using test::shifted;

namespace {

void fill(Image& image, const PixelBox& box, const Color& color) {
    for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x) image.at(x, y) = color;
}

}  // namespace

TEST_CASE("A masked reference has the test's pixels where they are ignored and its own elsewhere") {
    const Image reference = constant(8, 6, Color(0.5F)), test = constant(8, 6, Color(0.25F));
    CompareOptions options;
    options.ignored = {{1, 2, 3, 4}};
    options.mask = constant(8, 6, Color(1));
    options.mask.at(7, 5) = Color(0);
    const Image masked = masked_reference(test, reference, options);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 8; ++x) {
            const bool ignored = (x >= 1 && x < 3 && y >= 2 && y < 4) || (x == 7 && y == 5);
            CHECK(masked.at(x, y) == (ignored ? test : reference).at(x, y));
        }
}

TEST_CASE("Ignored pixels count nowhere") {
    const Image reference = disc(96, 64);
    Image test = reference;
    fill(test, {10, 20, 40, 30}, Color(3));
    CompareOptions options;
    REQUIRE(compare(test, reference, options).verdict == Verdict::fail);
    SECTION("in a box") { options.ignored = {{10, 20, 30, 30}, {30, 20, 1000, 30}}; }
    SECTION("by a mask") {
        options.mask = constant(96, 64, Color(1));
        fill(options.mask, {10, 20, 40, 30}, Color(0));
    }
    SECTION("whatever they are") {
        options.ignored = {{10, 20, 40, 30}};
        test.at(12, 22).x = std::numeric_limits<float>::quiet_NaN();
    }
    const Comparison result = compare(test, reference, options);
    CHECK(result.verdict == Verdict::pass);
    CHECK(result.diagnosis.empty());
    CHECK(result.value("parity") == 1);
    CHECK(result.value("exactness") == 1);
    CHECK(result.value("max_error") == 0);
    CHECK(result.value("rmse") == 0);
    CHECK(result.value("ssim_tile") == Approx(1).margin(1e-7));
    CHECK(result.value("flip") == 0);
    CHECK(result.value("outliers") == 0);
    CHECK(result.worst_tiles.empty());
}

TEST_CASE("Means are over the pixels that count") {
    Image test = constant(40, 40, Color(0.5F)), reference = test;
    fill(test, {0, 0, 20, 10}, Color(1));  // 200 of 1600 pixels
    CompareOptions options;
    options.background = Color(0);
    CHECK(compare(test, reference, options).value("parity") == Approx(1 - 200 / 1600.0));
    options.ignored = {{0, 20, 40, 40}};  // half of the picture
    const Comparison half = compare(test, reference, options);
    CHECK(half.value("parity") == Approx(1 - 200 / 800.0));
    CHECK(half.value("exactness") == Approx(1 - 200 / 800.0));
    const double encoded = 1 - double(linear_to_srgb(0.5F));
    CHECK(half.value("rmse") == Approx(encoded * std::sqrt(200 / 800.0)));
    CHECK(half.value("bias") == Approx(encoded * 200 / 800));
    CHECK(has(joined(half.diagnosis), "200 of 800 pixels differ"));
    // NaN where it counts still is an obstacle.
    test.at(5, 5).x = std::numeric_limits<float>::quiet_NaN();
    CHECK(compare(test, reference, options).verdict == Verdict::not_comparable);
}

TEST_CASE("A mask of another size is refused") {
    CompareOptions options;
    options.mask = constant(10, 20, Color(1));
    CHECK(test::message_of([&] { compare(disc(30, 20), disc(30, 20), options); }) ==
          "the mask has 10x20 pixels, the pictures have 30x20");
}

TEST_CASE("A mask that ignores everything leaves nothing to compare") {
    CompareOptions options;
    SECTION("mask") { options.mask = constant(30, 20, Color(0)); }
    SECTION("box") { options.ignored = {{-5, -5, 50, 50}}; }
    const Comparison result = compare(disc(30, 20), disc(30, 20), options);
    CHECK(result.verdict == Verdict::not_comparable);
    CHECK(joined(result.diagnosis) == "the mask and the ignored boxes leave no pixel to compare\n");
}

TEST_CASE("Tiles count when a quarter of their pixels do") {
    Image reference = constant(64, 16, Color(0.4F)), test = reference;
    fill(test, {16, 0, 32, 16}, Color(0.8F));  // all of the second tile
    CompareOptions options;
    options.background = Color(0);
    const double all = compare(test, reference, options).value("flip_tile");
    options.ignored = {{16, 0, 28, 16}};  // a quarter is left
    CHECK(compare(test, reference, options).value("flip_tile") > 0.3 * all);
    options.ignored = {{16, 0, 29, 16}};
    CHECK(compare(test, reference, options).value("flip_tile") < 0.1 * all);
}

TEST_CASE("A shift tolerance accepts the colours of neighbours in both pictures") {
    const Image reference = disc(96, 70);
    CompareOptions options;
    CHECK(compare(shifted(reference, 1, 0), reference, options).value("parity") < 0.99);
    options.shift_tolerance = 1;
    const Comparison moved = compare(shifted(reference, 1, -1), reference, options);
    CHECK(moved.value("parity") == 1);
    CHECK(moved.value("ssim") == 1);  // and so with all other figures
    CHECK(moved.value("flip") == 0);
    CHECK(moved.verdict == Verdict::pass);
    CHECK(compare(shifted(reference, 2, 0), reference, options).value("parity") < 1);
    options.shift_tolerance = 2;
    CHECK(compare(shifted(reference, 2, 0), reference, options).value("parity") == 1);
    // What only one of the pictures shows has no match, whichever it is.
    Image dotted = reference;
    dotted.at(3, 3) = Color(1);
    CHECK(compare(dotted, reference, options).value("parity") == Approx(1 - 1 / 6720.0));
    CHECK(compare(reference, dotted, options).value("parity") == Approx(1 - 1 / 6720.0));
}

TEST_CASE("Outliers are what no neighbour matches to 8/255") {
    const Image reference = disc(100, 100);
    CHECK(compare(shifted(reference, 1, 1), reference).value("outliers") == 0);
    CHECK(compare(shifted(reference, 3, 0), reference).value("outliers") > 0.005);
    Image test = reference;
    const auto grey = [](int byte) { return Color(srgb_to_linear(float(byte) / 255)); };
    fill(test, {0, 0, 2, 5}, grey(8));
    CHECK(compare(test, reference).value("outliers") == 0);
    fill(test, {0, 0, 2, 5}, grey(9));
    CHECK(compare(test, reference).value("outliers") == Approx(0.001));
    CompareOptions options;
    options.shift_tolerance = 3;
    CHECK(compare(shifted(reference, 3, 0), reference, options).value("outliers") == 0);
}

TEST_CASE("Figures of the covered part leave out the background") {
    const Image reference = constant(40, 40, {0.2F, 0.4F, 0.6F});
    Image a = reference, b = reference;
    fill(a, {10, 10, 30, 30}, Color(0.5F));  // 400 of 1600 pixels
    fill(b, {10, 10, 30, 30}, Color(0.5F));
    fill(b, {10, 10, 20, 30}, Color(0.6F));  // 200 of them
    const Comparison result = compare(a, b);
    CHECK(result.value("coverage") == 0.25);
    CHECK(result.value("parity") == Approx(1 - 200 / 1600.0));
    CHECK(result.value("parity_covered") == Approx(0.5));
    CHECK(result.value("rmse_covered") == Approx(2 * result.value("rmse")));
    CHECK(result.value("psnr_db_covered") ==
          Approx(result.value("psnr_db") - 20 * std::log10(2.0)));
    CHECK(result.value("bias_covered") == Approx(4 * result.value("bias")));
    CHECK(result.value("flip_covered") > 2 * result.value("flip"));
    CHECK(result.value("ssim_covered") < result.value("ssim"));
}

TEST_CASE("Figures of the covered part are of the objects where they are known") {
    const Image reference = constant(40, 40, Color(0));
    Image test = reference;
    fill(test, {10, 10, 20, 30}, Color(0.6F));  // 200 of 1600 pixels
    CompareOptions options;
    options.covered.resize(40 * 40);
    for (int y = 10; y < 30; ++y)
        for (int x = 10; x < 30; ++x) options.covered[std::size_t(y * 40 + x)] = true;
    const Comparison result = compare(test, reference, options);
    CHECK(result.value("coverage") == 0.25);
    CHECK(result.value("parity_covered") == Approx(0.5));
    CHECK(result.value("rmse_covered") == Approx(2 * result.value("rmse")));

    options.ignored = {{0, 0, 40, 20}};
    CHECK(compare(test, reference, options).value("coverage") == 0.25);
    options.covered.pop_back();
    CHECK(test::message_of([&] { (void)compare(test, reference, options); }) ==
          "what is covered must have a value for each of the 1600 pixels, not 1599");
}

TEST_CASE("Black objects on black are comparable where they are known") {
    const Image black = constant(64, 48, Color(0));
    CHECK(compare(black, black).verdict == Verdict::not_comparable);
    CompareOptions options;
    options.covered.assign(64 * 48, false);
    std::fill_n(options.covered.begin(), 64, true);
    const Comparison result = compare(black, black, options);
    CHECK(result.verdict == Verdict::pass);
    CHECK(result.value("coverage") == Approx(1.0 / 48));
    CHECK(result.value("parity_covered") == 1);

    options.covered.assign(64 * 48, false);
    const Comparison empty = compare(black, black, options);
    CHECK(empty.verdict == Verdict::not_comparable);
    REQUIRE(empty.diagnosis.size() == 1);
    CHECK(empty.diagnosis[0] == "only 0 % of the picture shows an object, at least 1 % must: point "
                                "the camera at the scene");
}

TEST_CASE("An edge band is two pixels wide and apart from the inside") {
    Image reference = constant(50, 20, Color(0.2F)), test = reference;
    fill(reference, {25, 0, 50, 20}, Color(0.8F));
    fill(test, {26, 0, 50, 20}, Color(0.8F));
    CompareOptions options;
    options.background = Color(0);
    const Comparison result = compare(test, reference, options);
    CHECK(result.value("edges") == Approx(2 / 50.0));
    CHECK(result.value("parity_edges") == 0.5);
    CHECK(result.value("parity_inside") == 1);
    CHECK(result.value("flip_edges") > 5 * result.value("flip"));
    CHECK(result.cause == "shift");
    // A smooth ramp has none.
    for (int x = 0; x < 50; ++x)
        fill(reference, {x, 0, x + 1, 20}, Color(0.3F + 0.005F * float(x)));
    const Comparison ramp = compare(reference, reference, options);
    CHECK(ramp.value("edges") == 0);
    CHECK(ramp.value("parity_edges") == 1);
    CHECK(ramp.value("flip_edges") == 0);
}

TEST_CASE("The worst tiles are apart and come worst first") {
    const Image reference = disc(100, 60);
    Image test = reference;
    fill(test, {34, 20, 46, 30}, Color(1));
    fill(test, {82, 50, 84, 52}, Color(1));
    const std::vector<Tile> tiles = compare(test, reference).worst_tiles;
    REQUIRE(tiles.size() == 4);
    CHECK(tiles[0].x == 32);
    CHECK(tiles[0].y == 16);
    CHECK(tiles[0].side == 16);
    CHECK(tiles[0].flip == Approx(compare(test, reference).value("flip_tile")));
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = i + 1; k < 4; ++k) {
            CHECK(tiles[i].flip >= tiles[k].flip);
            CHECK((std::abs(tiles[i].x - tiles[k].x) >= 16 ||
                   std::abs(tiles[i].y - tiles[k].y) >= 16));
        }
}

TEST_CASE("Exposure brightens what is encoded and nothing else") {
    const Image reference = disc(60, 50);
    Image test = reference;
    for (Color& c : test.pixels) c *= 1.05F;
    CompareOptions options;
    options.exposure = -2;
    const Comparison darker = compare(test, reference, options), plain = compare(test, reference);
    CHECK(darker.value("max_error") == plain.value("max_error"));
    CHECK(darker.value("rmse") < plain.value("rmse"));
    Image quarter_test = test, quarter_reference = reference;
    for (Color& c : quarter_test.pixels) c *= 0.25F;
    for (Color& c : quarter_reference.pixels) c *= 0.25F;
    const Comparison expected = compare(quarter_test, quarter_reference);
    for (const char* name : {"parity", "rmse", "ssim", "flip", "bias", "outliers", "coverage"})
        CHECK(darker.value(name) == Approx(expected.value(name)).margin(1e-9));
}
