#include "penumbra/image.h"

#include "file.h"
#include "image_module.h"
#include "jpeg_codec.h"
#include "png_codec.h"

#include "penumbra/error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

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

std::vector<std::byte> encode(const Raster& raster, const fs::path& file, bool srgb) {
    const bool png = lower_extension(file) == ".png" && raster.depth != Depth::f32;
    Encoded encoded = png ? encode_png(raster, srgb)
                          : module_for(Failure::output, file.string())
                                .encode(raster, lower_extension(file), srgb);
    if (!encoded.problem.empty())
        throw Error(Failure::output, file.string(), "cannot be written (" + encoded.problem + ")");
    return std::move(encoded.file);
}

// Nearest integer of [0, max]; NaN becomes 0.
unsigned quantise(float value, float max) {
    if (!(value > 0)) return 0;
    return unsigned(std::min(value, 1.0F) * max + 0.5F);
}

template <class Sample>
void store(std::byte*& to, Sample sample) {
    std::memcpy(to, &sample, sizeof sample);
    to += sizeof sample;
}

std::uint8_t encoded8(float linear) { return std::uint8_t(quantise(linear_to_srgb(linear), 255)); }

// The same without a power: the least linear value of every 8-bit sample, and where to begin
// looking.
class Encoder8 {
  public:
    Encoder8() {
        for (std::size_t sample = 1; sample < 256; ++sample) {
            std::uint32_t below = 0, at = std::bit_cast<std::uint32_t>(1.0F);  // floats in order
            while (at - below > 1) {
                const std::uint32_t middle = below + (at - below) / 2;
                (encoded8(std::bit_cast<float>(middle)) < sample ? below : at) = middle;
            }
            least_[sample] = std::bit_cast<float>(at);
        }
        least_[256] = std::numeric_limits<float>::infinity();
        for (std::size_t i = 0; i < first_.size(); ++i)
            first_[i] = encoded8(float(i) / float(first_.size()));
    }
    std::uint8_t operator()(float linear) const {
        if (!(linear > 0)) return 0;
        if (linear >= 1) return 255;
        std::size_t sample = first_[std::size_t(linear * float(first_.size()))];
        while (linear >= least_[sample + 1]) ++sample;
        return std::uint8_t(sample);
    }

  private:
    std::array<float, 257> least_ = {};
    std::array<std::uint8_t, 4096> first_ = {};
};

template <class Store>
void each_value(const Image& image, const Store& store) {
    for (const Color& pixel : image.pixels)
        for (const float value : {pixel.x, pixel.y, pixel.z}) store(value);
}

Raster to_raster(const Image& image, Depth depth) {
    Raster raster = {image.width, image.height, 3, depth, {}};
    raster.data.resize(image.pixels.size() * 3 * std::size_t(depth));
    std::byte* to = raster.data.data();
    if (depth == Depth::f32) {
        each_value(image, [&](float value) { store(to, value); });
    } else if (depth == Depth::u16) {
        each_value(image, [&](float value) {
            store(to, std::uint16_t(quantise(linear_to_srgb(value), 65535)));
        });
    } else {
        static const Encoder8 encoder;
        each_value(image, [&](float value) { store(to, encoder(value)); });
    }
    return raster;
}

// The linear value of every integer sample.
template <class Sample>
std::vector<float> decoding_table() {
    const std::size_t max = static_cast<Sample>(~Sample(0));
    std::vector<float> table(max + 1);
    for (std::size_t i = 0; i <= max; ++i) table[i] = srgb_to_linear(float(i) / float(max));
    return table;
}

template <class Sample, class Linear>
void fill(Image& image, const Raster& raster, const Linear& linear) {
    const auto channels = std::size_t(raster.channels);
    const std::array<std::size_t, 3> rgb = {0, channels > 2 ? 1U : 0U, channels > 2 ? 2U : 0U};
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            Sample sample;
            std::memcpy(&sample, raster.data.data() + (i * channels + rgb[c]) * sizeof sample,
                        sizeof sample);
            image.pixels[i][int(c)] = linear(sample);
        }
    }
}

Image to_image(const Raster& raster) {
    Image image(raster.width, raster.height);
    if (raster.depth == Depth::u8) {
        static const auto table = decoding_table<std::uint8_t>();
        fill<std::uint8_t>(image, raster, [&](std::uint8_t sample) { return table[sample]; });
    } else if (raster.depth == Depth::u16) {
        static const auto table = decoding_table<std::uint16_t>();
        fill<std::uint16_t>(image, raster, [&](std::uint16_t sample) { return table[sample]; });
    } else {
        fill<float>(image, raster, [](float sample) { return sample; });
    }
    return image;
}

void check_not_empty(const std::string& place, int width, int height) {
    if (width < 1 || height < 1) throw Error(Failure::output, place, "an empty picture");
}

}  // namespace

// IEC 61966-2-1, in float32 as POV-Ray 3.7 computes it (source/base/image/colourspace.cpp).
float srgb_to_linear(float encoded) {
    if (encoded < 0.04045F) return encoded / 12.92F;
    return std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

float linear_to_srgb(float linear) {
    if (linear <= 0.0031308F) return linear * 12.92F;
    return 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

Raster decode_image(std::span<const std::byte> file, const std::string& name) {
    Decoded decoded;
    if (is_png(file)) {
        decoded = decode_png(file);
    } else {
        if (is_jpeg(file)) decoded = decode_jpeg(file);
        if (decoded.raster.data.empty())
            decoded = module_for(Failure::input, name).decode(file, lower_extension(name));
    }
    if (!decoded.problem.empty())
        throw Error(Failure::input, name, "cannot be read as an image (" + decoded.problem + ")");
    return std::move(decoded.raster);
}

Image load_image(const fs::path& file) {
    return to_image(decode_image(read_bytes(file), file.string()));
}

bool can_save_image(const fs::path& file) {
    constexpr std::array known = {".png", ".exr", ".tif", ".tiff", ".jpg", ".jpeg", ".hdr"};
    return std::find(known.begin(), known.end(), lower_extension(file)) != known.end();
}

void save_image(const fs::path& file, const Image& image, const SaveOptions& options) {
    if (!can_save_image(file))
        throw Error(Failure::output, file.string(),
                    "unknown picture format (use .png, .exr, .tif, .jpg or .hdr)");
    check_not_empty(file.string(), image.width, image.height);
    const std::string extension = lower_extension(file);
    const bool linear = extension == ".exr" || extension == ".hdr";
    const Depth depth = linear ? Depth::f32 : options.bits == 16 ? Depth::u16 : Depth::u8;
    if (extension == ".hdr") {  // RGBE has no sign
        Image positive = image;
        for (Color& pixel : positive.pixels)
            for (int c = 0; c < 3; ++c) pixel[c] = pixel[c] > 0 ? pixel[c] : 0;
        return write_file(file, encode(to_raster(positive, depth), file, false));
    }
    write_file(file, encode(to_raster(image, depth), file, !linear));
}

void save_raster(const fs::path& file, const Raster& raster) {
    const bool fits = lower_extension(file) == (raster.depth == Depth::f32 ? ".exr" : ".png");
    if (!fits)
        throw Error(Failure::output, file.string(),
                    "samples of this depth need .png (integers) or .exr (floats)");
    check_not_empty(file.string(), raster.width, raster.height);
    write_file(file, encode(raster, file, false));
}

std::vector<std::byte> encode_png(const Image& image) {
    check_not_empty("PNG", image.width, image.height);
    return encode(to_raster(image, Depth::u8), "picture.png", true);
}

}  // namespace penumbra
