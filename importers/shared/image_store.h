// Decoded images -> Textures, each image decoded once as far as memory allows.
#pragma once

#include "penumbra/scene.h"

#include <functional>
#include <future>
#include <list>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace penumbra {

/// The images of one model by name. Those that became a texture are found in the scene, of others
/// the last few stay.
class ImageStore {
  public:
    /// `name` will probably be asked for after those expected before it. Other threads decode a few
    /// images ahead of the one that was last asked for.
    void expect(const std::string& name, std::function<Raster()> decode);

    /// The image; nullptr if it is not at hand (any more). It stays until scene.textures changes or
    /// four others were asked for. Throws what decoding an expected image has thrown, once.
    const Raster* find(const Scene& scene, const std::string& name);

    /// `name` is not at hand.
    void add(const std::string& name, Raster raster);

    /// Appends `frame` with the image to scene.textures. Precondition: the image is at hand.
    Index place(Scene& scene, const std::string& name, Texture frame);

  private:
    struct Expected {
        std::function<Raster()> decode = {};  ///< empty: it was asked for
        std::future<Raster> image = {};       ///< valid: it is being decoded

        bool waits() const { return image.valid(); }
    };
    void decode_ahead(std::size_t from);

    std::vector<Expected> expected_ = {};
    std::map<std::string, std::size_t> place_expected_ = {};
    std::list<std::pair<std::string, Raster>> recent_ = {};  ///< the last used first
    std::map<std::string, Index> placed_ = {};               ///< into Scene::textures
};

}  // namespace penumbra
