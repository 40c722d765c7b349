// Files -> Scene.
#pragma once

#include "penumbra/error.h"
#include "penumbra/scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra {

/// What a model file holds besides its Scene.
struct ModelInfo {
    std::string file = {};    ///< as the user wrote it
    std::string format = {};  ///< "glTF 2.0", "OBJ", "sidecar"
    std::size_t nodes = 0, animations = 0;
    std::vector<std::string> extensions = {};  ///< used by the file
};

struct Imported {
    Scene scene = {};
    RenderOptions render = {};
    /// render.exposure is still to be set to metered_exposure(): asked for, or the light comes from
    /// a glTF file, in physical units, and nobody says how to expose it.
    bool auto_exposure = false;
    std::vector<ModelInfo> models = {};
    Losses losses = {};  ///< what the files said that Scene cannot hold
};

/// Which of the pictures that a model file can give is wanted, and what it may read for that. Only
/// `allowed_paths` matters to OBJ files.
struct ModelOptions {
    std::string scene = {};           ///< name or number; empty: the file's default
    std::string variant = {};         ///< KHR_materials_variants, by name; empty: none
    std::string animation = {};       ///< name or number; empty: the first
    std::optional<double> time = {};  ///< seconds; without it and `animation` the nodes' own pose
    /// Folders below which a model may name files, besides its own.
    std::vector<std::filesystem::path> allowed_paths = {};
};

/// Reads glTF 2.0, .gltf or .glb. The scene has only what the file says. Throws Error (input; usage
/// where `options` name something that the file does not have).
Imported read_gltf(const std::filesystem::path& file, const ModelOptions& options = {});

/// Reads Wavefront OBJ with its MTL files. Throws Error (input).
Imported read_obj(const std::filesystem::path& file, const ModelOptions& options = {});

/// What becomes of normal maps, which POV-Ray does not have.
enum class NormalMaps {
    bake,   ///< vertex normals: bake_normal_maps()
    drop,   ///< left out: drop_normal_maps()
    pixel,  ///< kept, for render(): an export leaves them out. Missing tangents are computed
};

/// Does so. Precondition: that of bake_normal_maps().
Losses settle_normal_maps(Scene& scene, NormalMaps choice);

struct LoadOptions {
    std::optional<std::filesystem::path> sidecar = {};  ///< laid over the inputs
    std::vector<std::string> settings = {};             ///< "render.samples=3": any sidecar key
    std::optional<double> penumbra = {};                ///< delta of every source; 0: none
    ModelOptions model = {};
    NormalMaps normal_maps = NormalMaps::bake;
};

/// Reads models (.gltf, .glb, .obj) and sidecars (.toml) into one scene, lays sidecars and settings
/// over it, in the order given, and completes it (see complete()). Throws Error (input, usage).
Imported load_scene(const std::vector<std::filesystem::path>& inputs,
                    const LoadOptions& options = {});

}  // namespace penumbra
