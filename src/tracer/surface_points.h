// From a hit to what shading needs: point, normal and pigment.
#pragma once

#include "tracer/accel/rays.h"
#include "tracer/media_stack.h"
#include "tracer/prepared/prepared_scene.h"

namespace penumbra {

/// The two neighbouring lobes of a PreparedMaterial that a surface point shows.
struct LobeMix {
    Index first = 0;
    double share = 0;  ///< of the lobe after `first`
};

/// Surface points of one generation, in arrays.
struct SurfacePoints {
    std::size_t count = 0;
    Vec3Array position, normal, view;  ///< normal is unit and turned to the eye; view comes from it
    Vec3Array reflected;               ///< view mirrored by the normal; unit but for rounding
    Vec3Array facet_normal;            ///< unit geometric normal; of spheres and planes `normal`
    Vec3Array pigment;
    Vec3Array tint;               ///< takes the pigment's place in highlight and mirror
    Vec3Array emitted;            ///< ambient and emitted light
    Vec3Array transmittance;      ///< factor of what lies behind; of surfaces not opaque
    Vec3Array from_behind;        ///< K_T x opacity x alpha; of backlit surfaces
    Vec3Array kept, next_kept;    ///< what the mirrors of both lobes leave; where they take any
    std::vector<double> diffuse;  ///< K_D x opacity x alpha
    std::vector<double> alpha;    ///< of the AlphaMap; 1 without, 0 of a hidden back
    std::vector<double> share;    ///< of this look in a Blend; 1 without
    std::vector<double> depth;    ///< length of the ray that ended here
    std::vector<LobeMix> lobes;
    std::vector<char> front;  ///< the normal pointed to the eye before it was turned
    std::vector<Index> object;
    std::vector<const PreparedMaterial*> material;
    std::vector<MediumStack> inside;  ///< of the ray that ended here

    explicit SurfacePoints(std::size_t capacity = 0) { resize(capacity); }
    void resize(std::size_t capacity);
};

/// Writes surface point `slot` for a ray that ended in `hit`, but for `inside`. With a Blend it
/// writes the other look into the next slot. Returns how many it has written.
std::size_t find_surface_point(const PreparedScene& prepared, const Vec3& origin,
                               const Vec3& direction, const Hit& hit, SurfacePoints& surfaces,
                               std::size_t slot);

/// The factor of light that crosses the surface at `hit`, which is not opaque.
Vec3 light_through(const PreparedScene& prepared, const Vec3& origin, const Vec3& direction,
                   const Hit& hit);

}  // namespace penumbra
