// Texture statements of MTL files -> images.
#pragma once

#include "importers/obj/mtl/tally.h"
#include "importers/obj/mtl/text.h"
#include "importers/obj/text/paths.h"
#include "importers/shared/image_store.h"
#include "importers/shared/model_folders.h"

#include "penumbra/scene.h"

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::obj {

/// The operands of a texture statement: options before or after a file name with blanks.
struct MapOperands {
    std::string file = {};
    bool clamp = false;
    std::array<double, 6> transform = ImageMap().transform;  ///< -s and -o
    double base = 0, gain = 1;                               ///< -mm: base + gain x the sample
    double bump = 1;                                         ///< -bm
    char channel = '\0';                    ///< -imfchan: r g b, m for alpha, l; 0: not given
    std::vector<std::string> ignored = {};  ///< options that the Scene cannot hold

    bool is_ranged() const { return base != 0 || gain != 1; }
};
MapOperands parse_map(std::string_view operands);

/// A texture statement whose image can be read.
struct MapImage {
    std::string word = {};  ///< the statement's, for messages
    Index line = 0;
    std::filesystem::path file = {};
    MapOperands operands = {};

    ImageMap laid() const { return {.transform = operands.transform}; }
};

/// Decodes texture files, each once as far as memory allows.
class TextureReader {
  public:
    TextureReader(ModelFolders of_model, Scene& into, LossTally& lost);

    /// The image that `statement` names, if there is one, will be opened later: it may be decoded
    /// ahead.
    void expect(const MtlEntry& entry, const Statement& statement);

    /// The file that `statement` names, whether it is an image or not; empty if there is none.
    std::filesystem::path file(const MtlEntry& entry, const Statement& statement) const;

    /// The image that `statement` names; none, and a loss, if it cannot be had.
    std::optional<MapImage> open(const MtlEntry& entry, const Statement& statement);

    /// Its samples, which stay as ImageStore says. Throws Error (input) where the file has changed
    /// meanwhile.
    const Raster& raster(const MapImage& image);

    /// The Scene's texture with its samples.
    Index texture(const MapImage& image, bool srgb);

    /// The Scene's texture that `make` derives from it; `use`, whose first word ends its name, and
    /// `srgb` tell it from others.
    Index derived(const MapImage& image, const std::string& use, bool srgb,
                  const std::function<Raster()>& make);

  private:
    Found locate(const MtlEntry& entry, const std::string& name) const;

    Raster decode(const std::filesystem::path& file) const;

    ModelFolders folders_ = {};
    Scene& scene_;
    LossTally& tally_;
    ImageStore store_ = {};                           ///< by file
    std::map<std::string, std::string> broken_ = {};  ///< by file: what is wrong with it
    std::map<std::string, Index> known_ = {};         ///< by file, options and use
};

}  // namespace penumbra::obj
