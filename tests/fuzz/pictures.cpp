// Two encoded pictures that are compared.
//
// The input: a byte for the formats of both, which matters where their first bytes do not tell; a
// byte of options; three bytes with the length of the first picture, the least significant first;
// both files.
#include "fuzz.h"

#include "penumbra/compare.h"
#include "penumbra/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace fuzz {
namespace {

using namespace penumbra;

constexpr std::size_t head_size = 5;
constexpr int longest_side = 40;
constexpr std::array extensions = {"",     ".tga",  ".ico",  ".sgi", ".dpx", ".cin",
                                   ".rla", ".iff",  ".pic",  ".bw",  ".rgb", ".png",
                                   ".jpg", ".tpic", ".webp", ".exr"};

unsigned byte_at(Input input, std::size_t i) { return static_cast<unsigned char>(input[i]); }

float sample(const Raster& raster, std::size_t at) {
    const std::byte* from = raster.data.data() + at * std::size_t(raster.depth);
    if (raster.depth == Depth::u8) return srgb_to_linear(float(*from) / 255);
    if (raster.depth == Depth::u16) {
        std::uint16_t value;
        std::memcpy(&value, from, sizeof value);
        return srgb_to_linear(float(value) / 65535);
    }
    float value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

void check_raster(const Raster& raster) {
    if (raster.width < 1 || raster.height < 1 || raster.channels < 1 || raster.channels > 4)
        finding("a decoded picture has no size");
    if (raster.data.size() !=
        raster.texels() * std::size_t(raster.channels) * std::size_t(raster.depth))
        finding("a decoded picture has another size than its samples");
}

// The upper left corner, at most.
Image picture_of(const Raster& raster) {
    const auto channels = std::size_t(raster.channels);
    Image image(std::min(raster.width, longest_side), std::min(raster.height, longest_side));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t texel =
                    std::size_t(y) * std::size_t(raster.width) + std::size_t(x);
                image.at(x, y)[int(c)] = sample(raster, texel * channels + (channels > 2 ? c : 0));
            }
    return image;
}

Image cropped(const Image& image, int width, int height) {
    Image part(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) part.at(x, y) = image.at(x, y);
    return part;
}

CompareOptions options_of(unsigned bits, const Image& test) {
    CompareOptions options;
    if (bits & 1U) options.shift_tolerance = 1;
    if (bits & 2U) options.ignored = {{1, 1, test.width / 2, test.height / 2}};
    if (bits & 4U) options.exposure = bits & 8U ? 3 : -3;
    if (bits & 16U) {
        options.mask = Image(test.width, test.height);
        for (std::size_t i = 0; i < options.mask.pixels.size(); i += 2)
            options.mask.pixels[i] = Color(1);
    }
    if (bits & 32U) options.background = test.pixels.front();
    options.limits = profile_limits(bits & 64U ? "strict" : "similar");
    return options;
}

bool finite(const Image& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(), [](const Color& c) {
        return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
    });
}

void check_comparison(const Image& test, const Image& reference, const CompareOptions& options) {
    const Comparison result = penumbra::compare(test, reference, options);
    const bool good = result.verdict == Verdict::pass || result.verdict == Verdict::warn;
    const bool ignores = !options.ignored.empty() || options.mask.width > 0;
    if (good && !ignores && !(finite(test) && finite(reference)))
        finding("pictures with NaN or infinite pixels pass");
    if (good && (test.width != reference.width || test.height != reference.height))
        finding("pictures of different sizes pass");
    for (const Metric& metric : result.metrics) {
        if (std::isnan(metric.value) && metric.limit && metric.ok())
            finding("NaN meets the limit of " + metric.name);
        if (good && !metric.ok()) finding("a comparison passes beyond the limit of " + metric.name);
    }
    for (const std::string& sentence : result.diagnosis) check_presentable(sentence, "a diagnosis");
    const Case one = {.name = "pictures", .comparison = result};
    const std::vector<Case> again = cases_of_json(report_json({one}));
    if (again.size() != 1 || again[0].comparison.verdict != result.verdict)
        finding("a report's JSON is read back differently");
    if (result.flip_map.width > 0) encode_png(heat_map(result.flip_map));
}

}  // namespace

void compare(Input input) {
    if (input.size() < head_size) return;
    const unsigned formats = byte_at(input, 0), bits = byte_at(input, 1);
    const std::size_t length =
        byte_at(input, 2) | byte_at(input, 3) << 8 | std::size_t(byte_at(input, 4)) << 16;
    const Input files = input.substr(head_size);
    const Input first = files.substr(0, length), second = files.substr(first.size());

    Image test, reference;
    const auto decode = [](Input file, unsigned format, Image& image) {
        const auto bytes = std::as_bytes(std::span(file.data(), file.size()));
        return may_refuse([&] {
            const Raster raster = decode_image(bytes, std::string("picture") + extensions[format]);
            check_raster(raster);
            image = picture_of(raster);
        });
    };
    if (!decode(first, formats & 15U, test)) return;
    if (!decode(second, formats >> 4U, reference)) reference = test;
    may_refuse([&] {
        if (test.width != reference.width || test.height != reference.height) {
            check_comparison(test, reference, {});
            const int width = std::min(test.width, reference.width);
            const int height = std::min(test.height, reference.height);
            test = cropped(test, width, height);
            reference = cropped(reference, width, height);
        }
        check_comparison(test, reference, options_of(bits, test));
    });
}

}  // namespace fuzz
