// compare as its users run it: what it says of alpha, of single pixels and of memory.
#include "support/program.h"

#include "penumbra/image.h"

#include <nlohmann/json.hpp>

#include <algorithm>

using namespace test;
using nlohmann::json;

namespace {

// A grey ramp with a square whose colour and alpha are given.
void write_png(const fs::path& file, int red, int alpha) {
    penumbra::Raster raster = {64, 48, 4, penumbra::Depth::u8, {}};
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const bool inside = x >= 20 && x < 40 && y >= 10 && y < 30;
            for (const int value : {inside ? red : 4 * x, 4 * x, 4 * x, inside ? alpha : 255})
                raster.data.push_back(std::byte(value));
        }
    penumbra::save_raster(file, raster);
}

}  // namespace

TEST_CASE("compare counts alpha unless it is told to ignore it, and says so") {
    const TempDir folder;
    write_png(folder / "solid.png", 200, 255);
    write_png(folder / "hole.png", 200, 0);
    write_png(folder / "other.png", 10, 0);
    const Ended hole = run(folder.path, {"compare", "hole.png", "solid.png"});
    CHECK(hole.status == 1);
    CHECK(hole.out.find("  alpha is compared, ") != std::string::npos);
    CHECK(hole.out.find(" alpha 0, solid.png (") != std::string::npos);
    CHECK(run(folder.path, {"compare", "hole.png", "other.png"}).status == 0);
    CHECK(run(folder.path, {"compare", "hole.png", "other.png", "--alpha", "count"}).status == 0);
    const Ended ignored =
        run(folder.path, {"compare", "hole.png", "solid.png", "--alpha", "ignore", "--json"});
    CHECK(ignored.status == 0);
    CHECK(json::parse(ignored.out)["cases"][0]["alpha"] == "ignored");
    CHECK(run(folder.path, {"compare", "hole.png", "other.png", "--alpha", "ignore"}).status == 1);

    const Ended report =
        run(folder.path, {"compare", "hole.png", "solid.png", "--json", "--report", "out"});
    const json one = json::parse(report.out)["cases"][0];
    CHECK(one["alpha"] == "counted");
    CHECK(one["pixels"] == json{{"compared", 64 * 48}, {"differing", 400}});
    CHECK(one["worst_pixel"]["test_alpha"] == 0);
    CHECK(one["worst_pixel"]["reference_alpha"] == 1);
    CHECK(test::read(folder / "out/index.html").find("alpha is compared, ") != std::string::npos);

    test::write(folder / "a.ppm", ppm(40, 30, 100));
    const Ended none = run(folder.path, {"compare", "a.ppm", "a.ppm"});
    CHECK(none.out.find("alpha") == std::string::npos);
}

TEST_CASE("compare tells a single pixel from none") {
    const TempDir folder;
    penumbra::Raster raster = {2000, 1000, 1, penumbra::Depth::u8, {}};
    for (std::size_t i = 0; i < raster.texels(); ++i)
        raster.data.push_back(std::byte((i % 2000) / 8 % 200));
    penumbra::save_raster(folder / "a.png", raster);
    raster.data[1000500] = std::byte(255);
    penumbra::save_raster(folder / "b.png", raster);
    const Ended ended = run(folder.path, {"compare", "a.png", "b.png", "--min-parity", "1"});
    CHECK(ended.status == 1);
    CHECK(ended.out.find("  parity             0.9999995   >= 1        NOT MET   1 of 2,000,000 "
                         "pixels differs\n") != std::string::npos);
    CHECK(ended.out.find("edges differ") == std::string::npos);
}

TEST_CASE("compare takes 60 bytes a pixel at most, and says when there is less") {
    const TempDir folder;
    penumbra::Raster raster = {2000, 2000, 3, penumbra::Depth::u8, {}};
    for (std::size_t i = 0; i < 3 * raster.texels(); ++i)
        raster.data.push_back(std::byte(i / 40 % 251));
    penumbra::save_raster(folder / "a.png", raster);
    for (std::size_t i = 0; i < raster.data.size(); i += 7) raster.data[i] = std::byte(i % 13);
    penumbra::save_raster(folder / "b.png", raster);
    const Ended ended = run(folder.path, {"compare", "a.png", "b.png"});
    CHECK(ended.status == 1);
#if !defined(__SANITIZE_ADDRESS__)
    // What the program takes before it has seen a picture, and for some rows of them.
    const std::size_t always = std::size_t(140) << 20;
    CHECK(ended.peak < always + 60 * raster.texels());
#endif
    const Ended refused = run(folder.path, {"compare", "a.png", "b.png", "--max-memory", "200M"});
    CHECK(refused.status == 3);
    // The memory of the sanitizers is counted as well: it ends before both pictures are read.
#if !defined(__SANITIZE_ADDRESS__)
    CHECK(
        refused.err.starts_with("penumbra: error: comparing pictures of 2000x2000 pixels: needs "));
#endif
    CHECK(refused.err.ends_with("(raise it with --max-memory)\n"));
    CHECK(std::ranges::count(refused.err, '\n') == 1);
}
