// Both pictures and where they differ, small, for the list of all cases.
#include "validation/report/thumbnails.h"

#include "validation/report/html.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace penumbra::html {
namespace {

constexpr int most_width = 144, most_height = 108, gap = 3;

// The pixels of the source that make up small pixel `i`, of one axis.
struct Span {
    int begin, end;
};

Span span_of(int i, double scale, int size) {
    const int begin = std::min(int(double(i) * scale), size - 1);
    return {begin, std::clamp(int(std::ceil(double(i + 1) * scale)), begin + 1, size)};
}

struct Place {
    int x;         // of the left edge in the strip
    double scale;  // pixels of the source in one of the strip
};

int shrunk(int size, double scale) { return std::max(1, int(std::lround(size / scale))); }

// `merge(sum, pixel)` and `finish(sum, count)` make one colour of many.
template <class Merge, class Finish>
void draw(Image& strip, const Image& from, Place place, const Merge& merge, const Finish& finish) {
    const int width = shrunk(from.width, place.scale);
    const int height = shrunk(from.height, place.scale);
    for (int y = 0; y < height; ++y) {
        const Span rows = span_of(y, place.scale, from.height);
        for (int x = 0; x < width; ++x) {
            const Span columns = span_of(x, place.scale, from.width);
            Color sum(0);
            for (int v = rows.begin; v < rows.end; ++v)
                for (int u = columns.begin; u < columns.end; ++u) merge(sum, from.at(u, v));
            const int count = (rows.end - rows.begin) * (columns.end - columns.begin);
            strip.at(place.x + x, y) = finish(sum, float(count));
        }
    }
}

void draw_picture(Image& strip, const Image& from, Place place) {
    // Clamped first: one bright light would outshine all that it is averaged with.
    draw(
        strip, from, place,
        [](Color& sum, const Color& pixel) {
            for (int i = 0; i < 3; ++i) sum[i] += pixel[i] > 0 ? std::min(pixel[i], 1.F) : 0.F;
        },
        [](const Color& sum, float count) { return sum / count; });
}

// The worst of the pixels that fall together, so that a single wrong one stays visible.
void draw_errors(Image& strip, const Image& flip_map, Place place) {
    Image worst(strip.width, strip.height);
    draw(
        worst, flip_map, {0, place.scale},
        [](Color& sum, const Color& pixel) { sum.x = std::max(sum.x, pixel.x); },
        [](const Color& sum, float) { return Color(sum.x); });
    const Image colors = heat_map(worst);
    for (int y = 0; y < strip.height; ++y)
        for (int x = place.x; x < strip.width; ++x) strip.at(x, y) = colors.at(x - place.x, y);
}

}  // namespace

Image thumbnails(const Case& one) {
    assert(has_pixels(one.test) || has_pixels(one.reference));
    const bool has_map = has_pixels(one.comparison.flip_map);
    const int width = std::max(one.test.width, one.reference.width);
    const int height = std::max(one.test.height, one.reference.height);
    const double scale = std::max({1.0, double(width) / most_width, double(height) / most_height});
    const int w = shrunk(width, scale), h = shrunk(height, scale);
    Image strip(w * (has_map ? 3 : 2) + gap * (has_map ? 2 : 1), h);
    std::ranges::fill(strip.pixels, Color(0.216F));  // a middle grey
    if (has_pixels(one.test)) draw_picture(strip, one.test, {0, scale});
    if (has_pixels(one.reference)) draw_picture(strip, one.reference, {w + gap, scale});
    if (has_map) draw_errors(strip, one.comparison.flip_map, {2 * (w + gap), scale});
    return strip;
}

}  // namespace penumbra::html
