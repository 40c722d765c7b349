#include "image/png_encoder.h"

#include <png.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <exception>

namespace penumbra {

namespace {

// libpng reports errors by longjmp, so between setjmp and the last call of libpng nothing may be
// constructed that has a destructor, and no exception may pass through it.
class PngEncoder : public RowEncoder {
  public:
    PngEncoder(const Raster& frame, const FileNotes& notes, ByteSink to)
        : sink_(std::move(to)), stride_(std::size_t(frame.width) * std::size_t(frame.channels) *
                                        std::size_t(frame.depth)),
          comment_(notes.comment),
          png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning)) {
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
        if (info_ == nullptr)
            problem_ = "out of memory";
        else
            begin(frame, notes.srgb);
    }
    ~PngEncoder() override { png_destroy_write_struct(&png_, &info_); }

    std::string write(const std::byte* rows, int count) override {
        write_rows(rows, count);
        return outcome();
    }
    std::string finish() override {
        write_end();
        return outcome();
    }

    /// What went wrong. Throws what the sink has thrown.
    std::string outcome() const {
        if (thrown_) std::rethrow_exception(thrown_);
        return problem_;
    }

  private:
    ByteSink sink_;
    std::size_t stride_;
    // Not local to what libpng may jump out of.
    std::string comment_, comment_key_ = "Comment";
    std::string problem_ = {};
    std::exception_ptr thrown_ = {};
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;

    static PngEncoder& of(png_structp png) {
        return *static_cast<PngEncoder*>(png_get_error_ptr(png));
    }
    [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
        of(png).problem_ = message;
        png_longjmp(png, 1);
    }
    static void on_warning(png_structp, png_const_charp) {}
    static void on_flush(png_structp) {}
    static void on_bytes(png_structp png, png_bytep from, std::size_t count) {
        if (!of(png).pass_on(from, count)) png_error(png, "its bytes cannot be written");
    }
    bool pass_on(png_bytep from, std::size_t count) {
        try {
            sink_({reinterpret_cast<const std::byte*>(from), count});
            return true;
        } catch (...) {
            thrown_ = std::current_exception();
            return false;
        }
    }

    void begin(const Raster& frame, bool srgb) {
        if (setjmp(png_jmpbuf(png_)) != 0) return;
        constexpr std::array<int, 4> color_types = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                                    PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
        png_set_write_fn(png_, this, on_bytes, on_flush);
        png_set_error_fn(png_, this, on_error, on_warning);
        // Of what the Paeth filter leaves of a rendered picture, runs alone make files as small as
        // a search for repetitions does, in less than half the time.
        png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_PAETH);
        png_set_compression_strategy(png_, Z_RLE);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_set_IHDR(png_, info_, png_uint_32(frame.width), png_uint_32(frame.height),
                     frame.depth == Depth::u16 ? 16 : 8,
                     color_types[std::size_t(frame.channels - 1)], PNG_INTERLACE_NONE,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        if (srgb) png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
        if (!comment_.empty()) {
            png_text text{};  // which libpng copies
            text.compression = PNG_TEXT_COMPRESSION_NONE;
            text.key = comment_key_.data();
            text.text = comment_.data();
            text.text_length = comment_.size();
            png_set_text(png_, info_, &text, 1);
        }
        png_write_info(png_, info_);
        if constexpr (std::endian::native == std::endian::little)
            if (frame.depth == Depth::u16) png_set_swap(png_);
    }
    void write_rows(const std::byte* rows, int count) {
        if (setjmp(png_jmpbuf(png_)) != 0) return;
        for (int row = 0; row < count; ++row)
            png_write_row(png_,
                          reinterpret_cast<png_const_bytep>(rows + std::size_t(row) * stride_));
    }
    void write_end() {
        if (setjmp(png_jmpbuf(png_)) != 0) return;
        png_write_end(png_, nullptr);
    }
};

}  // namespace

OpenedEncoder open_png_encoder(const Raster& frame, const FileNotes& notes, ByteSink sink) {
    auto encoder = std::make_unique<PngEncoder>(frame, notes, std::move(sink));
    std::string problem = encoder->outcome();
    if (!problem.empty()) return {{}, std::move(problem)};
    return {std::move(encoder), {}};
}

EncodedPng encode_png(const Raster& raster, bool srgb) {
    EncodedPng result;
    const OpenedEncoder opened =
        open_png_encoder(raster, {.srgb = srgb}, [&](std::span<const std::byte> bytes) {
            result.file.insert(result.file.end(), bytes.begin(), bytes.end());
        });
    result.problem = opened.problem;
    if (opened.encoder) result.problem = opened.encoder->write(raster.data.data(), raster.height);
    if (result.problem.empty()) result.problem = opened.encoder->finish();
    return result;
}

}  // namespace penumbra
