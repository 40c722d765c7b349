// What may stand between groups of surface points and a light.
#pragma once

#include "tracer/accel/shaft.h"
#include "tracer/prepared/prepared_scene.h"
#include "tracer/surface_points.h"

#include <vector>

namespace penumbra {

/// Groups of surface points.
struct PointGroups {
    Bounds all = {};                   ///< around all of them
    std::vector<Bounds> boxes = {};    ///< around each group
    std::vector<Bounds> normals = {};  ///< around the shading normals of each
    std::vector<Extent> along = {};    ///< of n . p, for each group and each plane of the world

    void clear();
    void add(const PreparedScene& prepared, const SurfacePoints& surfaces, const IndexRange& range);

    /// True only when no source of the light is above the horizon of any point of the group.
    bool face_away(std::size_t group, const SourceGroup& light) const;

  private:
    std::vector<double> scratch_ = {};
};

/// What may stand between one group of points and a light; the shapes are
/// [first_shape, last_shape) of Blockers::shapes.
struct BlockedBy {
    bool away = false;                            ///< nothing of the light can reach them
    bool any = false;                             ///< anything, translucent or not
    bool facets = false;                          ///< facets may
    bool filters = false;                         ///< something translucent may
    std::size_t first_shape = 0, last_shape = 0;  ///< opaque spheres and planes that may
};

/// The same for many groups.
struct Blockers {
    std::vector<BlockedBy> groups = {};
    std::vector<Index> shapes = {};  ///< objects

    /// Finds what may stand between each group of points and a light.
    void find(const PreparedScene& prepared, const PointGroups& points, const SourceGroup& light);

  private:
    std::vector<Index> spheres_ = {};  // that may for any of the points
    void find_group(const PreparedScene& prepared, const PointGroups& points,
                    const SourceGroup& light, bool facets);
};

}  // namespace penumbra
