#include "file.h"
#include "image_writer.h"
#include "jpeg_codec.h"
#include "support.h"

#include "penumbra/image.h"

#include <sys/stat.h>

#include <array>
#include <cmath>
#include <cstring>
#include <ctime>
#include <initializer_list>
#include <limits>
#include <thread>
#include <vector>

using namespace penumbra;
namespace fs = std::filesystem;

namespace {

using Bytes = std::vector<std::byte>;

Bytes bytes(std::initializer_list<int> values) {
    Bytes result;
    for (const int value : values) result.push_back(std::byte(value));
    return result;
}

Bytes bytes(const std::string& text) {
    const auto view = std::as_bytes(std::span(text));
    return {view.begin(), view.end()};
}

void append(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }

Bytes big_endian(std::uint32_t value) {
    return bytes(
        {int(value >> 24), int(value >> 16 & 255), int(value >> 8 & 255), int(value & 255)});
}

Bytes chunk(const std::string& type, const Bytes& data) {
    Bytes body = bytes(type);
    append(body, data);
    std::uint32_t crc = 0xffffffff;
    for (const std::byte b : body) {
        crc ^= std::to_integer<std::uint32_t>(b);
        for (int k = 0; k < 8; ++k) crc = (crc & 1) != 0 ? 0xedb88320 ^ (crc >> 1) : crc >> 1;
    }
    Bytes whole = big_endian(std::uint32_t(data.size()));
    append(whole, body);
    append(whole, big_endian(~crc));
    return whole;
}

// One uncompressed block; Adler-32 as RFC 1950 defines it.
Bytes zlib_stored(const Bytes& data) {
    const int n = int(data.size());
    Bytes stream = bytes({0x78, 0x01, 1, n & 255, n >> 8, ~n & 255, ~n >> 8 & 255});
    append(stream, data);
    std::uint32_t a = 1, b = 0;
    for (const std::byte value : data) {
        a = (a + std::to_integer<std::uint32_t>(value)) % 65521;
        b = (b + a) % 65521;
    }
    append(stream, big_endian(b << 16 | a));
    return stream;
}

struct PngSpec {
    int width = 1, height = 1, bits = 8;
    int color = 2;     // 0 grey, 2 RGB, 3 palette, 4 grey + alpha, 6 RGBA
    Bytes extra = {};  // chunks before the samples
    Bytes rows = {};   // each with its filter byte in front
};

Bytes png(const PngSpec& spec) {
    Bytes header = big_endian(std::uint32_t(spec.width));
    append(header, big_endian(std::uint32_t(spec.height)));
    append(header, bytes({spec.bits, spec.color, 0, 0, 0}));
    Bytes file = bytes("\x89PNG\r\n\x1a\n");
    append(file, chunk("IHDR", header));
    append(file, spec.extra);
    append(file, chunk("IDAT", zlib_stored(spec.rows)));
    append(file, chunk("IEND", {}));
    return file;
}

std::vector<int> samples(const Raster& raster) {
    std::vector<int> values;
    for (std::size_t i = 0; i < raster.data.size(); i += std::size_t(raster.depth)) {
        std::uint16_t value = 0;
        std::memcpy(&value, &raster.data[i], std::size_t(raster.depth));
        values.push_back(value);
    }
    return values;
}

Raster decode(const Bytes& file) { return decode_image(file, "test"); }

using Values = std::vector<int>;

// Every value that 8 bits can hold, and some beyond them.
Image gradient() {
    Image image(32, 17);
    for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 32; ++x)
            image.at(x, y) = Color(srgb_to_linear(float(x * 8) / 255), float(y) / 12 - 0.2F, 0.5F);
    return image;
}

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

TEST_CASE("the sRGB curve has the values of IEC 61966-2-1") {
    CHECK(srgb_to_linear(0) == 0);
    CHECK(srgb_to_linear(1) == 1);
    CHECK(srgb_to_linear(0.04F) == Approx(0.04 / 12.92));
    CHECK(srgb_to_linear(0.5F) == Approx(0.21404114));
    CHECK(linear_to_srgb(0.21404114F) == Approx(0.5));
    CHECK(linear_to_srgb(0.002F) == Approx(0.02584));
    CHECK(linear_to_srgb(-0.1F) == Approx(-1.292));
    CHECK(linear_to_srgb(2) == Approx(1.353256));
}

