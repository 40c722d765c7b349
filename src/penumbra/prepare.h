// Scene -> Scene: what is done to a scene before it is rendered or exported.
#pragma once

#include "penumbra/error.h"
#include "penumbra/math.h"
#include "penumbra/render_options.h"
#include "penumbra/scene.h"

#include <cstddef>
#include <span>
#include <string>

namespace penumbra {

/// Gives a scene what a picture needs and its author left out: a material for everything without
/// one, a camera framed on the bounds from front-right-above, and, when it has neither lights nor
/// an environment, a rig of three sources sized to the bounds. `aspect` is width / height.
/// Precondition: that of bounds(), aspect > 0, and where there are cameras scene.camera is one of
/// them or no_index.
void complete(Scene& scene, double aspect);

/// Gives `mesh` the tangents that a normal map at `map` needs: per vertex, in the direction in
/// which u' of the map grows. The bitangent points to where v' grows, that is up in the image, as
/// green does in glTF's normal maps, whose v runs down but whose y is up (glTF 2.0, section 3.9.3).
/// Weighs facets by their angle at the vertex, as MikkTSpace does; vertices where facets of both
/// handednesses meet are split. A mesh without normals gets those of its facets first, each facet
/// then having vertices of its own. Does nothing to a mesh without texture coordinates.
/// Precondition: the facets' indices are in range. Throws Error (input: not enough memory).
void compute_tangents(Mesh& mesh, const ImageMap& map);

/// How far bake_normal_maps() goes.
struct NormalMapBudget {
    std::size_t facets = 500000;  ///< that all meshes with normal maps may have together
    /// Radians. Facets whose interpolated normals are this near to the map's, in the quadratic mean
    /// over the facet, are not divided further.
    double tolerance = 0.01;
};

/// Turns normal maps into vertex normals, which POV-Ray knows: divides the facets of every mesh
/// whose material has one, those with the largest error first, until the budget is reached. Facets
/// are halved on both sides of an edge, so that no cracks open. Normals become the perturbed ones,
/// normalize(scale x T + scale y B + z N), and the other vertex data are interpolated; tangents are
/// not kept. Computes missing tangents and, for flat facets, normals. No material has a normal map
/// afterwards. The losses say, for each material, what was reached.
/// Precondition: defects(scene) finds nothing in meshes and materials. Throws Error (input: too
/// many facets, not enough memory).
Losses bake_normal_maps(Scene& scene, const NormalMapBudget& budget = {});

/// Removes all normal maps; a loss for each material.
Losses drop_normal_maps(Scene& scene);

/// Of opaque facets that lie exactly on one another leaves the last: which of them a ray hits
/// would be a matter of rounding. Instances that share a mesh get one of their own where others
/// want it whole. Returns how many facets went. Precondition: the indices of instances, facets and
/// materials are in range.
std::size_t drop_coincident_facets(Scene& scene);

/// Parts what lies in one plane and overlaps, with light passing through or in part: facets, the
/// scene's planes, and spheres in one place. The later one lies on top, what is blended on all
/// the rest; it is lifted off the other, on the side of its front, by more than POV-Ray's
/// tolerances and less than a pixel. Facets hang together with all of their mesh that they share a
/// plane with. Nothing is done where it cannot be seen: to facets that look alike, and where
/// two bodies touch; nor, in scenes of more than 4 million facets, to meshes that are shown more
/// than once. The losses say what was done.
/// Precondition: that of drop_coincident_facets(). Throws Error (input: not enough memory).
Losses part_surfaces(Scene& scene);

/// Moves one-sided facets that lie exactly on one another and are shown on opposite sides apart,
/// each towards its own side, by four times POV-Ray's least distance: a ray that passed the
/// one which is not there would start where the other is, too near to meet it. Returns how many it
/// moved. Precondition: that of drop_coincident_facets().
std::size_t lift_back_to_back_facets(Scene& scene);

/// A loss for each material whose Sides::front cannot be kept to on some of its meshes: POV-Ray
/// tells the sides of smooth facets by their normals. Nothing is said of meshes that are closed and
/// opaque, whose backs nobody sees from outside. Normal maps are to be settled before.
/// Precondition: that of drop_coincident_facets().
Losses shown_backs(const Scene& scene);

/// What becomes of normal maps, which POV-Ray does not have.
enum class NormalMaps {
    bake,   ///< vertex normals: bake_normal_maps()
    drop,   ///< left out: drop_normal_maps()
    pixel,  ///< kept, for render(): an export leaves them out. Missing tangents are computed
};

/// Does so. Precondition and errors: those of bake_normal_maps().
Losses settle_normal_maps(Scene& scene, NormalMaps choice);

/// Environments of our own, computed and not photographed. A white Lambertian surface that faces
/// most of the light shows about 0.92 in all of them.
enum class Surroundings {
    studio,    ///< soft boxes: key behind the camera to the left, fill to the right, rim beyond
    overcast,  ///< a white sky over grey ground
    sunset,    ///< a low sun to the left of -z, behind who looks there
    night,     ///< coloured lamps around a dark place
};

/// Their names, in their order: "studio", "overcast", "sunset", "night".
std::span<const char* const> surroundings_names();

/// Gives the scene one of them in place of the environment that it has: adds its image to the
/// textures, and sets Environment::name, texture and before_camera. What else an Environment says
/// stays, or is the default. Lights that the scene has stay, too. Throws Error (input: not enough
/// memory).
Environment& set_surroundings(Scene& scene, Surroundings which);

/// Gives the scene an image of its textures as environment, likewise.
Environment& set_environment(Scene& scene, Index texture, const std::string& name);

/// Gives the scene an environment that has one radiance everywhere, likewise.
Environment& set_uniform_environment(Scene& scene, const Color& radiance);

/// Makes of Scene::environment what both renderers have: directional lights, each with the flux of
/// a part of all directions, and a Sky, or a mirror_sky where the camera does not see it. Phong
/// lobes are widened by as much as the lights stand for, so that surfaces do not show them one by
/// one. normalise() does so. Does nothing to a scene without an environment.
/// Precondition: defects(scene) finds nothing in environment, cameras and textures, and that of
/// bounds().
void light_by_environment(Scene& scene);

/// A scene in the units that both renderers work in. POV-Ray's tolerances are absolute, so all
/// lengths are multiplied by one power of two that brings the radius of the bounded geometry into
/// [128, 256); a scene whose middle is farther from the origin than its radius is moved there
/// first, and so is a mesh whose vertices lie as far from the mesh's own origin.
/// An environment becomes lights and a sky: see light_by_environment().
/// Meshes are rescaled by powers of two so that their instances have a scale near 1. Exposure
/// is folded into lights, ambience, emission and background. Material::color is multiplied into
/// the texture (16 bit linear) where POV-Ray cannot layer it: metallic, emissive and translucent
/// surfaces.
struct NormalisedScene {
    Scene scene = {};
    double factor = 1;        ///< user's length * factor = length here
    Vec3 offset = {0, 0, 0};  ///< subtracted, in the user's units, before scaling
};

/// Precondition: defects(scene).empty(). Throws Error (usage: see RenderOptions; input: not enough
/// memory).
NormalisedScene normalise(Scene scene, const RenderOptions& options);

}  // namespace penumbra
