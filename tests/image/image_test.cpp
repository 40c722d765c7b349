#include "base/file.h"
#include "image/jpeg_decoder.h"
#include "image/picture_writer.h"
#include "image/texels.h"
#include "support/image_samples.h"

#include "penumbra/image_module.h"

#include <sys/stat.h>

#include <array>
#include <cmath>
#include <thread>
#include <vector>

using namespace penumbra;
using test::bytes;
using test::Bytes;
using test::gradient;
using test::samples;
using test::Values;

namespace {

void append(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }

template <class Sample>
void append_all(Bytes& to, std::initializer_list<Sample> values) {
    const auto raw = std::as_bytes(std::span(values.begin(), values.size()));
    to.insert(to.end(), raw.begin(), raw.end());
}

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

Raster decode(const Bytes& file) { return decode_image(file, "test"); }

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

TEST_CASE("samples of every depth are read as linear values") {
    const Raster rgba = {1, 2, 4, Depth::u8, bytes({0, 128, 255, 7, 10, 20, 30, 40})};
    const LinearSamples linear(rgba, false), decoded(rgba, true);
    CHECK(linear[1] == 128 / 255.0F);
    CHECK(linear[3] == 7 / 255.0F);
    CHECK(decoded[1] == srgb_to_linear(128 / 255.0F));
    CHECK(linear.color(1) == Color(10 / 255.0F, 20 / 255.0F, 30 / 255.0F));
    CHECK(decoded.color(0) == Color(0, srgb_to_linear(128 / 255.0F), 1));

    Raster grey = {2, 1, 2, Depth::u16, {}};  // grey and alpha
    append_all<std::uint16_t>(grey.data, {1, 2, 40000, 65535});
    CHECK(LinearSamples(grey, false).color(1) == Color(40000 / 65535.0F));
    CHECK(LinearSamples(grey, true).color(0) == Color(srgb_to_linear(1 / 65535.0F)));
    CHECK(LinearSamples(grey, false)[3] == 1);

    Raster floats = {1, 1, 3, Depth::f32, {}};
    append_all<float>(floats.data, {-2, 0.5F, 1e6F});
    CHECK(LinearSamples(floats, true).color(0) == Color(-2, 0.5F, 1e6F));
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
