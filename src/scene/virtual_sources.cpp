// Where virtual sources stand. The tracer and the exporter both call this and nothing else.
#include "scene/tolerances.h"

#include "penumbra/light_model.h"
#include "penumbra/scene.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace penumbra {

namespace {

// POV-Ray's parallel lights end at the plane through their location, so a directional light stands
// far outside of a normalised scene, whose coordinates are below 4 least_radius.
constexpr double directional_distance = 8192 * least_radius;

std::vector<Vec3> axes_displacements(double delta) {
    return {{0, 0, 0},      {delta, 0, 0}, {-delta, 0, 0}, {0, delta, 0},
            {0, -delta, 0}, {0, 0, delta}, {0, 0, -delta}};
}

// A Fibonacci spiral on the sphere whose radii grow with the cube root, so that every point stands
// for the same volume of the ball.
std::vector<Vec3> ball_displacements(double delta, int count) {
    const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const double height = 1 - (2.0 * i + 1) / count;
        const double ring = std::sqrt(1 - height * height);
        // The radius runs through its range in another order than the height (base 2 radical
        // inverse), or all outer points would lie at one pole.
        double inverse = 0;
        for (int bits = i, weight = 2; bits != 0; bits >>= 1, weight <<= 1)
            inverse += double(bits & 1) / weight;
        const double radius = delta * std::cbrt(std::min(1.0, inverse + 0.5 / count));
        const double angle = i * golden_angle;
        points.emplace_back(radius * ring * std::cos(angle), radius * height,
                            radius * ring * std::sin(angle));
    }
    return points;
}

// Centres of the cells of a square that faces along `axis`.
std::vector<Vec3> grid_displacements(double delta, std::array<int, 2> count, const Vec3& axis) {
    const Vec3 normal = axis.normalized();
    const Vec3 helper = std::abs(normal.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
    const Vec3 u = helper.cross(normal).normalized(), v = normal.cross(u);
    std::vector<Vec3> points;
    for (int j = 0; j < count[1]; ++j)
        for (int i = 0; i < count[0]; ++i)
            points.push_back(u * (delta * ((2.0 * i + 1) / count[0] - 1)) +
                             v * (delta * ((2.0 * j + 1) / count[1] - 1)));
    return points;
}

std::vector<Vec3> displacements(const Light& light) {
    const Penumbra& penumbra = light.penumbra;
    if (penumbra.delta <= 0) return {{0, 0, 0}};
    switch (penumbra.layout) {
    case Penumbra::Layout::sphere: return ball_displacements(penumbra.delta, penumbra.count[0]);
    case Penumbra::Layout::grid: {
        const Vec3 to_target = penumbra.target - light.position;
        const bool aimed = light.type == Light::Type::point && to_target.length() > 0;
        return grid_displacements(penumbra.delta, penumbra.count,
                                  aimed ? to_target : light.direction);
    }
    case Penumbra::Layout::axes: break;
    }
    return axes_displacements(penumbra.delta);
}

}  // namespace

std::vector<Source> virtual_sources(const Light& light) {
    assert(light.penumbra.count[0] >= 1 && light.penumbra.count[1] >= 1);
    const std::vector<Vec3> offsets = displacements(light);
    const Vec3 axis = light.direction.normalized();
    std::vector<Source> sources;
    for (const Vec3& offset : offsets) {
        Source source = {.type = light.type,
                         .position = light.position + offset,
                         .point_at = light.position + offset + axis,
                         .color =
                             Color(Vec3(light.color) * (light.intensity / double(offsets.size()))),
                         .inner = light.inner,
                         .outer = light.outer,
                         .attenuation = light.attenuation};
        if (light.type == Light::Type::directional) {
            // delta is the tangent of the half-angle: displaced at unit distance.
            source.position = (offset - axis) * directional_distance;
            source.point_at = Vec3(0);
            source.attenuation.reset();
        }
        sources.push_back(source);
    }
    return sources;
}

}  // namespace penumbra
