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
    std::vector<ModelInfo> models = {};
    Losses losses = {};  ///< what the files said that Scene cannot hold
};

/// Reads glTF 2.0, .gltf or .glb. The scene has only what the file says. Throws Error (input).
Imported read_gltf(const std::filesystem::path& file);

/// Reads Wavefront OBJ with its MTL files. Throws Error (input).
Imported read_obj(const std::filesystem::path& file);

struct LoadOptions {
    std::optional<std::filesystem::path> sidecar = {};  ///< laid over the inputs
    std::vector<std::string> settings = {};             ///< "render.samples=3": any sidecar key
    std::optional<double> penumbra = {};                ///< delta of every source; 0: none
};

/// Reads models (.gltf, .glb, .obj) and sidecars (.toml) into one scene, lays sidecars and settings
/// over it, in the order given, and completes it (see complete()). Throws Error (input, usage).
Imported load_scene(const std::vector<std::filesystem::path>& inputs,
                    const LoadOptions& options = {});

}  // namespace penumbra
