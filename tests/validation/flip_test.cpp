// The FLIP map against a second implementation: double precision, two-dimensional kernels applied
// directly, written from the formulas of Andersson et al. 2020 without a library.
#include "support/support.h"

#include "penumbra/compare.h"
#include "penumbra/image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

using penumbra::Color;
using penumbra::Image;

namespace {

constexpr double pi = std::numbers::pi, ppd = 67;
using Triple = std::array<double, 3>;
using Plane = std::vector<double>;  // row-major

Triple xyz(const Triple& c) {
    return {(10135552 * c[0] + 8788810 * c[1] + 4435075 * c[2]) / 24577794,
            (2613072 * c[0] + 8788810 * c[1] + 887015 * c[2]) / 12288897,
            (1425312 * c[0] + 8788810 * c[1] + 70074185 * c[2]) / 73733382};
}

// Inverse of xyz(), by Cramer's rule.
Triple rgb(const Triple& v) {
    const Triple r = xyz({1, 0, 0}), g = xyz({0, 1, 0}), b = xyz({0, 0, 1});
    const auto det = [](const Triple& p, const Triple& q, const Triple& s) {
        return p[0] * (q[1] * s[2] - q[2] * s[1]) - q[0] * (p[1] * s[2] - p[2] * s[1]) +
               s[0] * (p[1] * q[2] - p[2] * q[1]);
    };
    const double d = det(r, g, b);
    return {det(v, g, b) / d, det(r, v, b) / d, det(r, g, v) / d};
}

Triple hunt_lab(const Triple& c) {
    const Triple v = xyz(c), white = xyz({1, 1, 1});
    Triple f;
    for (std::size_t i = 0; i < 3; ++i) {
        const double t = v[i] / white[i], d = 6.0 / 29;
        f[i] = t > d * d * d ? std::pow(t, 1.0 / 3) : t / (3 * d * d) + 4.0 / 29;
    }
    const double l = 116 * f[1] - 16;
    return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

double hyab(const Triple& a, const Triple& b) {
    return std::abs(a[0] - b[0]) + std::sqrt(std::pow(a[1] - b[1], 2) + std::pow(a[2] - b[2], 2));
}

double color_error(const Triple& a, const Triple& b) {
    const double most = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
    const double e = std::pow(hyab(hunt_lab(a), hunt_lab(b)), 0.7), knee = 0.4 * most;
    return e < knee ? 0.95 * e / knee : 0.95 + 0.05 * (e - knee) / (most - knee);
}

struct Kernel {
    int radius;
    Plane weights;  // (2 radius + 1)^2
};

Kernel kernel(int radius, const std::function<double(double, double)>& weight) {
    Kernel k = {radius, {}};
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x) k.weights.push_back(weight(x, y));
    return k;
}

Kernel sensitivity(double a1, double b1, double a2, double b2) {
    const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    Kernel k = kernel(radius, [&](double x, double y) {
        const double d2 = (x * x + y * y) / (ppd * ppd);
        return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * d2 / b1) +
               a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * d2 / b2);
    });
    double sum = 0;
    for (const double w : k.weights) sum += w;
    for (double& w : k.weights) w /= sum;
    return k;
}

Kernel feature(int order, bool along_y) {
    const double sd = 0.5 * 0.082 * ppd;
    Kernel k = kernel(int(std::ceil(3 * sd)), [&](double x, double y) {
        const double g = std::exp(-(x * x + y * y) / (2 * sd * sd)), t = along_y ? y : x;
        return order == 1 ? -t * g : (t * t / (sd * sd) - 1) * g;
    });
    double positive = 0, negative = 0;
    for (const double w : k.weights) (w > 0 ? positive : negative) += std::abs(w);
    for (double& w : k.weights) w /= w > 0 ? positive : negative;
    return k;
}

Plane convolved(const Plane& from, int width, int height, const Kernel& k) {
    Plane to(from.size());
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            double sum = 0;
            std::size_t w = 0;
            for (int j = -k.radius; j <= k.radius; ++j) {
                const int row = std::clamp(y + j, 0, height - 1) * width;
                for (int i = -k.radius; i <= k.radius; ++i)
                    sum +=
                        k.weights[w++] * from[std::size_t(row + std::clamp(x + i, 0, width - 1))];
            }
            to[std::size_t(y * width + x)] = sum;
        }
    }
    return to;
}

struct Seen {
    std::vector<Triple> color;
    Plane edges, points;
};

Plane strength(const Plane& luma, int w, int h, int order) {
    Plane a = convolved(luma, w, h, feature(order, false));
    const Plane b = convolved(luma, w, h, feature(order, true));
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = std::hypot(a[i], b[i]);
    return a;
}

