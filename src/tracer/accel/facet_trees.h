// Embree's trees over the facets of a scene.
#pragma once

#include "tracer/accel/embree.h"

#include "penumbra/scene.h"

#include <cstddef>
#include <vector>

namespace penumbra {

inline constexpr unsigned opaque_mask = 1, translucent_mask = 2;

/// Two levels: a mesh that several instances share has a tree of its own, of which the top tree
/// holds instances; the facets of the others lie in the top tree itself, in world space. Where
/// instances move, so has a large mesh that one shows.
class FacetTrees {
  public:
    FacetTrees() = default;
    /// Takes from `earlier`, the trees of a scene before it was changed, what is still right: a
    /// mesh with the same vertices and facets keeps its tree, an instance whose mesh, transform and
    /// opacity are the same its geometry, and where all instances are as they were the top tree
    /// stays. New trees are those that a first build makes. Throws Error (input) where the memory
    /// limit does not allow them.
    explicit FacetTrees(const Scene& scene, const FacetTrees* earlier = nullptr,
                        bool instances_move = false);

    RTCScene top() const { return top_.get(); }
    /// Over all facets that the mask takes, and perhaps others.
    RTCScene over(unsigned mask) const {
        return mask == translucent_mask ? translucent_.get() : top_.get();
    }
    bool instanced() const { return instanced_; }  ///< the top tree holds instances
    bool wide() const { return wide_; }            ///< 16 rays a packet are the best, else 8
    bool same_top(const FacetTrees& other) const { return top_ == other.top_; }
    /// Trees that were built anew, not taken from earlier ones.
    std::size_t built() const { return built_; }
    Bounds bounds() const;

  private:
    // Vertices and facets that Embree has a copy of.
    struct Facets {
        embree::Geometry geometry = {};
        std::size_t vertices = 0, facets = 0;

        Facets() = default;
        Facets(const embree::Device& device, const Mesh& mesh, const Matrix& to_world,
               unsigned mask);
        bool hold(const Mesh& mesh, const Matrix& to_world) const;
    };
    // A mesh that several instances share.
    struct SharedMesh {
        embree::Tree tree = {};
        Facets facets = {};
    };
    // What the top tree holds for an instance of the scene.
    struct Item {
        embree::Geometry geometry = {};
        Facets facets = {};  // that is it, of a mesh that is not shared
        Matrix transform = {};
        Index mesh = no_index;
        bool opaque = true, shared = false;
    };
    Item item_of(const Scene& scene, Index instance, bool shared, const FacetTrees* earlier);
    const Item* same_item(const Scene& scene, const Item& wanted, Index instance) const;
    void add_mesh(const Mesh& mesh, Index index, const FacetTrees* earlier);
    bool same_items(const FacetTrees& other) const;
    embree::Tree tree_over(unsigned mask) const;
    void build_top();

    embree::Device device_ = {};
    embree::Tree top_ = {};
    embree::Tree translucent_ = {};        // the same, of what light passes
    std::vector<SharedMesh> shared_ = {};  // by mesh
    std::vector<Item> items_ = {};         // by instance
    std::vector<Index> instance_of_ = {};  // by mesh: the last one that shows it
    bool instanced_ = false, wide_ = false;
    std::size_t built_ = 0;
};

}  // namespace penumbra
