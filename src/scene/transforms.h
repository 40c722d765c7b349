// What transforms are and do.
#pragma once

#include "penumbra/math.h"
#include "penumbra/scene.h"

#include <cmath>
#include <span>

namespace penumbra {

/// Of a transform's determinant, without its sign: scaled by less than 1e-30 nothing is left of a
/// mesh, and normalise() must still find an inverse.
inline constexpr double least_determinant = 1e-90;

/// Of a transform's numbers, for the same reason.
inline constexpr double largest_in_transform = 1e30;

/// Radii of what is looked at: from there on float32 loses more than it must.
inline constexpr double far_away = 1;

/// p * m, without the division that a projection would need.
inline Vec3 moved(const Vec3f& p, const Matrix& m) {
    const double x = p.x, y = p.y, z = p.z;
    const auto along = [&](int column) {
        return x * m[0][column] + y * m[1][column] + z * m[2][column] + m[3][column];
    };
    return {along(0), along(1), along(2)};
}

/// Around all of the points, or around those whose entry of `chosen` is not 0.
Bounds box_around(std::span<const Vec3f> points, std::span<const char> chosen = {});

/// Around the vertices that facets use. Precondition: their indices are in range.
Bounds box_around_facets(const Mesh& mesh);

inline bool finite(const Matrix& transform) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            if (!std::isfinite(transform[row][column])) return false;
    return true;
}

/// Is it a rotation about the origin?
inline bool is_rotation(const Matrix& m) {
    constexpr double rounding = 1e-6;
    bool unit = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            const double product = m[i][0] * m[k][0] + m[i][1] * m[k][1] + m[i][2] * m[k][2];
            unit &= std::abs(product - (i == k ? 1 : 0)) < rounding && m[3][k] == 0;
        }
    return unit && m.determinant() > 0;
}

/// Right-handed rotation about axis 0, 1 or 2 by degrees; exact at quarter turns.
inline Matrix rotation_about(int axis, double angle) {
    const double turn = std::remainder(angle, 360.0);
    double c = std::cos(radians(turn)), s = std::sin(radians(turn));
    if (std::remainder(turn, 90.0) == 0) c = std::round(c), s = std::round(s);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    Matrix m;
    m[u][u] = c;
    m[u][v] = s;
    m[v][u] = -s;
    m[v][v] = c;
    return m;
}

/// The factor by which `transform` changes lengths, in the mean over all directions.
inline double mean_scale(const Matrix& transform) {
    return std::cbrt(std::abs(transform.determinant()));
}

/// The centre of a box that lies so far from the origin, more than 64 of its radii, that positions
/// in float32 suffer; else the origin.
Vec3 local_origin(const Bounds& box);

/// A box around the transformed box (Arvo 1990).
Bounds transformed(const Bounds& box, const Matrix& transform);

}  // namespace penumbra
