// Nodes that show other glTF files: externalAssets of the draft of glTF 2.1.
#include "importers/gltf/external_assets.h"

#include "base/memory.h"
#include "importers/gltf/document/uri.h"
#include "importers/shared/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace penumbra::gltf {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t deepest = 8;  // files within one another

// Another file may read what this one may: its own names begin in its own folder, which is below
// one of those.
FileContent content_of(const Document& document, const FileSource& source,
                       const std::string& place) {
    FileContent content = {.name = place, .folders = document.folders};
    if (source.view < 0)
        if (const auto file = file_of(source.uri, document.folders, place)) {
            content.name = file->lexically_normal().string();
            if (document.folders.own_allowed)
                content.folders.allowed.push_back(
                    document.folders.own.empty() ? fs::path(".") : document.folders.own);
            content.folders.own = file->parent_path();
        }
    content.owned = image_bytes(document, source, place);
    content.bytes = content.owned;
    return content;
}

// The external assets of one file, each read once.
struct Assets {
    const Document& document;
    const ModelOptions& options;
    const Nesting& nesting;
    const ReadNested& read;
    Imported& whole;
    std::map<int, std::optional<Scene>> known = {};  // none: it cannot be read

    const std::optional<Scene>& scene_of(int asset, const std::string& place);
    Scene load(int asset, const std::string& place);
    void note_loss(const std::string& place, const std::string& why) const {
        whole.losses.push_back({Loss::dropped, place, "its external asset is left out: " + why});
    }
};

Scene Assets::load(int asset, const std::string& place) {
    FileContent content = content_of(document, document.external_assets[std::size_t(asset)], place);
    if (std::ranges::count(nesting.files, content.name) > 0)
        throw Error(Failure::input, place, "the file shows itself");
    if (nesting.files.size() >= deepest)
        throw Error(Failure::input, place,
                    fmt::format("files are within one another more than {} deep", deepest));
    if (*nesting.left == 0)
        throw Error(Failure::input, place, "the model is made of too many files");
    --*nesting.left;
    Nesting inner = nesting;
    inner.files.push_back(content.name);
    // What is asked for, a scene or an instant, is of the outermost file.
    ModelOptions own = options;
    own.scene = own.variant = own.animation = "";
    own.time.reset();
    Imported part = read(std::move(content), own, inner);
    const bool moves = std::ranges::any_of(part.models, [](auto& m) { return m.animations > 0; });
    if (options.time && moves)
        whole.losses.push_back(
            {Loss::dropped, place, "the animations of its external asset are not followed"});
    return add_model(whole, std::move(part)).placed;
}

const std::optional<Scene>& Assets::scene_of(int asset, const std::string& place) {
    const auto [found, fresh] = known.try_emplace(asset);
    if (!fresh) return found->second;
    try {
        found->second = load(asset, place);
    } catch (const MemoryError&) {
        throw;
    } catch (const Error& error) {
        const std::string said = error.what(), before = place + ": ";
        note_loss(place, said.starts_with(before) ? said.substr(before.size()) : said);
    }
    return found->second;
}

}  // namespace

void show_external_assets(const Reader& reader, const std::vector<AssetNode>& nodes,
                          const Nesting& nesting, const ReadNested& read, Imported& whole) {
    Assets assets = {reader.document, reader.options, nesting, read, whole};
    for (const AssetNode& each : nodes) {
        const std::string place =
            reader.document.place(fmt::format("/nodes/{}/externalAsset", each.node));
        const auto& scene = assets.scene_of(reader.document.asset_of_node.at(each.node), place);
        if (!scene) continue;
        const std::size_t count = scene->instances.size() + scene->lights.size();
        const MemoryClaim claim(times(count, 3 * sizeof(Instance)), place);
        place_model(whole.scene, *scene, each.world);
    }
}

}  // namespace penumbra::gltf
