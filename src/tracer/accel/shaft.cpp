#include "tracer/accel/shaft.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {

namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

}  // namespace

// In each of the three projections the hull of two rectangles has slanted edges that join corners
// of the same kind (such as both lower left ones), where the edge's normal points that way.
Shaft make_shaft(const Bounds& from, const Bounds& to) {
    Shaft shaft = {.hull = from};
    shaft.hull.extend(to.min);
    shaft.hull.extend(to.max);
    for (const auto& [a, b] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{2, 0}}) {
        for (const bool high_a : {false, true}) {
            for (const bool high_b : {false, true}) {
                const auto corner = [&](const Bounds& box) {
                    return Vec2(high_a ? box.max[a] : box.min[a], high_b ? box.max[b] : box.min[b]);
                };
                const Vec2 start = corner(from), edge = corner(to) - start;
                Vec2 normal(edge.y, -edge.x);
                if ((normal.x > 0) != high_a) normal = -normal;
                const bool outward = normal.x != 0 && normal.y != 0 && (normal.x > 0) == high_a &&
                                     (normal.y > 0) == high_b;
                if (!outward) continue;
                normal /= std::sqrt(normal.dot(normal));
                shaft.sides[std::size_t(shaft.count++)] = {a, b, normal.x, normal.y,
                                                           normal.dot(start)};
            }
        }
    }
    return shaft;
}

bool touches(const Shaft& shaft, const Bounds& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (box.min[axis] > shaft.hull.max[axis] || box.max[axis] < shaft.hull.min[axis])
            return false;
    for (int i = 0; i < shaft.count; ++i) {
        const Shaft::Side& side = shaft.sides[std::size_t(i)];
        // The box's corner that lies deepest inside.
        const double a = side.weight_a > 0 ? box.min[side.a] : box.max[side.a];
        const double b = side.weight_b > 0 ? box.min[side.b] : box.max[side.b];
        if (side.weight_a * a + side.weight_b * b > side.limit) return false;
    }
    return true;
}

Sweep make_sweep(const Bounds& from, const Vec3& direction) {
    return {from, {1 / direction.x, 1 / direction.y, 1 / direction.z}};
}

// Along every axis the two overlap for a while; the sweep touches the box where these times do.
bool touches(const Sweep& sweep, const Bounds& box) {
    double enter = 0, leave = no_limit;
    for (int axis = 0; axis < 3; ++axis) {
        const double ahead = box.min[axis] - sweep.from.max[axis];
        const double behind = box.max[axis] - sweep.from.min[axis];
        const double inverse = sweep.inverse[axis];
        if (std::isinf(inverse)) {
            if (ahead > 0 || behind < 0) return false;
            continue;
        }
        enter = std::max(enter, (inverse > 0 ? ahead : behind) * inverse);
        leave = std::min(leave, (inverse > 0 ? behind : ahead) * inverse);
    }
    return enter <= leave * (1 + 1e-12) + 1e-12;
}

Capsule make_capsule(const Bounds& from, const Bounds& to) {
    const double radius = from.radius(), growth = to.radius() - radius;
    const Vec3 way = to.center() - from.center();
    Capsule capsule = {.start = from.center(), .length = way.length(), .radius = radius};
    // One ball within the other: all of it counts.
    if (capsule.length <= std::abs(growth)) return {.start = from.center(), .radius = no_limit};
    capsule.axis = way / capsule.length;
    capsule.sine = growth / capsule.length;
    capsule.cosine = std::sqrt(1 - capsule.sine * capsule.sine);
    return capsule;
}

// The hull is the union of the balls between the two; the nearest of them lies where the line to
// the point leaves the axis at the angle of the sides.
bool touches(const Capsule& capsule, const Vec3& center, double radius) {
    if (capsule.radius == no_limit) return true;
    const Vec3 offset = center - capsule.start;
    const double along = offset.dot(capsule.axis);
    const double aside = std::sqrt(std::max(0.0, offset.dot(offset) - along * along));
    const double nearest =
        std::clamp(along + aside * capsule.sine / capsule.cosine, 0.0, capsule.length);
    const double before = along - nearest;
    const double distance = std::sqrt(before * before + aside * aside);
    return distance <= capsule.radius + capsule.sine * nearest + radius + 1e-9;
}

bool touches(const Beam& beam, const Bounds& box) {
    double enter = 0, leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        // The way from the origins to the near and the far side, as far as all rays have it to go.
        const double ahead = box.min[axis] - beam.origins.max[axis];
        const double behind = beam.origins.min[axis] - box.max[axis];
        const double slowest = beam.directions.min[axis], fastest = beam.directions.max[axis];
        if (ahead > 0) {
            if (fastest <= 0) return false;
            enter = std::max(enter, ahead / fastest);
        }
        if (behind > 0) {
            if (slowest >= 0) return false;
            enter = std::max(enter, behind / -slowest);
        }
        if (slowest > 0)
            leave = std::min(leave, (box.max[axis] - beam.origins.min[axis]) / slowest);
        if (fastest < 0)
            leave = std::min(leave, (box.min[axis] - beam.origins.max[axis]) / fastest);
    }
    return enter <= leave * (1 + 1e-12) + 1e-12;
}

}  // namespace penumbra
