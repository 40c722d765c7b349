#include "tile_rows.h"

#include <algorithm>

namespace penumbra {

namespace {

// Rows of tiles in memory: more than threads are busy with, as some tiles take much longer.
constexpr int most_rows = 64;
// But of large pictures fewer, in pixels.
constexpr int most_pixels = 1 << 24;

int rows_in_memory(int width) {
    return std::clamp(most_pixels / (width * tile_side), 4, most_rows);
}

}  // namespace

TileRows::TileRows(const RenderOptions& options, const RowRange& range, const TakeRows& taker)
    : width(options.width), height(options.height), last(range.last),
      given(range.first / tile_side * columns()), handed(range.first / tile_side), finished(given),
      take(taker) {}

int TileRows::columns() const { return (width + tile_side - 1) / tile_side; }

int TileRows::row_count() const { return (last + tile_side - 1) / tile_side; }

std::optional<TileRows::Work> TileRows::next() {
    std::unique_lock lock(mutex);
    // Whoever has the topmost tile does not wait here, so that the others do not wait for ever.
    room.wait(lock, [&] { return stopped || given / columns() < handed + rows_in_memory(width); });
    if (stopped || given == row_count() * columns()) return std::nullopt;
    const int row = given / columns(), column = given % columns();
    ++given;
    const Tile tile = {column * tile_side, row * tile_side,
                       std::min(tile_side, width - column * tile_side),
                       std::min(tile_side, height - row * tile_side)};
    const auto [entry, fresh] = rows.try_emplace(row);
    if (fresh) entry->second = {Image(width, tile.height), columns()};
    return Work{tile, &entry->second.image};
}

double TileRows::finish(const Tile& tile) {
    std::unique_lock lock(mutex);
    --rows.at(tile.y / tile_side).unfinished;
    ++finished;
    hand_over(lock);
    const int all = (height + tile_side - 1) / tile_side * columns();
    return double(finished) / double(all);
}

// One thread does so; the others go on.
void TileRows::hand_over(std::unique_lock<std::mutex>& lock) {
    if (handing) return;
    handing = true;
    for (auto row = rows.find(handed); row != rows.end() && row->second.unfinished == 0 && !stopped;
         row = rows.find(handed)) {
        const Image image = std::move(row->second.image);
        rows.erase(row);
        lock.unlock();
        take(handed * tile_side, image);
        lock.lock();
        ++handed;
        room.notify_all();
    }
    handing = false;
}

void TileRows::stop() {
    const std::lock_guard lock(mutex);
    stopped = true;
    room.notify_all();
}

}  // namespace penumbra
