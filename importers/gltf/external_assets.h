// Nodes that show other glTF files: externalAssets of the draft of glTF 2.1.
#pragma once

#include "importers/gltf/reader/reader.h"

#include "penumbra/importers.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace penumbra::gltf {

/// The files on the way to one that is read, and how many more may be read for the outermost one.
struct Nesting {
    std::vector<std::string> files = {};  ///< the outermost first
    std::size_t* left = nullptr;
};

/// Reads a file that another one shows.
using ReadNested =
    std::function<Imported(FileContent content, const ModelOptions& options, const Nesting&)>;

/// A node that shows an external asset, and where it stands.
struct AssetNode {
    int node = 0;
    Matrix world = {};
};

/// Adds to `whole` what these nodes show: the default scenes of other files, each with what it has
/// of instances, lights and cameras. What cannot be read is a loss. Throws MemoryError.
void show_external_assets(const Reader& reader, const std::vector<AssetNode>& nodes,
                          const Nesting& nesting, const ReadNested& read, Imported& whole);

}  // namespace penumbra::gltf
