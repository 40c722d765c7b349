// Rays and hits in arrays: the tracer works on many rays at once.
#pragma once

#include "scene/tolerances.h"

#include "penumbra/scene.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

namespace penumbra {

inline constexpr double no_hit = std::numeric_limits<double>::infinity();

/// Coordinates of many vectors, one array an axis.
struct Vec3Array {
    std::array<std::vector<double>, 3> axis = {};

    explicit Vec3Array(std::size_t capacity = 0) { resize(capacity); }
    void resize(std::size_t count) {
        for (auto& values : axis) values.resize(count);
    }
    /// Zeroes the first `count` entries, of which there are at least so many afterwards.
    void clear(std::size_t count) {
        for (auto& values : axis) values.assign(std::max(count, values.size()), 0.0);
    }
    void fill(std::size_t count, double value) {
        for (auto& values : axis) std::fill_n(values.begin(), count, value);
    }
    Vec3 operator[](std::size_t i) const { return {axis[0][i], axis[1][i], axis[2][i]}; }
    void set(std::size_t i, const Vec3& v) {
        axis[0][i] = v.x;
        axis[1][i] = v.y;
        axis[2][i] = v.z;
    }
};

/// Arrays of one vector each, for loops that the compiler turns into SIMD code.
struct Vec3View {
    const double *x = nullptr, *y = nullptr, *z = nullptr;
    Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
    Vec3View from(std::size_t first) const { return {x + first, y + first, z + first}; }
    Vec3View(const double* xs, const double* ys, const double* zs) : x(xs), y(ys), z(zs) {}
    explicit Vec3View(const Vec3Array& v, std::size_t first = 0)
        : x(v.axis[0].data() + first), y(v.axis[1].data() + first), z(v.axis[2].data() + first) {}
};

/// [first, last) of some arrays.
struct IndexRange {
    std::size_t first = 0, last = 0;
};

struct Extent {
    double low = 0, high = 0;
};

/// The least and the greatest of values[range]. Precondition: there are some, and no NaN.
Extent extent_of(const double* values, const IndexRange& range);

/// The box around vectors[range].
Bounds box_around(const Vec3Array& vectors, const IndexRange& range);

/// Rays of one generation; the first `count` entries of each array are in use.
struct Rays {
    std::size_t count = 0;
    Vec3Array origin, direction;  ///< directions are unit

    explicit Rays(std::size_t capacity = 0) : origin(capacity), direction(capacity) {}
};

/// What one ray hits. Objects count instances first, then spheres, then planes.
struct Hit {
    double t = no_hit;
    Index object = no_index;
    Index facet = no_index;  ///< of the instance's mesh
};

/// What many rays hit.
struct Hits {
    std::vector<double> t;
    std::vector<Index> object, facet;

    explicit Hits(std::size_t count = 0) { clear(count); }
    /// Makes them `count` times no hit.
    void clear(std::size_t count) {
        t.assign(count, no_hit);
        object.assign(count, no_index);
        facet.assign(count, no_index);
    }
    Hit operator[](std::size_t i) const { return {t[i], object[i], facet[i]}; }
    void set(std::size_t i, const Hit& hit) {
        t[i] = hit.t;
        object[i] = hit.object;
        facet[i] = hit.facet;
    }
};

/// Rays from surface points towards one source, in arrays of somebody else's.
struct ShadowRays {
    Vec3View origin, direction;        ///< directions are unit
    const double* distance = nullptr;  ///< to the source
    /// Of rays that leave a facet: sine of the angle to it. At a small one float32 could find that
    /// facet again.
    const double* sin_to_facet = nullptr;
    const Index* object = nullptr;  ///< that the ray starts on
};

}  // namespace penumbra
