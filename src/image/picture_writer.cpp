#include "image/picture_writer.h"

#include "base/text/text.h"
#include "image/png_encoder.h"
#include "image/samples.h"

#include "penumbra/error.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

// Samples that are kept before they are encoded.
constexpr std::size_t most_kept = std::size_t(32) << 20;

OpenedEncoder open_encoder(const fs::path& file, const Raster& frame, const FileNotes& notes,
                           StagedFile& staged) {
    const std::string extension = lower_extension(file);
    if (extension == ".png" && frame.depth != Depth::f32)
        return open_png_encoder(
            frame, notes, [&staged](std::span<const std::byte> bytes) { staged.write(bytes); });
    return module_for(Failure::output, file.string())
        .open_encoder(frame, extension, notes, staged.descriptor());
}

[[noreturn]] void fail(const fs::path& file, const std::string& problem) {
    throw Error(Failure::output, file.string(), "cannot be written (" + problem + ")");
}

}  // namespace

const ImageModule& module_for(Failure failure, const std::string& place) {
    try {
        return image_module();
    } catch (const std::exception& error) {
        throw Error(failure, place, error.what());
    }
}

bool can_save_image(const fs::path& file) {
    constexpr std::array known = {".png", ".exr", ".tif", ".tiff", ".jpg", ".jpeg", ".hdr"};
    return std::find(known.begin(), known.end(), lower_extension(file)) != known.end();
}

PictureFormat picture_format(const fs::path& file, int width, int height,
                             const SaveOptions& options) {
    if (!can_save_image(file))
        throw Error(Failure::output, file.string(),
                    "unknown picture format (use .png, .exr, .tif, .jpg or .hdr)");
    const std::string extension = lower_extension(file);
    const bool linear = extension == ".exr" || extension == ".hdr";
    const Depth depth = linear ? Depth::f32 : options.bits == 16 ? Depth::u16 : Depth::u8;
    return {.frame = {width, height, 3, depth, {}}, .positive = extension == ".hdr"};
}

void append_samples(std::span<const Color> pixels, const PictureFormat& format,
                    std::vector<std::byte>& samples) {
    if (!format.positive) return append_samples(pixels, format.frame.depth, samples);
    std::vector<Color> positive(pixels.begin(), pixels.end());
    for (Color& pixel : positive)
        for (int c = 0; c < 3; ++c) pixel[c] = pixel[c] > 0 ? pixel[c] : 0;
    append_samples(positive, format.frame.depth, samples);
}

SampleWriter::SampleWriter(const fs::path& name, const Raster& format, bool marked,
                           std::string comment)
    : file_(name), frame_(format), notes_{marked, std::move(comment)}, staged_(name),
      row_size_(std::size_t(frame_.width) * std::size_t(frame_.channels) *
                std::size_t(frame_.depth)) {
    if (frame_.width < 1 || frame_.height < 1)
        throw Error(Failure::output, name.string(), "an empty picture");
    // Some formats compress what comes together, so that it must not depend on who appends what.
    constexpr std::size_t step = 64;
    rows_together_ = std::max(most_kept / row_size_ / step, std::size_t(1)) * step;
}

void SampleWriter::append(std::span<const std::byte> rows) {
    kept_.insert(kept_.end(), rows.begin(), rows.end());
    const std::size_t count = kept_.size() / row_size_;
    if (count >= rows_together_) encode(count / rows_together_ * rows_together_);
}

void SampleWriter::encode(std::size_t rows) {
    if (rows == 0) return;
    if (!encoder_) {
        OpenedEncoder opened = open_encoder(file_, frame_, notes_, staged_);
        if (!opened.problem.empty()) fail(file_, opened.problem);
        encoder_ = std::move(opened.encoder);
    }
    const std::string problem = encoder_->write(kept_.data(), int(rows));
    if (!problem.empty()) fail(file_, problem);
    kept_.erase(kept_.begin(), kept_.begin() + std::ptrdiff_t(rows * row_size_));
}

void SampleWriter::finish() {
    encode(kept_.size() / row_size_);
    const std::string problem = encoder_->finish();
    if (!problem.empty()) fail(file_, problem);
    encoder_.reset();
    staged_.commit();
}

}  // namespace penumbra
