#include "scene/texture/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {

namespace {

constexpr int lattice = 2048;  // the noise repeats after so many cells

// Gradients and their permutation, drawn from the linear congruential generator that POV-Ray
// documents for its noise (source/backend/texture/texture.cpp of 3.7, InitSolidNoise).
struct Tables {
    std::array<int, 2 * lattice + 2> permutation = {};
    std::array<Vec3, 2 * lattice + 2> gradient = {};

    Tables() {
        std::uint32_t state = 1;
        const auto draw = [&state] {
            state = state * 1812433253U + 12345U;
            return int((state >> 16) & 0x7fffU);
        };
        const auto component = [&draw] { return (draw() % 4096 - 2048) / 2048.0; };
        for (int i = 0; i < lattice; ++i) {
            Vec3 g;
            double square = 0;
            do {
                g.x = component();
                g.y = component();
                g.z = component();
                square = g.dot(g);
            } while (square > 1 || square < 1e-5);
            gradient[std::size_t(i)] = g * (1 / std::sqrt(square));
        }
        for (int i = 0; i < lattice; ++i) permutation[std::size_t(i)] = i;
        for (int i = lattice; i > 0; i -= 2)
            std::swap(permutation[std::size_t(i)], permutation[std::size_t(draw() % lattice)]);
        for (std::size_t i = 0; i < lattice + 2; ++i) {
            permutation[lattice + i] = permutation[i];
            gradient[lattice + i] = gradient[i];
        }
    }
};

const Tables& tables() {
    static const Tables built;
    return built;
}

// One axis of the lattice cell that holds a point: both corners' indices and offsets from them.
struct Axis {
    std::size_t low, high;
    double from_low, from_high, weight;

    explicit Axis(double coordinate) {
        const double shifted = coordinate + 10000000.023157213;
        const double cell = std::floor(shifted);
        low = std::size_t(std::int64_t(cell) & (lattice - 1));
        high = (low + 1) & (lattice - 1);
        from_low = shifted - cell;
        from_high = from_low - 1;
        weight = from_low * from_low * (3 - 2 * from_low);
    }
};

double mix(double weight, double a, double b) { return a + weight * (b - a); }

}  // namespace

double perlin_noise(const Vec3& p) {
    const Tables& t = tables();
    const Axis x(p.x), y(p.y), z(p.z);
    const auto column = [&](std::size_t corner, std::size_t side) {
        return std::size_t(t.permutation[std::size_t(t.permutation[corner]) + side]);
    };
    const std::size_t b00 = column(x.low, y.low), b10 = column(x.high, y.low);
    const std::size_t b01 = column(x.low, y.high), b11 = column(x.high, y.high);
    const auto plane = [&](std::size_t side, double rz) {
        const auto ramp = [&](std::size_t corner, double rx, double ry) {
            return t.gradient[corner + side].dot(Vec3(rx, ry, rz));
        };
        const double low =
            mix(x.weight, ramp(b00, x.from_low, y.from_low), ramp(b10, x.from_high, y.from_low));
        const double high =
            mix(x.weight, ramp(b01, x.from_low, y.from_high), ramp(b11, x.from_high, y.from_high));
        return mix(y.weight, low, high);
    };
    const double n = mix(z.weight, plane(z.low, z.from_low), plane(z.high, z.from_high));
    return std::clamp(0.5 * (1.59 * n + 0.985), 0.0, 1.0);
}

double noise_value(const Noise& noise, const Vec3& p) {
    const Vec3 point = (p - noise.origin) * (1 / noise.size);
    double sum = 0, weights = 0, frequency = 1, weight = 1;
    for (int i = 0; i < noise.octaves; ++i) {
        sum += weight * perlin_noise(point * frequency);
        weights += weight;
        frequency *= 2;
        weight /= 2;
    }
    return sum / weights;
}

}  // namespace penumbra
