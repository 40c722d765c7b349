// The facets of the instances, numbered in the order of the file, where they lie in the units that
// both renderers work in.
#pragma once

#include "prepare/surfaces/mesh_corners.h"
#include "scene/tolerances.h"
#include "scene/transforms.h"

#include "penumbra/scene.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace penumbra {

/// Facets whose planes differ by no more lie in one plane: a few times what float32 leaves open,
/// and more than POV-Ray's least distance, within which a ray meets one of two at most.
inline constexpr double in_one_plane = 20 * coordinate_rounding;
static_assert(in_one_plane > least_distance);

/// What overlaps by less does not count; a pixel is some ten times wider.
inline constexpr double least_overlap = 500 * coordinate_rounding;

struct WorldFacet {
    std::array<Vec3, 3> corners = {};
    Vec3 normal = Vec3(0);  ///< unit, out of its front (glTF 2.0, section 3.7.2.1)

    /// Of a point from the facet's plane, positive in front of it.
    double height(const Vec3& p) const { return normal.dot(p - corners[0]); }
};

/// The Scene must outlive it, and keep its facets. `box` is bounds(scene).
class WorldFacets {
  public:
    WorldFacets(const Scene& scene, const Bounds& box);

    const Scene& scene() const { return scene_; }
    std::size_t count() const { return first_.back(); }
    /// A user's length times this is a length here.
    double factor() const { return factor_; }
    Vec3 place(const Vec3& world) const { return (world - origin_) * factor_; }

    Index instance_of(Index facet) const;
    /// The number of the first facet of an instance.
    Index first_of(Index instance) const { return first_[instance]; }
    const Mesh& mesh_of(Index instance) const {
        return scene_.meshes[scene_.instances[instance].mesh];
    }
    const Material& material_of(Index instance) const {
        return scene_.materials[mesh_of(instance).material];
    }

    /// Around all facets of an instance.
    Bounds box_of(Index instance) const {
        return transformed(boxes_[scene_.instances[instance].mesh], places_[instance]);
    }

    /// Nothing where the facet is too thin to overlap anything, or is not finite.
    std::optional<WorldFacet> at(Index instance, Index facet) const;

    /// Fetches the corners of a facet that is asked for soon: what at() waits for is memory.
    void prefetch(Index instance, Index facet) const {
        const Mesh& mesh = mesh_of(instance);
        if (facet >= mesh.triangles.size()) return;
        for (const Index corner : mesh.triangles[facet])
            __builtin_prefetch(&mesh.positions[corner]);
    }

    /// Does the facet look like any other of its material in its plane?
    bool plain(Index instance, Index facet) const;

    /// Is the facet part of a body that lies behind it, so that only its front is seen? All of its
    /// mesh does, or all that meets its corners: not every body is recognised. Through the gaps of
    /// an open mesh that shows one side others are seen.
    bool solid(Index instance, Index facet) const;

  private:
    const Scene& scene_;
    Vec3 origin_ = Vec3(0);
    double factor_ = 1;
    std::vector<Index> first_;    // and behind the last one
    std::vector<bool> mirrored_;  // of each instance
    std::vector<Matrix> places_;  // the same, to the units here
    std::vector<Bounds> boxes_;   // around the meshes
    // Of those that were asked:
    mutable std::vector<std::optional<MeshCorners>> corners_;
    mutable std::vector<std::optional<bool>> bodies_;
};

}  // namespace penumbra
