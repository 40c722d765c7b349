#include "penumbra/image.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text/text.h"
#include "image/image_module.h"
#include "image/jpeg_decoder.h"
#include "image/picture_writer.h"
#include "image/png_decoder.h"
#include "image/png_encoder.h"
#include "image/samples.h"

#include "penumbra/error.h"

#include <algorithm>
#include <cassert>
#include <optional>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

Raster frame_of(const Raster& raster) {
    return {raster.width, raster.height, raster.channels, raster.depth, {}};
}

}  // namespace

Raster decode_image(std::span<const std::byte> file, const std::string& name) {
    MemoryClaim claim;
    std::optional<MemoryError> refused;
    const MayTake may_take = [&](std::size_t bytes) {  // what libjpeg calls must not throw
        try {
            claim = MemoryClaim();
            claim = MemoryClaim(bytes, name);
        } catch (const MemoryError& error) {
            refused = error;
        }
        return !refused.has_value();
    };
    Decoded decoded;
    if (is_png(file)) {
        decoded = decode_png(file, may_take);
    } else {
        const bool jpeg = is_jpeg(file);
        if (jpeg && has_too_many_scans(file))
            throw Error(Failure::input, name, "cannot be read as an image (it has too many scans)");
        if (jpeg) decoded = decode_jpeg(file, may_take);
        if (decoded.raster.data.empty() && !refused)
            decoded =
                module_for(Failure::input, name).decode(file, lower_extension(name), may_take);
    }
    if (refused) throw MemoryError(*refused);
    if (!decoded.problem.empty())
        throw Error(Failure::input, name,
                    "cannot be read as an image (" + one_line(decoded.problem) + ")");
    return std::move(decoded.raster);
}

Image load_image(const fs::path& file) {
    const Raster raster = decode_image(read_bytes(file), file.string());
    const MemoryClaim claim(times(raster.texels(), sizeof(Color)), file.string());
    return to_image(raster);
}

void save_image(const fs::path& file, const Image& image, const SaveOptions& options) {
    assert(image.pixels.size() == std::size_t(image.width) * std::size_t(image.height));
    const PictureFormat format = picture_format(file, image.width, image.height, options);
    SampleWriter writer(file, format.frame, format.srgb());
    constexpr std::size_t together = std::size_t(1) << 20;  // pixels; about
    const auto width = std::size_t(image.width);
    const std::size_t step = (together / width + 1) * width;
    std::vector<std::byte> samples;
    for (std::size_t i = 0; i < image.pixels.size(); i += step) {
        const std::size_t count = std::min(step, image.pixels.size() - i);
        samples.clear();
        append_samples(std::span(image.pixels).subspan(i, count), format, samples);
        writer.append(samples);
    }
    writer.finish();
}

void save_raster(const fs::path& file, const Raster& raster, const std::string& comment) {
    assert(raster.data.size() ==
           raster.texels() * std::size_t(raster.channels) * std::size_t(raster.depth));
    const bool fits = lower_extension(file) == (raster.depth == Depth::f32 ? ".exr" : ".png");
    if (!fits)
        throw Error(Failure::output, file.string(),
                    "samples of this depth need .png (integers) or .exr (floats)");
    SampleWriter writer(file, frame_of(raster), false, comment);
    writer.append(raster.data);
    writer.finish();
}

std::vector<std::byte> encode_png(const Image& image) {
    if (image.pixels.empty()) throw Error(Failure::output, "PNG", "an empty picture");
    Raster raster = {.width = image.width, .height = image.height, .channels = 3};
    append_samples(image.pixels, raster.depth, raster.data);
    EncodedPng encoded = encode_png(raster, true);
    if (!encoded.problem.empty())
        throw Error(Failure::output, "PNG", "cannot be written (" + encoded.problem + ")");
    return std::move(encoded.file);
}

}  // namespace penumbra
