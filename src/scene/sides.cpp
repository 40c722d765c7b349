#include "scene/sides.h"

#include "scene/defects.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>

namespace penumbra {

namespace {

// Vertices of other colours are textures of their own in POV-Ray, of which there is none for the
// front of a facet whose normal leans away. While few lean they are hidden, and else no back is.
constexpr int most_lean_of_tints = 10;

bool tinted(const Mesh& mesh, const Material& material) {
    const bool takes_colors = std::holds_alternative<std::monostate>(material.pattern) ||
                              std::holds_alternative<ImageMap>(material.pattern);
    const bool faded = !mesh.alphas.empty() && material.alpha_map && !material.alpha_map->cutoff;
    return faded || (takes_colors && std::ranges::any_of(mesh.colors, [](const Color& c) {
                         return c != Color(1);
                     }));
}

// By the matrix of normals, if there is one.
Vec3 turned(const std::optional<Matrix>& normals, const Vec3& direction) {
    if (!normals) return direction;
    Vec3 result;
    normals->multDirMatrix(direction, result);
    return result;
}

// Whole degrees by which the normals of a facet lean away from it.
int lean_of(const Mesh& mesh, const std::array<Index, 3>& corners, const Vec3& front,
            const std::optional<Matrix>& normals) {
    double cosine = 1;
    for (const Index corner : corners) {
        const Vec3 normal = turned(normals, Vec3(mesh.normals[corner]));
        cosine = std::min(cosine, normal.dot(front) / normal.length());
    }
    static const std::array<double, 91> cosines = [] {
        std::array<double, 91> table{};
        for (int i = 0; i < 90; ++i)
            table[std::size_t(i)] = std::cos(radians(i + 0.01));  // rounding
        return table;
    }();
    const auto lean = std::ranges::partition_point(cosines, [&](double c) { return c > cosine; });
    return lean == cosines.end() ? 90 : int(lean - cosines.begin());
}

// The same of a mesh, but for a thousandth of its area: slivers have normals at random.
int lean_of(const Mesh& mesh, const Matrix& to_world) {
    std::array<double, 91> areas{};
    double all = 0;
    std::optional<Matrix> normals;
    if (to_world != Matrix()) normals = to_world.inverse().transposed();
    for (const auto& corners : mesh.triangles) {
        const Vec3 a(mesh.positions[corners[0]]);
        const Vec3 front = turned(
            normals,
            (Vec3(mesh.positions[corners[1]]) - a).cross(Vec3(mesh.positions[corners[2]]) - a));
        const double area = front.length();
        if (!(area > 0)) continue;
        all += area;
        const bool flat = flat_by_normals(mesh, corners);
        areas[std::size_t(flat ? 0 : lean_of(mesh, corners, front / area, normals))] += area;
    }
    int lean = 90;
    for (double rest = areas[90]; lean > 0 && rest <= all / 1000; rest += areas[std::size_t(lean)])
        --lean;
    return lean;
}

Backs backs_of(const Mesh& mesh, const Material& material, const Matrix& to_world) {
    if (material.sides == Sides::both) return {};
    if (!material.smooth || mesh.normals.empty()) return {.hidden = true};
    const int lean = lean_of(mesh, to_world);
    if (tinted(mesh, material)) return {.hidden = lean <= most_lean_of_tints, .lean = lean};
    return {.hidden = lean < 90, .from = lean, .lean = lean};
}

// Does it keep angles?
bool conformal(const Matrix& m) {
    const Vec3 x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]),
        z(m[2][0], m[2][1], m[2][2]);
    const double size = x.dot(x), slack = 1e-6 * size;
    return std::abs(y.dot(y) - size) <= slack && std::abs(z.dot(z) - size) <= slack &&
           std::abs(x.dot(y)) <= slack && std::abs(y.dot(z)) <= slack &&
           std::abs(z.dot(x)) <= slack;
}

}  // namespace

std::vector<Backs> backs(const Scene& scene) {
    assert(indices_in_range(scene));
    std::vector<Backs> found;
    std::vector<std::optional<Backs>> known(scene.meshes.size());
    found.reserve(scene.instances.size());
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const Material& material = scene.materials[mesh.material];
        if (material.sides == Sides::both) {
            found.emplace_back();
        } else if (conformal(instance.transform)) {
            std::optional<Backs>& same = known[instance.mesh];
            if (!same) same = backs_of(mesh, material, Matrix());
            found.push_back(*same);
        } else {
            found.push_back(backs_of(mesh, material, instance.transform));
        }
    }
    return found;
}

}  // namespace penumbra
