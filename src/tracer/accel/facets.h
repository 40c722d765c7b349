// Ray-facet hits: Embree finds the facet in float32, double arithmetic finds the point.
#pragma once

#include "scene/sides.h"
#include "tracer/accel/facet_trees.h"
#include "tracer/accel/rays.h"

#include "penumbra/scene.h"

#include <algorithm>
#include <vector>

namespace penumbra {

/// One facet in its mesh's space with the plane that POV-Ray stores: unit normal and distance in
/// float32, from the float32 vertices (source/backend/shape/mesh.cpp of 3.7,
/// compute_mesh_triangle).
struct FacetPlane {
    Vec3 normal = {};
    double distance = 0;  ///< normal . p + distance = 0 on the facet
};
FacetPlane facet_plane(const Mesh& mesh, Index facet);

/// An Instance with what the tracer derives from it.
struct PlacedMesh {
    const Mesh* mesh = nullptr;
    Matrix to_mesh = {};    ///< world to mesh
    bool identity = false;  ///< mesh space is world space
    bool smooth = false;    ///< has normals and a material that uses them
    bool opaque = true;
    Backs backs = {};

    Vec3 point_to_mesh(const Vec3& p) const;
    Vec3 vector_to_mesh(const Vec3& v) const;
    /// A normal in mesh space as one in world space; not unit.
    Vec3 normal_to_world(const Vec3& n) const;
};

/// All facets of a scene, ready for queries. The Scene must outlive it.
class FacetAccel {
  public:
    FacetAccel() = default;  ///< no facets
    /// Takes over from `earlier`, that of the scene before it was changed, what is still right: see
    /// FacetTrees.
    explicit FacetAccel(const Scene& scene, const FacetAccel* earlier = nullptr,
                        bool instances_move = false);

    bool empty() const { return placed_.empty(); }
    bool same_trees(const FacetAccel& other) const { return trees_.same_top(other.trees_); }
    std::size_t trees_built() const { return trees_.built(); }
    const PlacedMesh& placed(Index instance) const { return placed_[instance]; }

    /// Lowers hits[i].t, object and facet where a facet is hit nearer than what hits hold already.
    /// `coherent` tells that neighbouring rays are nearly parallel.
    void closest(const Rays& rays, Hits& hits, bool coherent) const;

    /// Sets visible[i] to 0 where an opaque facet blocks shadow ray i, for the rays in `asked`.
    void occluded(const ShadowRays& rays, std::span<const Index> asked,
                  std::span<double> visible) const;

    /// Lists those of the shadow rays in `asked` that may cross translucent facets, or start on
    /// one.
    void find_filtered(const ShadowRays& rays, std::span<const Index> asked,
                       std::vector<Index>& filtered) const;

    /// The nearest translucent facet with distance in (nearest, farthest).
    bool translucent(const Vec3& origin, const Vec3& direction, double nearest, double farthest,
                     Hit& hit) const;
    /// All translucent facets with distance in [0, farthest), nearest first.
    void translucent(const Vec3& origin, const Vec3& direction, double farthest,
                     std::vector<Hit>& hits) const;

  private:
    template <class Width>
    void fill(typename Width::RayHits& packet, const Rays& rays, const Hits& hits,
              std::size_t first) const;
    template <class Width>
    void use(const typename Width::RayHits& packet, const Rays& rays, Hits& hits,
             std::size_t first) const;
    template <class Width>
    void closest_packets(const Rays&, Hits&, bool coherent) const;
    /// Calls found(ray) for those in `asked` that meet facets of the mask beyond `near`.
    template <class Found>
    void each_occluded(const ShadowRays&, std::span<const Index> asked, unsigned mask, double near,
                       Found found) const;
    template <class Width, class Found>
    void each_occluded_packet(const ShadowRays&, std::span<const Index> asked, unsigned mask,
                              double near, Found found) const;
    /// Offers the facets along a ray, nearest first, to `accept` until it returns true.
    template <class Accept>
    bool walk(const Vec3& origin, const Vec3& direction, float from, double farthest, unsigned mask,
              Accept accept) const;
    bool exact_closest(const Vec3& origin, const Vec3& direction, float from, Hit& hit) const;
    /// Embree tells facets that meet in an edge apart in float32. Where a barycentric coordinate is
    /// below this, double has the last word.
    static constexpr float edge_share = 1e-4F;
    static bool is_at_edge(float u, float v) { return std::min({u, v, 1 - u - v}) < edge_share; }
    Hit beyond_edge(const Vec3& origin, const Vec3& direction, const Hit& found, int corner) const;
    void closest_at_edge(const Vec3& origin, const Vec3& direction, const Hit& found, float behind,
                         Hit& hit) const;
    bool exact_blocked(const Vec3& origin, const Vec3& direction, double distance) const;
    bool blocked_at_small_angle(const ShadowRays& rays, std::size_t i) const;
    bool blocked_beyond(const Vec3& origin, const Vec3& direction, double near, double far) const;
    double distance_to(Index instance, Index facet, const Vec3& origin,
                       const Vec3& direction) const;

    std::vector<PlacedMesh> placed_;
    FacetTrees trees_;
    bool translucent_ = false;  ///< any facet is
    Vec3 center_ = {};          ///< of the sphere around all facets
    double reach_ = 0;          ///< its radius
};

/// The translucent facets along a ray, one after another. The first is looked for by itself, for
/// often there is no other, or it blocks the light; then all others at once.
class TranslucentFacets {
  public:
    /// `scratch` is the room for them.
    TranslucentFacets(const FacetAccel& facets, const Vec3& origin, const Vec3& direction,
                      double farthest, std::vector<Hit>& scratch)
        : facets_(facets), origin_(origin), direction_(direction), farthest_(farthest),
          all_(scratch) {}

    /// Lowers `hit` to the nearest facet with distance in (nearest, hit.t). Precondition: `nearest`
    /// never falls.
    bool next(double nearest, Hit& hit);

  private:
    const FacetAccel& facets_;
    Vec3 origin_, direction_;
    double farthest_;
    std::vector<Hit>& all_;
    std::size_t at_ = 0;
    enum class Known : unsigned char { none, first, all } known_ = Known::none;
};

}  // namespace penumbra
