// Where images are looked up, and how light fades within a surface.
#include "penumbra/light_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace penumbra {

Vec2 sphere_texcoord(const Vec3& p) {
    // POV-Ray's sphere uv_mapping, mirrored by `scale <-1, 1, 1>`.
    const double turn = -std::atan2(p.z, p.x) / (2 * std::numbers::pi);
    return {turn < 0 ? turn + 1 : turn,
            0.5 + std::asin(std::clamp(p.y, -1.0, 1.0)) / std::numbers::pi};
}

PlaneFrame plane_frame(const Plane& plane) {
    assert(plane.normal.length() > 0);
    const Vec3 normal = plane.normal.normalized();
    // Up in the image is world up on a wall and away from the viewer (-z) on a floor or ceiling.
    const Vec3 up = std::abs(normal.y) > 0.99 ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
    const Vec3 u = up.cross(normal).normalized();
    return {.origin = plane.point, .normal = normal, .u = u, .v = normal.cross(u)};
}

Color fade_color(const Absorption& absorption) {
    const auto fade = [](float c) { return float(1 + std::log(double(std::max(c, 1e-6F)))); };
    return {fade(absorption.color.x), fade(absorption.color.y), fade(absorption.color.z)};
}

Vec3 fade_exponent(const Absorption& absorption) {
    return (Vec3(1) - Vec3(fade_color(absorption))) * (1 / double(float(absorption.distance)));
}

Vec2 sky_texcoord(const Sky& sky, const Vec3& direction) {
    Vec3 d(0);
    sky.rotation.transposed().multDirMatrix(direction, d);  // its inverse
    return {std::atan2(d.x, -d.z) / (2 * std::numbers::pi) + 0.5,
            std::asin(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi + 0.5};
}

Vec3 on_mirror_sky(const Vec3& origin, const Vec3& direction) {
    const Vec3 from = origin / mirror_sky_radius;
    const double along = from.dot(direction);
    const double square = along * along + 1 - from.length2();
    return from + direction * (std::sqrt(std::max(0.0, square)) - along);
}

}  // namespace penumbra