Seen seen(const Image& image) {
    const int w = image.width, h = image.height;
    const Triple white = xyz({1, 1, 1});
    std::array<Plane, 3> opponent;
    Plane luma;
    for (const Color& c : image.pixels) {
        Triple v = xyz({c.x, c.y, c.z});
        for (std::size_t i = 0; i < 3; ++i) v[i] /= white[i];
        opponent[0].push_back(116 * v[1] - 16);
        opponent[1].push_back(500 * (v[0] - v[1]));
        opponent[2].push_back(200 * (v[1] - v[2]));
        luma.push_back(v[1]);
    }
    opponent[0] = convolved(opponent[0], w, h, sensitivity(1, 0.0047, 0, 1e-5));
    opponent[1] = convolved(opponent[1], w, h, sensitivity(1, 0.0053, 0, 1e-5));
    opponent[2] = convolved(opponent[2], w, h, sensitivity(34.1, 0.04, 13.5, 0.025));
    Seen result;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const double y = (opponent[0][i] + 16) / 116;
        Triple c = rgb({(y + opponent[1][i] / 500) * white[0], y * white[1],
                        (y - opponent[2][i] / 200) * white[2]});
        for (double& channel : c) channel = std::clamp(channel, 0.0, 1.0);
        result.color.push_back(c);
    }
    result.edges = strength(luma, w, h, 1);
    result.points = strength(luma, w, h, 2);
    return result;
}

Plane flip(const Image& test, const Image& reference) {
    const Seen a = seen(test), b = seen(reference);
    Plane result;
    for (std::size_t i = 0; i < test.pixels.size(); ++i) {
        const double f =
            std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i])) /
            std::sqrt(2.0);
        result.push_back(std::pow(color_error(a.color[i], b.color[i]), 1 - std::sqrt(f)));
    }
    return result;
}

Image constant(int w, int h, const Color& color) {
    Image image(w, h);
    std::ranges::fill(image.pixels, color);
    return image;
}

// Edges, points, saturated colours and smooth parts.
Image pattern(int w, int h, unsigned seed) {
    Image image(w, h);
    unsigned state = seed;
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            state = state * 1664525U + 1013904223U;
            const float noise = float(state >> 8) / float(1U << 24);
            Color c = {float(x) / float(w), float(y) / float(h), 0.5F};
            if (x > w / 2 && y > h / 3) c = {0.9F, 0.05F, 0.1F};
            if ((x + int(seed)) % 11 == 0 && y % 7 == 0) c = Color(1);
            if (y > 2 * h / 3) c = c * 0.5F + Color(noise) * 0.5F;
            image.at(x, y) = c;
        }
    }
    return image;
}

}  // namespace

TEST_CASE("FLIP agrees with a second implementation in every pixel") {
    const int w = 61, h = 43;
    const Image reference = pattern(w, h, 1), test = pattern(w, h, 5);
    const Plane expected = flip(test, reference);
    const penumbra::Comparison result = penumbra::compare(test, reference);
    double mean = 0, worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        worst = std::max(worst, std::abs(expected[i] - double(result.flip_map.pixels[i].x)));
        mean += expected[i] / double(expected.size());
    }
    CHECK(worst < 2e-5);
    CHECK(result.value("flip") == Approx(mean).margin(1e-6));
    CHECK(mean > 0.05);  // there is something to find
}

TEST_CASE("FLIP does not care which picture is the reference") {
    const Image a = pattern(40, 30, 1), b = pattern(40, 30, 9);
    CHECK(penumbra::compare(a, b).value("flip") ==
          Approx(penumbra::compare(b, a).value("flip")).margin(1e-12));
}

TEST_CASE("FLIP is zero for equal pictures") {
    const Image a = pattern(40, 30, 3);
    const penumbra::Comparison result = penumbra::compare(a, a);
    CHECK(result.value("flip") == 0);
    CHECK(result.value("flip_p99") == 0);
    CHECK(result.value("flip_tile") == 0);
}

TEST_CASE("FLIP of constant pictures follows from their colours alone") {
    // Black against white: no features; HyAB is the difference of lightness, 100. It is beyond the
    // knee: 0.95 + 0.05 (100^0.7 - 0.4 m) / (0.6 m), m = (HyAB of green and blue)^0.7.
    const double most = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
    const double expected = 0.95 + 0.05 * (std::pow(100, 0.7) - 0.4 * most) / (0.6 * most);
    const penumbra::Comparison result =
        penumbra::compare(constant(32, 32, Color(0)), constant(32, 32, Color(1)));
    CHECK(result.value("flip") == Approx(expected).margin(1e-5));
    CHECK(result.value("flip_p99") == Approx(expected).margin(1e-5));
    CHECK(expected > 0.95);
    CHECK(expected < 1);
    // The largest difference that there is.
    CHECK(
        penumbra::compare(constant(32, 32, {0, 1, 0}), constant(32, 32, {0, 0, 1})).value("flip") ==
        Approx(1).margin(1e-5));
    // Middle greys of L* 50 and 54: below the knee, proportional to the power of the distance 4.
    const auto grey = [](double l) { return Color(float(std::pow((l + 16) / 116, 3))); };
    CHECK(penumbra::compare(constant(32, 32, grey(54)), constant(32, 32, grey(50))).value("flip") ==
          Approx(0.95 / (0.4 * most) * std::pow(4, 0.7)).margin(1e-4));
}

