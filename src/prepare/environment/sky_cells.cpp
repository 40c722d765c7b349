#include "prepare/environment/sky_cells.h"

#include "base/luminance.h"
#include "image/texels.h"
#include "scene/texture/texture_lookup.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra {

namespace {

constexpr float brightest = 65504;  // of a half: what renderers see of a sky

// How one axis of the image is divided: of a large image several pixels make a cell, of a small one
// a pixel is several.
struct Division {
    int samples = 0, per_cell = 1, cells = 0;

    Division(int size, int most) {
        per_cell = (size + most - 1) / most;
        samples = size * std::max(1, most / size);
        cells = (samples + per_cell - 1) / per_cell;
    }
};

float usable(float value) { return std::isnan(value) ? 0 : std::clamp(value, 0.0F, brightest); }

Vec3 usable(const Color& color) {
    return {double(usable(color.x)), double(usable(color.y)), double(usable(color.z))};
}

// Sines and cosines of the longitudes of all columns.
std::vector<Vec2> longitudes(int count) {
    std::vector<Vec2> result;
    for (int x = 0; x < count; ++x) {
        const double angle = ((x + 0.5) / count - 0.5) * 2 * std::numbers::pi;
        result.emplace_back(std::sin(angle), std::cos(angle));
    }
    return result;
}

}  // namespace

SkyCells sky_cells(const Texture& texture, int sources) {
    const Raster& raster = texture.raster;
    const int most_rows = sources <= 256 ? 128 : 256;
    const Division across(raster.width, 2 * most_rows), down(raster.height, most_rows);
    SkyCells cells{.width = across.cells, .height = down.cells};
    const auto count = std::size_t(cells.width) * std::size_t(cells.height);
    cells.moments.resize(count);
    cells.flux.resize(count, Vec3(0));
    const TextureLookup lookup(texture);
    const bool exact = across.samples == raster.width && down.samples == raster.height;
    const std::vector<Vec2> turns = longitudes(across.samples);
    const double pi = std::numbers::pi;
    for (int y = 0; y < down.samples; ++y) {
        const double middle = (0.5 - (y + 0.5) / down.samples) * pi;
        const double top = (0.5 - double(y) / down.samples) * pi;
        const double bottom = (0.5 - (y + 1.0) / down.samples) * pi;
        const double angle = (std::sin(top) - std::sin(bottom)) * (2 * pi / across.samples);
        const double level = std::cos(middle), height = std::sin(middle);
        for (int x = 0; x < across.samples; ++x) {
            const Color color =
                exact ? lookup.samples.color(std::size_t(y) * std::size_t(raster.width) +
                                             std::size_t(x))
                      : sample(lookup, (x + 0.5) / across.samples, 1 - (y + 0.5) / down.samples);
            const Vec3 flux = usable(color) * angle;
            const double energy = luminance(flux);
            const Vec2& turn = turns[std::size_t(x)];
            const Vec3 direction(turn.x * level, height, -turn.y * level);
            const std::size_t cell = cells.at(x / across.per_cell, y / down.per_cell);
            cells.moments[cell].add({energy, direction * energy});
            cells.flux[cell] += flux;
        }
    }
    return cells;
}

}  // namespace penumbra
