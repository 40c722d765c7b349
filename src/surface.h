// From a hit to what shading needs: point, normal and pigment.
#pragma once

#include "rays.h"
#include "world.h"

namespace penumbra {

/// Surface points of one generation, in arrays.
struct Surfaces {
    std::size_t count = 0;
    Vectors position, normal, view;  ///< normal is unit and turned to the eye; view comes from it
    Vectors mirrored;                ///< view mirrored by the normal; unit but for rounding
    Vectors facet_normal;            ///< unit geometric normal; zero on spheres and planes
    Vectors pigment;
    std::vector<double> diffuse, specular;  ///< K_D x opacity, K_S
    std::vector<Index> object;
    std::vector<const Finish*> finish;

    explicit Surfaces(std::size_t capacity = 0) { resize(capacity); }
    void resize(std::size_t capacity);
};

/// Writes surface point `slot` for a ray that ended in `hit`.
void find_surface(const World& world, const Vec3& origin, const Vec3& direction, const Hit& hit,
                  Surfaces& surfaces, std::size_t slot);

}  // namespace penumbra
