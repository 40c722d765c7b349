// The order in which a picture is rendered: in tiles, handed over in whole rows of them.
#pragma once

#include "penumbra/image.h"
#include "penumbra/tracer.h"

#include <condition_variable>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>

namespace penumbra {

/// Pixels; fixed, so that the picture does not depend on threads.
inline constexpr int tile_side = render_band;

/// A piece of a picture, in pixels.
struct PictureTile {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Gives the tiles of a picture to threads, from the top, and hands finished rows of tiles over in
/// that order. Few are in memory at a time.
class TileRows {
  public:
    TileRows(const RenderOptions& options, const RowRange& range, const TakeRows& take);

    /// The next tile and the rows that it lies in; none at the end and after stop(). Waits for the
    /// others where too much would be in memory.
    struct Work {
        PictureTile tile = {};
        Image* rows = nullptr;  ///< their first row is that of the tile
    };
    std::optional<Work> next();

    /// Its pixels are there. Returns the share of the picture that is finished.
    double finish(const PictureTile& tile);

    /// next() gives no more.
    void stop();

  private:
    struct Row {
        Image image = {};
        int unfinished = 0;  ///< tiles
    };
    int columns() const;
    int row_count() const;  ///< of tiles, above and in the range
    void hand_over(std::unique_lock<std::mutex>& lock);

    int width_, height_, last_;
    int given_;         ///< tiles; those above the first are as if they were finished
    int handed_;        ///< rows of tiles
    int finished_ = 0;  ///< tiles
    bool handing_ = false, stopped_ = false;
    const TakeRows& take_;
    std::map<int, Row> rows_ = {};  ///< in memory
    std::mutex mutex_ = {};
    std::condition_variable room_ = {};
};

}  // namespace penumbra
