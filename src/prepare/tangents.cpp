// Per-vertex tangents of texture coordinates.
#include "base/memory.h"
#include "prepare/weld.h"
#include "scene/defects.h"
#include "scene/normal_map.h"
#include "scene/vertex_arrays.h"

#include "penumbra/light_model.h"
#include "penumbra/prepare.h"

#include <cassert>
#include <cmath>

namespace penumbra {

namespace {

// The direction in which u grows over a facet and the handedness of (u, v) as seen from the side of
// its normals; 0 where the facet has no area in space or in the image.
struct FacetTangent {
    Vec3 direction = {};
    int handedness = 0;
};

FacetTangent facet_tangent(const Mesh& mesh, const ImageMap& map,
                           const std::array<Index, 3>& facet) {
    const auto& [a, b, c] = facet;
    const Vec3 first(mesh.positions[a]);
    const Vec3 p1 = Vec3(mesh.positions[b]) - first, p2 = Vec3(mesh.positions[c]) - first;
    const Vec2 origin = map_texcoord(map, Vec2(mesh.texcoords[a]));
    const Vec2 t1 = map_texcoord(map, Vec2(mesh.texcoords[b])) - origin;
    const Vec2 t2 = map_texcoord(map, Vec2(mesh.texcoords[c])) - origin;
    const Vec3 side = Vec3(mesh.normals[a]) + Vec3(mesh.normals[b]) + Vec3(mesh.normals[c]);
    const double area = t1.x * t2.y - t1.y * t2.x, facing = p1.cross(p2).dot(side);
    if (!(std::abs(area) > 0) || !(std::abs(facing) > 0)) return {};
    const Vec3 direction = (p1 * t2.y - p2 * t1.y) * (area < 0 ? -1.0 : 1.0);
    if (!(direction.length() > 0)) return {};
    return {direction.normalized(), (area < 0) == (facing < 0) ? 1 : -1};
}

Vec3 in_plane(const Vec3& v, const Vec3& normal) {
    return (v - normal * v.dot(normal)).normalized();
}

// What a corner of a facet adds to its vertex (as MikkTSpace of M. Mikkelsen, 2008): the facet's
// direction in the plane of the vertex, times the facet's angle there.
Vec3 share_of_corner(const Mesh& mesh, const std::array<Index, 3>& facet, unsigned corner,
                     const Vec3& direction) {
    const Vec3 normal(mesh.normals[facet[corner]]), here(mesh.positions[facet[corner]]);
    const Vec3 e1 = in_plane(Vec3(mesh.positions[facet[(corner + 1) % 3]]) - here, normal);
    const Vec3 e2 = in_plane(Vec3(mesh.positions[facet[(corner + 2) % 3]]) - here, normal);
    return in_plane(direction, normal) * std::acos(std::clamp(e1.dot(e2), -1.0, 1.0));
}

Vec3 any_perpendicular(const Vec3& normal) {
    const Vec3 axis = std::abs(normal.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    return in_plane(axis, normal);
}

std::vector<Index> welded_vertices(const Mesh& mesh) {
    return weld(mesh.positions.size(), [&](Index i) {
        const Vec3f &p = mesh.positions[i], &n = mesh.normals[i];
        const Vec2f& t = mesh.texcoords[i];
        return std::array<float, 8>{p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y};
    });
}

// Sums of both handednesses, at the first of the vertices that are the same.
using Sums = std::array<std::vector<Vec3>, 2>;

// The index of the handedness in Sums.
std::size_t slot(int handedness) { return handedness < 0 ? 1 : 0; }

Sums add_up(const Mesh& mesh, const std::vector<FacetTangent>& facets,
            const std::vector<Index>& first) {
    Sums sums;
    for (auto& sum : sums) sum.resize(mesh.positions.size(), Vec3(0));
    for (std::size_t f = 0; f < facets.size(); ++f)
        for (unsigned k = 0; facets[f].handedness != 0 && k < 3; ++k)
            sums[slot(facets[f].handedness)][first[mesh.triangles[f][k]]] +=
                share_of_corner(mesh, mesh.triangles[f], k, facets[f].direction);
    return sums;
}

Tangent tangent_of(const Vec3& sum, const Vec3f& normal, int handedness) {
    const Vec3 direction = in_plane(sum, Vec3(normal));
    const bool usable = direction.length() > 0.5;
    return {Vec3f(usable ? direction : any_perpendicular(Vec3(normal))), float(handedness)};
}

// Gives each vertex the tangents of both kinds of facets around it: a copy where both are there.
class Twins {
  public:
    Twins(Mesh& mesh, const Sums& sums, const std::vector<Index>& first)
        : mesh_(mesh), sums_(sums), first_(first) {
        for (auto& twin : twins_) twin.resize(mesh.positions.size(), no_index);
    }

    // `vertex` itself for the handedness that is asked for first.
    Index vertex_with(Index vertex, int handedness) {
        Index& twin = twins_[slot(handedness)][vertex];
        if (twin != no_index) return twin;
        twin = vertex;
        if (twins_[slot(-handedness)][vertex] != no_index) twin = copy_of(vertex);
        mesh_.tangents[twin] =
            tangent_of(sums_[slot(handedness)][first_[vertex]], mesh_.normals[vertex], handedness);
        return twin;
    }

    // One that it has; right-handed where it has none or both.
    int handedness_of(Index vertex) const {
        return twins_[0][vertex] == no_index && twins_[1][vertex] != no_index ? -1 : 1;
    }

  private:
    Mesh& mesh_;
    const Sums& sums_;
    const std::vector<Index>& first_;
    // Per vertex, the one that has its data and each handedness.
    std::array<std::vector<Index>, 2> twins_;

    Index copy_of(Index vertex) {
        const auto copy = Index(mesh_.positions.size());
        each_vertex_array(mesh_, [&](auto& values) {
            if (values.empty()) return;
            const auto value = values[vertex];
            values.push_back(value);
        });
        return copy;
    }
};

}  // namespace

void compute_tangents(Mesh& mesh, const ImageMap& map) {
    assert(indices_in_range(mesh));
    if (mesh.texcoords.empty()) return;
    if (mesh.normals.empty()) give_facet_normals(mesh);
    const MemoryClaim claim(mesh.positions.size() * (2 * sizeof(Vec3) + 4 * sizeof(Index)) +
                                mesh.triangles.size() * 2 * sizeof(FacetTangent),
                            "mesh " + mesh.name);
    const std::vector<Index> first = welded_vertices(mesh);
    std::vector<FacetTangent> facets;
    for (const auto& facet : mesh.triangles) facets.push_back(facet_tangent(mesh, map, facet));
    const Sums sums = add_up(mesh, facets, first);

    mesh.tangents.assign(mesh.positions.size(), {});
    Twins twins(mesh, sums, first);
    // Facets without a tangent take what the others need.
    for (const bool usable : {true, false})
        for (std::size_t f = 0; f < facets.size(); ++f) {
            if ((facets[f].handedness != 0) != usable) continue;
            for (Index& corner : mesh.triangles[f])
                corner = twins.vertex_with(corner, usable ? facets[f].handedness
                                                          : twins.handedness_of(corner));
        }
}

}  // namespace penumbra
