// What may stand between groups of surface points and a light.
#pragma once

#include "shaft.h"
#include "world.h"

#include <span>
#include <vector>

namespace penumbra {

/// Boxes around runs of facets, of all instances.
BoxTree boxes_of_facets(const Scene& scene);

/// Boxes around spheres; the items are objects.
BoxTree boxes_of_spheres(const Scene& scene);

/// What may stand between one group of points and a light; the shapes are
/// [first_shape, last_shape) of Blockers::shapes.
struct BlockedBy {
    bool any = false;                             ///< anything, translucent or not
    bool facets = false;                          ///< facets may
    std::size_t first_shape = 0, last_shape = 0;  ///< opaque spheres and planes that may
};

/// The same for many groups.
struct Blockers {
    std::vector<BlockedBy> groups = {};
    std::vector<Index> shapes = {};  ///< objects

    /// Finds what may stand between the points in each of `boxes`, all of them in `all`, and a
    /// light whose sources lie in `light`. Returns whether anything may anywhere; groups are set
    /// only then.
    bool find(const World& world, const Bounds& all, std::span<const Bounds> boxes,
              const Bounds& light);

  private:
    std::vector<Index> spheres_ = {}, planes_ = {};  // that may for all of the points
    void find_group(const World& world, const Bounds& box, const Bounds& light, bool facets);
};

}  // namespace penumbra
