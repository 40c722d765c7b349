// Layers (sidecars and settings) -> changes of a Scene. Each function reads one part of a layer;
// load_scene() calls them in the order in which names must be known.
#pragma once

#include "base/toml/section.h"

#include "penumbra/importers.h"

#include <map>
#include <set>

namespace penumbra {

/// A model file and how it is placed: [[model]], or an input that is a model.
struct Placement {
    std::filesystem::path file = {};
    std::string name = {};
    Vec3 translate = {0, 0, 0};
    Vec3 rotate = {0, 0, 0};  ///< degrees, about x, then y, then z
    Vec3 scale = {1, 1, 1};
    std::optional<Matrix> matrix = {};       ///< instead of the three above
    std::optional<Reference> material = {};  ///< replaces all of the model's
    bool backdrop = false;                   ///< Instance::backdrop of all its instances
    std::optional<Reference> named_by = {};  ///< where a sidecar names the file

    Matrix transform() const;
};

/// Image files by path -> Index into Scene::textures, so that each is read once.
using TextureFiles = std::map<std::filesystem::path, Index>;

/// Materials that a setting made up, with the place of the setting; a typing error unless used.
using NewMaterials = std::map<Index, Reference>;

/// What is to be known about a camera to change it further.
struct CameraAims {
    std::map<Index, Vec3> look_at = {};  ///< given points to look at, by camera
    std::set<Index> framed = {};         ///< cameras that follow the bounds
};

/// Throws Error when the layer has an unknown key at its top level.
void check_top_level(const Layer& layer);

/// [[model]]: appends to `placements`; a setting also changes those that are there.
void read_placements(const Layer& layer, std::vector<Placement>& placements);

/// [material.NAME]: lays over all materials of that name or appends a new one.
void lay_materials(const Layer& layer, Scene& scene, TextureFiles& files, NewMaterials& made);

/// The texture in `file`, relative to the layer, that `key` of the section names.
Index load_texture(Section& section, const std::string& key, const std::string& file, Scene& scene,
                   TextureFiles& files);

/// [render] and [lighting]. Returns whether the picture's size is named.
bool lay_globals(const Layer& layer, Imported& result, TextureFiles& files);

/// [environment].
void lay_environment(const Layer& layer, Scene& scene, TextureFiles& files);

/// [[sphere]] and [[plane]].
void lay_objects(const Layer& layer, Scene& scene);

/// [[light]]: appends.
void lay_lights(const Layer& layer, Scene& scene);

/// A setting's light.N.KEY; lights of the rig of complete() have numbers too.
void edit_lights(const Layer& layer, Scene& scene);

/// [camera]: a sidecar adds a camera or picks one, a setting changes the active one. Without a
/// position the camera is framed on `box`.
void lay_camera(const Layer& layer, Scene& scene, CameraAims& aims, const Bounds& box,
                double aspect);

/// The material of that name. Throws Error when there is none.
Index material_named(const Scene& scene, const Reference& reference);

}  // namespace penumbra
