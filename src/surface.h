// From a hit to what shading needs: point, normal and pigment.
#pragma once

#include "rays.h"
#include "world.h"

namespace penumbra {

/// The transparent objects that a ray is inside of, outermost first, as POV-Ray keeps them. Deeper
/// nesting than the array holds is not told apart.
struct Interiors {
    std::array<Index, 7> objects = {};
    std::uint32_t count = 0;
    /// Crosses the surface of `object`. Returns whether that enters it.
    bool toggle(Index object) {
        const auto end = objects.begin() + count;
        const auto found = std::find(objects.begin(), end, object);
        if (found != end) {
            std::copy(found + 1, end, found);
            --count;
            return false;
        }
        if (count < objects.size()) objects[count++] = object;
        return true;
    }
    bool contains(Index object) const {
        return std::find(objects.begin(), objects.begin() + count, object) !=
               objects.begin() + count;
    }
};

/// The two neighbouring lobes of a Finish that a surface point shows.
struct LobeMix {
    Index first = 0;
    double share = 0;  ///< of the lobe after `first`
};

/// Surface points of one generation, in arrays.
struct Surfaces {
    std::size_t count = 0;
    Vectors position, normal, view;  ///< normal is unit and turned to the eye; view comes from it
    Vectors mirrored;                ///< view mirrored by the normal; unit but for rounding
    Vectors facet_normal;            ///< unit geometric normal; of spheres and planes `normal`
    Vectors pigment;
    Vectors tint;                 ///< takes the pigment's place in highlight and mirror
    Vectors own;                  ///< ambient and emitted light
    Vectors through;              ///< factor of what lies behind; of surfaces not opaque
    std::vector<double> diffuse;  ///< K_D x opacity x coverage
    std::vector<double> coverage;
    std::vector<double> depth;  ///< length of the ray that ended here
    std::vector<LobeMix> lobes;
    std::vector<Index> object;
    std::vector<const Finish*> finish;
    std::vector<const Interiors*> inside;  ///< of the ray that ended here

    explicit Surfaces(std::size_t capacity = 0) { resize(capacity); }
    void resize(std::size_t capacity);
};

/// Writes surface point `slot` for a ray that ended in `hit`, but for `inside`.
void find_surface(const World& world, const Vec3& origin, const Vec3& direction, const Hit& hit,
                  Surfaces& surfaces, std::size_t slot);

/// The factor of light that crosses the surface at `hit`, which is not opaque.
Vec3 light_through(const World& world, const Vec3& origin, const Vec3& direction, const Hit& hit);

}  // namespace penumbra
