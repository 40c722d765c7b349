#include "tracer/pixel_sampler.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

// Cells that are refined together, all of a tile's pixels at least. Of every level no more are in
// memory.
constexpr std::size_t most_cells = 4096;

// POV-Ray's Antialias_Gamma of 2.5, in its precision.
Color encoded(const Color& color) {
    const auto encode = [](float c) { return std::pow(std::max(c, 0.F), 1 / 2.5F); };
    return {encode(color.x), encode(color.y), encode(color.z)};
}

float distance(const Color& a, const Color& b) {
    return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z);
}

// The bits of `value` with a zero between any two of them.
std::uint64_t spread(std::uint64_t value) {
    value = (value | value << 8U) & 0x00FF00FFU;
    value = (value | value << 4U) & 0x0F0F0F0FU;
    value = (value | value << 2U) & 0x33333333U;
    return (value | value << 1U) & 0x55555555U;
}

// Along a Z-order curve (Morton 1966), so that the rays of a packet are close together.
std::uint64_t place_on_curve(std::uint32_t x, std::uint32_t y) {
    return spread(x) | spread(y) << 1U;
}

}  // namespace

void AdaptiveSampler::sample(const PictureTile& tile, const Antialiasing& rule,
                             const TracePoints& trace) {
    trace_ = &trace;
    corner_ = {double(tile.x), double(tile.y)};
    threshold_ = float(rule.threshold);
    steps_ = 1U << unsigned(rule.depth - 1);
    colors_.clear();
    encoded_.clear();
    pixels_.assign(std::size_t(tile.width) * std::size_t(tile.height), Vec3(0));
    refine(pixel_cells(tile), {steps_, 1});
}

// The whole pixels, with their corners traced.
std::vector<AdaptiveSampler::Cell> AdaptiveSampler::pixel_cells(const PictureTile& tile) {
    const auto width = std::uint32_t(tile.width), height = std::uint32_t(tile.height);
    std::vector<std::uint32_t> samples(std::size_t(width + 1) * (height + 1));
    wanted_.clear();
    for (std::uint32_t y = 0, i = 0; y <= height; ++y)
        for (std::uint32_t x = 0; x <= width; ++x, ++i)
            wanted_.push_back({x * steps_, y * steps_, &samples[i]});
    trace_wanted();
    std::vector<Cell> cells;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::uint32_t* const above = &samples[y * (width + 1) + x];
            const std::uint32_t* const below = above + width + 1;
            cells.push_back(
                {x * steps_, y * steps_, y * width + x, {above[0], above[1], below[0], below[1]}});
        }
    return cells;
}

void AdaptiveSampler::refine(std::span<const Cell> cells, const Level& level) {
    while (!cells.empty()) {
        const std::size_t count = std::min(cells.size(), most_cells);
        refine_some(cells.first(count), level);
        cells = cells.subspan(count);
    }
}

void AdaptiveSampler::refine_some(std::span<const Cell> cells, const Level& level) {
    std::vector<Cell> split;
    for (const Cell& cell : cells) {
        if (level.side > 1 && varies(cell))
            split.push_back(cell);
        else
            add(cell, level);
    }
    if (split.empty()) return;
    const std::size_t known = colors_.size();
    refine(quartered(split, level), {level.side / 2, level.weight / 4});
    // Points between those of these cells are of no use to others.
    colors_.resize(known);
    encoded_.resize(known);
}

// The quarters of cells, with their corners traced.
std::vector<AdaptiveSampler::Cell> AdaptiveSampler::quartered(std::span<const Cell> cells,
                                                              const Level& level) {
    const std::uint32_t half = level.side / 2;
    // Middles of the upper, left, right and lower edge, and of the cell.
    std::vector<std::array<std::uint32_t, 5>> middles(cells.size());
    wanted_.clear();
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto [x, y] = std::array{cells[i].x, cells[i].y};
        wanted_.push_back({x + half, y, &middles[i][0]});
        wanted_.push_back({x, y + half, &middles[i][1]});
        wanted_.push_back({x + level.side, y + half, &middles[i][2]});
        wanted_.push_back({x + half, y + level.side, &middles[i][3]});
        wanted_.push_back({x + half, y + half, &middles[i][4]});
    }
    trace_wanted();
    std::vector<Cell> quarters;
    quarters.reserve(4 * cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto& [x, y, pixel, corners] = cells[i];
        const auto& [upper, left, right, lower, middle] = middles[i];
        quarters.push_back({x, y, pixel, {corners[0], upper, left, middle}});
        quarters.push_back({x + half, y, pixel, {upper, corners[1], middle, right}});
        quarters.push_back({x, y + half, pixel, {left, middle, corners[2], lower}});
        quarters.push_back({x + half, y + half, pixel, {middle, right, lower, corners[3]}});
    }
    return quarters;
}

// Traces each place that is wanted once.
void AdaptiveSampler::trace_wanted() {
    order_.clear();
    for (std::size_t i = 0; i < wanted_.size(); ++i)
        order_.push_back(place_on_curve(wanted_[i].x, wanted_[i].y) << 32U | i);
    std::ranges::sort(order_);
    points_.clear();
    const std::size_t known = colors_.size();
    for (std::size_t k = 0; k < order_.size(); ++k) {
        const Wanted& wanted = wanted_[order_[k] & 0xFFFFFFFFU];
        if (k == 0 || order_[k] >> 32U != order_[k - 1] >> 32U)
            points_.push_back(corner_ + Vec2(wanted.x, wanted.y) / double(steps_));
        *wanted.sample = std::uint32_t(known + points_.size() - 1);
    }
    colors_.resize(known + points_.size());
    (*trace_)(points_, std::span(colors_).subspan(known));
    for (std::size_t i = known; i < colors_.size(); ++i) encoded_.push_back(encoded(colors_[i]));
}

bool AdaptiveSampler::varies(const Cell& cell) const {
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = i + 1; j < 4; ++j)
            if (distance(encoded_[cell.corners[i]], encoded_[cell.corners[j]]) >= threshold_)
                return true;
    return false;
}

// Weights are powers of two, and a cell of one colour leaves it as it is.
void AdaptiveSampler::add(const Cell& cell, const Level& level) {
    Vec3 sum(0);
    for (const std::uint32_t corner : cell.corners) sum += Vec3(colors_[corner]);
    pixels_[cell.pixel] += sum * (level.weight / 4);
}

}  // namespace penumbra
