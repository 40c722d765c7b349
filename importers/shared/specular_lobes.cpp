#include "importers/shared/specular_lobes.h"

#include "base/memory.h"
#include "image/samples.h"
#include "scene/texture/texture_lookup.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr float no_metal = 0.002F;              // less than half a step of an 8-bit image
constexpr int most_lobes = 8, most_steps = 32;  // mixed, and one at a time
constexpr double lobe_step = 0.1;               // of roughness
constexpr std::size_t most_texels = std::size_t(64) << 20;

double largest(const Color& c) { return double(std::max({c.x, c.y, c.z})); }

Color mixed(const Color& a, const Color& b, float t) { return a + (b - a) * t; }

struct Size {
    int width = 1, height = 1;
    std::size_t texels() const { return std::size_t(width) * std::size_t(height); }
};

Size size_of(const TexelSource& source) {
    return source.raster != nullptr ? Size{source.raster->width, source.raster->height} : Size{};
}

// The larger size of all images; that of the base colour's where it would be too much.
Size common_size(const LobeMaps& maps) {
    Size size;
    for (const TexelSource* source :
         {&maps.base, &maps.metallic, &maps.roughness, &maps.specular}) {
        const Size own = size_of(*source);
        size = {std::max(size.width, own.width), std::max(size.height, own.height)};
    }
    if (size.texels() <= most_texels) return size;
    return size_of(maps.base.raster != nullptr ? maps.base : maps.roughness);
}

// A source as it would be with the size of `to`.
class Resized {
  public:
    Resized(const TexelSource& source, const LobeMaps& given, Size to)
        : reader_(source), maps_(given), from_(size_of(source)),
          scale_x_(double(from_.width) / to.width), scale_y_(double(from_.height) / to.height),
          same_(from_.width == to.width && from_.height == to.height), single_(from_.texels() == 1),
          first_(reader_.color(0, 0)) {}

    Color color(int x, int y) const {
        return at(x, y, [&](int i, int j) { return reader_.color(i, j); }, first_);
    }
    float value(int x, int y) const {
        return at(x, y, [&](int i, int j) { return reader_.value(i, j); }, first_.x);
    }

  private:
    TexelReader reader_;
    const LobeMaps& maps_;
    Size from_;
    double scale_x_, scale_y_;
    bool same_, single_;
    Color first_;

    template <class Read, class Value>
    Value at(int x, int y, Read read, const Value& only) const {
        if (single_) return only;
        if (same_) return read(x, y);
        const double px = (x + 0.5) * scale_x_, py = (y + 0.5) * scale_y_;
        if (!maps_.bilinear)
            return read(std::min(int(px), from_.width - 1), std::min(int(py), from_.height - 1));
        const double left = std::floor(px - 0.5), top = std::floor(py - 0.5);
        const auto tx = float(px - 0.5 - left), ty = float(py - 0.5 - top);
        const int x0 = wrapped(int(left), from_.width, maps_.wrap_u);
        const int x1 = wrapped(int(left) + 1, from_.width, maps_.wrap_u);
        const int y0 = wrapped(int(top), from_.height, maps_.wrap_v);
        const int y1 = wrapped(int(top) + 1, from_.height, maps_.wrap_v);
        const Value above = read(x0, y0) * (1 - tx) + read(x1, y0) * tx;
        const Value below = read(x0, y1) * (1 - tx) + read(x1, y1) * tx;
        return above * (1 - ty) + below * ty;
    }
};

Raster blank(Size size, int channels) {
    Raster raster = {.width = size.width, .height = size.height, .channels = channels};
    raster.data.resize(size.texels() * std::size_t(channels));
    return raster;
}

// Fills a raster with what `make` gives for each texel, an array of bytes.
template <class Make>
Raster filled(Size size, Make make) {
    constexpr std::size_t channels = std::tuple_size_v<decltype(make(0, 0))>;
    Raster raster = blank(size, int(channels));
    tbb::parallel_for(0, size.height, [&](int y) {
        std::byte* out = raster.data.data() + std::size_t(y) * std::size_t(size.width) * channels;
        for (int x = 0; x < size.width; ++x)
            for (const std::uint8_t byte : make(x, y)) *out++ = std::byte(byte);
    });
    return raster;
}

