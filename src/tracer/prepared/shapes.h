// Hits of rays with spheres and infinite planes, in double.
#pragma once

#include "tracer/accel/rays.h"
#include "tracer/prepared/prepared_scene.h"

namespace penumbra {

/// Distances at which a ray crosses a sphere or plane, nearer first; count is 0 to 2.
struct Crossings {
    int count = 0;
    std::array<double, 2> t = {};
};

/// POV-Ray's sphere test (source/backend/shape/spheres.cpp of 3.7). `direction` is unit.
Crossings cross_sphere(const Sphere& sphere, const Vec3& origin, const Vec3& direction);

/// POV-Ray's plane test (source/backend/shape/planes.cpp of 3.7). `direction` is unit.
Crossings cross_plane(const PreparedPlane& plane, const Vec3& origin, const Vec3& direction);

/// Lowers hits where a sphere or plane is nearer than what they hold. `scratch` is kept between
/// calls.
void closest_shapes(const PreparedScene& prepared, const Rays& rays, Hits& hits,
                    std::vector<Index>& scratch);

/// The same with plane `k` of the scene alone; closest_shapes() leaves those out that are not seen
/// in mirrors.
void closest_on_plane(const PreparedScene& prepared, std::size_t k, const Rays& rays, Hits& hits);

/// Sets visible[i] to 0 where one of the spheres and planes `objects`, all of them opaque, blocks
/// shadow ray i, for i in `range`. A ray never meets the plane again that it starts on.
void block_by_shapes(const PreparedScene& prepared, std::span<const Index> objects,
                     const ShadowRays& rays, const IndexRange& range, std::span<double> visible);

/// The nearest translucent sphere or plane with distance in (nearest, hit.t).
bool translucent_shape(const PreparedScene& prepared, const Vec3& origin, const Vec3& direction,
                       double nearest, Hit& hit);

}  // namespace penumbra
