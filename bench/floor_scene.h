// A scene as the floor needs it: in Embree, in float32, with what decides where rays go.
#pragma once

#include "tracer/accel/embree.h"

#include "penumbra/scene.h"

#include <array>
#include <vector>

namespace penumbra::bench {

/// What a hit needs to know of the instance or the spheres that it lies on, by Embree's geometry.
struct Placed {
    const std::array<Index, 3>* triangles = nullptr;
    const Vec3f* normals = nullptr;      ///< per vertex; null: the facet's own
    std::array<Vec3f, 3> to_world = {};  ///< columns of the matrix for normals
    bool moved = false;                  ///< normals need `to_world`
    bool mirrors = false;
    std::vector<unsigned char> each = {};  ///< of spheres: does this one mirror?
    std::vector<Vec3f> own_normals = {};   ///< where the transform was applied before
};

struct FlatPlane {
    Vec3f normal = Vec3f(0);
    float distance = 0;  ///< normal . p = distance
    bool mirrors = false;
};

struct FloorScene {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<RTCScene> shared = {};  ///< of the meshes with several instances
    std::vector<Placed> placed = {};    ///< by geometry; the spheres last
    std::vector<FlatPlane> planes = {};
    std::vector<Vec3f> sources = {};
    bool instanced = false;

    FloorScene() = default;
    FloorScene(const FloorScene&) = delete;
    FloorScene& operator=(const FloorScene&) = delete;
    ~FloorScene();
};

/// Fills `out` and builds the hierarchy with so many threads. Throws Error (input) where the scene
/// has more than opaque surfaces and point lights. `scene` must outlive `out`.
void build(const Scene& scene, int threads, FloorScene& out);

}  // namespace penumbra::bench
