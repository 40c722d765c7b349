#include "prepare/environment/cut.h"

#include <algorithm>
#include <span>

namespace penumbra {

namespace {

constexpr int most_steps = 20;

// Which parts touch which, each with the others in the order in which they were met.
using Neighbours = std::vector<std::vector<int>>;

void meet(Neighbours& neighbours, int a, int b) {
    if (a == b) return;
    std::vector<int>& known = neighbours[std::size_t(a)];
    if (std::ranges::find(known, b) != known.end()) return;
    known.push_back(b);
    neighbours[std::size_t(b)].push_back(a);
}

Neighbours neighbours_of(const SkyCells& cells, const std::vector<int>& part_of,
                         std::size_t parts) {
    Neighbours neighbours(parts);
    for (int y = 0; y < cells.height; ++y) {
        // Over a pole the column on the other side is the next.
        const bool pole = y == 0 || y + 1 == cells.height;
        for (int x = 0; x < cells.width; ++x) {
            const int here = part_of[cells.at(x, y)];
            meet(neighbours, here, part_of[cells.at((x + 1) % cells.width, y)]);
            if (y + 1 < cells.height) meet(neighbours, here, part_of[cells.at(x, y + 1)]);
            if (pole)
                meet(neighbours, here, part_of[cells.at((x + cells.width / 2) % cells.width, y)]);
        }
    }
    return neighbours;
}

// Unit; those of parts without light stay what they were.
void find_directions(const SkyCells& cells, const std::vector<int>& part_of,
                     std::vector<Vec3>& directions) {
    std::vector<Vec3> sums(directions.size(), Vec3(0));
    for (std::size_t i = 0; i < part_of.size(); ++i)
        sums[std::size_t(part_of[i])] += cells.moments[i].vector;
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (sums[i].length() > 0) directions[i] = sums[i].normalized();
}

}  // namespace

void relax(const SkyCells& cells, std::vector<int>& part_of) {
    const auto parts = std::size_t(*std::max_element(part_of.begin(), part_of.end())) + 1;
    std::vector<Vec3> directions(parts, Vec3(0));
    for (int step = 0; step < most_steps; ++step) {
        find_directions(cells, part_of, directions);
        // Parts are small, so that a cell that is nearer to another part is so to a neighbour of
        // its own, at the latest in a later step.
        const Neighbours neighbours = neighbours_of(cells, part_of, parts);
        bool moved = false;
        for (std::size_t i = 0; i < part_of.size(); ++i) {
            const Vec3& cell = cells.moments[i].vector;
            const int own = part_of[i];
            int nearest = own;
            auto best = float(cell.dot(directions[std::size_t(own)]));
            for (const int other : neighbours[std::size_t(own)]) {
                const auto cosine = float(cell.dot(directions[std::size_t(other)]));
                if (cosine > best || (cosine == best && other < nearest && nearest != own)) {
                    best = cosine;
                    nearest = other;
                }
            }
            moved |= nearest != own;
            part_of[i] = nearest;
        }
        if (!moved) break;
    }
}

}  // namespace penumbra
