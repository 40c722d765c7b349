// A glTF file -> Document, in steps: bytes -> checked JSON -> structures.
//
// tinygltf turns the JSON into structures; it is given a JSON without buffers and images, so that
// it never opens a file. Everything that refers to something is checked before (checks.h), so that
// after open_document() every index is in range and every accessor within its buffer. Compressed
// data are decompressed there as well; what comes later sees plain accessors only.
#pragma once

#include "importers/gltf/document/container.h"
#include "importers/gltf/document/text.h"
#include "importers/shared/model_folders.h"

#include "penumbra/error.h"

#include <nlohmann/json_fwd.hpp>
#include <tiny_gltf.h>

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::gltf {

/// A .gltf or .glb and where it comes from.
struct FileContent {
    std::string name = {};              ///< as the user wrote it
    ModelFolders folders = {};          ///< where its other files are
    std::vector<std::byte> owned = {};  ///< what `bytes` refer to; empty: it is the caller's
    Bytes bytes = {};
};

/// An image as the file describes it; its bytes are fetched when a material wants them.
struct ImageSource {
    std::string name = {};
    std::string uri = {};  ///< empty: in `view`
    int view = -1;         ///< into Model::bufferViews
};

/// A file that the draft of glTF 2.1 lists under `files`; its bytes are fetched as an image's are.
using FileSource = ImageSource;

/// A glTF file whose references can be trusted.
struct Document {
    std::string file = {};                             ///< as the user wrote it
    ModelFolders folders = {};                         ///< where its other files are
    tinygltf::Model model = {};                        ///< without buffers and images
    std::vector<std::vector<std::byte>> storage = {};  ///< owns what `buffers` refer to
    std::vector<Bytes> buffers = {};                   ///< empty: the file gives no content
    std::vector<ImageSource> images = {};
    std::vector<FileSource> external_assets = {};   ///< other glTF files that nodes show
    std::map<int, int> asset_of_node = {};          ///< node -> into `external_assets`
    std::vector<std::filesystem::path> files = {};  ///< that buffers and images name

    /// Where a person can look: "box.gltf#/meshes/0".
    std::string place(const std::string& pointer) const { return file + '#' + pointer; }
};

/// Changes the checked JSON of a Document that is otherwise complete, and says whether it did.
using Amend = std::function<bool(const Document&, nlohmann::json&)>;

/// Reads and checks a file; buffers are loaded, images are not. Bytes of the caller's must outlive
/// the Document. `amend`, if any, is asked where animations have pointers. Throws Error (input),
/// and what `amend` throws.
Document open_document(FileContent content, Losses& losses, const Amend& amend = {});

/// The bytes of an image. Throws Error (input).
std::vector<std::byte> image_bytes(const Document& document, const ImageSource& image,
                                   const std::string& place);

}  // namespace penumbra::gltf
