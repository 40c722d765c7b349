// Normal maps -> vertex normals.
#include "base/memory.h"
#include "prepare/normal_baker.h"
#include "scene/defects.h"
#include "scene/vertex_arrays.h"

#include "penumbra/prepare.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cassert>
#include <cmath>
#include <map>
#include <queue>

namespace penumbra {

namespace {

/// A facet of less area in the image is not divided: what is left is the step between texels that
/// are not interpolated.
constexpr double least_texels = 1.0 / 16;

/// Squared distance of normals that POV-Ray takes for equal.
constexpr double flattened = 1e-10;

struct Entry {
    float error = 0;  ///< of the facet, times its area
    Index baker = 0, facet = 0;
    unsigned version = 0;
    bool operator<(const Entry& o) const { return error < o.error; }
};

// All meshes with their facets in one queue: the budget goes to where the error is. Works in
// rounds, so that errors are measured in parallel; the result does not depend on the number of
// threads.
class Bake {
  public:
    Bake(std::vector<NormalBaker>& bakers, const NormalMapBudget& budget)
        : bakers_(bakers), budget_(budget) {
        for (Index b = 0; b < bakers_.size(); ++b) {
            const auto count = Index(bakers_[b].mesh.mesh().triangles.size());
            for (Index facet = 0; facet < count; ++facet) changed_.push_back({b, facet});
            versions_.emplace_back(count, 0);
            facets_ += count;
        }
        measure_changed();
    }

    void divide() {
        while (!queue_.empty() && facets_ < budget_.facets) {
            const std::vector<Entry> worst = take_worst(std::clamp<std::size_t>(
                queue_.size() / 16, 1, std::min<std::size_t>(4096, budget_.facets - facets_)));
            for (const Entry& entry : worst)
                if (is_current(entry) && facets_ < budget_.facets) divide(entry);
            measure_changed();
            for (const Entry& entry : worst)
                if (is_current(entry)) queue_.push(entry);  // only a neighbour was halved yet
        }
    }

  private:
    struct Changed {
        Index baker = 0, facet = 0;
        unsigned version = 0;
        FacetError error = {};
    };

    std::vector<NormalBaker>& bakers_;
    const NormalMapBudget& budget_;
    std::priority_queue<Entry> queue_;
    std::vector<std::vector<unsigned>> versions_;  // of facets: how often each was halved
    std::vector<Changed> changed_;                 // in this round
    std::vector<Index> halved_;
    std::size_t facets_ = 0;

    bool is_current(const Entry& e) const { return versions_[e.baker][e.facet] == e.version; }

    std::vector<Entry> take_worst(std::size_t count) {
        std::vector<Entry> worst;
        for (; worst.size() < count && !queue_.empty(); queue_.pop())
            if (is_current(queue_.top())) worst.push_back(queue_.top());
        return worst;
    }

    void divide(const Entry& entry) {
        NormalBaker& baker = bakers_[entry.baker];
        facets_ -= baker.mesh.mesh().triangles.size();
        halved_.clear();
        baker.mesh.divide(entry.facet, halved_);
        facets_ += baker.mesh.mesh().triangles.size();
        std::vector<unsigned>& versions = versions_[entry.baker];
        versions.resize(baker.mesh.mesh().triangles.size(), 0);
        for (const Index facet : halved_)
            changed_.push_back({entry.baker, facet, ++versions[facet]});
    }

    void measure_changed() {
        for (NormalBaker& baker : bakers_) add_normals(baker);
        std::erase_if(changed_,
                      [&](const Changed& c) { return versions_[c.baker][c.facet] != c.version; });
        tbb::parallel_for(std::size_t(0), changed_.size(), [&](std::size_t i) {
            changed_[i].error = error_of(bakers_[changed_[i].baker], changed_[i].facet);
        });
        for (const Changed& c : changed_) enqueue(c);
        changed_.clear();
    }

    void enqueue(const Changed& c) {
        const double tolerated = budget_.tolerance * budget_.tolerance;
        const NormalBaker& baker = bakers_[c.baker];
        if (c.error.mean > tolerated && texels_on(baker, c.facet) > least_texels)
            queue_.push({float(c.error.mean * c.error.area), c.baker, c.facet, c.version});
    }
};

// Says whether POV-Ray would draw the facet flat, with a normal that is not the one given: it does
// so when the three normals are nearly equal (source/backend/parser/parse.cpp of 3.7, Parse_Mesh2).
bool would_be_flattened(const Mesh& mesh, const std::array<Index, 3>& facet) {
    const auto& [a, b, c] = facet;
    const Vec3 normal(mesh.normals[a]);
    const auto close = [&](Index i) {
        return (Vec3(mesh.normals[i]) - normal).length2() <= flattened;
    };
    if (!close(b) || !close(c)) return false;
    const Vec3 first(mesh.positions[a]);
    const Vec3 flat =
        (Vec3(mesh.positions[b]) - first).cross(Vec3(mesh.positions[c]) - first).normalized();
    return flat.cross(normal).length2() > flattened;
}

// Turns one normal of each such facet by a few units of what POV-Ray tells apart.
void keep_interpolated(Mesh& mesh) {
    std::vector<unsigned char> turns(mesh.normals.size(), 0);
    for (int pass = 0; pass < 8; ++pass) {
        bool clean = true;
        for (const auto& facet : mesh.triangles) {
            if (!would_be_flattened(mesh, facet)) continue;
            clean = false;
            const Index corner = *std::min_element(
                facet.begin(), facet.end(), [&](Index a, Index b) { return turns[a] < turns[b]; });
            const Vec3 normal(mesh.normals[corner]);
            const Vec3 axis = std::abs(normal.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
            const double angle = 2 * std::sqrt(flattened) * ++turns[corner];
            mesh.normals[corner] =
                Vec3f((normal + normal.cross(axis).normalized() * angle).normalized());
        }
        if (clean) return;
    }
}

// 12345 as "12,345".
std::string grouped(std::size_t number) {
    const std::string digits = std::to_string(number);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
        text += digits[i];
    }
    return text;
}

// What became of one material's meshes.
struct Outcome {
    std::size_t given = 0, made = 0;  // facets
    double angles = 0, area = 0;      // sum of mean angle x area

