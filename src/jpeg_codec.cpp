#include "jpeg_codec.h"

#include <jpeglib.h>

#include <csetjmp>
#include <cstdio>

namespace penumbra {

namespace {

// Owns libjpeg's structures. libjpeg reports errors by a function that must not return, so between
// setjmp and the last call of libjpeg nothing may be constructed that has a destructor: everything
// lives in here.
struct Reader {
    jpeg_decompress_struct jpeg = {};
    jpeg_error_mgr errors = {};
    std::jmp_buf escape = {};
    std::array<char, JMSG_LENGTH_MAX> message = {};
    Raster raster = {};

    Reader() {
        jpeg.err = jpeg_std_error(&errors);
        jpeg.client_data = this;
        errors.error_exit = on_error;
        errors.emit_message = on_warning;
        jpeg_create_decompress(&jpeg);
    }
    ~Reader() { jpeg_destroy_decompress(&jpeg); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    [[noreturn]] static void on_error(j_common_ptr info) {
        auto& reader = *static_cast<Reader*>(info->client_data);
        info->err->format_message(info, reader.message.data());
        std::longjmp(reader.escape, 1);
    }
    // libjpeg goes on with invented pixels.
    static void on_warning(j_common_ptr info, int level) {
        if (level < 0) on_error(info);
    }

    void refuse(const char* why) {
        std::snprintf(message.data(), message.size(), "%s", why);
        std::longjmp(escape, 1);
    }

    void read(std::span<const std::byte> file) {
        jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(file.data()), file.size());
        jpeg_read_header(&jpeg, TRUE);
        const bool grey = jpeg.num_components == 1;
        if (!grey && jpeg.num_components != 3) refuse("it has neither one channel nor three");
        const auto width = std::size_t(jpeg.image_width), height = std::size_t(jpeg.image_height);
        if (width > max_image_side || height > max_image_side || width * height > max_image_pixels)
            refuse("it is too large");
        jpeg.out_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
        raster.width = int(width);
        raster.height = int(height);
        raster.channels = grey ? 1 : 3;
        const std::size_t row = width * std::size_t(raster.channels);
        raster.data.resize(row * height);
        jpeg_start_decompress(&jpeg);
        while (jpeg.output_scanline < jpeg.output_height) {
            auto* to =
                reinterpret_cast<unsigned char*>(raster.data.data() + row * jpeg.output_scanline);
            jpeg_read_scanlines(&jpeg, &to, 1);
        }
        jpeg_finish_decompress(&jpeg);
    }
};

}  // namespace

bool is_jpeg(std::span<const std::byte> file) {
    return file.size() > 3 && file[0] == std::byte(0xFF) && file[1] == std::byte(0xD8) &&
           file[2] == std::byte(0xFF);
}

Decoded decode_jpeg(std::span<const std::byte> file) {
    Reader reader;
    if (setjmp(reader.escape) != 0) return {.problem = reader.message.data()};
    reader.read(file);
    return {.raster = std::move(reader.raster)};
}

}  // namespace penumbra
