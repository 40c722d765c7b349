// A line sweeps down over the polygon and cuts it into pieces that are monotone in y, and each
// piece is cut into triangles from the top (de Berg et al. 2008, "Computational Geometry:
// Algorithms and Applications", chapter 3). Every triangle must turn the right way, which an
// outline that is not simple cannot give.
#include "importers/shared/triangulate_sweep.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace penumbra {

namespace {

using Triangle = std::array<Index, 3>;

double turn(const Vec2& a, const Vec2& b, const Vec2& c) { return (b - a).cross(c - a); }

// The order of the sweep; corners of equal height from left to right.
bool above(const Vec2& a, const Vec2& b) { return a.y > b.y || (a.y == b.y && a.x < b.x); }

struct Sweep {
    // Edges that run down, so with the inside on their right, from left to right; an edge is known
    // by its first corner. All that are in the set at one time meet one horizontal line.
    struct ByPlace {
        using is_transparent = void;
        const Sweep* sweep = nullptr;
        bool operator()(Index a, Index b) const {
            if (a == b) return false;
            return above(sweep->at(b), sweep->at(a)) ? sweep->side(b, sweep->at(a)) < 0
                                                     : sweep->side(a, sweep->at(b)) > 0;
        }
        bool operator()(Index edge, const Vec2& p) const { return sweep->side(edge, p) > 0; }
        bool operator()(const Vec2& p, Index edge) const { return sweep->side(edge, p) < 0; }
    };
    using Edges = std::set<Index, ByPlace>;

    std::span<const Vec2> corners = {};
    Edges edges = Edges(ByPlace{this});
    std::vector<Edges::iterator> where = std::vector(corners.size(), edges.end());
    std::vector<Index> helper = std::vector<Index>(corners.size());  // by edge
    std::vector<bool> merges = std::vector<bool>(corners.size());    // corners that join two pieces
    std::vector<std::vector<Index>> diagonals = std::vector<std::vector<Index>>(corners.size());
    std::vector<Triangle> triangles = {};

    explicit Sweep(std::span<const Vec2> polygon) : corners(polygon) {}
    Sweep(const Sweep&) = delete;
    Sweep& operator=(const Sweep&) = delete;

    Index next(Index i) const { return i + 1 < corners.size() ? i + 1 : 0; }
    Index previous(Index i) const { return i > 0 ? i - 1 : Index(corners.size() - 1); }
    const Vec2& at(Index i) const { return corners[i]; }
    // Positive: p is to the right of the edge.
    double side(Index edge, const Vec2& p) const { return turn(at(edge), at(next(edge)), p); }

    void cut(Index a, Index b) {
        diagonals[a].push_back(b);
        diagonals[b].push_back(a);
    }

    void cut_to_merge(Index corner, Index edge) {
        if (merges[helper[edge]]) cut(corner, helper[edge]);
    }

    bool begin_edge(Index corner) {
        const auto [place, fresh] = edges.insert(corner);
        if (!fresh) return false;
        where[corner] = place;
        helper[corner] = corner;
        return true;
    }

    bool end_edge(Index corner) {
        const Index edge = previous(corner);
        if (where[edge] == edges.end()) return false;
        cut_to_merge(corner, edge);
        edges.erase(where[edge]);
        where[edge] = edges.end();
        return true;
    }

    std::optional<Index> edge_left_of(Index corner) const {
        const auto found = edges.lower_bound(at(corner));
        if (found == edges.begin()) return {};
        return *std::prev(found);
    }

    // Returns false when the corner cannot stand where it does in a simple polygon.
    bool visit(Index corner) {
        const Vec2 &before = at(previous(corner)), &here = at(corner), &after = at(next(corner));
        const bool convex = turn(before, here, after) > 0;
        const bool comes_down = above(before, here), goes_down = above(here, after);
        if (!comes_down && goes_down && convex) return begin_edge(corner);
        if (comes_down && !end_edge(corner)) return false;
        if (comes_down && goes_down) return begin_edge(corner);
        if (comes_down && convex) return true;
        const std::optional<Index> left = edge_left_of(corner);
        if (!left) return false;
        const bool splits = !comes_down && goes_down;
        if (splits)
            cut(corner, helper[*left]);
        else
            cut_to_merge(corner, *left);
        helper[*left] = corner;
        merges[corner] = comes_down;
        return !splits || begin_edge(corner);
    }

    bool triangle(Index a, Index b, Index c) {
        if (!(turn(at(a), at(b), at(c)) > 0)) return false;
        triangles.push_back({a, b, c});
        return true;
    }