    Loss loss(const std::string& material) const {
        return {Loss::approximated, material,
                fmt::format("its normal map is baked into vertex normals: {} facets became {}, "
                            "mean error {:.1f} "
                            "degrees",
                            grouped(given), grouped(made),
                            area > 0 ? degrees(angles / area) : 0.0)};
    }
};

// The area of each mesh in the world, over its own.
std::vector<double> magnifications(const Scene& scene) {
    std::vector<double> result(scene.meshes.size(), 0);
    for (const Instance& i : scene.instances)
        result[i.mesh] += std::pow(std::abs(i.transform.determinant()), 2.0 / 3);
    return result;
}

std::string name_of(const Scene& scene, Index material) {
    const std::string& name = scene.materials[material].name;
    return name.empty() ? fmt::format("material {}", material) : name;
}

// Makes `mesh`, of a material that is smooth from now on, look as it did.
void keep_unmapped(const Material& material, Mesh& mesh, Losses& losses) {
    if (!material.smooth) mesh.normals.clear();
    losses.push_back({Loss::dropped, mesh.name,
                      fmt::format("has no texture coordinates for the normal map of "
                                  "material '{}'; it is left out",
                                  material.name)});
}

// Facets and their sides are numbered, and take several times what the mesh takes.
MemoryClaim claim_for(const Mesh& mesh) {
    constexpr std::size_t copies = 4, facet = 96;
    const std::string place = "mesh " + mesh.name;
    if (mesh.triangles.size() >= no_index / 3 - 1)
        throw Error(Failure::input, place, "has too many facets for a normal map");
    return {copies * memory_of(mesh) + facet * mesh.triangles.size(), place};
}

// Takes the maps off the materials, and says what was reached.
Losses conclude(Scene& scene, const std::map<Index, Outcome>& outcomes) {
    Losses losses;
    for (Mesh& mesh : scene.meshes)
        if (mesh.texcoords.empty() && mesh.material < scene.materials.size() &&
            scene.materials[mesh.material].normal_map)
            keep_unmapped(scene.materials[mesh.material], mesh, losses);
    for (const auto& [material, outcome] : outcomes)
        losses.push_back(outcome.loss(name_of(scene, material)));
    for (Material& material : scene.materials) {
        if (!material.normal_map) continue;
        material.normal_map.reset();
        material.smooth = true;
    }
    return losses;
}

}  // namespace

Losses bake_normal_maps(Scene& scene, const NormalMapBudget& budget) {
    assert(surface_defects(scene).empty());
    complete_tangents(scene);
    const std::vector<double> magnification = magnifications(scene);
    std::map<Index, TextureLookup> lookups;  // by texture
    std::map<Index, Outcome> outcomes;       // by material
    std::vector<NormalBaker> bakers;
    std::vector<Index> baked;
    std::vector<MemoryClaim> claims;
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        Mesh& mesh = scene.meshes[i];
        if (!has_normal_map(scene, mesh) || magnification[i] == 0) continue;
        const NormalMap& map = *scene.materials[mesh.material].normal_map;
        const auto found =
            lookups.try_emplace(map.map.texture, scene.textures[map.map.texture]).first;
        outcomes[mesh.material].given += mesh.triangles.size();
        claims.push_back(claim_for(mesh));
        bakers.push_back({map, found->second, magnification[i], Subdivision(std::move(mesh))});
        baked.push_back(Index(i));
    }
    Bake(bakers, budget).divide();
    for (std::size_t i = 0; i < bakers.size(); ++i) {
        const MeshError error = fit_normals(bakers[i]);
        Mesh& mesh = scene.meshes[baked[i]];
        mesh = std::move(bakers[i].mesh.mesh());
        mesh.normals = std::move(bakers[i].normals);
        mesh.tangents.clear();
        keep_interpolated(mesh);
        Outcome& outcome = outcomes[mesh.material];
        outcome.made += mesh.triangles.size();
        outcome.angles += error.angle * error.area;
        outcome.area += error.area;
    }
    return conclude(scene, outcomes);
}

}  // namespace penumbra