TEST_CASE("image, 8-bit samples are the encoded values to the nearest") {
    constexpr int side = 512;
    Image image(side, side);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const float x = float(i) / float(image.pixels.size() - 1);
        image.pixels[i] = {x * x * x, x * 1.02F - 0.01F, float(i % 256) / 255};
        image.pixels[i].z = std::nextafter(srgb_to_linear(image.pixels[i].z + 0.5F / 255), x * 2);
    }
    const Raster raster = decode_image(encode_png(image), "ramp");
    REQUIRE(raster.data.size() == image.pixels.size() * 3);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < raster.data.size(); ++i) {
        const float value = image.pixels[i / 3][int(i % 3)];
        const float encoded = std::clamp(linear_to_srgb(value), 0.0F, 1.0F);
        wrong += int(raster.data[i]) != int(encoded * 255 + 0.5F);
    }
    CHECK(wrong == 0);
}

TEST_CASE("decoding and encoding sRGB returns every 16-bit value") {
    int wrong = 0;
    for (int i = 0; i < 65536; ++i) {
        const float encoded = linear_to_srgb(srgb_to_linear(float(i) / 65535));
        if (int(encoded * 65535 + 0.5F) != i) ++wrong;
    }
    CHECK(wrong == 0);
}

TEST_CASE("a PNG keeps its own depth and channels") {
    const Raster rgb = decode(png({1, 2, 8, 2, {}, bytes({0, 1, 2, 3, 0, 4, 5, 6})}));
    CHECK(rgb.width == 1);
    CHECK(rgb.height == 2);
    CHECK(rgb.channels == 3);
    CHECK(rgb.depth == Depth::u8);
    CHECK(samples(rgb) == Values{1, 2, 3, 4, 5, 6});  // the top row first

    const Raster grey = decode(png({2, 1, 16, 0, {}, bytes({0, 0, 1, 255, 254})}));
    CHECK(grey.channels == 1);
    CHECK(grey.depth == Depth::u16);
    CHECK(samples(grey) == Values{1, 65534});
}

TEST_CASE("grey of 1, 2 and 4 bits is spread over 8") {
    CHECK(samples(decode(png({8, 1, 1, 0, {}, bytes({0, 0xa0})}))) ==
          Values{255, 0, 255, 0, 0, 0, 0, 0});
    CHECK(samples(decode(png({4, 1, 2, 0, {}, bytes({0, 0x1b})}))) == Values{0, 85, 170, 255});
    CHECK(samples(decode(png({2, 1, 4, 0, {}, bytes({0, 0x5f})}))) == Values{85, 255});
}

TEST_CASE("a palette is looked up, with its alpha") {
    Bytes extra = chunk("PLTE", bytes({255, 0, 0, 10, 20, 30}));
    CHECK(samples(decode(png({2, 1, 8, 3, extra, bytes({0, 1, 0})}))) ==
          Values{10, 20, 30, 255, 0, 0});
    append(extra, chunk("tRNS", bytes({255, 7})));
    CHECK(samples(decode(png({2, 1, 8, 3, extra, bytes({0, 1, 0})}))) ==
          Values{10, 20, 30, 7, 255, 0, 0, 255});
}

TEST_CASE("alpha stays straight, however small it is") {
    const auto rgba = bytes({0, 200, 100, 50, 0, 200, 100, 50, 3});
    CHECK(samples(decode(png({2, 1, 8, 6, {}, rgba}))) == Values{200, 100, 50, 0, 200, 100, 50, 3});
    CHECK(samples(decode(png({2, 1, 8, 4, {}, bytes({0, 200, 0, 100, 3})}))) ==
          Values{200, 0, 100, 3});

    // A lossless WebP of 256 x 128 equal texels (255, 0, 0) with alpha 128.
    const auto webp = bytes({'R', 'I', 'F', 'F', 28,  0, 0, 0,  'W',  'E',  'B',  'P',
                             'V', 'P', '8', 'L', 15,  0, 0, 0,  0x2f, 0xff, 0xc0, 0x1f,
                             16,  7,   16,  253, 143, 2, 6, 34, 0xa2, 0xff, 1,    0});
    const Raster red = decode(webp);
    CHECK(red.width == 256);
    CHECK(red.height == 128);
    const Values all = samples(red);
    CHECK(Values(all.begin(), all.begin() + 4) == Values{255, 0, 0, 128});
    CHECK(Values(all.end() - 4, all.end()) == Values{255, 0, 0, 128});

    // A TGA of one column, stored from the bottom, blue first.
    const auto tga = bytes(
        {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2, 0, 32, 8, 50, 100, 200, 3, 1, 2, 3, 255});
    CHECK(samples(decode_image(tga, "a.tga")) == Values{3, 2, 1, 255, 200, 100, 50, 3});
}

TEST_CASE("a colour profile or gamma in the file changes no sample") {
    Bytes extra = chunk("gAMA", big_endian(100000));
    append(extra, chunk("iCCP", bytes("broken")));
    CHECK(samples(decode(png({1, 1, 8, 2, extra, bytes({0, 200, 1, 2})}))) == Values{200, 1, 2});
}

