// A scene made ready for tracing: everything that is the same for all rays is computed once.
#pragma once

#include "box_tree.h"
#include "facets.h"
#include "rays.h"
#include "sampler.h"

#include "penumbra/scene.h"

namespace penumbra {

/// A Lobe with its float32 numbers widened.
struct PreparedLobe {
    double specular = 0, shininess = 0;
    double highlight_end = 0;  ///< below this cosine the highlight is nothing
    Vec3 reflection = Vec3(0);
};

/// A Material with its float32 numbers widened and combined with the scene's.
struct Finish {
    const Material* material = nullptr;
    Vec3 ambient = {}, emission = {};      ///< ambient includes Ia
    std::vector<PreparedLobe> lobes = {};  ///< of the material itself, or of its gloss
    double diffuse = 0, metallic = 0;
    double opacity = 1, transmission = 0, ior = 1;
    Vec3 absorption = Vec3(0);  ///< exponent per unit of length
    bool opaque = true, absorbs = false, fresnel = false;
    bool textured = false;
    bool shines = false, mirrors = false;  ///< any lobe does
};

/// A Source with its cosines and unit axis.
struct PreparedSource {
    Light::Type type = Light::Type::point;
    Vec3 position = {}, axis = {}, color = {};
    double cos_inner = 0, cos_outer = 0;
    bool fades = false;
    double fade_distance = 1, fade_power = 2;
};

/// The virtual sources of one Light.
struct SourceGroup {
    std::vector<PreparedSource> sources = {};
    Bounds box = {};                 ///< of their positions
    std::vector<Extent> along = {};  ///< of n . position, for each plane
};

/// A point with normal . p = distance lies on the plane.
struct PreparedPlane {
    PlaneFrame frame = {};
    double distance = 0;
};

struct World {
    const Scene& scene;
    Facets facets;
    BoxTree facet_boxes;                 ///< around runs of facets
    BoxTree sphere_boxes;                ///< items are objects
    Bounds surroundings;                 ///< of facets and spheres: their box, twice as large
    std::vector<Finish> finishes = {};   ///< by material
    std::vector<Sampler> samplers = {};  ///< by texture
    std::vector<SourceGroup> lights = {};
    std::vector<PreparedPlane> planes = {};
    std::vector<Index> translucent_shapes = {};  ///< spheres and planes, as objects
    bool translucent = false;                    ///< any object lets light through
    bool shadows = true;                         ///< else nothing hides a source

    explicit World(const Scene& given);

    // Objects are counted: instances, spheres, planes.
    Index first_sphere() const { return Index(scene.instances.size()); }
    Index first_plane() const { return Index(scene.instances.size() + scene.spheres.size()); }
    Index material_of(Index object) const;
    const Finish& finish_of(Index object) const { return finishes[material_of(object)]; }
    const Sphere& sphere(Index object) const { return scene.spheres[object - first_sphere()]; }
    const PreparedPlane& plane(Index object) const { return planes[object - first_plane()]; }
};

}  // namespace penumbra
