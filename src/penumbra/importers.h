// Files -> Scene.
#pragma once

#include "penumbra/error.h"
#include "penumbra/light_model.h"
#include "penumbra/prepare.h"
#include "penumbra/render_options.h"
#include "penumbra/scene.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// A kind of model files that load_scene() reads.
struct Format {
    std::string name = {};                     ///< "glTF 2.0"
    std::vector<std::string> extensions = {};  ///< in lower case: ".gltf", ".glb"
};

/// All of them. Sidecars (.toml) are none: they are laid over models.
std::span<const Format> formats();

/// What a model file holds besides its Scene.
struct ModelInfo {
    std::string file = {};    ///< as the user wrote it
    std::string format = {};  ///< Format::name, or "sidecar"
    std::size_t nodes = 0, animations = 0;
    std::vector<std::string> extensions = {};  ///< used by the file
};

struct Imported {
    Scene scene = {};
    RenderOptions render = {};
    /// render.exposure is still to be set to metered_exposure(): asked for, or the light comes from
    /// a glTF file, in physical units, and nobody says how to expose it.
    bool auto_exposure = false;
    /// Scene::background stands for what nobody has said: it is to be seen as it is, whatever
    /// render.exposure will be.
    bool plain_background = false;
    bool sampled = false;  ///< a sidecar or a setting says where rays go through a pixel
    std::vector<ModelInfo> models = {};
    /// The files that it comes from: those that were read, and those that models name besides,
    /// wherever they are there. None of them may be overwritten: see ExportOptions::inputs.
    std::vector<std::filesystem::path> files = {};
    Losses losses = {};  ///< what the files said that Scene cannot hold
    Illumination illumination = Illumination::lamps;  ///< that its surfaces were made for
};

/// Which of the pictures that a model file can give is wanted, and what it may read for that: to
/// OBJ files only the latter matters.
struct ModelOptions {
    std::string scene = {};      ///< name or number; empty: the file's default
    std::string variant = {};    ///< KHR_materials_variants, by name; empty: none
    std::string animation = {};  ///< name or number; empty: the first
    /// Seconds, finite; without it and `animation` the nodes' own pose.
    std::optional<double> time = {};
    /// Where the light will come from: surfaces of metalness and roughness are imitated in another
    /// way by few lamps than by an environment.
    Illumination illumination = Illumination::lamps;
    /// Folders below which a model may name files, besides its own. A model in memory has none of
    /// its own.
    std::vector<std::filesystem::path> allowed_paths = {};
    /// How a program's user allows one, for messages about files that lie elsewhere.
    std::string how_to_allow = {};
};

// The readers give a scene with only what the file says; complete() makes a picture of it. They
// throw Error
// - (input) where the file, or a buffer that it needs, is missing, cannot be opened, has more than
//   4 GiB, is malformed, needs what penumbra cannot do, or needs more memory than memory_limit()
//   leaves; the place names the file and where in it. Images and MTL files that cannot be had, and
//   files that the model may not read, are losses, unless it is a buffer of a glTF file;
// - (usage) where ModelOptions name a scene, variant or animation that the file does not have, or a
//   time that is not finite.
// What no limit foresees may end in std::bad_alloc.
//
// A model in memory is `bytes`, which need to live during the call only. `name` stands for its file
// in messages and in ModelInfo, and files that it refers to are looked for relative to the folder
// of `name`, as if it lay there. It reads none of them but those below ModelOptions::allowed_paths:
// with that folder in it the scene is that of the file, without it a model must bring everything in
// its GLB chunk or in data: URIs.

/// Reads glTF 2.0, .gltf or .glb.
Imported read_gltf(const std::filesystem::path& file, const ModelOptions& options = {});
Imported read_gltf(std::span<const std::byte> bytes, const std::string& name,
                   const ModelOptions& options = {});

/// Reads Wavefront OBJ with its MTL files. Of `options` only `allowed_paths` matters.
Imported read_obj(const std::filesystem::path& file, const ModelOptions& options = {});
Imported read_obj(std::span<const std::byte> bytes, const std::string& name,
                  const ModelOptions& options = {});

/// What a scene without lights gets; with lights, but neither an environment nor a background, it
/// stands before a grey that is the background but with `black`.
enum class Studio {
    black,  ///< a rig of three lights, in the dark
    plain,  ///< Surroundings::studio, before a plain background
    floor,  ///< and a seamless floor, unless it would hide something: see Environment::stage
};

struct LoadOptions {
    std::optional<std::filesystem::path> sidecar = {};  ///< laid over the inputs
    /// "render.samples=3": any sidecar key. Errors say "setting 'render.samples=3': ...".
    std::vector<std::string> settings = {};
    std::optional<double> penumbra = {};  ///< delta of every source; 0: none
    /// Material::sides of all models, in place of what they say; sidecars and settings lie over it.
    std::optional<Sides> sides = {};
    ModelOptions model = {};
    NormalMaps normal_maps = NormalMaps::bake;
    Studio studio = Studio::black;
    int studio_sources = 64;          ///< of that environment
    std::optional<int> sources = {};  ///< of any environment: 0 to most_sources
};

/// Reads models (see formats()) and sidecars (.toml) into one scene, lays sidecars and settings
/// over it, in the order given, and completes it (see complete()); defects() finds nothing in what
/// is returned. Throws Error
/// - (usage) without any input; where `penumbra` is negative or not finite, an allowed path is no
///   folder, or a setting is malformed or names what is not there; and as the readers;
/// - (input) where an input is missing or of no known format, a sidecar is malformed or names what
///   is not there, or the scene has defects(); and as the readers.
Imported load_scene(const std::vector<std::filesystem::path>& inputs,
                    const LoadOptions& options = {});

}  // namespace penumbra
