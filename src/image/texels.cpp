#include "image/texels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace penumbra {

namespace {

constexpr int alpha = 3;

bool has_alpha(const Raster& raster) { return raster.channels == 2 || raster.channels == 4; }

template <class T>
T read(const Raster& raster, std::size_t at) {
    T value;
    std::memcpy(&value, raster.data.data() + at * sizeof(T), sizeof value);
    return value;
}

template <class T>
void write(Raster& raster, std::size_t at, T value) {
    std::memcpy(raster.data.data() + at * sizeof(T), &value, sizeof value);
}

// Made once, as textures share them: 65536 powers take a while.
template <class Sample, bool srgb>
const float* decoding_table() {
    static const std::vector<float> table = [] {
        const std::size_t max = static_cast<Sample>(~Sample(0));
        std::vector<float> made(max + 1);
        for (std::size_t i = 0; i <= max; ++i) {
            const float encoded = float(i) / float(max);
            made[i] = srgb ? srgb_to_linear(encoded) : encoded;
        }
        return made;
    }();
    return table.data();
}

const float* decoding_table(Depth depth, bool srgb) {
    switch (depth) {
    case Depth::u8:
        return srgb ? decoding_table<std::uint8_t, true>() : decoding_table<std::uint8_t, false>();
    case Depth::u16:
        return srgb ? decoding_table<std::uint16_t, true>()
                    : decoding_table<std::uint16_t, false>();
    case Depth::f32: break;
    }
    return nullptr;
}

// Calls `see` with the position of every texel; once where there is no image.
template <class See>
void for_each_texel(const TexelSource& source, See see) {
    const int width = source.raster != nullptr ? source.raster->width : 1;
    const int height = source.raster != nullptr ? source.raster->height : 1;
    std::size_t texel = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, ++texel)
            if (source.only == nullptr || (*source.only)[texel]) see(x, y);
}

constexpr float step = 1.0001F / 255;

}  // namespace

LinearSamples::LinearSamples(const Raster& raster, bool srgb)
    : data_(raster.data.data()), decoded_(decoding_table(raster.depth, srgb)),
      channels_(std::size_t(raster.channels)), depth_(raster.depth) {}

TexelReader::TexelReader(const TexelSource& given) : source_(given) {
    if (source_.raster == nullptr) return;
    samples_ = LinearSamples(*source_.raster, source_.srgb && source_.channel != alpha);
    const int channels = source_.raster->channels;
    varies_ =
        source_.factor != Color(0) && (source_.channel != alpha || has_alpha(*source_.raster));
    for (std::size_t i = 0; i < offsets_.size(); ++i) {
        if (source_.channel == alpha)
            offsets_[i] = std::size_t(channels - 1);
        else if (channels >= 3)
            offsets_[i] =
                std::min(std::size_t(source_.channel) + (source_.single ? 0 : i), std::size_t(2));
    }
}

float TexelReader::at(int x, int y, int channel) const {
    float value = 1;
    if (varies_) {
        const auto texel = std::size_t(y) * std::size_t(source_.raster->width) + std::size_t(x);
        value = samples_[texel * std::size_t(source_.raster->channels) +
                         offsets_[std::size_t(channel)]];
        if (!std::isfinite(value)) value = 0;
    }
    return source_.offset + source_.factor[channel] * value;
}

float TexelReader::value(int x, int y) const { return at(x, y, 0); }

Color TexelReader::color(int x, int y) const { return {at(x, y, 0), at(x, y, 1), at(x, y, 2)}; }

Color mean_of(const TexelSource& source) {
    const TexelReader reader(source);
    Vec3 sum(0);
    double count = 0;
    for_each_texel(source, [&](int x, int y) {
        sum += Vec3(reader.color(x, y));
        ++count;
    });
    if (count == 0) return reader.color(0, 0);
    const Vec3 mean = sum / count;
    return {float(mean.x), float(mean.y), float(mean.z)};
}

std::array<float, 2> range_of(const TexelSource& source) {
    const TexelReader reader(source);
    std::optional<std::array<float, 2>> found;
    for_each_texel(source, [&](int x, int y) {
        const float value = reader.value(x, y);
        if (!found) found = {value, value};
        found = {std::min((*found)[0], value), std::max((*found)[1], value)};
    });
    return found.value_or(std::array<float, 2>{reader.value(0, 0), reader.value(0, 0)});
}

std::optional<Color> constant_of(const TexelSource& source) {
    const TexelReader reader(source);
    Color first = reader.color(0, 0);
    if (source.raster == nullptr) return first;
    for (int y = 0; y < source.raster->height; ++y)
        for (int x = 0; x < source.raster->width; ++x)
            if (reader.color(x, y) != first) return std::nullopt;
    return first;
}

std::optional<Color> even_of(const TexelSource& source) {
    const TexelReader reader(source);
    std::optional<Color> least, most;
    for_each_texel(source, [&](int x, int y) {
        const Color color = reader.color(x, y);
        if (!least) least = most = color;
        for (int c = 0; c < 3; ++c) {
            (*least)[c] = std::min((*least)[c], color[c]);
            (*most)[c] = std::max((*most)[c], color[c]);
        }
    });
    if (!least) return reader.color(0, 0);
    for (int c = 0; c < 3; ++c)
        if ((*most)[c] - (*least)[c] > step) return std::nullopt;
    return *least == *most ? *least : mean_of(source);
}

bool has_transparency(const Raster& raster) {
    if (!has_alpha(raster)) return false;
    const LinearSamples samples(raster, false);
    const auto channels = std::size_t(raster.channels);
    for (std::size_t i = channels - 1; i < raster.texels() * channels; i += channels)
        if (samples[i] < 1) return true;
    return false;
}

Raster grey_of(const TexelSource& source) {
    const TexelReader reader(source);
    Raster grey = {.width = source.raster->width,
                   .height = source.raster->height,
                   .channels = 1,
                   .depth = source.raster->depth};
    grey.data.resize(grey.texels() * std::size_t(grey.depth));
    std::size_t at = 0;
    for_each_texel(source, [&](int x, int y) {
        const float value = reader.value(x, y), inside = std::clamp(value, 0.0F, 1.0F);
        switch (grey.depth) {
        case Depth::u8: write(grey, at++, std::uint8_t(std::lround(inside * 255))); break;
        case Depth::u16: write(grey, at++, std::uint16_t(std::lround(inside * 65535))); break;
        case Depth::f32: write(grey, at++, value); break;
        }
    });
    return grey;
}

Raster remapped(Raster raster, double base, double gain) {
    const auto channels = std::size_t(raster.channels);
    const auto mapped = [&](double value) { return std::clamp(base + gain * value, 0.0, 1.0); };
    for (std::size_t i = 0; i < raster.texels() * channels; ++i) {
        if (has_alpha(raster) && i % channels == channels - 1) continue;
        switch (raster.depth) {
        case Depth::u8:
            write(raster, i,
                  std::uint8_t(std::lround(255 * mapped(read<std::uint8_t>(raster, i) / 255.0))));
            break;
        case Depth::u16:
            write(raster, i,
                  std::uint16_t(
                      std::lround(65535 * mapped(read<std::uint16_t>(raster, i) / 65535.0))));
            break;
        case Depth::f32:
            write(raster, i, float(base + gain * double(read<float>(raster, i))));
            break;
        }
    }
    return raster;
}

}  // namespace penumbra
