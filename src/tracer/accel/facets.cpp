#include "tracer/accel/facets.h"

#include "base/memory.h"
#include "base/simd.h"
#include "tracer/accel/embree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {

namespace {

// Below this angle to its facet a shadow ray may find that facet again: float32 rounds its start
// point, and as much the facet's distance from there.
constexpr double grazing_sine = coordinate_rounding / shadow_margin;

struct Width8 {
    using RayHits = RTCRayHit8;
    using Shadows = RTCRay8;
    static constexpr std::size_t size = 8;
};
struct Width16 {
    using RayHits = RTCRayHit16;
    using Shadows = RTCRay16;
    static constexpr std::size_t size = 16;
};

}  // namespace

FacetPlane facet_plane(const Mesh& mesh, Index facet) {
    const auto& [a, b, c] = mesh.triangles[facet];
    const Vec3 first(mesh.positions[a]);
    const Vec3 e1 = Vec3(mesh.positions[b]) - first, e2 = Vec3(mesh.positions[c]) - first;
    const Vec3 normal = e2.cross(e1);
    const double length = std::sqrt(normal.dot(normal));
    if (length == 0) return {};
    const Vec3 unit = normal * (1 / length);
    return {Vec3(Vec3f(unit)), double(-float(unit.dot(first)))};
}

Vec3 PlacedMesh::point_to_mesh(const Vec3& p) const { return identity ? p : p * to_mesh; }

Vec3 PlacedMesh::vector_to_mesh(const Vec3& v) const {
    if (identity) return v;
    Vec3 out;
    to_mesh.multDirMatrix(v, out);
    return out;
}

Vec3 PlacedMesh::normal_to_world(const Vec3& n) const {
    if (identity) return n;
    const Matrix& m = to_mesh;  // inverse transpose: rows become columns
    return {m[0][0] * n.x + m[0][1] * n.y + m[0][2] * n.z,
            m[1][0] * n.x + m[1][1] * n.y + m[1][2] * n.z,
            m[2][0] * n.x + m[2][1] * n.y + m[2][2] * n.z};
}

FacetAccel::FacetAccel(const Scene& scene, const FacetAccel* earlier, bool instances_move) {
    constexpr std::size_t each = sizeof(PlacedMesh) + 512;  // with Embree's own
    const MemoryClaim claim(times(scene.instances.size(), each), "the scene");
    const std::vector<Backs> all_backs = backs(scene);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const Material& material = scene.materials[mesh.material];
        placed_.push_back({.mesh = &mesh,
                           .to_mesh = instance.transform.inverse(),
                           .identity = instance.transform == Matrix(),
                           .smooth = material.smooth && !mesh.normals.empty(),
                           .opaque = opaque(material),
                           .backs = all_backs[placed_.size()]});
        translucent_ |= !placed_.back().opaque;
    }
    trees_ = FacetTrees(scene, earlier != nullptr ? &earlier->trees_ : nullptr, instances_move);
    const Bounds box = trees_.bounds();
    if (!box.empty()) {
        center_ = box.center();
        reach_ = box.radius();
    }
}

double FacetAccel::distance_to(Index instance, Index facet, const Vec3& origin,
                               const Vec3& direction) const {
    const PlacedMesh& placed = placed_[instance];
    const FacetPlane plane = facet_plane(*placed.mesh, facet);
    Vec3 towards = placed.vector_to_mesh(direction);
    double scale = 1;
    if (!placed.identity) {
        scale = 1 / std::sqrt(towards.dot(towards));
        towards *= scale;
    }
    const double along = plane.normal.dot(towards);
    if (std::abs(along) < least_cosine) return no_hit;
    const double depth = -(plane.distance + plane.normal.dot(placed.point_to_mesh(origin))) / along;
    return depth >= least_depth && depth <= greatest_depth ? depth * scale : no_hit;
}

template <class Accept>
bool FacetAccel::walk(const Vec3& origin, const Vec3& direction, float from, double farthest,
                      unsigned mask, Accept accept) const {
    if (!embree::takes(direction)) return false;
    embree::Query query(false);
    float near = from;
    while (true) {
        RTCRayHit ray = embree::single_ray(origin, direction, near, farthest, mask);
        embree::intersect(trees_.over(mask), query, ray);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
        const Index instance = embree::instance_in(ray);
        const double t = distance_to(instance, ray.hit.primID, origin, direction);
        if (accept(Hit{t, instance, ray.hit.primID})) return true;
        near = std::nextafter(ray.ray.tfar, std::numeric_limits<float>::infinity());
    }
}

bool FacetAccel::exact_closest(const Vec3& origin, const Vec3& direction, float from,
                               Hit& hit) const {
    return walk(origin, direction, from, no_hit, opaque_mask | translucent_mask,
                [&](const Hit& found) {
                    if (found.t < least_distance || found.t == no_hit) return false;
                    if (found.t < hit.t) hit = found;
                    return true;
                });
}

