#include "image_store.h"

#include <algorithm>

namespace penumbra {

namespace {

// As many as one material may join (see bake_polish()).
constexpr std::size_t most_recent = 4;

}  // namespace

const Raster* ImageStore::find(const Scene& scene, const std::string& name) {
    if (const auto found = placed.find(name); found != placed.end())
        return &scene.textures[found->second].raster;
    const auto found = std::find_if(recent.begin(), recent.end(),
                                    [&](const auto& entry) { return entry.first == name; });
    if (found == recent.end()) return nullptr;
    recent.splice(recent.begin(), recent, found);
    return &recent.front().second;
}

void ImageStore::add(const std::string& name, Raster raster) {
    recent.emplace_front(name, std::move(raster));
    if (recent.size() > most_recent) recent.pop_back();
}

Index ImageStore::place(Scene& scene, const std::string& name, Texture frame) {
    const Raster* raster = find(scene, name);
    const auto made = Index(scene.textures.size());
    if (placed.count(name) != 0) {
        frame.raster = *raster;
    } else {
        frame.raster = std::move(recent.front().second);
        recent.pop_front();
        placed[name] = made;
    }
    scene.textures.push_back(std::move(frame));
    return made;
}

}  // namespace penumbra