    struct Link {
        Index corner = 0;
        bool left = false;  // on the chain from the top down the left side, the top included
    };

    // The corners of a monotone, counter-clockwise piece from top to bottom.
    std::vector<Link> from_top(const std::vector<Index>& piece) const {
        const auto higher = [&](Index a, Index b) { return above(at(a), at(b)); };
        const auto top = std::min_element(piece.begin(), piece.end(), higher) - piece.begin();
        const auto bottom = std::max_element(piece.begin(), piece.end(), higher) - piece.begin();
        std::vector<Link> left, right, order;
        for (auto i = std::size_t(top); i != std::size_t(bottom); i = (i + 1) % piece.size())
            left.push_back({piece[i], true});
        for (auto i = std::size_t(bottom); i != std::size_t(top); i = (i + 1) % piece.size())
            right.push_back({piece[i], false});
        std::reverse(right.begin(), right.end());
        std::ranges::merge(left, right, std::back_inserter(order), higher, &Link::corner,
                           &Link::corner);
        return order;
    }

    // Cuts triangles with `tip` off the chain that ends with stack.back(): all of them, or, when
    // the tip continues the chain, those that turn the right way.
    bool cut_corners(std::vector<Link>& stack, Index tip, bool all) {
        while (stack.size() > 1) {
            Index a = stack[stack.size() - 2].corner, b = stack.back().corner;
            if (!stack.back().left) std::swap(a, b);
            if (!all && !(turn(at(a), at(b), at(tip)) > 0)) return true;
            if (!triangle(a, b, tip)) return false;
            stack.pop_back();
        }
        return true;
    }

    bool cut_piece(const std::vector<Index>& piece) {
        const std::vector<Link> order = from_top(piece);
        std::vector<Link> stack = {order[0], order[1]};
        for (std::size_t i = 2; i < order.size(); ++i) {
            const Link last = stack.back();
            const bool opposite = order[i].left != last.left || i + 1 == order.size();
            if (!cut_corners(stack, order[i].corner, opposite)) return false;
            if (opposite) stack = {last};
            stack.push_back(order[i]);
        }
        return true;
    }

    // Neighbours of each corner in the order of their direction, from the next to the previous one.
    std::vector<std::vector<Index>> neighbours() const {
        std::vector<std::vector<Index>> result(corners.size());
        for (Index i = 0; i < corners.size(); ++i) {
            std::vector<std::pair<double, Index>> sorted;
            const Vec2 first = at(next(i)) - at(i);
            for (const Index other : diagonals[i]) {
                const Vec2 to = at(other) - at(i);
                const double angle = std::atan2(first.cross(to), first.dot(to));
                sorted.emplace_back(angle < 0 ? angle + radians(360) : angle, other);
            }
            std::sort(sorted.begin(), sorted.end());
            result[i].push_back(next(i));
            for (const auto& [angle, other] : sorted) result[i].push_back(other);
            result[i].push_back(previous(i));
        }
        return result;
    }

    // Walks around each piece, turning at every corner to the neighbour just clockwise of where the
    // walk came from.
    bool cut_pieces() {
        std::vector<std::vector<Index>> around = neighbours();
        std::vector<std::vector<bool>> done;
        done.reserve(around.size());
        for (const auto& of_corner : around) done.emplace_back(of_corner.size());
        for (Index start = 0; start < corners.size(); ++start) {
            for (std::size_t from = 1; from < around[start].size(); ++from) {
                std::vector<Index> piece;
                Index i = start;
                for (std::size_t k = from; !done[i][k];) {
                    done[i][k] = true;
                    piece.push_back(i);
                    const Index to = around[i][k - 1];
                    k = std::size_t(std::ranges::find(around[to], i) - around[to].begin());
                    if (k == 0 || k == around[to].size()) return false;
                    i = to;
                }
                if (!piece.empty() && (piece.size() < 3 || !cut_piece(piece))) return false;
            }
        }
        return triangles.size() + 2 == corners.size();
    }
};

}  // namespace

std::optional<std::vector<Triangle>> triangulate_simple(std::span<const Vec2> corners) {
    Sweep sweep(corners);
    std::vector<Index> order(corners.size());
    std::iota(order.begin(), order.end(), Index(0));
    std::ranges::sort(order, above, [&](Index i) { return corners[i]; });
    for (const Index corner : order)
        if (!sweep.visit(corner)) return {};
    if (!sweep.cut_pieces()) return {};
    return std::move(sweep.triangles);
}

}  // namespace penumbra