std::array<std::uint8_t, 3> bytes_of(const Color& c) {
    return {srgb_byte(c.x), srgb_byte(c.y), srgb_byte(c.z)};
}

// The largest channel of the median texel and of all, 0 to 1.
std::array<double, 2> median_and_most(const Raster& rgb) {
    std::array<std::size_t, 256> count = {};
    for (std::size_t i = 0; i < rgb.data.size(); i += 3)
        ++count[std::max({std::to_integer<std::size_t>(rgb.data[i]),
                          std::to_integer<std::size_t>(rgb.data[i + 1]),
                          std::to_integer<std::size_t>(rgb.data[i + 2])})];
    const auto linear = [](std::size_t code) {
        return double(srgb_to_linear(float(code) / 255.0F));
    };
    std::size_t below = 0, median = 0, most = 255;
    while ((below += count[median]) * 2 < rgb.texels()) ++median;
    while (most > 0 && count[most] == 0) --most;
    return {linear(median), linear(most)};
}

// What a roughness is in SpecularLobes::level, and the lobes that level chooses from.
struct Levels {
    float low = 0, high = 0;
    int count = 1;

    Levels(const TexelSource& roughness, Illumination illumination) {
        const auto range = range_of(roughness);
        low = std::clamp(range[0], 0.0F, 1.0F);
        high = std::clamp(range[1], 0.0F, 1.0F);
        if (high - low < no_metal) return;
        const bool mixed = illumination == Illumination::lamps;
        const double step = mixed ? lobe_step : lobe_step / 4;
        count = std::clamp(1 + int(std::ceil(double(high - low) / step - 1e-4)), 2,
                           mixed ? most_lobes : most_steps);
    }
    double roughness(int lobe) const {
        return count == 1 ? double(low + high) / 2
                          : double(low) + double(high - low) * lobe / (count - 1);
    }
    Raster image(const TexelSource& source) const {
        if (count == 1) return {};
        const TexelReader reader(source);
        return filled(size_of(source), [&](int x, int y) {
            const float t = (reader.value(x, y) - low) / (high - low);
            return std::array{std::uint8_t(std::lround(std::clamp(t, 0.0F, 1.0F) * 255))};
        });
    }
};

// Nothing is metal: what is reflected is the same everywhere, if more or less sharply.
LobeImages bake_roughness(const LobeMaps& maps) {
    const Levels levels(maps.roughness, maps.illumination);
    const DielectricReflectance dielectric = *reflectance_of(maps);
    const Color f0 = dielectric.f0;
    const bool tinted = !dielectric.plain();
    const double most = std::max(largest(f0), 1e-6);
    const double strength = tinted ? dielectric.strength() : most;
    LobeImages images = {.level = levels.image(maps.roughness)};
    for (int i = 0; i < levels.count; ++i) {
        SpecularLobe lobe = full_lobe(levels.roughness(i), 1 / strength, most, maps.illumination);
        if (maps.illumination == Illumination::lamps) {
            lobe.specular *= float(strength);
            lobe.reflection *= tinted ? Color(float(strength)) : f0;
        }
        images.lobes.push_back(lobe);
    }
    return images;
}

}  // namespace

bool has_lobe_maps(const LobeMaps& maps) {
    if (!constant_of(maps.metallic) || !constant_of(maps.roughness)) return true;
    const auto dielectric = reflectance_of(maps);
    // A tint of a constant and of an image: neither takes the other's place.
    return !dielectric || (!dielectric->plain() && maps.base.raster != nullptr &&
                           !keeps_base(maps) && constant_of(maps.metallic)->x < 1);
}

bool dulls_base(const LobeMaps& maps) {
    constexpr float dullest_unseen = 0.29F;  // roughness: below that the loss is under 1 %
    if (maps.illumination != Illumination::environment || maps.base.raster == nullptr) return false;
    const auto metallic = constant_of(maps.metallic), roughness = constant_of(maps.roughness);
    if (!metallic || !roughness || metallic->x < no_metal) return false;
    return metallic->x < 1 || roughness->x > dullest_unseen;
}

