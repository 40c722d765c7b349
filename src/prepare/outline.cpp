#include "prepare/outline.h"

#include "scene/transforms.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace penumbra {

namespace {

Bounds box_around(const Vec3& center, double half) {
    return {.min = center - Vec3(half), .max = center + Vec3(half)};
}

constexpr std::size_t most_corners = 30'000'000;  // that are looked at one by one

std::array<Vec3, 8> corners_of(const Bounds& box) {
    std::array<Vec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i)
        corners[i] = {(i & 1U) != 0 ? box.max.x : box.min.x, (i & 2U) != 0 ? box.max.y : box.min.y,
                      (i & 4U) != 0 ? box.max.z : box.min.z};
    return corners;
}

struct Reach {
    Vec3 direction = {};
    double farthest = -std::numeric_limits<double>::infinity();

    void extend(const Vec3& p) { farthest = std::max(farthest, p.dot(direction)); }
    void extend(const Mesh& mesh) {
        for (const auto& triangle : mesh.triangles)
            for (const Index corner : triangle) extend(Vec3(mesh.positions[corner]));
    }
    void extend(const Bounds& box) {
        for (const Vec3& corner : corners_of(box)) extend(corner);
    }
};

// p . d in the world is m . p + b . d in the mesh's space, with b where its origin lies.
Reach in_mesh(const Vec3& direction, const Matrix& m) {
    return {{m[0][0] * direction.x + m[0][1] * direction.y + m[0][2] * direction.z,
             m[1][0] * direction.x + m[1][1] * direction.y + m[1][2] * direction.z,
             m[2][0] * direction.x + m[2][1] * direction.y + m[2][2] * direction.z}};
}

}  // namespace

Bounds stage(const Scene& scene) {
    Bounds box = bounds(scene);
    if (!box.empty() && box.radius() > 0) return box;
    const Vec3 center = box.empty() ? Vec3(0) : box.center();
    if (!box.empty() || scene.planes.empty()) return box_around(center, 1);
    const Vec3 normal = scene.planes[0].normal.normalized();
    return box_around(scene.planes[0].point + normal * (normal.y < 0 ? -1 : 1), 1);
}

void reaches(const Scene& scene, std::span<const Vec3> directions, std::span<double> farthest) {
    const bool one_by_one = 3 * facet_count(scene) <= most_corners;
    const bool empty = !(bounds(scene).radius() > 0);
    std::vector<Bounds> boxes;
    for (const Mesh& mesh : scene.meshes) boxes.push_back(box_around_facets(mesh));
    for (std::size_t k = 0; k < directions.size(); ++k) {
        const Vec3& d = directions[k];
        Reach all = {d};
        for (const Instance& instance : scene.instances) {
            const Mesh& mesh = scene.meshes[instance.mesh];
            if (mesh.triangles.empty()) continue;
            const Matrix& m = instance.transform;
            const double origin = Vec3(m[3][0], m[3][1], m[3][2]).dot(d);
            // Rounding keeps order: no corner of a facet reaches farther than those of the box.
            Reach own = in_mesh(d, m);
            own.extend(boxes[instance.mesh]);
            if (own.farthest + origin <= all.farthest) continue;
            if (one_by_one) {
                own = in_mesh(d, m);
                own.extend(mesh);
            }
            all.farthest = std::max(all.farthest, own.farthest + origin);
        }
        for (const Sphere& sphere : scene.spheres)
            all.farthest =
                std::max(all.farthest, sphere.center.dot(d) + sphere.radius * d.length());
        if (empty) {
            all = {d};
            all.extend(stage(scene));
        }
        farthest[k] = all.farthest;
    }
}

}  // namespace penumbra
