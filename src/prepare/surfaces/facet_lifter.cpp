#include "prepare/surfaces/facet_lifter.h"

#include "prepare/weld.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace penumbra {

namespace {

// What the facets of a vertex want; nothing is known where they lie on nothing.
struct Wanted {
    double level = 0;
    bool known = false, torn = false;
};

// A facet pulls a vertex along its normal.
struct Pull {
    Index vertex = 0;
    Vec3 normal = {};  // in the world, unit
    double level = 0;
    bool torn = false;
};

using Pulls = std::unordered_map<Vec3f, std::vector<Pull>, PointHash>;

// Out of the front in the world, unit; 0 for a facet without area.
Vec3 front_of(const Mesh& mesh, const Matrix& transform, Index facet) {
    const auto& [a, b, c] = mesh.triangles[facet];
    const Vec3 first = Vec3(mesh.positions[a]) * transform;
    const Vec3 normal = (Vec3(mesh.positions[b]) * transform - first)
                            .cross(Vec3(mesh.positions[c]) * transform - first)
                            .normalized();
    return transform.determinant() < 0 ? -normal : normal;
}

std::vector<Wanted> wanted_by_vertices(const Mesh& mesh, const std::vector<LevelledFacet>& facets) {
    std::vector<Wanted> result(mesh.positions.size());
    for (const LevelledFacet& f : facets)
        for (const Index vertex : mesh.triangles[f.facet]) {
            Wanted& wanted = result[vertex];
            if (std::abs(f.level) > std::abs(wanted.level)) wanted.level = f.level;
            wanted.known = true;
            wanted.torn |= f.torn;
        }
    return result;
}

Pulls pulls_of(const Mesh& mesh, const Matrix& transform,
               const std::vector<LevelledFacet>& facets) {
    Pulls pulls;
    for (const LevelledFacet& f : facets) {
        if (f.level == 0) continue;
        const Vec3 front = front_of(mesh, transform, f.facet);
        for (const Index vertex : mesh.triangles[f.facet])
            pulls[mesh.positions[vertex]].push_back(
                {vertex, f.turned ? -front : front, f.level, f.torn});
    }
    return pulls;
}

// Of the pulls at a vertex's position those that it follows: of its own facets and of others on the
// same level. A vertex of neither goes with the lowest, so that no gap opens.
std::vector<Pull> pulls_to_follow(Index vertex, const Wanted& wanted, std::vector<Pull> pulls) {
    std::erase_if(pulls,
                  [&](const Pull& p) { return p.vertex != vertex && p.torn != wanted.torn; });
    if (pulls.empty()) return pulls;
    const auto lowest = [](const Pull& a, const Pull& b) {
        return std::abs(a.level) < std::abs(b.level);
    };
    const double level =
        wanted.known ? wanted.level : std::ranges::min_element(pulls, lowest)->level;
    std::erase_if(pulls, [&](const Pull& p) { return p.vertex != vertex && p.level != level; });
    return pulls;
}

// The shortest way that lifts all planes by their heights, by Kaczmarz' method: each in turn is
// satisfied from where the others left off. Planes that are nearly parallel are met in the mean.
Vec3 way_of(const std::vector<Pull>& pulls, double step) {
    Vec3 way(0);
    double longest = 0;
    for (int pass = 0; pass < 16; ++pass)
        for (const Pull& pull : pulls) {
            way += pull.normal * (pull.level * step - pull.normal.dot(way));
            longest = std::max(longest, 4 * std::abs(pull.level) * step);
        }
    // Spikes would grow without bound.
    const double length = way.length();
    return length > longest ? way * (longest / length) : way;
}

}  // namespace

void lift(Mesh& mesh, const Matrix& transform, const std::vector<LevelledFacet>& facets,
          double step) {
    const std::vector<Wanted> wanted = wanted_by_vertices(mesh, facets);
    const Pulls pulls = pulls_of(mesh, transform, facets);
    const Matrix to_mesh = transform.inverse();
    for (Index vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        if (wanted[vertex].known && wanted[vertex].level == 0) continue;
        Vec3f& position = mesh.positions[vertex];
        const auto found = pulls.find(position);
        if (found == pulls.end()) continue;
        const Vec3 way = way_of(pulls_to_follow(vertex, wanted[vertex], found->second), step);
        Vec3 in_mesh;
        to_mesh.multDirMatrix(way, in_mesh);
        position = Vec3f(Vec3(position) + in_mesh);
    }
}

}  // namespace penumbra
