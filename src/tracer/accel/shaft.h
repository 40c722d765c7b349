// Groups of rays, and whether they may touch a box.
#pragma once

#include "penumbra/scene.h"

#include <array>

namespace penumbra {

/// The convex hull of two boxes: all segments from one to the other lie in it. After Haines and
/// Wallace 1991, "Shaft Culling for Efficient Ray-Traced Radiosity".
struct Shaft {
    /// A plane parallel to one axis that touches both boxes on their outside; points of the shaft
    /// have weight_a p[a] + weight_b p[b] <= limit.
    struct Side {
        int a = 0, b = 0;
        double weight_a = 0, weight_b = 0, limit = 0;
    };
    Bounds hull;
    std::array<Side, 12> sides = {};
    int count = 0;
};

Shaft make_shaft(const Bounds& from, const Bounds& to);

/// False only when no segment from one box to the other touches `box`.
bool touches(const Shaft& shaft, const Bounds& box);

/// All that a box passes over on its way along a direction, without end.
struct Sweep {
    Bounds from;
    Vec3 inverse = {};  ///< of the direction, by axis; infinite along those that it does not go
};

Sweep make_sweep(const Bounds& from, const Vec3& direction);

/// False only when no ray from `from` along the direction touches `box`.
bool touches(const Sweep& sweep, const Bounds& box);

/// The convex hull of the balls around two boxes, which holds their shaft.
struct Capsule {
    Vec3 start = {}, axis = {};   ///< centre of the first ball; unit, to that of the second
    double length = 0;            ///< from one to the other
    double radius = 0;            ///< of the first ball
    double sine = 0, cosine = 1;  ///< of the angle at which the sides open
};

Capsule make_capsule(const Bounds& from, const Bounds& to);

/// False only when no segment from one box to the other touches the ball.
bool touches(const Capsule& capsule, const Vec3& center, double radius);

/// Rays whose origins lie in one box and whose directions in another.
struct Beam {
    Bounds origins, directions;
};

/// False only when no ray of the beam touches `box`.
bool touches(const Beam& beam, const Bounds& box);

}  // namespace penumbra
