// Writing pictures and other files.
#include "base/file.h"
#include "support/image_samples.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

using namespace penumbra;
using test::bytes;
using test::gradient;
using test::samples;
using test::Values;
namespace fs = std::filesystem;

namespace {

float largest_difference(const Image& a, const Image& b) {
    REQUIRE(a.width == b.width);
    REQUIRE(a.height == b.height);
    float largest = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const float seen = std::min(std::max(a.pixels[i][c], 0.0F), 1.0F);
            const float other = std::min(std::max(b.pixels[i][c], 0.0F), 1.0F);
            largest = std::max(largest, std::abs(linear_to_srgb(seen) - linear_to_srgb(other)));
        }
    return largest;
}

}  // namespace

TEST_CASE("a saved picture is read back") {
    const test::TempDir folder;
    const Image image = gradient();
    const auto error_of = [&](const std::string& name, int bits) {
        save_image(folder / name, image, {bits});
        return largest_difference(image, load_image(folder / name));
    };
    CHECK(error_of("8.png", 8) <= 0.5F / 255 + 1e-6F);
    CHECK(error_of("16.png", 16) <= 0.5F / 65535 + 1e-6F);
    CHECK(error_of("8.tif", 8) <= 0.5F / 255 + 1e-6F);
    CHECK(error_of("16.TIFF", 16) <= 0.5F / 65535 + 1e-6F);
    CHECK(error_of("a.jpg", 8) <= 0.08F);
    CHECK(decode_image(read_bytes(folder / "16.png"), "").depth == Depth::u16);
    CHECK(decode_image(read_bytes(folder / "16.TIFF"), "").depth == Depth::u16);
    CHECK(decode_image(read_bytes(folder / "8.png"), "").channels == 3);
}

TEST_CASE("an HDR keeps what its shared exponent can, without negative values") {
    const test::TempDir folder;
    const Image image = gradient();
    save_image(folder / "a.hdr", image);
    const Image again = load_image(folder / "a.hdr");
    int wrong = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Color& saved = image.pixels[i];
        const float step = std::max({saved.x, saved.y, saved.z}) / 128;
        for (int c = 0; c < 3; ++c)
            if (!(std::abs(again.pixels[i][c] - std::max(saved[c], 0.0F)) <= step)) ++wrong;
    }
    CHECK(wrong == 0);
}

TEST_CASE("an EXR keeps every bit of a float") {
    const test::TempDir folder;
    Image image = gradient();
    image.at(3, 4) = Color(-7.25F, 1e30F, 1.1754944e-38F);
    save_image(folder / "a.exr", image);
    CHECK(load_image(folder / "a.exr").pixels == image.pixels);
}

TEST_CASE("saved integers are the nearest to the exact value") {
    const Image image = gradient();
    const Raster raster = decode_image(encode_png(image), "");
    int wrong = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (samples(raster)[i * 3] != int(i % 32) * 8) ++wrong;
    CHECK(wrong == 0);

    Image odd(3, 1);
    odd.pixels = {Color(std::numeric_limits<float>::quiet_NaN()), Color(-1), Color(1e9F)};
    CHECK(samples(decode_image(encode_png(odd), "")) == Values{0, 0, 0, 0, 0, 0, 255, 255, 255});
}

TEST_CASE("pictures carry no date") {
    const test::TempDir folder;
    const std::time_t now = std::time(nullptr);
    const std::string year = std::to_string(1900 + std::gmtime(&now)->tm_year) + ":";
    for (const std::string name : {"a.exr", "a.tif", "a.png", "a.jpg", "a.hdr"}) {
        save_image(folder / name, gradient());
        INFO(name);
        CHECK(test::read(folder / name).find(year) == std::string::npos);
    }
}

TEST_CASE("a raster is saved as it is") {
    const test::TempDir folder;
    const Raster rgba = {2, 1, 4, Depth::u8, bytes({200, 100, 50, 0, 9, 8, 7, 3})};
    const Raster grey = {2, 1, 2, Depth::u16, bytes({1, 2, 3, 4, 5, 6, 7, 8})};
    const Raster half = {1, 1, 3, Depth::f32, bytes({0, 0, 0, 63, 0, 0, 0, 64, 0, 0, 128, 192})};
    for (const auto& [name, raster] :
         {std::pair("a.png", rgba), {"b.png", grey}, {"c.exr", half}}) {
        save_raster(folder / name, raster);
        const Raster again = decode_image(read_bytes(folder / name), name);
        CHECK(again.channels == raster.channels);
        CHECK(again.depth == raster.depth);
        CHECK(again.data == raster.data);
    }
    CHECK(test::message_of([&] { save_raster("c.png", half); }) ==
          "c.png: samples of this depth need .png (integers) or .exr (floats)");
}

TEST_CASE("a failing write says why and leaves nothing") {
    const test::TempDir folder;
    const auto message = [&](const fs::path& file) {
        return test::message_of([&] { save_image(file, gradient()); });
    };
    CHECK(message("a.webp") ==
          "a.webp: unknown picture format (use .png, .exr, .tif, .jpg or .hdr)");
    CHECK(message(folder / "no/a.png") ==
          (folder / "no/a.png").string() + ": its folder does not exist");
    fs::create_directory(folder / "is.png");
    CHECK(message(folder / "is.png") ==
          (folder / "is.png").string() + ": cannot write: is a folder");
    test::write(folder / "file", "");
    CHECK(message(folder / "file/a.png") ==
          (folder / "file/a.png").string() + ": cannot write: not a directory");
    CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 2);
}

TEST_CASE("writing replaces a file as a whole and keeps a link to it") {
    const test::TempDir folder;
    write_file(folder / "real", "first, and long");
    fs::create_symlink("real", folder / "link");
    write_file(folder / "link", "second");
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(test::read(folder / "real") == "second");
    CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 2);
    CHECK((fs::status(folder / "real").permissions() & fs::perms::owner_read) != fs::perms::none);
}
