// Alpha of picture files, and what of them is not read.
#include "base/file.h"
#include "image/contents.h"
#include "support/image_samples.h"

#include "penumbra/picture.h"

#include <cstring>

using namespace penumbra;
using test::bytes;
using test::Bytes;
using test::TempDir;

namespace {

Bytes together(std::initializer_list<Bytes> parts) {
    Bytes all;
    for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::vector<std::string> unread(std::initializer_list<Bytes> parts) {
    return contents_of(together(parts)).unread;
}

template <class Sample>
Raster rgba(Depth depth, const std::vector<Sample>& values) {
    Raster raster = {int(values.size() / 4), 1, 4, depth, {}};
    raster.data.resize(values.size() * sizeof(Sample));
    std::memcpy(raster.data.data(), values.data(), raster.data.size());
    return raster;
}

}  // namespace

TEST_CASE("Pictures, colours are multiplied by alpha whether the file has done so or not") {
    const TempDir folder;
    save_raster(folder / "straight.png",
                rgba<std::uint8_t>(Depth::u8, {255, 188, 0, 128, 9, 9, 9, 0, 255, 0, 255, 255}));
    const Picture straight = load_picture(folder / "straight.png");
    const float half = 128 / 255.F;
    CHECK(straight.use == Alpha::counted);
    CHECK(straight.colors.at(0, 0) == Color(half, srgb_to_linear(188 / 255.F) * half, 0));
    CHECK(straight.colors.at(1, 0) == Color(0));
    CHECK(straight.colors.at(2, 0) == Color(1, 0, 1));
    CHECK(straight.alpha.data == bytes({128, 0, 255}));

    save_raster(folder / "associated.exr",
                rgba<float>(Depth::f32, {0.5F, 0.25F, 0, 0.5F, 0.3F, 0, 0, 0, 4, 0, 1, 1}));
    const Picture associated = load_picture(folder / "associated.exr");
    CHECK(associated.use == Alpha::counted);
    CHECK(associated.colors.at(0, 0) == Color(0.5F, 0.25F, 0));
    CHECK(associated.colors.at(1, 0) == Color(0));
    CHECK(associated.colors.at(2, 0) == Color(4, 0, 1));
}

TEST_CASE("Pictures, alpha may be ignored, absent or 1 everywhere") {
    const TempDir folder;
    save_raster(folder / "a.png", rgba<std::uint8_t>(Depth::u8, {255, 0, 0, 0}));
    const Picture ignored = load_picture(folder / "a.png", true);
    CHECK(ignored.use == Alpha::ignored);
    CHECK(ignored.colors.at(0, 0) == Color(1, 0, 0));
    CHECK(ignored.alpha.data.empty());
    save_raster(folder / "b.png", rgba<std::uint8_t>(Depth::u8, {255, 0, 0, 255}));
    CHECK(load_picture(folder / "b.png").use == Alpha::counted);
    CHECK(load_picture(folder / "b.png").alpha.data.empty());
    save_image(folder / "c.png", test::gradient());
    CHECK(load_picture(folder / "c.png").use == Alpha::none);
    CHECK(load_picture(folder / "c.png").losses.empty());
}

TEST_CASE("Pictures, further frames and colour profiles are named") {
    const Bytes png = bytes("\x89PNG\r\n\x1a\n");
    const Bytes frames = together(
        {bytes({0, 0, 0, 8}), bytes("acTL"), bytes({0, 0, 0, 3, 0, 0, 0, 0}), bytes({0, 0, 0, 0})});
    CHECK(unread({png, frames}) ==
          std::vector<std::string>{"has 3 frames, and only the first is read"});
    const auto profile = [](const std::string& name) {
        return together({bytes({0, 0, 0, int(name.size() + 2)}), bytes("iCCP"), bytes(name),
                         bytes({0, 0}), bytes({0, 0, 0, 0})});
    };
    CHECK(unread({png, profile("Display P3")}) ==
          std::vector<std::string>{
              "has a colour profile (ICC) other than sRGB, and its samples are taken as sRGB"});
    CHECK(unread({png, profile("sRGB IEC61966-2.1")}).empty());
    // A zlib stream without compression: 0x78 0x01, a stored block, Adler-32 left out.
    const auto packed = [](const std::string& text) {
        const int size = int(text.size());
        return together({bytes({0, 0, 0, 5 + 7 + size}), bytes("iCCP"), bytes("icc"), bytes({0, 0}),
                         bytes({0x78, 1, 1, size, 0, 255 - size, 255}), bytes(text),
                         bytes({0, 0, 0, 0})});
    };
    CHECK(unread({png, packed("desc sRGB built-in")}).empty());
    CHECK(unread({png, packed("desc Display P3")}).size() == 1);

    const auto gamma = [](int high, int low) {
        return together({bytes({0, 0, 0, 4}), bytes("gAMA"),
                         bytes({0, high / 256, high % 256, low}), bytes({0, 0, 0, 0})});
    };
    CHECK(
        unread({png, gamma(0x186, 0xA0)}) ==  // 1.0
        std::vector<std::string>{"has a gamma (gAMA) other than that of sRGB, and its samples are "
                                 "taken as sRGB"});
    CHECK(unread({png, gamma(0xB1, 0x8F)}).empty());
    const Bytes srgb = together({bytes({0, 0, 0, 1}), bytes("sRGB"), bytes({0, 0, 0, 0, 0})});
    CHECK(unread({png, srgb, gamma(0x186, 0xA0)}).empty());

    const Bytes gif = together(
        {bytes("GIF89a"), bytes({1, 0, 1, 0, 0x80, 0, 0}), bytes({0, 0, 0, 255, 255, 255})});
    const Bytes frame =
        bytes({0x21, 0xF9, 4, 0, 0, 0, 0, 0, 0x2C, 0, 0, 0, 0, 1, 0, 1, 0, 0, 2, 2, 0x44, 1, 0});
    CHECK(unread({gif, frame, bytes({0x3B})}).empty());
    CHECK(unread({gif, frame, frame, bytes({0x3B})}) ==
          std::vector<std::string>{"has 2 frames, and only the first is read"});
}

TEST_CASE("Pictures, further pages of a TIFF are named, and alpha that is associated is known") {
    // Two directories, each of one entry: ExtraSamples, one short.
    const auto directory = [](int extra, int next) {
        return bytes({1, 0, 0x52, 1, 3, 0, 1, 0, 0, 0, extra, 0, 0, 0, next, 0, 0, 0});
    };
    const Bytes start = bytes({'I', 'I', 42, 0, 8, 0, 0, 0});
    const Contents two = contents_of(together({start, directory(1, 26), directory(2, 0)}));
    CHECK(two.associated_alpha);
    CHECK(two.unread == std::vector<std::string>{"has 2 pages, and only the first is read"});
    const Contents one = contents_of(together({start, directory(2, 0)}));
    CHECK_FALSE(one.associated_alpha);
    CHECK(one.unread.empty());
    // A list that leads back to itself ends.
    CHECK(contents_of(together({start, directory(2, 8)})).unread.size() == 1);
}