std::optional<DielectricReflectance> reflectance_of(const LobeMaps& maps) {
    const auto f0 = constant_of(maps.specular);
    if (!f0) return std::nullopt;
    return dielectric_reflectance(*f0, maps.white);
}

bool keeps_base(const LobeMaps& maps) {
    return maps.specular.raster == nullptr && reflectance_of(maps)->metal == 0 &&
           range_of(maps.metallic)[1] < no_metal;
}

// What is reflected, and so tints the lobes, goes from 0.04 to 1. Highlights are not limited by the
// colour that they get but by that of the median texel: a plastic with some screws keeps the usual
// highlight, and the screws' may be brighter than white.
LobeImages bake_specular_lobes(const LobeMaps& maps) {
    constexpr std::size_t channels = 7;  // of the three images
    const Size size = common_size(maps);
    const MemoryClaim claim(size.texels() * channels, maps.place);
    if (keeps_base(maps)) return bake_roughness(maps);
    const Resized base(maps.base, maps, size), metallic(maps.metallic, maps, size),
        roughness(maps.roughness, maps, size), specular(maps.specular, maps, size);
    const Levels levels(maps.roughness, maps.illumination);
    LobeImages images = {.level = levels.image(maps.roughness)};
    images.reflected = filled(size, [&](int x, int y) {
        return bytes_of(mixed(specular.color(x, y), base.color(x, y),
                              std::clamp(metallic.value(x, y), 0.0F, 1.0F)));
    });

    const auto [median, most] = median_and_most(images.reflected);
    const double limit = 1 / std::max(median, 0.02);
    for (int i = 0; i < levels.count; ++i)
        images.lobes.push_back(full_lobe(levels.roughness(i), limit, most, maps.illumination));

    images.scattered = filled(size, [&](int x, int y) {
        const RoughnessLobe lobe =
            lobe_of_roughness(double(roughness.value(x, y)), maps.illumination);
        const double m = std::clamp(double(metallic.value(x, y)), 0.0, 1.0);
        const DielectricReflectance dielectric =
            dielectric_reflectance(specular.color(x, y), maps.white);
        const double f0 = std::clamp(largest(dielectric.f0), 0.0, 1.0);
        const Color color = base.color(x, y);
        const double b = largest(color), tint = 1 - m + m * b;
        const double part = tint > 0 ? (f0 + m * (b - f0)) / tint : 1;
        const double highlight = std::min(lobe.highlight, limit) *
                                 std::min(std::max(part, double(dielectric.metal)), 1.0);
        return bytes_of(scattered_color(lobe, color, m, dielectric, highlight));
    });
    return images;
}

void set_constant_lobes(Material& material, float metallic, float roughness,
                        const DielectricReflectance& dielectric, Illumination illumination,
                        bool multiplied) {
    const bool white = multiplied && metallic == 1 && illumination == Illumination::environment;
    const Color factor = material.color;
    if (white) material.color = Color(1);
    set_metallic_roughness(material, metallic, roughness, dielectric, illumination);
    if (white) material.color = factor;
}

void lay_specular_lobes(Material& material, SpecularLobes specular_lobes, const ImageMap& scattered,
                        const DielectricReflectance& dielectric, Illumination illumination) {
    material.specular_lobes = std::move(specular_lobes);
    material.specular_lobes->mixed = illumination == Illumination::lamps;
    material.specular = 0;
    material.reflection = Color(0);
    material.metallic = 0;
    material.diffuse = 1 - std::min(float(largest(dielectric.f0)), 1.0F);
    if (scattered.texture == no_index) {
        const bool surrounded = illumination == Illumination::environment;
        material.conserve_energy = surrounded;
        if (dielectric.plain() && !surrounded) return;
        material.specular_color = surrounded ? dielectric.f0 : dielectric.tint();
        material.metallic = 1;
        return;
    }
    material.pattern = scattered;
    material.color = Color(1);
    material.diffuse = material.metallic = 1;
}

}  // namespace penumbra
