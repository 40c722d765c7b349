// What a camera's light meter would say.
#include "base/luminance.h"
#include "scene/check_options.h"

#include "penumbra/tracer.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr int metering_width = 64;  // pixels
constexpr double middle = 0.25;
constexpr double highlight_share = 0.05;  // of the picture, which may be brighter than white
constexpr double most_over = 1;           // EV that the highlights' limit gives way for the rest
constexpr double deepest_shadow = 1e-3;   // of the highlights; what is darker counts as this
constexpr double least = -32, most = 32;  // EV

// Of what is not plain background.
std::vector<Color> subject_pixels(const Image& image, const Scene& scene) {
    std::vector<Color> pixels;
    for (const Color& pixel : image.pixels)
        if (scene.sky || pixel != scene.background) pixels.push_back(pixel);
    return pixels;
}

// What all but `highlight_share` of the pixels keep below, in their brightest channel: that is the
// one that would be clipped.
double highlight_of(const std::vector<Color>& pixels) {
    std::vector<float> values;
    for (const Color& c : pixels) values.push_back(std::max({c.x, c.y, c.z}));
    const auto at =
        values.begin() + std::ptrdiff_t((1 - highlight_share) * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return double(*at);
}

// Mean of log2 of the luminance (Rec. 709).
double mean_stops(const std::vector<Color>& pixels, double darkest) {
    double sum = 0;
    for (const Color& c : pixels) {
        sum += std::log2(std::max(luminance(Vec3(c)), darkest));
    }
    return sum / double(pixels.size());
}

}  // namespace

double metered_exposure(const Tracer& tracer, const RenderOptions& options, const Watch& watch) {
    check(options);
    RenderOptions small = options;
    small.width = metering_width;
    small.height =
        std::clamp(int(std::lround(double(metering_width) * options.height / options.width)), 1,
                   4 * metering_width);
    small.samples = 1;
    small.antialiasing.reset();
    // Penumbrae do not change the exposure, and cost the most.
    const Image image = tracer.render(small, {.penumbrae = false}, {.stop = watch.stop});
    const std::vector<Color> pixels = subject_pixels(image, tracer.scene().scene);
    const double highlight = pixels.empty() ? 0 : highlight_of(pixels);
    if (!(highlight > 0)) return 0;
    const double limit = -std::log2(highlight);
    const double key = std::log2(middle) - mean_stops(pixels, deepest_shadow * highlight);
    const double over = std::min((key - limit) / 2, most_over);
    const double stops = std::min(key, limit + std::max(over, 0.0));
    return std::round(std::clamp(stops, least, most) * 4) / 4;
}

double metered_exposure(const NormalisedScene& scene, const RenderOptions& options,
                        const Watch& watch) {
    return metered_exposure(Tracer(scene, options.threads), options, watch);
}

}  // namespace penumbra
