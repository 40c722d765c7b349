#include "prepare/environment/cut.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace penumbra {

namespace {

// Cells [x0, x1) x [y0, y1).
struct Rectangle {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// Sums over all cells above and to the left.
class SumTable {
  public:
    explicit SumTable(const SkyCells& cells) : stride_(std::size_t(cells.width) + 1) {
        sums_.resize(stride_ * (std::size_t(cells.height) + 1));
        for (int y = 0; y < cells.height; ++y) {
            LightMoments row;
            for (int x = 0; x < cells.width; ++x) {
                row.add(cells.moments[cells.at(x, y)]);
                LightMoments& sum = sums_[at(x + 1, y + 1)];
                sum = sums_[at(x + 1, y)];
                sum.add(row);
            }
        }
    }

    LightMoments operator()(const Rectangle& r) const {
        const LightMoments &a = sums_[at(r.x1, r.y1)], &b = sums_[at(r.x1, r.y0)],
                           &c = sums_[at(r.x0, r.y1)], &d = sums_[at(r.x0, r.y0)];
        return {a.energy - b.energy - c.energy + d.energy,
                a.vector - b.vector - c.vector + d.vector};
    }

  private:
    std::size_t stride_;
    std::vector<LightMoments> sums_;
    std::size_t at(int x, int y) const { return std::size_t(y) * stride_ + std::size_t(x); }
};

// A part and the best way to cut it. Variances are compared as floats, so that what differs by
// rounding alone is equal.
struct Part {
    Rectangle whole = {};
    float variance = 0;
    bool can_be_cut = false;
    Rectangle first = {}, second = {};
};

Part part_of(const SumTable& sums, const Rectangle& whole) {
    Part part = {.whole = whole, .variance = float(sums(whole).variance())};
    if (!(part.variance > 0)) return part;
    float least = 0;
    const auto consider = [&](const Rectangle& first, const Rectangle& second) {
        const auto rest = float(sums(first).variance() + sums(second).variance());
        if (part.can_be_cut && rest >= least) return;
        least = rest;
        part.first = first;
        part.second = second;
        part.can_be_cut = true;
    };
    for (int y = whole.y0 + 1; y < whole.y1; ++y)
        consider({whole.x0, whole.y0, whole.x1, y}, {whole.x0, y, whole.x1, whole.y1});
    for (int x = whole.x0 + 1; x < whole.x1; ++x)
        consider({whole.x0, whole.y0, x, whole.y1}, {x, whole.y0, whole.x1, whole.y1});
    return part;
}

// To a millionth: neither renderer needs more, and the last bits would be those of a machine.
Vec3 rounded(const Vec3& v) {
    constexpr double steps = 1 << 20;
    return Vec3(std::round(v.x * steps), std::round(v.y * steps), std::round(v.z * steps)) / steps;
}

}  // namespace

std::vector<int> cut_by_variance(const SkyCells& cells, int count) {
    const SumTable sums(cells);
    std::vector<Part> parts = {part_of(sums, {0, 0, cells.width, cells.height})};
    struct Next {
        float variance;
        int part;
        // Of equal ones the first.
        bool operator<(const Next& other) const {
            return variance < other.variance || (variance == other.variance && part > other.part);
        }
    };
    std::priority_queue<Next> open;
    const auto offer = [&](int i) {
        if (parts[std::size_t(i)].can_be_cut) open.push({parts[std::size_t(i)].variance, i});
    };
    offer(0);
    while (int(parts.size()) < count && !open.empty()) {
        const int i = open.top().part;
        open.pop();
        const Part whole = parts[std::size_t(i)];
        parts[std::size_t(i)] = part_of(sums, whole.first);
        parts.push_back(part_of(sums, whole.second));
        offer(i);
        offer(int(parts.size()) - 1);
    }
    std::vector<int> label(cells.moments.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Rectangle& r = parts[i].whole;
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x) label[cells.at(x, y)] = int(i);
    }
    return label;
}

SkySources sky_sources(const SkyCells& cells, int count) {
    SkySources result;
    if (count <= 0) return result;
    std::vector<int> label = cut_by_variance(cells, count);
    relax(cells, label);
    const auto parts = std::size_t(*std::max_element(label.begin(), label.end())) + 1;
    std::vector<LightMoments> moments(parts);
    std::vector<Vec3> flux(parts, Vec3(0));
    for (std::size_t i = 0; i < label.size(); ++i) {
        moments[std::size_t(label[i])].add(cells.moments[i]);
        flux[std::size_t(label[i])] += cells.flux[i];
    }
    double energy = 0, variance = 0;
    for (std::size_t i = 0; i < parts; ++i) {
        if (!(moments[i].energy > 0)) continue;
        const Vec3 toward = moments[i].vector.length() > 0 ? moments[i].vector : Vec3(0, 1, 0);
        result.sources.push_back({rounded(toward.normalized()), flux[i]});
        energy += moments[i].energy;
        variance += moments[i].variance();
    }
    // Of a disc of radius r the mean square of 1 - cos^2 is r^2 / 2.
    result.spread = energy > 0 ? 2 * variance / energy : 0;
    return result;
}

}  // namespace penumbra
