// Which of the facets that meet in an edge a ray hits.
#include "scene/tolerances.h"
#include "tracer/accel/embree.h"
#include "tracer/accel/facets.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {

// How far beside the ray a facet beyond the edge is looked for: where float32 tells both apart.
constexpr double least_shift = 4 * coordinate_rounding;

namespace {

// Of a facet and the point where a ray meets its plane: the barycentric coordinates, in double.
// POV-Ray asks the same of the vertices without the axis that the normal is longest along
// (source/backend/shape/mesh.cpp of 3.7, intersect_mesh_triangle).
std::array<double, 3> shares_at(const Mesh& mesh, Index facet, const Vec3& normal, const Vec3& p) {
    const Vec3 size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
    const int drop = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    const auto& [a, b, c] = mesh.triangles[facet];
    const Vec3 corners[] = {Vec3(mesh.positions[a]), Vec3(mesh.positions[b]),
                            Vec3(mesh.positions[c])};
    std::array<double, 3> areas;
    for (int i = 0; i < 3; ++i) {
        const Vec3 from = corners[(i + 1) % 3], side = corners[(i + 2) % 3] - from;
        areas[std::size_t(i)] = side[u] * (p[v] - from[v]) - side[v] * (p[u] - from[u]);
    }
    const double whole = areas[0] + areas[1] + areas[2];
    for (double& area : areas) area /= whole;
    return areas;
}

bool all_inside(const std::array<double, 3>& shares) {
    return shares[0] >= 0 && shares[1] >= 0 && shares[2] >= 0;
}

// From the edge across from corner `i` straight away from it, in the mesh's space; its length is
// the height over the edge.
Vec3 out_of(const Mesh& mesh, Index facet, int i) {
    const auto& triangle = mesh.triangles[facet];
    const auto corner = [&](int k) { return Vec3(mesh.positions[triangle[std::size_t(k % 3)]]); };
    const Vec3 from = corner(i + 1), side = corner(i + 2) - from, height = from - corner(i);
    return height - side * (height.dot(side) / side.dot(side));
}

}  // namespace

// The facet on the other side of an edge, which a parallel ray beside this one meets; `found`
// itself where there is none that float32 tells from it.
Hit FacetAccel::beyond_edge(const Vec3& origin, const Vec3& direction, const Hit& found,
                            int corner) const {
    const PlacedMesh& placed = placed_[found.object];
    Vec3 out;
    placed.to_mesh.inverse().multDirMatrix(out_of(*placed.mesh, found.facet, corner), out);
    const double height = out.length();
    if (!(height > 0)) return found;
    const Vec3 shift = out * (std::max(3 * double(edge_share) * height, least_shift) / height);
    const double reach = 100 * shift.length() + 1e-6 * found.t;
    RTCRayHit ray =
        embree::single_ray(origin + shift, direction, float(std::max(0.0, found.t - reach)),
                           found.t + reach, opaque_mask | translucent_mask);
    embree::Query query(false);
    embree::intersect(trees_.top(), query, ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const Index instance = embree::instance_in(ray);
    return {distance_to(instance, ray.hit.primID, origin, direction), instance, ray.hit.primID};
}

// What a ray meets that Embree sees at an edge of `found`: whatever of the facets there it lies
// within in double, the nearest of them; what lies behind where it passes by.
void FacetAccel::closest_at_edge(const Vec3& origin, const Vec3& direction, const Hit& found,
                                 float behind, Hit& hit) const {
    const auto shares = [&](const Hit& at) {
        const PlacedMesh& placed = placed_[at.object];
        return shares_at(*placed.mesh, at.facet, facet_plane(*placed.mesh, at.facet).normal,
                         placed.point_to_mesh(origin + direction * at.t));
    };
    const std::array<double, 3> own = shares(found);
    Hit best = all_inside(own) ? found : Hit{};
    bool alone = true;  // no facet beyond
    for (int i = 0; i < 3; ++i) {
        if (own[std::size_t(i)] > 4 * double(edge_share)) continue;
        const Hit other = beyond_edge(origin, direction, found, i);
        if (other.t == no_hit || other.t < least_distance) continue;
        alone = false;
        if (other.t < best.t && all_inside(shares(other))) best = other;
    }
    if (best.t == no_hit && alone) {
        exact_closest(origin, direction, behind, hit);
        return;
    }
    if (best.t == no_hit) best = found;
    if (best.t < hit.t) hit = best;
}

}  // namespace penumbra
