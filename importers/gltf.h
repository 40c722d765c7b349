// glTF file -> Scene, in steps: bytes -> checked JSON -> Document -> meshes, materials, nodes.
//
// tinygltf turns the JSON into structures; it is given a JSON without buffers and images, so that
// it never opens a file. Everything that refers to something is checked before (gltf_check.cpp),
// so that after open_document() every index is in range and every accessor within its buffer.
// Compressed data are decompressed there as well; what comes later sees plain accessors only.
#pragma once

#include "gltf_pose.h"
#include "image_store.h"
#include "model_folders.h"

#include "penumbra/importers.h"

#include <nlohmann/json_fwd.hpp>
#include <tiny_gltf.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra::gltf {

using Bytes = std::span<const std::byte>;

/// An image as the file describes it; its bytes are fetched when a material wants them.
struct ImageSource {
    std::string name = {};
    std::string uri = {};  ///< empty: in `view`
    int view = -1;         ///< into Model::bufferViews
};

/// A glTF file whose references can be trusted.
struct Document {
    std::string file = {};                             ///< as the user wrote it
    ModelFolders folders = {};                         ///< where its other files are
    tinygltf::Model model = {};                        ///< without buffers and images
    std::vector<std::vector<std::byte>> storage = {};  ///< owns what `buffers` refer to
    std::vector<Bytes> buffers = {};                   ///< empty: the file gives no content
    std::vector<ImageSource> images = {};

    /// Where a person can look: "box.gltf#/meshes/0".
    std::string place(const std::string& pointer) const { return file + '#' + pointer; }
};

// ---- gltf_document.cpp ------------------------------------------------------------------------

/// Reads and checks `file`; buffers are loaded, images are not. Throws Error (input).
Document open_document(const std::filesystem::path& file, const ModelOptions& options,
                       Losses& losses);

/// The bytes of an image. Throws Error (input).
std::vector<std::byte> image_bytes(const Document& document, const ImageSource& image,
                                   const std::string& place);

// ---- gltf_container.cpp -----------------------------------------------------------------------

/// The two parts of a glTF file; `bin` is empty where there is no BIN chunk.
struct Container {
    std::string_view json = {};
    Bytes bin = {};
};

/// Splits a .glb, or takes all of `content` as JSON. Throws Error (input).
Container split_container(Bytes content, const std::string& file, Losses& losses);

// ---- gltf_json.cpp ----------------------------------------------------------------------------

/// Parses JSON; extras and what is nested deeper than any glTF are left out, long names are cut.
/// Throws Error (input).
nlohmann::json parse_json(std::string_view text, const std::string& file, Losses& losses);

// ---- gltf_meshopt.cpp, gltf_meshopt_vertices.cpp, gltf_draco.cpp ------------------------------

/// Decompresses the buffer views that EXT_ or KHR_meshopt_compression compresses, each into a
/// buffer of its own. Throws Error (input).
void decode_meshopt(Document& document, nlohmann::json& root);

/// By buffer: whether it only serves programs that cannot decompress, and need not be read.
/// Precondition: check_schema() passed.
std::vector<bool> fallback_buffers(const nlohmann::json& root);

/// The bytes of `count` elements of `stride` bytes, a multiple of 4 up to 256, from the attribute
/// codec of KHR_meshopt_compression, version 1. None where `data` are not valid.
std::vector<std::byte> decode_vertices_v1(Bytes data, std::size_t count, std::size_t stride);

/// Decompresses the primitives that KHR_draco_mesh_compression compresses, into accessors of their
/// own. Throws Error (input).
void decode_draco(Document& document, nlohmann::json& root, Losses& losses);

// ---- gltf_uri.cpp -----------------------------------------------------------------------------

/// The bytes that `uri` stands for: a data: URI, or a file in `folders`. Throws Error (input).
std::vector<std::byte> fetch(const std::string& uri, const ModelFolders& folders,
                             const std::string& place);

// ---- gltf_asset.cpp, gltf_check.cpp, gltf_layout.cpp -------------------------------------------

/// Refuses versions and required extensions that are not supported. Throws Error (input).
void check_asset(const nlohmann::json& root, const std::string& file, Losses& losses);

/// Checks types, references and numbers of the whole document against the glTF 2.0 schema, writes
/// whole numbers as integers and clamps factors. Throws Error (input).
void check_schema(nlohmann::json& root, const std::string& file, Losses& losses);

/// Checks that accessors lie in their buffer views and these in their buffers, and that the nodes
/// form trees; names accessors that are not aligned and nodes with two transforms. Precondition:
/// check_schema() passed. Throws Error (input).
void check_layout(const nlohmann::json& root, const std::string& file, Losses& losses);

/// `text` on one line: control characters become '?', long texts are cut.
std::string printable(std::string_view text);

// ---- gltf_accessor.cpp ------------------------------------------------------------------------

/// Some elements of an accessor: [first, first + count), or those that are chosen.
struct Range {
    std::size_t first = 0, count = 0;
    std::span<const Index> chosen = {};  ///< `count` of them, ascending; empty: all of the range

    /// The number of the i-th of them in the accessor.
    std::size_t operator[](std::size_t i) const {
        return chosen.empty() ? first + i : std::size_t(chosen[i]);
    }
    /// `length` of them from the `start`-th on.
    Range part(std::size_t start, std::size_t length) const {
        return {.first = first + start,
                .count = length,
                .chosen = chosen.empty() ? chosen : chosen.subspan(start, length)};
    }
};

