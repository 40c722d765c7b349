// Scene -> what the POV-Ray exporter decides before it writes: names, files, surfaces.
#pragma once

#include "scene/sides.h"

#include "penumbra/error.h"
#include "penumbra/exporters.h"
#include "penumbra/light_model.h"
#include "penumbra/render_options.h"
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
    bool other = false;     ///< the other look of a Blend
    bool mirrored = false;  ///< as rays see it that were mirrored: see blurs()
    std::string name = {};  ///< what its identifiers end in: "wood" of Material_wood
    Index twin = no_index;  ///< into Plan::looks: the same, mirrored; of looks that blur
};

/// What tells the textures of vertices apart.
struct Tint {
    Color color = Color(1);  ///< vertex colour times Material::color
    float alpha = 1;         ///< of Mesh::alphas
    Color other = Color(1);  ///< vertex colour times the colour of a Blend's other look
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
    /// What identifiers carry that stand in scenes by others, "chair" of Material_chair__wood;
    /// empty in a scene of its own. No two underscores in a row.
    std::string model = {};
    std::vector<TextureFile> textures = {};
    std::vector<Look> looks = {};
    std::vector<MeshPlan> meshes = {};
    std::vector<Index> spheres = {}, planes = {};  ///< their looks
    std::vector<Backs> backs = {};                 ///< of instances
    Losses losses = {};
};

/// Precondition: defects(scene).empty(). Throws Error (usage), see RenderOptions. `stem` is FILE
/// without .pov.
Plan make_plan(const Scene& scene, const RenderOptions& render, const std::string& stem,
               PovStyle style = PovStyle::standalone);

/// Whether a texture is needed of surfaces that are not there.
bool needs_nothing(const Plan& plan);

/// Whether what is written will stand in a scene by others, whose #default must not show.
inline bool in_other_scenes(const Plan& plan) { return !plan.model.empty(); }

/// What the look shows.
const Material& material_of(const Plan& plan, const Look& look);

/// Does the look blur what is seen through it?
inline bool frosted(const Plan& plan, const Look& look) {
    return !look.tinted && frosts(material_of(plan, look));
}

/// "Material_wood", or "Material_chair__wood" in scenes by others.
std::string identifier(const Plan& plan, const char* kind, const std::string& name);

/// "Nothing", or "Nothing_chair" in scenes by others.
std::string identifier(const Plan& plan, const char* only);

/// `stem` itself where POV-Ray can open files of this name, else a name that it can: its option
/// parser stumbles over spaces and most punctuation, its file names are ASCII.
std::string safe_stem(const std::string& stem);

/// `stem` as a part of identifiers without two underscores in a row; different ones stay different.
std::string safe_identifier(const std::string& stem);

}  // namespace penumbra::pov
