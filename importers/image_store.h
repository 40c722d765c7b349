// Decoded images -> Textures, each image decoded once as far as memory allows.
#pragma once

#include "penumbra/scene.h"

#include <list>
#include <map>
#include <string>
#include <utility>

namespace penumbra {

/// The images of one model by name. Those that became a texture are found in the scene, of others
/// the last few stay.
class ImageStore {
  public:
    /// The image; nullptr if it is not at hand (any more). It stays until scene.textures changes or
    /// four others were asked for.
    const Raster* find(const Scene& scene, const std::string& name);

    /// `name` is not at hand.
    void add(const std::string& name, Raster raster);

    /// Appends `frame` with the image to scene.textures. Precondition: the image is at hand.
    Index place(Scene& scene, const std::string& name, Texture frame);

  private:
    std::list<std::pair<std::string, Raster>> recent = {};  ///< the last used first
    std::map<std::string, Index> placed = {};               ///< into Scene::textures
};

}  // namespace penumbra
