#include "importers/shared/image_store.h"

#include "base/memory.h"

#include <tbb/global_control.h>

#include <algorithm>

namespace penumbra {

namespace {

// As many as one material may join (see bake_specular_lobes()).
constexpr std::size_t most_recent = 4;

}  // namespace

void ImageStore::expect(const std::string& name, std::function<Raster()> decode) {
    const auto [place, fresh] = place_expected_.try_emplace(name, expected_.size());
    if (fresh) expected_.push_back({.decode = std::move(decode)});
}

// Images that nobody asks for in the end must not pile up.
void ImageStore::decode_ahead(std::size_t from) {
    const auto threads =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    if (threads < 2) return;
    std::size_t free =
        threads -
        std::min(threads, std::size_t(std::ranges::count_if(expected_, &Expected::waits)));
    for (std::size_t i = from; i < std::min(from + threads, expected_.size()); ++i) {
        if (!expected_[i].decode || expected_[i].waits() || free == 0) continue;
        expected_[i].image =
            std::async(std::launch::async | std::launch::deferred, expected_[i].decode);
        --free;
    }
}

const Raster* ImageStore::find(const Scene& scene, const std::string& name) {
    if (const auto found = placed_.find(name); found != placed_.end())
        return &scene.textures[found->second].raster;
    const auto found = std::find_if(recent_.begin(), recent_.end(),
                                    [&](const auto& entry) { return entry.first == name; });
    if (found != recent_.end()) {
        recent_.splice(recent_.begin(), recent_, found);
        return &recent_.front().second;
    }
    const auto awaited = place_expected_.find(name);
    if (awaited == place_expected_.end() || !expected_[awaited->second].decode) return nullptr;
    Expected& entry = expected_[awaited->second];
    const auto decode = std::exchange(entry.decode, nullptr);
    decode_ahead(awaited->second + 1);
    add(name, entry.waits() ? entry.image.get() : decode());
    return &recent_.front().second;
}

void ImageStore::add(const std::string& name, Raster raster) {
    recent_.emplace_front(name, std::move(raster));
    if (recent_.size() > most_recent) recent_.pop_back();
}

Index ImageStore::place(Scene& scene, const std::string& name, Texture frame) {
    const Raster* raster = find(scene, name);
    const auto made = Index(scene.textures.size());
    if (placed_.count(name) != 0) {
        const MemoryClaim claim(raster->data.size(), frame.name);
        frame.raster = *raster;
    } else {
        frame.raster = std::move(recent_.front().second);
        recent_.pop_front();
        placed_[name] = made;
    }
    scene.textures.push_back(std::move(frame));
    return made;
}

}  // namespace penumbra
