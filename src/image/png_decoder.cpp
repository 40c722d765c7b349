#include "image/png_decoder.h"

#include <png.h>

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
    std::string problem = {};
    std::span<const std::byte> input = {};
    std::size_t consumed = 0;
    std::vector<png_bytep> rows = {};
    Raster raster = {};
    const MayTake& may_take;

    explicit Codec(const MayTake& asked) : may_take(asked) {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
        if (png != nullptr) info = png_create_info_struct(png);
    }
    ~Codec() { png_destroy_read_struct(&png, &info, nullptr); }
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
};

void point_rows(Codec& codec) {
    Raster& raster = codec.raster;
    const std::size_t stride =
        std::size_t(raster.width) * std::size_t(raster.channels) * std::size_t(raster.depth);
    auto* const first = reinterpret_cast<png_bytep>(raster.data.data());
    codec.rows.resize(std::size_t(raster.height));
    for (std::size_t y = 0; y < codec.rows.size(); ++y) codec.rows[y] = first + y * stride;
}

// Of texts and the like, which may be compressed, libpng keeps one.
constexpr png_uint_32 one_chunk = 2;  // it counts down to 1; 0 means all

// libpng ends a function that it cannot finish by a jump: nothing in there may need a destructor.
void read_header(Codec& codec) {
    if (setjmp(png_jmpbuf(codec.png)) != 0) return;
    png_set_read_fn(codec.png, &codec, Codec::read);
    png_set_error_fn(codec.png, &codec, Codec::on_error, Codec::on_warning);
    png_set_user_limits(codec.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // checked below
    png_set_chunk_cache_max(codec.png, one_chunk);
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
}

// Not when the picture is too large: `problem` says so.
void make_room(Codec& codec) {
    Raster& raster = codec.raster;
    if (std::max(raster.width, raster.height) > max_image_side ||
        raster.texels() > max_image_pixels) {
        codec.problem = "it has " + std::to_string(raster.width) + " x " +
                        std::to_string(raster.height) + " pixels, more than is supported";
        return;
    }
    const std::size_t row =
        std::size_t(raster.width) * std::size_t(raster.channels) * std::size_t(raster.depth);
    const std::size_t height = std::size_t(raster.height);
    if (!codec.may_take(row * height)) {
        codec.problem = no_memory;
        return;
    }
    raster.data.resize(row * height);
    point_rows(codec);
    codec.may_take(4 * row);  // libpng's own; the picture's are in use by now
}

void read_pixels(Codec& codec) {
    if (setjmp(png_jmpbuf(codec.png)) != 0) return;
    png_read_image(codec.png, codec.rows.data());
    png_read_end(codec.png, nullptr);
}

}  // namespace

bool is_png(std::span<const std::byte> file) {
    return file.size() >= 8 &&
           png_sig_cmp(reinterpret_cast<png_const_bytep>(file.data()), 0, 8) == 0;
}

Decoded decode_png(std::span<const std::byte> file, const MayTake& may_take) {
    Codec codec(may_take);
    if (codec.info == nullptr) return {{}, no_memory};
    codec.input = file;
    for (const auto step : {read_header, make_room, read_pixels}) {
        step(codec);
        if (!codec.problem.empty()) return {{}, codec.problem};
    }
    return {std::move(codec.raster), {}};
}

}  // namespace penumbra
