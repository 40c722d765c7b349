// Sheen as a matte layer that covers more of a surface the flatter it is seen. The tracer and the
// exporter both call this and nothing else.
//
// Charlie scatters from l to v D(h) V(l, v), D = (2 + 1/a) sin(h)^(1/a) / (2 pi), a = roughness^2,
// V = 1 / (4 (n.l + n.v - n.l n.v)). Under light that is the same from everywhere a surface shows
// of it E(v), the integral of D V n.l over all l, and is left 1 - max(colour) E(v) of what lies
// below. A layer of that opacity and of the colour colour / max(colour), matte, shows the same.
#include "penumbra/light_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double smoothest = 0.07;  // below it the lobe is too narrow for the sum over directions

// E by the midpoints of even parts of n.l and of half a turn.
double directional_albedo(double roughness, double facing) {
    constexpr int heights = 32, turns = 32;
    const double exponent = 1 / (roughness * roughness);
    const double sine = std::sqrt(1 - facing * facing);
    double sum = 0;
    for (int i = 0; i < heights; ++i) {
        const double up = (i + 0.5) / heights, across = std::sqrt(1 - up * up);
        const double visibility = 1 / (4 * (up + facing - up * facing));
        for (int k = 0; k < turns; ++k) {
            const double turn = (k + 0.5) / turns * pi;
            // h = l + v, of length sqrt(2 + 2 l.v)
            const double together = up * facing + across * sine * std::cos(turn);
            const double raised = (up + facing) * (up + facing) / (2 + 2 * together);
            sum += std::pow(std::max(0.0, 1 - raised), exponent / 2) * visibility * up;
        }
    }
    return (2 + exponent) / (2 * pi) * sum * (2 * pi / (heights * turns));
}

float largest_channel(const Color& c) { return std::max({c.x, c.y, c.z}); }

}  // namespace

bool covers(const Material& material) {
    return material.sheen && material.opacity >= 1 && largest_channel(material.sheen->color) > 0;
}

std::array<float, 17> sheen_cover(const Sheen& sheen) {
    std::array<float, 17> cover{};
    const double roughness = std::clamp(double(sheen.roughness), smoothest, 1.0);
    for (std::size_t i = 0; i < cover.size(); ++i) {
        const double raised = pi / 2 * double(i) / double(cover.size() - 1);
        const double facing = std::clamp(std::sin(raised), 1e-3, 1.0);
        cover[i] = float(std::min(1.0, double(largest_channel(sheen.color)) *
                                           directional_albedo(roughness, facing)));
    }
    return cover;
}

Color sheen_tint(const Sheen& sheen) { return sheen.color / largest_channel(sheen.color); }

}  // namespace penumbra