bool FacetAccel::exact_blocked(const Vec3& origin, const Vec3& direction, double distance) const {
    return walk(origin, direction, 0, distance, opaque_mask, [&](const Hit& found) {
        return found.t > shadow_margin && found.t < distance - shadow_margin;
    });
}

// What Embree says.
bool FacetAccel::blocked_beyond(const Vec3& origin, const Vec3& direction, double near,
                                double far) const {
    embree::Query query(false);
    RTCRayHit ray = embree::single_ray(origin, direction, float(near), far, opaque_mask);
    embree::occluded(trees_.top(), query, ray.ray);
    return ray.ray.tfar < 0;
}

bool FacetAccel::translucent(const Vec3& origin, const Vec3& direction, double nearest,
                             double farthest, Hit& hit) const {
    if (!translucent_) return false;
    const auto from = float(std::max(0.0, nearest - 100 * coordinate_rounding));
    return walk(origin, direction, from, farthest, translucent_mask, [&](const Hit& found) {
        if (!(found.t > nearest && found.t < farthest)) return false;
        hit = found;
        return true;
    });
}

namespace {

// What goes where in a packet: float(from[ray] - less).
struct Column {
    const double* from = nullptr;
    float* to = nullptr;
    double less = 0;
};

// Fills a packet with the rays `from`, of which there are a multiple of eight.
PENUMBRA_VECTORISED
void gather(std::span<const Column> columns, std::span<const Index> from) {
    const Index* const rays = from.data();
    for (const Column& column : columns) {
        const double* const values = column.from;
        float* const to = column.to;
        for (std::size_t first = 0; first < from.size(); first += 8) {
            PENUMBRA_INDEPENDENT
            for (std::size_t i = first; i < first + 8; ++i)
                to[i] = float(values[rays[i]] - column.less);
        }
    }
}

// About how far the rays of a packet start from one another: neighbours lie along a curve.
template <class Width>
float spread_of_origins(const typename Width::Shadows& packet) {
    float widest = 0;
    for (const auto* const origins : {&packet.org_x, &packet.org_y, &packet.org_z})
        for (const std::size_t lane : {Width::size / 3, 2 * Width::size / 3, Width::size - 1})
            widest = std::max(widest, std::abs((*origins)[lane] - (*origins)[0]));
    return widest;
}

}  // namespace

template <class Width>
void FacetAccel::fill(typename Width::RayHits& packet, const Rays& rays, const Hits& hits,
                      std::size_t first) const {
    const std::size_t lanes = std::min(Width::size, rays.count - first);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        const std::size_t i = first + lane;
        const Vec3 origin = rays.origin[i], direction = rays.direction[i];
        // A ray that starts far away is moved to the facets first: float32 has no digits for both
        // the distance and the hit.
        const double shift = std::max(0.0, (center_ - origin).dot(direction) - reach_);
        const Vec3 start = shift > reach_ ? origin + direction * shift : origin;
        const double moved = shift > reach_ ? shift : 0;
        packet.ray.org_x[lane] = float(start.x);
        packet.ray.org_y[lane] = float(start.y);
        packet.ray.org_z[lane] = float(start.z);
        packet.ray.dir_x[lane] = float(direction.x);
        packet.ray.dir_y[lane] = float(direction.y);
        packet.ray.dir_z[lane] = float(direction.z);
        packet.ray.tnear[lane] = moved > 0 ? 0 : float(least_distance / 2);
        packet.ray.tfar[lane] = hits.t[i] == no_hit ? std::numeric_limits<float>::infinity()
                                                    : float((hits.t[i] - moved) * (1 + 1e-6));
        packet.ray.time[lane] = 0;
        packet.ray.mask[lane] = opaque_mask | translucent_mask;
        packet.ray.id[lane] = 0;
        packet.ray.flags[lane] = 0;
        packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
}

template <class Width>
void FacetAccel::use(const typename Width::RayHits& packet, const Rays& rays, Hits& hits,
                     std::size_t first) const {
    const std::size_t lanes = std::min(Width::size, rays.count - first);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
        const std::size_t i = first + lane;
        const Index instance = packet.hit.instID[0][lane] != RTC_INVALID_GEOMETRY_ID
                                   ? packet.hit.instID[0][lane]
                                   : packet.hit.geomID[lane];
        const Index facet = packet.hit.primID[lane];
        const Vec3 origin = rays.origin[i], direction = rays.direction[i];
        const double t = distance_to(instance, facet, origin, direction);
        Hit hit = hits[i];
        if (t < least_distance || t == no_hit)
            exact_closest(origin, direction, packet.ray.tfar[lane], hit);
        else if (is_at_edge(packet.hit.u[lane], packet.hit.v[lane]))
            closest_at_edge(origin, direction, {t, instance, facet}, packet.ray.tfar[lane], hit);
        else if (t < hit.t)
            hit = {t, instance, facet};
        hits.set(i, hit);
    }
}

