// Scene -> what the POV-Ray exporter decides before it writes: names, files, surfaces.
#pragma once

#include "penumbra/error.h"
#include "penumbra/scene.h"

#include <string>
#include <vector>

namespace penumbra::pov {

/// The texels of one axis of an exported image, counted from the left or from the bottom. POV-Ray
/// repeats images and nothing else, so the other kinds of wrapping are made part of the image.
struct BakedAxis {
    int size = 1;   ///< of the texture
    int first = 0;  ///< texel of the wrapped texture that the exported image begins with
    int count = 1;  ///< of the exported image
    double scale() const { return double(count) / size; }
    double shift() const { return double(first) / size; }
    bool operator==(const BakedAxis&) const = default;
};

/// How a Scene::textures entry is exported.
struct TextureFile {
    std::string file = {};  ///< "chair_textures/wood.png"; empty: not used. May serve several
    BakedAxis u = {}, v = {};
};

/// A material on a kind of surface: what becomes one declaration of the .pov.
struct Look {
    /// any: the texture does not depend on the surface (no image).
    enum class Surface { any, mesh, sphere, plane };
    Index material = 0;
    Surface surface = Surface::any;
    PlaneFrame frame = {};  ///< of the plane
    bool tinted = false;    ///< has vertex colours
    std::string name = {};  ///< what its identifiers end in: "wood" of Material_wood
};

/// What tells the textures of vertices apart.
struct Tint {
    Color color = Color(1);  ///< vertex colour times Material::color
    float alpha = 1;         ///< of Mesh::alphas
};

/// How a Scene::meshes entry is exported.
struct MeshPlan {
    std::string name = {};                    ///< what follows "Mesh_"; empty: not drawn
    Index look = 0;                           ///< into Plan::looks
    bool texcoords = false, normals = false;  ///< are needed
    std::vector<Tint> tints = {};             ///< distinct ones of the vertices
    std::vector<Index> tint_of = {};          ///< per vertex, into tints
};

struct Plan {
    const Scene* scene = nullptr;
    std::string stem = {};  ///< begins the names of all files that POV-Ray reads by name
    std::vector<TextureFile> textures = {};
    std::vector<Look> looks = {};
    std::vector<MeshPlan> meshes = {};
    std::vector<Index> spheres = {}, planes = {};  ///< their looks
    Losses losses = {};
};

/// Precondition: defects(scene).empty(). `stem` is FILE without .pov.
Plan make_plan(const Scene& scene, const RenderOptions& render, const std::string& stem);

/// `stem` itself where POV-Ray can open files of this name, else a name that it can: its option
/// parser stumbles over spaces and most punctuation, its file names are ASCII.
std::string safe_stem(const std::string& stem);

/// The samples that are written to the texture's file: RGB, no grey, no alpha.
Raster baked(const Texture& texture, const TextureFile& file);

/// FILE_geometry.inc; empty when the scene has no meshes.
std::string geometry_text(const Plan& plan);

/// The pigment of Scene::sky.
std::string sky_pigment(const Plan& plan);

/// The declaration of a look, the textures it needs included; of a tinted one what its tints share.
std::string look_text(const Plan& plan, const Look& look);

}  // namespace penumbra::pov
