#include "png_codec.h"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstring>

namespace penumbra {

namespace {

// Owns libpng's structures. libpng reports errors by longjmp, so between setjmp and the last call
// of libpng nothing may be constructed that has a destructor: everything lives in here.
struct Codec {
    png_structp png = nullptr;
    png_infop info = nullptr;
    bool reading = true;
    std::string problem = {};
    std::span<const std::byte> input = {};
    std::size_t consumed = 0;
    std::vector<std::byte> output = {};
    std::vector<png_bytep> rows = {};
    Raster raster = {};  // that is read

    explicit Codec(bool read) : reading(read) {
        png = read ? png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning)
                   : png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
        if (png != nullptr) info = png_create_info_struct(png);
    }
    ~Codec() {
        if (reading)
            png_destroy_read_struct(&png, &info, nullptr);
        else
            png_destroy_write_struct(&png, &info);
    }
    Codec(const Codec&) = delete;
    Codec& operator=(const Codec&) = delete;

    static Codec& of(png_structp png) { return *static_cast<Codec*>(png_get_error_ptr(png)); }
    [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
        of(png).problem = message;
        png_longjmp(png, 1);
    }
    static void on_warning(png_structp, png_const_charp) {}

    static void read(png_structp png, png_bytep to, std::size_t count) {
        Codec& codec = of(png);
        if (codec.input.size() - codec.consumed < count) png_error(png, "the file is cut short");
        std::memcpy(to, codec.input.data() + codec.consumed, count);
        codec.consumed += count;
    }
    static void write(png_structp png, png_bytep from, std::size_t count) {
        const auto* bytes = reinterpret_cast<const std::byte*>(from);
        of(png).output.insert(of(png).output.end(), bytes, bytes + count);
    }
    static void flush(png_structp) {}
};

// libpng takes rows that it may write to; what is written from is only read.
void point_rows(Codec& codec, const Raster& raster) {
    const std::size_t stride =
        std::size_t(raster.width) * std::size_t(raster.channels) * std::size_t(raster.depth);
    auto* const first = reinterpret_cast<png_bytep>(const_cast<std::byte*>(raster.data.data()));
    codec.rows.resize(std::size_t(raster.height));
    for (std::size_t y = 0; y < codec.rows.size(); ++y) codec.rows[y] = first + y * stride;
}

// Reads the header and makes room. False when the picture is too large.
bool prepare_to_read(Codec& codec) {
    png_set_read_fn(codec.png, &codec, Codec::read);
    png_set_error_fn(codec.png, &codec, Codec::on_error, Codec::on_warning);
    png_set_user_limits(codec.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // checked below
    png_read_info(codec.png, codec.info);
    png_set_expand(codec.png);  // palette to RGB, few bits to 8, tRNS to alpha
    if constexpr (std::endian::native == std::endian::little) png_set_swap(codec.png);
    (void)png_set_interlace_handling(codec.png);
    png_read_update_info(codec.png, codec.info);
    Raster& raster = codec.raster;
    raster.width = int(png_get_image_width(codec.png, codec.info));
    raster.height = int(png_get_image_height(codec.png, codec.info));
    raster.channels = png_get_channels(codec.png, codec.info);
    raster.depth = png_get_bit_depth(codec.png, codec.info) == 16 ? Depth::u16 : Depth::u8;
    if (std::max(raster.width, raster.height) > max_image_side ||
        raster.texels() > max_image_pixels)
        return false;
    raster.data.resize(raster.texels() * std::size_t(raster.channels) * std::size_t(raster.depth));
    point_rows(codec, raster);
    return true;
}

void read_all(Codec& codec) {
    if (setjmp(png_jmpbuf(codec.png)) != 0) return;
    if (!prepare_to_read(codec)) {
        codec.problem = "it has " + std::to_string(codec.raster.width) + " x " +
                        std::to_string(codec.raster.height) + " pixels, more than is supported";
        return;
    }
    png_read_image(codec.png, codec.rows.data());
    png_read_end(codec.png, nullptr);
}

void write_all(Codec& codec, const Raster& raster, bool srgb) {
    if (setjmp(png_jmpbuf(codec.png)) != 0) return;
    constexpr std::array<int, 4> color_types = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                                PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
    png_set_write_fn(codec.png, &codec, Codec::write, Codec::flush);
    png_set_error_fn(codec.png, &codec, Codec::on_error, Codec::on_warning);
    // Of what the Paeth filter leaves of a rendered picture, runs alone make files as small as a
    // search for repetitions does, in less than half the time.
    png_set_filter(codec.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_PAETH);
    png_set_compression_strategy(codec.png, Z_RLE);
    png_set_IHDR(codec.png, codec.info, png_uint_32(raster.width), png_uint_32(raster.height),
                 raster.depth == Depth::u16 ? 16 : 8, color_types[std::size_t(raster.channels - 1)],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (srgb) png_set_sRGB(codec.png, codec.info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(codec.png, codec.info);
    if constexpr (std::endian::native == std::endian::little)
        if (raster.depth == Depth::u16) png_set_swap(codec.png);
    png_write_image(codec.png, codec.rows.data());
    png_write_end(codec.png, nullptr);
}

}  // namespace

bool is_png(std::span<const std::byte> file) {
    return file.size() >= 8 &&
           png_sig_cmp(reinterpret_cast<png_const_bytep>(file.data()), 0, 8) == 0;
}

Decoded decode_png(std::span<const std::byte> file) {
    Codec codec(true);
    if (codec.info == nullptr) return {{}, "out of memory"};
    codec.input = file;
    read_all(codec);
    if (!codec.problem.empty()) return {{}, codec.problem};
    return {std::move(codec.raster), {}};
}

Encoded encode_png(const Raster& raster, bool srgb) {
    Codec codec(false);
    if (codec.info == nullptr) return {{}, "out of memory"};
    point_rows(codec, raster);
    write_all(codec, raster, srgb);
    return {std::move(codec.output), codec.problem};
}

}  // namespace penumbra
