#include "tracer/tile_rows.h"

#include "base/isolated.h"

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
    : width_(options.width), height_(options.height), last_(range.last),
      given_(range.first / tile_side * columns()), handed_(range.first / tile_side),
      finished_(given_), take_(taker) {}

int TileRows::columns() const { return (width_ + tile_side - 1) / tile_side; }

int TileRows::row_count() const { return (last_ + tile_side - 1) / tile_side; }

std::optional<TileRows::Work> TileRows::next() {
    std::unique_lock lock(mutex_);
    // Whoever has the topmost tile does not wait here, so that the others do not wait for ever.
    room_.wait(lock,
               [&] { return stopped_ || given_ / columns() < handed_ + rows_in_memory(width_); });
    if (stopped_ || given_ == row_count() * columns()) return std::nullopt;
    const int row = given_ / columns(), column = given_ % columns();
    ++given_;
    const PictureTile tile = {column * tile_side, row * tile_side,
                              std::min(tile_side, width_ - column * tile_side),
                              std::min(tile_side, height_ - row * tile_side)};
    const auto [entry, fresh] = rows_.try_emplace(row);
    if (fresh) entry->second = {Image(width_, tile.height), columns()};
    return Work{tile, &entry->second.image};
}

double TileRows::finish(const PictureTile& tile) {
    std::unique_lock lock(mutex_);
    --rows_.at(tile.y / tile_side).unfinished;
    ++finished_;
    hand_over(lock);
    const int all = (height_ + tile_side - 1) / tile_side * columns();
    return double(finished_) / double(all);
}

// One thread does so; the others go on.
void TileRows::hand_over(std::unique_lock<std::mutex>& lock) {
    if (handing_) return;
    handing_ = true;
    for (auto row = rows_.find(handed_);
         row != rows_.end() && row->second.unfinished == 0 && !stopped_;
         row = rows_.find(handed_)) {
        const Image image = std::move(row->second.image);
        rows_.erase(row);
        lock.unlock();
        call_isolated([&] { take_(handed_ * tile_side, image); });
        lock.lock();
        ++handed_;
        room_.notify_all();
    }
    handing_ = false;
}

void TileRows::stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    room_.notify_all();
}

}  // namespace penumbra
