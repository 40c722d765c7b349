// Which texels of an image facets can show.
#include "importers/gltf/material/used_texels.h"

#include "scene/texture/texture_lookup.h"

#include "penumbra/light_model.h"

#include <algorithm>
#include <cmath>

namespace penumbra::gltf {
namespace {

// A facet that ends where a texel begins does not show it: what rounding brings in is less.
constexpr double slack = 1e-3;        // of a texel
constexpr double most_copies = 4;     // of the image across a facet
constexpr double most_visited = 2e8;  // texels

using Corners = std::array<Vec2, 3>;  // in texels, from the lower left of the image

struct Span {
    double min = 1e300, max = -1e300;
    void extend(double x) {
        min = std::min(min, x);
        max = std::max(max, x);
    }
};

// The texels [first, last] that a lookup anywhere in the span touches; `reach` beyond their edges.
struct Range {
    int first, last;
    Range(const Span& span, double reach)
        : first(int(std::ceil(span.min - 1 - reach + slack))),
          last(int(std::floor(span.max + reach - slack))) {
        if (first > last) first = last = int(std::floor((span.min + span.max) / 2));
    }
};

// What of the facet's x lies between two heights.
Span within(const Corners& facet, double low, double high) {
    Span span;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 &a = facet[i], &b = facet[(i + 1) % 3];
        if (a.y >= low && a.y <= high) span.extend(a.x);
        for (const double y : {low, high})
            if ((a.y < y) != (b.y < y)) span.extend(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
    }
    return span;
}

struct Marker {
    const Texture& frame;
    int width, height;
    TexelMask mask;
    double visited = 0;

    double reach() const { return frame.bilinear ? 0.5 : 0; }

    // False where there is too much to do.
    bool mark(const Corners& facet) {
        Span x, y;
        for (const Vec2& corner : facet) {
            x.extend(corner.x);
            y.extend(corner.y);
        }
        // Not the negation, so that NaN is refused.
        if (!(x.max - x.min < most_copies * width && y.max - y.min < most_copies * height &&
              std::abs(x.min) < 1e9 && std::abs(y.min) < 1e9))
            return false;
        const Range rows(y, reach());
        for (int row = rows.first; row <= rows.last; ++row) {
            Span part = within(facet, row - reach(), row + 1 + reach());
            if (part.min > part.max) part = x;
            const Range columns(part, reach());
            visited += columns.last - columns.first + 1;
            // Rows of images count from the top.
            const auto line =
                std::size_t(height - 1 - wrapped(row, height, frame.wrap_v)) * std::size_t(width);
            for (int column = columns.first; column <= columns.last; ++column)
                mask[line + std::size_t(wrapped(column, width, frame.wrap_u))] = true;
        }
        return visited < most_visited;
    }
};

}  // namespace

std::optional<TexelMask> texels_under(const std::vector<LaidFacet>& facets, const ImageMap& map,
                                      const Texture& frame, int width, int height) {
    Marker marker = {.frame = frame,
                     .width = width,
                     .height = height,
                     .mask = TexelMask(std::size_t(width) * std::size_t(height))};
    for (const LaidFacet& facet : facets) {
        Corners corners;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec2 at = map_texcoord(map, Vec2(facet[i]));
            corners[i] = {at.x * width, at.y * height};
        }
        if (!marker.mark(corners)) return std::nullopt;
    }
    return std::move(marker.mask);
}

}  // namespace penumbra::gltf
