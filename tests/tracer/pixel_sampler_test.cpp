// The recursive rule, followed cell by cell, against the sampler that takes a tile at a time.
#include "support/small_scenes.h"
#include "support/support.h"
#include "tracer/pixel_sampler.h"

#include "penumbra/tracer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

using namespace penumbra;

namespace {

// A picture as a function of points, in pixels.
using Picture = std::function<Color(double x, double y)>;

float distance(const Color& a, const Color& b) {
    float sum = 0;
    for (int i = 0; i < 3; ++i)
        sum += std::abs(std::pow(std::max(a[i], 0.F), 0.4F) - std::pow(std::max(b[i], 0.F), 0.4F));
    return sum;
}

// The rule as POV-Ray has it: one square after the other.
Vec3 square(const Picture& picture, const Antialiasing& rule, double x, double y, double side,
            int depth) {
    const std::array corners = {picture(x, y), picture(x + side, y), picture(x, y + side),
                                picture(x + side, y + side)};
    bool differ = false;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j)
            differ = differ || distance(corners[i], corners[j]) >= float(rule.threshold);
    Vec3 sum(0);
    if (depth <= 1 || !differ) {
        for (const Color& corner : corners) sum += Vec3(corner);
        return sum / 4.0;
    }
    const double half = side / 2;
    for (const double dy : {0.0, half})
        for (const double dx : {0.0, half})
            sum += square(picture, rule, x + dx, y + dy, half, depth - 1);
    return sum / 4.0;
}

Color slanted_edge(double x, double y) {
    return x + 0.37 * y > 19.3 ? Color(0.9F, 0.5F, 0.1F) : Color(0.1F, 0.2F, 0.3F);
}

Color rings(double x, double y) {
    return Color(float(0.5 + 0.5 * std::sin(0.05 * (x * x + y * y))), 0.25F, -0.5F);
}

// The sampler's pixels, and how many points it asked for.
struct Sampled {
    std::vector<Vec3> pixels = {};
    std::size_t points = 0, different = 0;
};

Sampled sampled(const Picture& picture, const PictureTile& tile, const Antialiasing& rule) {
    Sampled result;
    std::set<std::pair<double, double>> seen;
    AdaptiveSampler sampler;
    sampler.sample(tile, rule, [&](std::span<const Vec2> points, std::span<Color> colors) {
        REQUIRE(points.size() == colors.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            seen.emplace(points[i].x, points[i].y);
            colors[i] = picture(points[i].x, points[i].y);
        }
        result.points += points.size();
    });
    result.pixels = sampler.pixels();
    result.different = seen.size();
    return result;
}

}  // namespace

TEST_CASE("AdaptiveSampler, gives each pixel what the rule gives it by itself") {
    const Antialiasing rule = {GENERATE(0.0, 0.05, 0.1, 0.5, 5.0), GENERATE(1, 2, 3, 5)};
    const Picture picture = GENERATE(Picture(slanted_edge), Picture(rings));
    const PictureTile tile = {8, 5, 21, 13};
    const Sampled result = sampled(picture, tile, rule);
    REQUIRE(result.pixels.size() == 21 * 13);
    for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x) {
            const Vec3 expected = square(picture, rule, tile.x + x, tile.y + y, 1, rule.depth);
            const Vec3 found = result.pixels[std::size_t(y * tile.width + x)];
            REQUIRE((found - expected).length() < 1e-6);
        }
}

TEST_CASE("AdaptiveSampler, traces corners once and no more than it needs") {
    const PictureTile tile = {32, 64, 32, 32};
    const auto flat = [](double, double) { return Color(0.3F, 0.7F, 0.1F); };
    const Sampled plain = sampled(flat, tile, {});
    CHECK(plain.points == 33 * 33);
    for (const Vec3& pixel : plain.pixels) CHECK(Color(pixel) == Color(0.3F, 0.7F, 0.1F));

    const auto edge = [](double x, double) { return Color(x > 40.1 ? 1.F : 0.F); };
    const Sampled one_column = sampled(edge, tile, {0.1, 3});
    CHECK(one_column.different == one_column.points);
    // In one column of pixels 3 new points for each half row and two more, twice.
    CHECK(one_column.points == 33 * 33 + (32 * 3 + 32 + 1) + (64 * 3 + 64 + 1));
    CHECK(one_column.pixels[8].x == Approx(0.875));

    CHECK(sampled(rings, {0, 0, 32, 32}, {0, 3}).points == 129 * 129);
}

TEST_CASE("AdaptiveSampler, cuts many cells in pieces without a difference") {
    const Antialiasing deep = {0, 7};  // 64 x 64 cells a pixel
    const PictureTile tile = {0, 0, 3, 2};
    const Sampled result = sampled(rings, tile, deep);
    for (int i = 0; i < 6; ++i) {
        const Vec3 expected = square(rings, deep, i % 3, i / 3, 1, deep.depth);
        CHECK((result.pixels[std::size_t(i)] - expected).length() < 1e-6);
    }
}

TEST_CASE("render, anti-aliases to the same bytes on any threads and in any rows") {
    Scene scene = test::empty_scene();
    scene.materials[0].ambient = Color(0.3F);
    scene.materials[0].reflection = Color(0.4F);
    scene.materials[0].pattern = Checker{.colors = {Color(1), Color(0)}, .size = 0.4};
    scene.planes = {{"floor", {0, -1, 0}, {0, 1, 0}, 0}};
    scene.spheres = {{"ball", {0, 0, 0}, 1.3, 0}};
    scene.lights = {{.name = "lamp", .position = {3, 5, 6}}};
    RenderOptions options = {
        .width = 90, .height = 70, .antialiasing = Antialiasing{.threshold = 0.2}, .threads = 1};
    const NormalisedScene normalised = test::as_is(scene);
    const Tracer tracer(normalised);
    const Image one = tracer.render(options);
    options.threads = 3;
    CHECK(tracer.render(options).pixels == one.pixels);
    for (const RowRange& rows : {RowRange{0, 32}, RowRange{32, 64}, RowRange{64, 70}})
        tracer.render_rows(options, rows, [&](int first, const Image& some) {
            CHECK(std::equal(some.pixels.begin(), some.pixels.end(), &one.at(0, first)));
        });

    // Another setting is another picture, and a shift moves this one.
    RenderOptions other = options;
    other.antialiasing->depth = 3;
    CHECK(tracer.render(other).pixels != one.pixels);
    const Image moved = tracer.render(options, {.dx = 1, .dy = 0});
    for (int y = 0; y < 70; ++y)
        for (int x = 0; x + 1 < 90; ++x)
            REQUIRE((moved.at(x, y) - one.at(x + 1, y)).length() < 1e-5F);
}
