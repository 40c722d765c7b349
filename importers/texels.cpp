#include "texels.h"

#include <algorithm>
#include <cmath>
#include <cstring>

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
bool any_below(const Raster& raster, T opaque) {
    const auto channels = std::size_t(raster.channels);
    for (std::size_t i = channels - 1; i < raster.texels() * channels; i += channels)
        if (read<T>(raster, i) < opaque) return true;
    return false;
}

template <class T>
void write(Raster& raster, std::size_t at, T value) {
    std::memcpy(raster.data.data() + at * sizeof(T), &value, sizeof value);
}

// Calls `see` with the position of every texel; once where there is no image.
template <class See>
void for_each_texel(const TexelSource& source, See see) {
    const int width = source.raster != nullptr ? source.raster->width : 1;
    const int height = source.raster != nullptr ? source.raster->height : 1;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) see(x, y);
}

}  // namespace

TexelReader::TexelReader(const TexelSource& given) : source(given) {
    if (source.raster == nullptr) return;
    const int channels = source.raster->channels;
    varies = source.factor != Color(0) && (source.channel != alpha || has_alpha(*source.raster));
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        if (source.channel == alpha)
            offsets[i] = std::size_t(channels - 1);
        else if (channels >= 3)
            offsets[i] =
                std::min(std::size_t(source.channel) + (source.single ? 0 : i), std::size_t(2));
    }
    const bool encoded = source.srgb && source.channel != alpha;
    for (std::size_t i = 0; i < decoded.size(); ++i) {
        const float linear = float(i) / 255.0F;
        decoded[i] = encoded ? srgb_to_linear(linear) : linear;
    }
}

float TexelReader::sample(std::size_t at) const {
    switch (source.raster->depth) {
    case Depth::u8: return decoded[read<std::uint8_t>(*source.raster, at)];
    case Depth::u16: {
        const float value = float(read<std::uint16_t>(*source.raster, at)) / 65535.0F;
        return source.srgb && source.channel != alpha ? srgb_to_linear(value) : value;
    }
    case Depth::f32: break;
    }
    const auto value = read<float>(*source.raster, at);
    return std::isfinite(value) ? value : 0;
}

float TexelReader::at(int x, int y, int channel) const {
    float value = 1;
    if (varies) {
        const auto texel = std::size_t(y) * std::size_t(source.raster->width) + std::size_t(x);
        value =
            sample(texel * std::size_t(source.raster->channels) + offsets[std::size_t(channel)]);
    }
    return source.offset + source.factor[channel] * value;
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
    const Vec3 mean = sum / count;
    return {float(mean.x), float(mean.y), float(mean.z)};
}

std::array<float, 2> range_of(const TexelSource& source) {
    const TexelReader reader(source);
    std::array<float, 2> range = {reader.value(0, 0), reader.value(0, 0)};
    for_each_texel(source, [&](int x, int y) {
        const float value = reader.value(x, y);
        range = {std::min(range[0], value), std::max(range[1], value)};
    });
    return range;
}

std::optional<Color> constant_of(const TexelSource& source) {
    const TexelReader reader(source);
    const Color first = reader.color(0, 0);
    if (source.raster == nullptr) return first;
    for (int y = 0; y < source.raster->height; ++y)
        for (int x = 0; x < source.raster->width; ++x)
            if (reader.color(x, y) != first) return std::nullopt;
    return first;
}

bool has_transparency(const Raster& raster) {
    if (!has_alpha(raster)) return false;
    switch (raster.depth) {
    case Depth::u8: return any_below<std::uint8_t>(raster, 255);
    case Depth::u16: return any_below<std::uint16_t>(raster, 65535);
    case Depth::f32: return any_below<float>(raster, 1);
    }
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

std::uint8_t srgb_byte(float linear) {
    // Fine enough to be off by one code only within a twentieth of a code of the boundary.
    constexpr std::size_t steps = 65535;
    static const std::vector<std::uint8_t> codes = [] {
        std::vector<std::uint8_t> table(steps + 1);
        for (std::size_t i = 0; i <= steps; ++i)
            table[i] = std::uint8_t(std::lround(linear_to_srgb(float(i) / float(steps)) * 255.0F));
        return table;
    }();
    const float inside = std::clamp(linear, 0.0F, 1.0F);
    return codes[std::size_t(std::lround(inside * float(steps)))];
}

}  // namespace penumbra