template <class Width>
void FacetAccel::closest_packets(const Rays& rays, Hits& hits, bool coherent) const {
    embree::Query query(coherent && !trees_.instanced());
    typename Width::RayHits packet;
    for (std::size_t first = 0; first < rays.count; first += Width::size) {
        alignas(64) std::array<int, Width::size> valid{};
        const std::size_t lanes = std::min(Width::size, rays.count - first);
        for (std::size_t lane = 0; lane < lanes; ++lane)
            valid[lane] = embree::takes(rays.direction[first + lane]) ? -1 : 0;
        fill<Width>(packet, rays, hits, first);
        embree::intersect(valid.data(), trees_.top(), query, packet);
        use<Width>(packet, rays, hits, first);
    }
}

// So far from its start the ray does not find the facet again that it leaves.
bool FacetAccel::blocked_at_small_angle(const ShadowRays& rays, std::size_t i) const {
    const Vec3 origin = rays.origin[i], direction = rays.direction[i];
    const double leaves = 2 * coordinate_rounding / rays.sin_to_facet[i];
    const double far = rays.distance[i] - shadow_margin;
    if (leaves < far && blocked_beyond(origin, direction, leaves, far)) return true;
    return exact_blocked(origin, direction, rays.distance[i]);
}

template <class Width, class Found>
void FacetAccel::each_occluded_packet(const ShadowRays& rays, std::span<const Index> asked,
                                      unsigned mask, double near, Found found) const {
    // Embree 3.13's coherent traversal never returns from rtcOccluded16 on instances, so only
    // scenes without them use it. Where mirrors have scattered the points of a packet over the
    // scene its frustum holds nearly all facets: with a million of them under 64 sources the other
    // traversal took a quarter less time.
    embree::Query together(!trees_.instanced()), apart(false);
    const float wide = float(reach_) / 8;
    typename Width::Shadows packet;
    for (std::size_t lane = 0; lane < Width::size; ++lane) {
        packet.tnear[lane] = float(near);
        packet.time[lane] = 0;
        packet.mask[lane] = mask;
        packet.id[lane] = 0;
        packet.flags[lane] = 0;
    }
    const std::array<Column, 7> columns = {{{rays.origin.x, packet.org_x},
                                            {rays.origin.y, packet.org_y},
                                            {rays.origin.z, packet.org_z},
                                            {rays.direction.x, packet.dir_x},
                                            {rays.direction.y, packet.dir_y},
                                            {rays.direction.z, packet.dir_z},
                                            {rays.distance, packet.tfar, shadow_margin}}};
    for (std::size_t first = 0; first < asked.size(); first += Width::size) {
        alignas(64) std::array<int, Width::size> valid{};
        std::array<Index, Width::size> from{};
        const std::size_t lanes = std::min(Width::size, asked.size() - first);
        for (std::size_t lane = 0; lane < Width::size; ++lane) {
            from[lane] = asked[std::min(first + lane, asked.size() - 1)];
            valid[lane] = lane < lanes ? -1 : 0;
        }
        gather(columns, from);
        embree::Query& query = spread_of_origins<Width>(packet) > wide ? apart : together;
        embree::occluded(valid.data(), trees_.over(mask), query, packet);
        for (std::size_t lane = 0; lane < lanes; ++lane)
            if (packet.tfar[lane] < 0) found(from[lane]);
    }
}

void FacetAccel::closest(const Rays& rays, Hits& hits, bool coherent) const {
    if (empty()) return;
    if (trees_.wide())
        closest_packets<Width16>(rays, hits, coherent);
    else
        closest_packets<Width8>(rays, hits, coherent);
}

template <class Found>
void FacetAccel::each_occluded(const ShadowRays& rays, std::span<const Index> asked, unsigned mask,
                               double near, Found found) const {
    if (trees_.wide())
        each_occluded_packet<Width16>(rays, asked, mask, near, found);
    else
        each_occluded_packet<Width8>(rays, asked, mask, near, found);
}

void FacetAccel::occluded(const ShadowRays& rays, std::span<const Index> asked,
                          std::span<double> visible) const {
    if (empty()) return;
    each_occluded(rays, asked, opaque_mask, shadow_margin, [&](Index i) {
        if (rays.sin_to_facet[i] >= grazing_sine || blocked_at_small_angle(rays, i)) visible[i] = 0;
    });
}

void FacetAccel::find_filtered(const ShadowRays& rays, std::span<const Index> asked,
                               std::vector<Index>& filtered) const {
    filtered.clear();
    if (translucent_)
        each_occluded(rays, asked, translucent_mask, 0, [&](Index i) { filtered.push_back(i); });
}

}  // namespace penumbra
