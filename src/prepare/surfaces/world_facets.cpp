#include "prepare/surfaces/world_facets.h"

#include "prepare/body.h"
#include "prepare/scale.h"
#include "scene/transforms.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

WorldFacets::WorldFacets(const Scene& scene, const Bounds& box)
    : scene_(scene), first_{0}, corners_(scene.meshes.size()), bodies_(scene.meshes.size()) {
    if (!box.empty()) origin_ = box.center();
    factor_ = normalising_factor(box);
    std::vector<std::size_t> uses(scene.meshes.size(), 0);
    for (const Instance& instance : scene.instances) ++uses[instance.mesh];
    const bool all = facet_count(scene) <= most_facets;
    for (const Instance& instance : scene.instances) {
        const std::size_t facets = scene.meshes[instance.mesh].triangles.size();
        first_.push_back(first_.back() + Index(all || uses[instance.mesh] == 1 ? facets : 0));
    }
    for (const Instance& instance : scene.instances) {
        mirrored_.push_back(instance.transform.determinant() < 0);
        Matrix placed = instance.transform;
        for (int column = 0; column < 3; ++column) {
            placed[3][column] -= origin_[column];
            for (int row = 0; row < 4; ++row) placed[row][column] *= factor_;
        }
        places_.push_back(placed);
    }
    for (const Mesh& mesh : scene.meshes) boxes_.push_back(box_around(mesh.positions));
}

Index WorldFacets::instance_of(Index facet) const {
    return Index(std::upper_bound(first_.begin(), first_.end(), facet) - first_.begin() - 1);
}

std::optional<WorldFacet> WorldFacets::at(Index instance, Index facet) const {
    const Mesh& mesh = mesh_of(instance);
    const auto& [first, second, third] = mesh.triangles[facet];
    const Matrix& to_here = places_[instance];
    const Vec3 a = moved(mesh.positions[first], to_here),
               b = moved(mesh.positions[second], to_here),
               c = moved(mesh.positions[third], to_here);
    const Vec3 normal = (b - a).cross(c - a);
    const double area = normal.length();
    const double longest = std::max({(b - a).length2(), (c - a).length2(), (c - b).length2()});
    if (!(area * area > longest * (least_overlap * least_overlap)) || !std::isfinite(area))
        return {};
    // A transform that mirrors turns the winding over, not the front.
    return WorldFacet{{a, b, c}, normal / (mirrored_[instance] ? -area : area)};
}

bool WorldFacets::plain(Index instance, Index facet) const {
    const Mesh& mesh = mesh_of(instance);
    const Material& m = material_of(instance);
    if (!opaque(m) || std::holds_alternative<ImageMap>(m.pattern) || m.emission_map ||
        m.specular_lobes || m.normal_map || !mesh.colors.empty())
        return false;
    if (!m.smooth || mesh.normals.empty()) return true;
    // POV-Ray's rule for facets that are flat although they have normals: see docs/povray.md.
    const auto& [a, b, c] = mesh.triangles[facet];
    const Vec3f first = mesh.normals[a];
    return (mesh.normals[b] - first).length2() < 1e-10F &&
           (mesh.normals[c] - first).length2() < 1e-10F;
}

namespace {

// A facet's plane in the space of its mesh; heights within `tolerance` lie in it.
struct MeshPlane {
    Vec3 corner, normal;
    double tolerance;
    double height(const Vec3& p) const { return normal.dot(p - corner); }
};

bool box_behind(const Bounds& box, const MeshPlane& plane) {
    const Vec3 half = (box.max - box.min) * 0.5, n = plane.normal;
    const double middle = plane.height(box.center());
    const double reach = std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z;
    return middle + reach < plane.tolerance && middle - reach < -100 * plane.tolerance;
}

// Do all facets that meet a corner, if there are others, go back from the plane?
bool neighbours_behind(const Mesh& mesh, const MeshCorners& corners, Index facet,
                       const MeshPlane& plane) {
    bool behind = false;
    for (const Index vertex : mesh.triangles[facet])
        for (const Index neighbour : corners.facets_at(vertex))
            for (const Index other : mesh.triangles[neighbour]) {
                const double height = plane.height(Vec3(mesh.positions[other]));
                if (height > plane.tolerance) return false;
                behind |= height < -plane.tolerance;
            }
    return behind;
}

}  // namespace

bool WorldFacets::solid(Index instance, Index facet) const {
    const Mesh& mesh = mesh_of(instance);
    const Index index = scene_.instances[instance].mesh;
    if (material_of(instance).sides == Sides::front) {
        auto& body = bodies_[index];
        if (!body) body = bounds_body(mesh);
        if (!*body) return false;
    }
    const auto& [a, b, c] = mesh.triangles[facet];
    const Vec3 corner(mesh.positions[a]);
    const MeshPlane plane = {
        .corner = corner,
        .normal =
            (Vec3(mesh.positions[b]) - corner).cross(Vec3(mesh.positions[c]) - corner).normalized(),
        .tolerance = 1e-5 * boxes_[index].radius()};
    if (box_behind(boxes_[index], plane)) return true;
    auto& corners = corners_[index];
    if (!corners) corners.emplace(mesh);
    return neighbours_behind(mesh, *corners, facet, plane);
}

}  // namespace penumbra
