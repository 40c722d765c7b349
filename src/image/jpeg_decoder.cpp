#include "image/jpeg_decoder.h"

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
    const MayTake& may_take;

    explicit Reader(const MayTake& asked) : may_take(asked) {
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

    // What libjpeg keeps of a picture that comes in several scans: its coefficients.
    std::size_t coefficients() {
        if (jpeg_has_multiple_scans(&jpeg) == FALSE) return 0;
        std::size_t blocks = 0;
        for (int i = 0; i < jpeg.num_components; ++i)
            blocks += std::size_t(jpeg.comp_info[i].width_in_blocks + MAX_SAMP_FACTOR) *
                      std::size_t(jpeg.comp_info[i].height_in_blocks + MAX_SAMP_FACTOR);
        return blocks * sizeof(JBLOCK);
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
        if (!may_take(row * height)) refuse(no_memory);
        raster.data.resize(row * height);
        if (!may_take(coefficients() + 64 * row)) refuse(no_memory);
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

// ITU-T T.81, annex B: marker segments, and entropy-coded data behind a start of scan.
bool has_too_many_scans(std::span<const std::byte> file) {
    constexpr std::size_t most_work = std::size_t(1) << 30, always = 16;
    const auto byte = [&](std::size_t i) {
        return i < file.size() ? std::to_integer<std::size_t>(file[i]) : 0;
    };
    std::size_t scans = 0, pixels = 0;
    for (std::size_t at = 2; at + 4 <= file.size();) {
        const std::size_t marker = byte(at) == 0xFF ? byte(at + 1) : 0;
        const bool alone = marker == 0 || marker == 0xFF || (marker >= 0xD0 && marker <= 0xD7);
        if (alone) {  // within data, or padding
            ++at;
            continue;
        }
        if (marker == 0xD9) break;
        if (marker == 0xDA) ++scans;
        if (marker >= 0xC0 && marker <= 0xC2)
            pixels = (byte(at + 5) << 8 | byte(at + 6)) * (byte(at + 7) << 8 | byte(at + 8));
        at += 2 + (byte(at + 2) << 8 | byte(at + 3));
    }
    return scans > always && scans * pixels > most_work;
}

Decoded decode_jpeg(std::span<const std::byte> file, const MayTake& may_take) {
    Reader reader(may_take);
    if (setjmp(reader.escape) != 0) return {.problem = reader.message.data()};
    reader.read(file);
    return {.raster = std::move(reader.raster)};
}

}  // namespace penumbra
