// What may stand between groups of surface points and a light.
#pragma once

#include "shaft.h"
#include "world.h"

#include <vector>

namespace penumbra {

/// Boxes around runs of facets, of all instances.
BoxTree boxes_of_facets(const Scene& scene);

/// Boxes around spheres; the items are objects.
BoxTree boxes_of_spheres(const Scene& scene);

/// Groups of surface points.
struct PointGroups {
    Bounds all = {};                 ///< around all of them
    std::vector<Bounds> boxes = {};  ///< around each group
    std::vector<Extent> along = {};  ///< of n . p, for each group and each plane of the world

    void clear();
    void add(const World& world, const Vectors& positions, const IndexRange& range);

  private:
    std::vector<double> scratch_ = {};
};

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

    /// Finds what may stand between each group of points and a light.
    void find(const World& world, const PointGroups& points, const SourceGroup& light);

  private:
    std::vector<Index> spheres_ = {};  // that may for any of the points
    void find_group(const World& world, const PointGroups& points, const SourceGroup& light,
                    bool facets);
};

}  // namespace penumbra
