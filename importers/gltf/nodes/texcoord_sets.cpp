// Images on a second set of texture coordinates. POV-Ray's meshes have one set; where the second is
// an affine function of the first, facet by facet, the image is laid by the first.
#include "base/memory.h"
#include "importers/gltf/material/material.h"
#include "importers/gltf/nodes/mesh.h"
#include "scene/vertex_arrays.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace penumbra::gltf {
namespace {

constexpr std::size_t most_lookups = 64;  // a material and a mesh for each
constexpr double tolerance = 1e-5;        // in texture coordinates

using Corners = std::array<Vec2, 3>;
using Facet = std::array<Index, 3>;

Corners corners_of(const std::vector<Vec2f>& texcoords, const Facet& facet) {
    return {Vec2(texcoords[facet[0]]), Vec2(texcoords[facet[1]]), Vec2(texcoords[facet[2]])};
}

bool leads(const Lookup& t, const Corners& from, const Corners& to) {
    const ImageMap map = {.transform = t};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 found = map_texcoord(map, from[i]);
        // Not the negation, so that NaN does not lead anywhere.
        if (!(std::abs(found.x - to[i].x) <= tolerance && std::abs(found.y - to[i].y) <= tolerance))
            return false;
    }
    return true;
}

// `second` after `first`.
Lookup chained(const Lookup& second, const Lookup& first) {
    const auto& [a, b, c, d, e, f] = second;
    const auto& [p, q, r, s, t, u] = first;
    return {a * p + b * s, a * q + b * t, a * r + b * u + c,
            d * p + e * s, d * q + e * t, d * r + e * u + f};
}

// The affine function that takes the corners `from` to the corners `to`. None where that has no
// inverse, which an ImageMap needs.
std::optional<Lookup> lookup_between(const Corners& from, const Corners& to) {
    const Vec2 a = from[1] - from[0], b = from[2] - from[0];
    const Vec2 p = to[1] - to[0], q = to[2] - to[0];
    const double area = a.cross(b), scale = 1 / area;
    Lookup t = {(p.x * b.y - q.x * a.y) * scale, (q.x * a.x - p.x * b.x) * scale, 0,
                (p.y * b.y - q.y * a.y) * scale, (q.y * a.x - p.y * b.x) * scale, 0};
    // Both may be points; what is found wrong below is refused.
    if (area == 0) t = {1, 0, 0, 0, 1, 0};
    // A facet that shows one point or one line of the image: nearly so.
    if (std::abs(t[0] * t[4] - t[1] * t[3]) < 1e-12) {
        t[0] += tolerance / 8;
        t[4] += tolerance / 8;
    }
    t[2] = to[0].x - t[0] * from[0].x - t[1] * from[0].y;
    t[5] = to[0].y - t[3] * from[0].x - t[4] * from[0].y;
    if (!leads(t, from, to) || std::abs(t[0] * t[4] - t[1] * t[3]) < 1e-14) return std::nullopt;
    return t;
}

// The sets of texture coordinates that OtherSets use, for the vertices of a mesh.
using Sets = std::vector<std::vector<Vec2f>>;

std::optional<Sets> read_sets(const Part& part, const Elements& range,
                              const std::vector<OtherSet>& wanted) {
    Sets sets;
    for (const OtherSet& other : wanted) {
        const std::string name = fmt::format("TEXCOORD_{}", other.texcoord);
        if (attribute(part, name, {TINYGLTF_TYPE_VEC2}) < 0) return std::nullopt;
        sets.push_back(read_texcoord_set(part, name, range));
    }
    return sets;
}

// Facets whose OtherSets follow from the first set in one way, a lookup for each set.
struct Group {
    std::vector<Lookup> lookups = {};
    std::vector<Facet> facets = {};
};

bool belongs(const Group& group, const Facet& facet, const Corners& from, const Sets& sets) {
    for (std::size_t i = 0; i < sets.size(); ++i)
        if (!leads(group.lookups[i], from, corners_of(sets[i], facet))) return false;
    return true;
}

std::optional<std::vector<Group>> grouped(const Mesh& mesh, const Sets& sets) {
    std::vector<Group> groups;
    for (const Facet& facet : mesh.triangles) {
        const Corners from = corners_of(mesh.texcoords, facet);
        auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& known) {
            return belongs(known, facet, from, sets);
        });
        if (group == groups.end()) {
            if (groups.size() == most_lookups) return std::nullopt;
            group = groups.emplace(groups.end());
            for (const auto& set : sets) {
                const auto lookup = lookup_between(from, corners_of(set, facet));
                if (!lookup) return std::nullopt;
                group->lookups.push_back(*lookup);
            }
        }
        group->facets.push_back(facet);
    }
    return groups;
}

Index relaid(Reader& reader, Index original, const std::vector<OtherSet>& others,
             const std::vector<Lookup>& lookups) {
    for (const Relaid& known : reader.cache.relaid)
        if (known.original == original && known.lookups == lookups) return known.material;
    Material material = reader.scene.materials[original];
    for (std::size_t i = 0; i < others.size(); ++i) {
        ImageMap& map = others[i].map(material);
        map.transform = chained(map.transform, lookups[i]);
    }
    reader.scene.materials.push_back(std::move(material));
    const auto index = Index(reader.scene.materials.size() - 1);
    reader.cache.relaid.push_back({original, index, lookups});
    return index;
}

// Those facets of a mesh and their vertices.
Mesh part_of(const Mesh& mesh, std::vector<Facet> facets) {
    std::vector<Index> place(mesh.positions.size(), no_index), chosen;
    for (Facet& facet : facets)
        for (Index& corner : facet) {
            if (place[corner] == no_index) {
                place[corner] = Index(chosen.size());
                chosen.push_back(corner);
            }
            corner = place[corner];
        }
    Mesh part = mesh;
    part.triangles = std::move(facets);
    choose_vertices(part, chosen);
    return part;
}

}  // namespace

std::vector<Mesh> lay_by_one_set(const Part& part, const Elements& range, Mesh mesh) {
    Reader& reader = part.reader;
    const int source = material_on(reader, material_of(reader, part.primitive), part.primitive);
    const auto others = reader.cache.other_sets.find(source);
    const bool textured = !mesh.texcoords.empty();
    std::vector<Mesh> result;
    if (others == reader.cache.other_sets.end() || !textured) {
        result.push_back(std::move(mesh));
        return result;
    }
    const auto sets = read_sets(part, range, others->second);
    auto groups = sets ? grouped(mesh, *sets) : std::nullopt;
    if (!groups) {
        const bool fades = !mesh.alphas.empty();
        mesh.material = with_one_set(reader, source);
        if (fades) mesh.material = fading(reader, mesh.material);
        result.push_back(std::move(mesh));
        return result;
    }
    for (Group& group : *groups) {
        const MemoryClaim claim(2 * memory_of(mesh), part.place());
        const Index material = relaid(reader, mesh.material, others->second, group.lookups);
        result.push_back(part_of(mesh, std::move(group.facets)));
        result.back().material = material;
    }
    return result;
}

}  // namespace penumbra::gltf