TEST_CASE("FLIP clamps what a display cannot show") {
    CHECK(penumbra::compare(constant(32, 32, Color(7)), constant(32, 32, Color(1))).value("flip") ==
          0);
    CHECK(
        penumbra::compare(constant(32, 32, Color(-3)), constant(32, 32, Color(0))).value("flip") ==
        0);
}

namespace {

// The ACES curve of the HDR-FLIP papers.
double aces(double x) {
    return (0.36 * 2.51 * x * x + 0.6 * 0.03 * x) / (0.36 * 2.43 * x * x + 0.6 * 0.59 * x + 0.14);
}

// Where it is 0.85, by bisection.
double inverse_of_085() {
    double low = 0, high = 100;
    for (int i = 0; i < 200; ++i) (aces((low + high) / 2) < 0.85 ? low : high) = (low + high) / 2;
    return low;
}

Image seen_at(const Image& image, double exposure) {
    Image result = image;
    for (Color& c : result.pixels)
        for (int i = 0; i < 3; ++i)
            c[i] = float(
                std::clamp(aces(std::exp2(exposure) * std::max(0.0, double(c[i]))), 0.0, 1.0));
    return result;
}

}  // namespace

TEST_CASE("FLIP does not see the rounding of one picture to 8 bits") {
    // Dark enough that FLIP of the rounding alone is beyond the limit of a profile.
    Image fine = pattern(60, 40, 1);
    for (Color& c : fine.pixels) c *= 0.02F;
    const auto rounded = [](Image image) {
        for (Color& c : image.pixels)
            for (int i = 0; i < 3; ++i)
                c[i] = penumbra::srgb_to_linear(std::round(penumbra::linear_to_srgb(c[i]) * 255) /
                                                255);
        return image;
    };
    const Image coarse = rounded(fine);
    CHECK(penumbra::compare(fine, coarse).value("flip") == 0);
    CHECK(penumbra::compare(coarse, fine).value("flip") == 0);
    // More than rounding is seen, and so is as little between two pictures of the same kind.
    Image brighter = fine;
    for (Color& c : brighter.pixels) c *= 1.05F;
    CHECK(penumbra::compare(brighter, coarse).value("flip") > 0.01);
    Image slightly = fine;
    for (Color& c : slightly.pixels) c *= 1.001F;
    CHECK(penumbra::compare(slightly, fine).value("flip") > 0);
}

TEST_CASE("HDR-FLIP is the worst FLIP over the exposures of the reference") {
    const int w = 40, h = 30;
    Image reference = pattern(w, h, 1), test = pattern(w, h, 5);
    for (Color& c : reference.pixels) c *= c * 30;
    for (Color& c : test.pixels) c *= c * 33;
    std::vector<double> luminances;
    for (const Color& c : reference.pixels)
        luminances.push_back(0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z));
    std::ranges::sort(luminances);
    const double first = std::log2(inverse_of_085() / luminances.back());
    const double last = std::log2(inverse_of_085() / luminances[(luminances.size() - 1) / 2]);
    const int count = std::max(2, int(std::ceil(last - first)));
    Plane worst(reference.pixels.size());
    for (int i = 0; i < count; ++i) {
        const double exposure = first + i * (last - first) / (count - 1);
        const Plane errors = flip(seen_at(test, exposure), seen_at(reference, exposure));
        for (std::size_t k = 0; k < errors.size(); ++k) worst[k] = std::max(worst[k], errors[k]);
    }
    double mean = 0;
    for (const double error : worst) mean += error / double(worst.size());
    REQUIRE(count > 2);
    CHECK(penumbra::compare(test, reference).value("hdr_flip") == Approx(mean).margin(1e-5));
}

TEST_CASE("HDR-FLIP is measured where something is brighter than white or a limit asks") {
    const Image dark = pattern(40, 30, 1);
    CHECK(std::isnan(penumbra::compare(dark, dark).value("hdr_flip")));
    penumbra::CompareOptions options;
    options.limits.limits["hdr_flip"] = 0.1;
    CHECK(penumbra::compare(dark, dark, options).value("hdr_flip") == 0);
    CHECK(penumbra::compare(dark, dark, options).verdict == penumbra::Verdict::pass);
    Image bright = dark;
    for (int x = 0; x < 40; ++x) bright.at(x, 0) = Color(1.5F);
    CHECK(penumbra::compare(dark, bright).value("hdr_flip") > 0);
    // LDR-FLIP cannot tell 4 from 8, HDR-FLIP can.
    const Image four = constant(32, 32, Color(4)), eight = constant(32, 32, Color(8));
    CHECK(penumbra::compare(four, eight).value("flip") == 0);
    CHECK(penumbra::compare(four, eight).value("hdr_flip") > 0.1);
}
