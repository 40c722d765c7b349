#include "image_writer.h"

#include "png_encoder.h"
#include "samples.h"

#include "penumbra/error.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

// Samples that are kept before they are encoded.
constexpr std::size_t most_kept = std::size_t(32) << 20;

OpenedEncoder open_encoder(const fs::path& file, const Raster& frame, bool srgb,
                           StagedFile& staged) {
    const std::string extension = lower_extension(file);
    if (extension == ".png" && frame.depth != Depth::f32)
        return open_png_encoder(
            frame, srgb, [&staged](std::span<const std::byte> bytes) { staged.write(bytes); });
    return module_for(Failure::output, file.string())
        .open_encoder(frame, extension, srgb, staged.descriptor());
}

[[noreturn]] void fail(const fs::path& file, const std::string& problem) {
    throw Error(Failure::output, file.string(), "cannot be written (" + problem + ")");
}

}  // namespace

std::string lower_extension(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return extension;
}

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

SampleWriter::SampleWriter(const fs::path& name, const Raster& format, bool marked)
    : file(name), frame(format), srgb(marked), staged(name),
      row_size(std::size_t(frame.width) * std::size_t(frame.channels) * std::size_t(frame.depth)) {
    if (frame.width < 1 || frame.height < 1)
        throw Error(Failure::output, name.string(), "an empty picture");
    // Some formats compress what comes together, so that it must not depend on who appends what.
    constexpr std::size_t step = 64;
    rows_together = std::max(most_kept / row_size / step, std::size_t(1)) * step;
}

void SampleWriter::append(std::span<const std::byte> rows) {
    kept.insert(kept.end(), rows.begin(), rows.end());
    const std::size_t count = kept.size() / row_size;
    if (count >= rows_together) encode(count / rows_together * rows_together);
}

void SampleWriter::encode(std::size_t rows) {
    if (rows == 0) return;
    if (!encoder) {
        OpenedEncoder opened = open_encoder(file, frame, srgb, staged);
        if (!opened.problem.empty()) fail(file, opened.problem);
        encoder = std::move(opened.encoder);
    }
    const std::string problem = encoder->write(kept.data(), int(rows));
    if (!problem.empty()) fail(file, problem);
    kept.erase(kept.begin(), kept.begin() + std::ptrdiff_t(rows * row_size));
}

void SampleWriter::finish() {
    encode(kept.size() / row_size);
    const std::string problem = encoder->finish();
    if (!problem.empty()) fail(file, problem);
    encoder.reset();
    staged.commit();
}

}  // namespace penumbra
