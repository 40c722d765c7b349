// glTF file -> Scene, in steps: bytes -> checked JSON -> Document -> meshes, materials, nodes.
//
// tinygltf turns the JSON into structures; it is given a JSON without buffers and images, so that
// it never opens a file. Everything that refers to something is checked before (gltf_check.cpp),
// so that after open_document() every index is in range and every accessor within its buffer.
#pragma once

#include "penumbra/importers.h"

#include <nlohmann/json_fwd.hpp>
#include <tiny_gltf.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
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
    std::filesystem::path folder = {};                 ///< where its other files are
    tinygltf::Model model = {};                        ///< without buffers and images
    std::vector<std::vector<std::byte>> storage = {};  ///< owns what `buffers` refer to
    std::vector<Bytes> buffers = {};                   ///< empty: the file gives no content
    std::vector<ImageSource> images = {};

    /// Where a person can look: "box.gltf#/meshes/0".
    std::string place(const std::string& pointer) const { return file + '#' + pointer; }
};

// ---- gltf_document.cpp ------------------------------------------------------------------------

/// Reads and checks `file`; buffers are loaded, images are not. Throws Error (input).
Document open_document(const std::filesystem::path& file, Losses& losses);

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

/// Parses JSON; what is nested deeper than any glTF is left out. Throws Error (input).
nlohmann::json parse_json(std::string_view text, const std::string& file, Losses& losses);

// ---- gltf_uri.cpp -----------------------------------------------------------------------------

/// The bytes that `uri` stands for: a data: URI, or a file below `folder`. Throws Error (input).
std::vector<std::byte> fetch(const std::string& uri, const std::filesystem::path& folder,
                             const std::string& place);

// ---- gltf_asset.cpp, gltf_check.cpp, gltf_layout.cpp -------------------------------------------

/// Refuses versions and required extensions that are not supported. Throws Error (input).
void check_asset(const nlohmann::json& root, const std::string& file, Losses& losses);

/// Checks types, references and numbers of the whole document against the glTF 2.0 schema, writes
/// whole numbers as integers and clamps factors. Throws Error (input).
void check_schema(nlohmann::json& root, const std::string& file, Losses& losses);

/// Checks that accessors lie in their buffer views and these in their buffers, and that the nodes
/// form trees. Precondition: check_schema() passed. Throws Error (input).
void check_layout(const nlohmann::json& root, const std::string& file);

/// `text` on one line: control characters become '?', long texts are cut.
std::string printable(std::string_view text);

// ---- gltf_accessor.cpp ------------------------------------------------------------------------

/// Elements [first, first + count) of an accessor.
struct Range {
    std::size_t first = 0, count = 0;
};

/// Writes the first `width` components of each element as floats, one element after the other.
/// Integers are normalised if the accessor says so. Throws Error (input) where a float is not
/// finite or a buffer has no content. Precondition: range and width fit the accessor.
void read_floats(const Document& document, int accessor, Range range, int width, float* out);

/// Writes all elements of a SCALAR accessor of unsigned integers. Throws Error (input).
void read_indices(const Document& document, int accessor, Index* out);

/// Number of components of the accessor's type.
int components(const tinygltf::Accessor& accessor);

// ---- gltf_material.cpp ------------------------------------------------------------------------

/// What reading has produced so far, and what of the file it came from.
struct Reader {
    const Document& document;
    Scene& scene;
    Losses& losses;
    std::map<int, Index> materials = {};                ///< by glTF index; -1: the default one
    std::map<Index, Index> untextured = {};             ///< by Scene's material
    std::map<std::array<int, 4>, Index> textures = {};  ///< by image, wrapping and filter
    std::map<std::pair<int, bool>, Color> means = {};   ///< by texture, and whether it is sRGB
    std::map<int, std::vector<Index>> meshes = {};      ///< by glTF mesh: one Mesh a primitive

    void lose(const std::string& pointer, const std::string& what) {
        losses.push_back({document.place(pointer), what});
    }
};

/// How a material's base colour texture is laid over a mesh.
struct TextureUse {
    bool used = false;
    int texcoord = 0;          ///< TEXCOORD_n
    bool transformed = false;  ///< u' = a u + c v + e, v' = b u + d v + f, before v is flipped
    std::array<double, 6> transform = {1, 0, 0, 1, 0, 0};  ///< a b c d e f
};

/// The Scene's material for glTF material `index`, made on first use; -1 is glTF's default.
Index read_material(Reader& reader, int index);

/// The texture that read_material() gives to glTF material `index`.
TextureUse base_texture_use(const Reader& reader, int index);

/// The Scene's `material` without its texture.
Index untextured(Reader& reader, Index material);

// ---- gltf_mesh.cpp ----------------------------------------------------------------------------

/// The Scene's meshes for glTF mesh `index`, made on first use.
const std::vector<Index>& read_mesh(Reader& reader, int index);

}  // namespace penumbra::gltf
