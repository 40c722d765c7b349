// POV-Ray's recursive anti-aliasing: where rays go through the pixels of a tile, and what their
// colours make of these.
#pragma once

#include "tracer/tile_rows.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace penumbra {

/// Finds the colours that are seen through points of the picture, in pixels from its upper left
/// corner. There are as many of both.
using TracePoints = std::function<void(std::span<const Vec2> points, std::span<Color> colors)>;

/// Follows POV-Ray's `+AM2` (source/backend/render/tracetask.cpp, SubdivideOnePixel), but for all
/// pixels of a tile at once, so that many rays are traced together. Points that cells share are
/// traced once. Kept from tile to tile, as its arrays grow.
class AdaptiveSampler {
  public:
    /// Makes pixels() those of the tile.
    void sample(const PictureTile& tile, const Antialiasing& rule, const TracePoints& trace);

    /// Row by row.
    const std::vector<Vec3>& pixels() const { return pixels_; }

  private:
    // A square of a pixel, whose corners are samples: upper left, upper right, lower left, lower
    // right. Places are steps of the finest cells from the tile's upper left corner.
    struct Cell {
        std::uint32_t x = 0, y = 0;
        std::uint32_t pixel = 0;
        std::array<std::uint32_t, 4> corners = {};
    };
    // A point that is to be traced, and where the number of its sample goes.
    struct Wanted {
        std::uint32_t x = 0, y = 0;
        std::uint32_t* sample = nullptr;
    };
    // Cells of one size.
    struct Level {
        std::uint32_t side = 1;  // steps
        double weight = 1;       // of a cell in its pixel
    };

    std::vector<Cell> pixel_cells(const PictureTile& tile);
    void refine(std::span<const Cell> cells, const Level& level);
    void refine_some(std::span<const Cell> cells, const Level& level);
    std::vector<Cell> quartered(std::span<const Cell> cells, const Level& level);
    void trace_wanted();
    bool varies(const Cell& cell) const;
    void add(const Cell& cell, const Level& level);

    const TracePoints* trace_ = nullptr;
    Vec2 corner_ = Vec2(0);  // of the tile, pixels
    float threshold_ = 0;
    std::uint32_t steps_ = 1;                        // in a pixel's side
    std::vector<Color> colors_ = {}, encoded_ = {};  // of the samples
    std::vector<Wanted> wanted_ = {};
    std::vector<std::uint64_t> order_ = {};  // scratch: places of wanted points, and which
    std::vector<Vec2> points_ = {};          // scratch
    std::vector<Vec3> pixels_ = {};
};

}  // namespace penumbra
