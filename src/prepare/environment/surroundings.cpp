// The environments of our own: what they show in each direction.
#include "base/memory.h"

#include "penumbra/prepare.h"
#include "penumbra/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

namespace penumbra {

namespace {

// Of images of soft boxes and of a sky, and of those with a sun or lamps in them.
constexpr int smooth = 512, detailed = 1024;

double ramp(double from, double to, double value) {
    const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// A direction by degrees from -z to the right, and above the horizon.
Vec3 toward(double azimuth, double elevation) {
    const double a = radians(azimuth), e = radians(elevation);
    return {std::sin(a) * std::cos(e), std::sin(e), -std::cos(a) * std::cos(e)};
}

// A rectangle that faces the middle and gives `radiance`, with soft edges; half-sizes are tangents
// of angles.
struct SoftBox {
    Vec3 axis, right, up;
    double half_width, half_height;
    Vec3 radiance;

    SoftBox(double azimuth, double elevation, double across, double along, const Vec3& light)
        : axis(toward(azimuth, elevation)), right(axis.cross(Vec3(0, 1, 0)).normalized()),
          up(right.cross(axis)), half_width(across), half_height(along), radiance(light) {}

    Vec3 at(const Vec3& d) const {
        const double depth = d.dot(axis);
        if (depth <= 0.01) return Vec3(0);
        const auto inside = [](double place, double half) {
            return 1 - ramp(0.85 * half, 1.15 * half, std::abs(place));
        };
        return radiance *
               (inside(d.dot(right) / depth, half_width) * inside(d.dot(up) / depth, half_height));
    }
};

template <std::size_t n>
Vec3 light_of(const std::array<SoftBox, n>& boxes, const Vec3& d) {
    Vec3 sum(0);
    for (const SoftBox& box : boxes) sum += box.at(d);
    return sum;
}

// The middle lies where the camera looks: what lights a subject's front is behind it.
Vec3 studio(const Vec3& d) {
    static const std::array boxes = {
        SoftBox(228, 38, 0.55, 0.55, {2.6, 2.6, 2.54}),    // key
        SoftBox(118, 15, 0.40, 0.70, {0.87, 0.90, 0.95}),  // fill
        SoftBox(20, 48, 0.75, 0.25, {1.69, 1.70, 1.74}),   // rim
    };
    const double room = 0.07 + 0.07 * ramp(-0.2, 1, d.y) - 0.036 * ramp(0.1, -0.6, d.y);
    return Vec3(room) + light_of(boxes, d);
}

// CIE standard overcast sky: (1 + 2 sin) / 3 of the zenith (Moon and Spencer 1942).
Vec3 overcast(const Vec3& d) {
    const double level = d.y > 0 ? (1 + 2 * d.y) / 3 : 0.18;
    return Vec3(1.12, 1.18, 1.24) * level;
}

Vec3 sunset(const Vec3& d) {
    static const Vec3 sun = toward(214, 12);
    const Vec3 zenith(0.14, 0.22, 0.43), away(0.39, 0.38, 0.47), near(1.24, 0.65, 0.29);
    if (d.y < 0) return Vec3(0.17, 0.135, 0.11) * (1 - 0.4 * ramp(0, -1, d.y));
    const double cosine = d.dot(sun);
    const double disc = ramp(std::cos(radians(2.2)), std::cos(radians(1.6)), cosine);
    const double glow = std::pow(std::max(cosine, 0.0), 24);
    const double haze = std::exp(-3.2 * d.y), share = ramp(-0.4, 1, cosine);
    return zenith * (1 - haze) + (away * (1 - share) + near * share) * haze +
           Vec3(1, 0.60, 0.29) * (735 * disc + 2 * glow);
}

Vec3 night(const Vec3& d) {
    static const std::array lamps = {
        SoftBox(236, 34, 0.16, 0.16, {30, 19, 9}),  SoftBox(118, 22, 0.10, 0.18, {8, 14, 26}),
        SoftBox(22, 40, 0.14, 0.08, {28, 12, 9}),   SoftBox(318, 12, 0.05, 0.05, {33, 23, 12}),
        SoftBox(64, 9, 0.05, 0.05, {12, 31, 18}),   SoftBox(170, 58, 0.08, 0.08, {18, 15, 26}),
        SoftBox(280, 55, 0.05, 0.05, {33, 26, 15}),
    };
    const double dusk = 0.013 + 0.030 * ramp(-0.1, 0.5, d.y);
    return Vec3(0.5, 0.7, 1.2) * dusk + light_of(lamps, d);
}

template <class Light>
Texture draw(const char* name, int width, const Light& light) {
    const int height = width / 2;
    Texture texture = {.name = name, .srgb = false};
    Raster& raster = texture.raster;
    raster = {.width = width, .height = height, .channels = 3, .depth = Depth::f32};
    const std::size_t size = raster.texels() * 3 * sizeof(float);
    const MemoryClaim claim(size, std::string("environment ") + name);
    raster.data.resize(size);
    std::byte* to = raster.data.data();
    std::vector<Vec3> level;
    for (int x = 0; x < width; ++x) level.push_back(toward(((x + 0.5) / width - 0.5) * 360, 0));
    for (int y = 0; y < height; ++y) {
        const double elevation = radians((0.5 - (y + 0.5) / height) * 180);
        const double across = std::cos(elevation), up = std::sin(elevation);
        for (int x = 0; x < width; ++x) {
            const Vec3& d = level[std::size_t(x)];
            const Color color(light({d.x * across, up, d.z * across}));
            std::memcpy(to, &color.x, 3 * sizeof(float));
            to += 3 * sizeof(float);
        }
    }
    return texture;
}

constexpr std::array<const char*, 4> names = {"studio", "overcast", "sunset", "night"};

}  // namespace

std::span<const char* const> surroundings_names() { return names; }

Environment& set_surroundings(Scene& scene, Surroundings which) {
    const char* name = names[std::size_t(which)];
    switch (which) {
    case Surroundings::studio: scene.textures.push_back(draw(name, smooth, studio)); break;
    case Surroundings::overcast: scene.textures.push_back(draw(name, smooth, overcast)); break;
    case Surroundings::sunset: scene.textures.push_back(draw(name, detailed, sunset)); break;
    case Surroundings::night: scene.textures.push_back(draw(name, detailed, night)); break;
    }
    Environment& environment = set_environment(scene, Index(scene.textures.size() - 1), name);
    environment.before_camera = which == Surroundings::studio;
    return environment;
}

}  // namespace penumbra
