// Ray-facet hits: Embree finds the facet in float32, double arithmetic finds the point.
#pragma once

#include "rays.h"

#include "penumbra/scene.h"

#include <memory>

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

    Vec3 point_to_mesh(const Vec3& p) const;
    Vec3 vector_to_mesh(const Vec3& v) const;
    /// A normal in mesh space as one in world space; not unit.
    Vec3 normal_to_world(const Vec3& n) const;
};

/// All facets of a scene, ready for queries. The Scene must outlive it.
class Facets {
  public:
    explicit Facets(const Scene& scene);
    ~Facets();
    Facets(const Facets&) = delete;
    Facets& operator=(const Facets&) = delete;

    bool empty() const { return placed_.empty(); }
    const PlacedMesh& placed(Index instance) const { return placed_[instance]; }

    /// Lowers hits[i].t, object and facet where a facet is hit nearer than what hits hold already.
    /// `coherent` tells that neighbouring rays are nearly parallel.
    void closest(const Rays& rays, Hits& hits, bool coherent) const;

    /// Sets visible[i] to 0 where an opaque facet blocks shadow ray i, for the rays in `asked`.
    void block(const ShadowRays& rays, std::span<const Index> asked,
               std::span<double> visible) const;

    /// The nearest translucent facet with distance in (nearest, farthest).
    bool translucent(const Vec3& origin, const Vec3& direction, double nearest, double farthest,
                     Hit& hit) const;

  private:
    struct Device;
    template <class Width>
    void closest_packets(const Rays&, Hits&, bool coherent) const;
    template <class Width>
    void block_packets(const ShadowRays&, std::span<const Index>, std::span<double>) const;
    /// Offers the facets along a ray, nearest first, to `accept` until it returns true.
    template <class Accept>
    bool walk(const Vec3& origin, const Vec3& direction, float from, double farthest, unsigned mask,
              Accept accept) const;
    bool exact_closest(const Vec3& origin, const Vec3& direction, float from, Hit& hit) const;
    bool exact_blocked(const Vec3& origin, const Vec3& direction, double distance) const;
    double distance_to(Index instance, Index facet, const Vec3& origin,
                       const Vec3& direction) const;

    const Scene& scene_;
    std::vector<PlacedMesh> placed_;
    std::unique_ptr<Device> device_;
    bool wide_ = false;         ///< 16 rays a packet, else 8
    bool translucent_ = false;  ///< any facet is
    /// Embree 3.13's coherent traversal never returns from rtcOccluded16 on instances, so only
    /// scenes without them use it.
    bool instanced_ = false;
    Vec3 center_ = {};  ///< of the sphere around all facets
    double reach_ = 0;  ///< its radius
};

}  // namespace penumbra