TEST_CASE("a picture that cannot be decoded is named with the reason") {
    const auto message = [](const Bytes& file) {
        return test::message_of([&] { decode_image(file, "wood.png"); });
    };
    CHECK(message({}) == "wood.png: cannot be read as an image (it is empty)");
    CHECK(message(bytes("no picture")) == "wood.png: cannot be read as an image (unknown format)");

    Bytes file = png({1, 1, 8, 2, {}, bytes({0, 1, 2, 3})});
    const Bytes cut(file.begin(), file.end() - 20);
    CHECK(message(cut) == "wood.png: cannot be read as an image (the file is cut short)");
    file[file.size() - 18] ^= std::byte{1};
    CHECK(message(file) == "wood.png: cannot be read as an image (IDAT: incorrect data check)");
    CHECK(message(png({60000, 60000, 8, 0, {}, {}})) ==
          "wood.png: cannot be read as an image (it has 60000 x 60000 pixels, more than "
          "is supported)");
}

TEST_CASE("a JPEG file has the samples that OpenImageIO finds in it") {
    const test::TempDir folder;
    save_image(folder / "a.jpg", gradient());
    Raster grey = {.width = 3, .height = 2, .channels = 1};
    for (const int sample : {0, 50, 100, 150, 200, 250}) grey.data.push_back(std::byte(sample));
    SampleWriter writer(folder / "grey.jpg", {3, 2, 1, Depth::u8, {}}, true);
    writer.append(grey.data);
    writer.finish();
    const MayTake always = [](std::size_t) { return true; };
    for (const Bytes& file : {read_bytes(folder / "a.jpg"), read_bytes(folder / "grey.jpg")}) {
        REQUIRE(is_jpeg(file));
        const Decoded ours = decode_jpeg(file, always);
        const Decoded theirs = image_module().decode(file, ".jpg", always);
        REQUIRE(ours.problem.empty());
        CHECK(ours.raster.width == theirs.raster.width);
        CHECK(ours.raster.channels == theirs.raster.channels);
        CHECK(ours.raster.data == theirs.raster.data);
    }
    Bytes cut = read_bytes(folder / "a.jpg");
    cut.resize(cut.size() / 2);
    CHECK(decode_jpeg(cut, always).problem == "Premature end of JPEG file");
    cut.resize(20);
    CHECK_FALSE(decode_jpeg(cut, always).problem.empty());
}

TEST_CASE("every cut of a file is either decoded or refused") {
    const test::TempDir folder;
    for (const std::string name : {"a.exr", "a.jpg", "a.tif", "a.hdr", "a.png"}) {
        save_image(folder / name, gradient());
        const Bytes whole = read_bytes(folder / name);
        for (std::size_t part = 0; part < 8; ++part) {
            const auto size = whole.size() * part / 8;
            try {
                const Raster raster = decode_image(std::span(whole).first(size), name);
                CHECK(raster.width == 32);
            } catch (const Error& error) {
                CHECK(error.failure == Failure::input);
            }
        }
    }
}

TEST_CASE("a missing file, a folder and a pipe are told apart") {
    const test::TempDir folder;
    const auto message = [&](const std::string& name) {
        return test::message_of([&] { load_image(folder / name); });
    };
    CHECK(message("none.png") == (folder / "none.png").string() + ": no such file");
    CHECK(message(".") == (folder / ".").string() + ": is a folder");
    mkfifo((folder / "pipe").c_str(), 0600);
    CHECK(message("pipe") == (folder / "pipe").string() + ": is not a regular file");
    test::write(folder / "long", "12345");
    CHECK(test::message_of([&] { read_text(folder / "long", 4); }) ==
          (folder / "long").string() + ": has 5 bytes, more than the 4 that are read");
}

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

TEST_CASE("the image module may be loaded ahead") {
    wait_for_image_module();
    preload_image_module();
    preload_image_module();
    wait_for_image_module();
    wait_for_image_module();
    CHECK_FALSE(encode_png(Image(1, 1)).empty());
}

TEST_CASE("pictures may be decoded in several threads at once") {
    const Bytes file = png({2, 1, 8, 6, {}, bytes({0, 200, 100, 50, 0, 200, 100, 50, 3})});
    std::array<Values, 4> seen;
    {
        std::vector<std::jthread> threads;
        for (Values& values : seen) threads.emplace_back([&] { values = samples(decode(file)); });
    }
    for (const Values& values : seen) CHECK(values == Values{200, 100, 50, 0, 200, 100, 50, 3});
}