/// Writes the first `width` components of each element as floats, one element after the other.
/// Integers are normalised if the accessor says so. Throws Error (input) where a float is not
/// finite or a buffer has no content. Precondition: range and width fit the accessor.
void read_floats(const Document& document, int accessor, const Range& range, int width, float* out);

/// Writes all elements of a SCALAR accessor of unsigned integers. Throws Error (input).
void read_indices(const Document& document, int accessor, Index* out);

/// Number of components of the accessor's type.
int components(const tinygltf::Accessor& accessor);

// ---- gltf_loss.cpp ----------------------------------------------------------------------------

/// What many primitives may have in common, said once.
struct PrimitiveLoss {
    std::string what = {};     ///< a sentence, or with `things` the word for one of them
    std::string pointer = {};  ///< to the first primitive
    std::size_t primitives = 0;
    std::optional<std::size_t> things = {};  ///< so many are ignored
};

// ---- gltf_material.cpp ------------------------------------------------------------------------

/// The images of one surface that bake_polish() made, for all materials with the same ones.
struct BakedPolish {
    Index scattered = no_index;  ///< into Scene::textures; none: the base colour stays
    Gloss gloss = {};            ///< without transforms
};

/// An image of a material that is laid by other texture coordinates than the first one.
struct OtherSet {
    int texcoord = 0;  ///< n of TEXCOORD_n
    ImageMap& (*map)(Material&) = nullptr;
};

/// A map from texture coordinates to others, as ImageMap::transform.
using Lookup = std::array<double, 6>;

/// A material whose OtherSets are looked up by the first texture coordinates.
struct Relaid {
    Index original = no_index, material = no_index;
    std::vector<Lookup> lookups = {};
};

/// What the materials have come to so far.
struct Looks {
    std::map<int, Index> materials = {};   ///< by glTF index; -1: the default one
    std::map<int, Index> untextured = {};  ///< the same without images
    std::map<int, Index> one_set = {};     ///< the same with the images of the first TEXCOORD_n
    std::map<Index, Index> fading = {};    ///< by material: the same with a coverage
    std::map<int, std::vector<OtherSet>> other_sets = {};  ///< by glTF index
    std::vector<Relaid> relaid = {};
    std::map<int, int> texcoords = {};  ///< n of TEXCOORD_n by glTF index; absent: no images
    std::map<std::string, Index> textures = {};  ///< by image, sampling and use
    std::map<std::string, BakedPolish> polishes = {};
    ImageStore store = {};           ///< by number
    std::map<int, int> images = {};  ///< by texture: the one that can be read; -1: none
    std::map<std::pair<int, bool>, Color> means = {};  ///< by texture, and whether it is sRGB
    std::map<std::string, std::pair<std::size_t, int>> told = {};  ///< into losses, and how often
};

/// What reading has produced so far, and what of the file it came from.
struct Reader {
    const Document& document;
    Scene& scene;
    Losses& losses;
    const ModelOptions& options;
    Looks looks = {};
    Pose pose = {};                                      ///< of all nodes
    std::map<Form, std::vector<ShownMesh>> meshes = {};  ///< one Mesh a primitive
    std::vector<PrimitiveLoss> primitive_losses = {};

    void lose(const std::string& pointer, const std::string& what) {
        losses.push_back({document.place(pointer), what});
    }
    /// The same sentence for several materials becomes one loss with their number.
    void lose_in_material(const std::string& pointer, const std::string& what);
    /// The same sentence for several primitives becomes one loss.
    void lose_in_primitive(const std::string& pointer, const std::string& what);
    /// `count` things, such as a "point", are ignored in a primitive; they are added up.
    void ignore_in_primitive(const std::string& pointer, const std::string& thing,
                             std::size_t count);
    /// Moves what primitives have lost to `losses`.
    void say_primitive_losses();
};

/// Which texture coordinates a material's images are laid by; all of them have the same ones.
struct TextureUse {
    bool used = false;
    int texcoord = 0;  ///< TEXCOORD_n
};

/// The glTF material of a primitive, which the chosen variant may replace; -1 is glTF's default.
/// Throws Error (usage) where the file does not have that variant.
int material_of(const Reader& reader, const tinygltf::Primitive& primitive);

/// The Scene's material for glTF material `index`, made on first use.
Index read_material(Reader& reader, int index);

/// What the images need that read_material() gave to glTF material `index`.
TextureUse texture_use(const Reader& reader, int index);

/// glTF material `index` without its images.
Index untextured(Reader& reader, int index);

/// glTF material `index` without the images that are laid by other texture coordinates than the
/// first one.
Index with_one_set(Reader& reader, int index);

// ---- gltf_camera.cpp, gltf_lights.cpp ---------------------------------------------------------

/// Adds the camera of a node that has one.
void read_camera(Reader& reader, int node, const Matrix& world);

/// Adds the light of a node if it has one.
void read_light(Reader& reader, int node, const Matrix& world);

/// Lets the lights that have a position fall off with the square of the distance, once the size of
/// the scene is known.
void set_attenuation(Scene& scene);

/// Where a camera or a light looks: both look along -z (glTF 2.0, section 3.10, and
/// KHR_lights_punctual).
Vec3 direction_of(const Matrix& world);

// ---- gltf_mesh.cpp ----------------------------------------------------------------------------

/// The Scene's meshes for a glTF mesh in that form, made on first use.
const std::vector<ShownMesh>& read_mesh(Reader& reader, const Form& form);

}  // namespace penumbra::gltf
