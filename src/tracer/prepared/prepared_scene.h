// A scene made ready for tracing: everything that is the same for all rays is computed once.
#pragma once

#include "scene/objects.h"
#include "scene/texture/texture_lookup.h"
#include "tracer/accel/box_tree.h"
#include "tracer/accel/facets.h"
#include "tracer/accel/rays.h"

#include "penumbra/light_model.h"
#include "penumbra/scene.h"

#include <memory>
#include <optional>
#include <vector>

namespace penumbra {

/// A SpecularLobe with its float32 numbers widened.
struct PreparedLobe {
    double specular = 0, shininess = 0;
    double highlight_end = 0;  ///< below this cosine the highlight is nothing
    Vec3 reflection = Vec3(0);
    std::vector<Vec3> mirrors = {Vec3(0)};  ///< displacements of the normal: see virtual_mirrors()
};

/// A Coat likewise.
struct PreparedCoat {
    PreparedLobe lobe = {};  ///< its reflection is that at normal incidence
    double grazing = 0;
    bool takes_reflected = false;
};

/// A Sheen likewise.
struct PreparedSheen {
    std::array<float, 17> cover = {};
    Vec3 tint = Vec3(0);
};

/// A Material with its float32 numbers widened and combined with the scene's.
struct PreparedMaterial {
    const Material* source = nullptr;
    Vec3 ambient = {}, emission = {};      ///< ambient includes Ia
    std::vector<PreparedLobe> lobes = {};  ///< of the material itself, or of its specular lobes
    double diffuse = 0, metallic = 0;
    double highlight_metallic = 0;  ///< `metallic` in the M of highlights
    double opacity = 1, transmission = 0, ior = 1;
    Vec3 absorption = Vec3(0);  ///< exponent per unit of length
    bool opaque = true, absorbs = false, fresnel = false;
    bool passes = false;  ///< rays may go on behind it: not opaque, or not there from behind
    bool textured = false;
    bool shines = false, mirrors = false;  ///< any lobe does
    bool blurs = false;                    ///< any lobe has several mirrors
    bool frosts = false;                   ///< see frosts()
    bool conserves = false;                ///< see takes_reflected()
    bool takes_reflected = false;          ///< it, its coat or its sheen
    std::optional<PreparedCoat> coat = {};
    std::optional<PreparedSheen> sheen = {};
    bool backlit = false;                                ///< shows light from behind
    std::shared_ptr<const PreparedMaterial> other = {};  ///< of its Blend
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

    /// Does all of its light go one way?
    bool parallel() const {
        return sources.size() == 1 && sources.front().type == Light::Type::directional;
    }
};

/// A point with normal . p = distance lies on the plane.
struct PreparedPlane {
    PlaneFrame frame = {};
    double distance = 0;
};

/// The virtual sources of every light.
std::vector<SourceGroup> source_groups(const std::vector<Light>& lights,
                                       const std::vector<PreparedPlane>& planes);

/// What takes time to build is shared by copies, so that a copy with something done otherwise is
/// cheap. The Scene must outlive it.
struct PreparedScene {
    const Scene& scene;
    std::shared_ptr<const FacetAccel> facets;
    std::shared_ptr<const BoxTree> facet_boxes;  ///< around runs of facets
    BoxTree translucent_boxes;                   ///< around runs of facets that light passes
    BoxTree sphere_boxes;                        ///< items are objects
    Bounds surroundings;  ///< of facets and spheres: their box, twice as large
    std::vector<PreparedMaterial> materials = {};  ///< by material
    std::vector<TextureLookup> textures = {};      ///< by texture
    std::vector<char> own_textures = {};           ///< by mesh: its vertices have some, and mirrors
    std::vector<SourceGroup> lights = {};
    std::vector<PreparedPlane> planes = {};
    std::vector<Index> translucent_shapes = {};  ///< spheres and planes, as objects
    bool translucent = false;                    ///< any object lets light through
    bool backlit = false;                        ///< any material is
    bool blended = false;                        ///< any material is
    bool bends = false;                          ///< it matters what a ray is inside of
    bool shadows = true;                         ///< else nothing hides a source

    /// Takes over from `earlier`, the same scene before it was changed, what is still right: see
    /// FacetTrees.
    explicit PreparedScene(const Scene& given, const PreparedScene* earlier = nullptr,
                           bool instances_move = false);

    // Objects are counted: instances, spheres, planes.
    Index first_sphere() const { return Index(scene.instances.size()); }
    Index first_plane() const { return Index(scene.instances.size() + scene.spheres.size()); }
    const PreparedMaterial& material_of(Index object) const {
        return materials[material_index(scene, object)];
    }
    /// What a MediumStack holds of an object. To rays that were mirrored an object that blurs is
    /// another one, of which they see a single mirror.
    Index medium_of(Index object, bool mirrored) const {
        return mirrored && material_of(object).blurs ? object + objects() : object;
    }
    const PreparedMaterial& material_in(Index medium) const {
        return material_of(medium < objects() ? medium : medium - objects());
    }
    /// Does what lies behind the object blur?
    bool frosts(Index object) const {
        return material_of(object).frosts &&
               (object >= first_sphere() || own_textures[scene.instances[object].mesh] == 0);
    }
    /// Are mirrors displaced in the space of the mesh, and not in that of the world?
    bool displaces_in_mesh(Index object) const {
        return object < first_sphere() && own_textures[scene.instances[object].mesh] != 0;
    }
    bool casts_shadow(Index object) const {
        return object < first_plane() || scene.planes[object - first_plane()].casts_shadow;
    }
    Index objects() const { return first_plane() + Index(planes.size()); }
    const Sphere& sphere(Index object) const { return scene.spheres[object - first_sphere()]; }
    const PreparedPlane& plane(Index object) const { return planes[object - first_plane()]; }
};

}  // namespace penumbra
