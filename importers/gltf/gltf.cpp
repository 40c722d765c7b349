// glTF file -> Scene, in steps: bytes -> checked JSON -> Document -> meshes, materials, nodes.
#include "base/file.h"
#include "base/memory.h"
#include "importers/gltf/document/document.h"
#include "importers/gltf/external_assets.h"
#include "importers/gltf/material/texture.h"
#include "importers/gltf/nodes/animation_pointer.h"
#include "importers/gltf/nodes/camera.h"
#include "importers/gltf/nodes/image_based_light.h"
#include "importers/gltf/nodes/lights.h"
#include "importers/gltf/nodes/mesh.h"
#include "importers/gltf/nodes/pose.h"
#include "importers/gltf/reader/reader.h"
#include "scene/transforms.h"
#include "scene/vertex_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <new>
#include <optional>
#include <span>
#include <utility>

namespace penumbra {
namespace gltf {
namespace {

// Walks a scene.
struct Walker {
    Reader& reader;
    std::vector<AssetNode> assets = {};  // what is shown of other files

    const tinygltf::Model& model() const { return reader.document.model; }
    void walk();
    void node(int index, bool visible);
    void show_mesh(int node);
    void show_asset(int node, const Matrix& world);
    void place(const ShownMesh& shown, int node, const Matrix& world);
};

bool hidden(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_node_visibility");
    if (found == node.extensions.end() || !found->second.Has("visible")) return false;
    const tinygltf::Value& visible = found->second.Get("visible");
    return visible.IsBool() && !visible.Get<bool>();
}

// The scene that is asked for, else the default one, else the first.
const tinygltf::Scene& chosen_scene(const Reader& reader) {
    const tinygltf::Model& model = reader.document.model;
    if (reader.options.scene.empty())
        return model.scenes[std::size_t(std::max(model.defaultScene, 0))];
    std::vector<std::string> names;
    for (const tinygltf::Scene& scene : model.scenes) names.push_back(scene.name);
    return model.scenes[choose(reader.document, reader.options.scene, names, "scene")];
}

// The roots of what is shown. Without a scene it is every node that is no other's child: glTF 2.0,
// section 3.5.1, leaves it to us.
std::vector<int> roots(const Reader& reader) {
    const tinygltf::Model& model = reader.document.model;
    if (!model.scenes.empty() || !reader.options.scene.empty()) return chosen_scene(reader).nodes;
    std::vector<bool> child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
        for (const int index : node.children) child[std::size_t(index)] = true;
    std::vector<int> found;
    for (std::size_t i = 0; i < child.size(); ++i)
        if (!child[i]) found.push_back(int(i));
    return found;
}

// The tree may be deep, so that it is walked without recursion; in the order of the file.
void Walker::walk() {
    struct Entry {
        int node;
        bool visible;
    };
    std::vector<Entry> open;
    const auto push = [&](const std::vector<int>& nodes, bool visible) {
        for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) open.push_back({*i, visible});
    };
    push(roots(reader), true);
    std::vector<bool> seen(model().nodes.size(), false);
    while (!open.empty()) {
        const auto [index, parents_visible] = open.back();
        open.pop_back();
        const std::string place = reader.document.place(fmt::format("/nodes/{}", index));
        if (seen[std::size_t(index)])
            throw Error(Failure::input, place,
                        "is in the scene twice: a root of a scene must be no other node's child");
        seen[std::size_t(index)] = true;
        if (!finite(reader.pose.world[std::size_t(index)]))
            throw Error(Failure::input, place, "its position in the world is too large a number");
        const tinygltf::Node& source = model().nodes[std::size_t(index)];
        const bool visible = parents_visible && !hidden(source);
        node(index, visible);
        push(source.children, visible);
    }
}

// KHR_node_visibility affects no cameras.
void Walker::node(int index, bool visible) {
    const tinygltf::Node& source = model().nodes[std::size_t(index)];
    const Matrix& world = reader.pose.world[std::size_t(index)];
    if (source.mesh >= 0 && visible) show_mesh(index);
    if (source.camera >= 0) read_camera(reader, index, world);
    if (visible) read_light(reader, index, world);
    if (visible && reader.document.asset_of_node.contains(index)) show_asset(index, world);
}

bool has_usable_size(const Matrix& m) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 3; ++column)
            if (std::abs(m[row][column]) > largest_in_transform) return false;
    return true;
}

// A matrix that has no inverse up to rounding: it flattens what it is applied to, or leaves next to
// nothing of it.
bool is_flat(const Matrix& m) {
    double volume = 1;
    for (int row = 0; row < 3; ++row) volume *= Vec3(m[row][0], m[row][1], m[row][2]).length();
    return std::abs(m.determinant()) <= std::max(1e-12 * volume, least_determinant);
}

struct PlacedMesh {
    Mesh mesh = {};
    Vec3 origin = Vec3(0);  // where in the world its vertices are counted from
};

// An Instance must have an inverse, so that a flattened mesh is placed by its vertices. None when
// no facet has an area left.
std::optional<PlacedMesh> flattened(const Mesh& mesh, const Matrix& world) {
    std::vector<Vec3> positions;
    positions.reserve(mesh.positions.size());
    for (const Vec3f& position : mesh.positions) positions.push_back(Vec3(position) * world);
    PlacedMesh placed = {.mesh = mesh};
    Mesh& flat = placed.mesh;
    flat.normals.clear();
    placed.origin = set_positions(positions, flat);
    const auto has_area = [&](const std::array<Index, 3>& t) {
        const Vec3f a = flat.positions[t[0]];
        return (flat.positions[t[1]] - a).cross(flat.positions[t[2]] - a).length() > 0;
    };
    if (std::none_of(flat.triangles.begin(), flat.triangles.end(), has_area)) return std::nullopt;
    return placed;
}

void Walker::show_asset(int index, const Matrix& world) {
    if (!has_usable_size(world))
        throw Error(Failure::input, reader.document.place(fmt::format("/nodes/{}", index)),
                    "its position in the world is too large a number");
    if (is_flat(world))
        return reader.note_loss(Loss::dropped, fmt::format("/nodes/{}", index),
                                "it is flattened; its external asset is left out");
    assets.push_back({index, world});
}

// To where a mesh stands that counts its vertices from `origin`.
Matrix from_origin(const Vec3& origin, const Matrix& world) {
    return origin == Vec3(0) ? world : Matrix().setTranslation(origin) * world;
}

void Walker::show_mesh(int index) {
    const tinygltf::Node& node = model().nodes[std::size_t(index)];
    const Matrix& world = reader.pose.world[std::size_t(index)];
    const MeshKey key = {
        .mesh = node.mesh, .skin = node.skin, .weights = reader.pose.weights[std::size_t(index)]};
    const auto& shown = read_mesh(reader, key);
    const auto instances = read_instances(reader, index);
    const bool posed = std::any_of(shown.begin(), shown.end(), [](auto& s) { return s.posed; });
    if (instances && posed)
        reader.note_loss(Loss::dropped,
                         fmt::format("/nodes/{}/extensions/EXT_mesh_gpu_instancing", index),
                         "its mesh has a skin and is shown once");
    const MemoryClaim claim(
        times(times(instances ? instances->size() : 1, shown.size()), 2 * sizeof(Instance)),
        reader.document.place(fmt::format("/nodes/{}", index)));
    for (const ShownMesh& each : shown) {
        if (each.posed)
            place(each, index, from_origin(each.origin, Matrix()));
        else if (!instances)
            place(each, index, from_origin(each.origin, world));
        else
            for (const Matrix& instance : *instances)
                place(each, index, from_origin(each.origin, instance * world));
    }
}

void Walker::place(const ShownMesh& shown, int index, const Matrix& world) {
    const std::string pointer = fmt::format("/nodes/{}", index);
    const std::string& own_name = model().nodes[std::size_t(index)].name;
    const std::string name = own_name.empty() ? fmt::format("node{}", index) : own_name;
    Scene& scene = reader.scene;
    if (!finite(world) || !has_usable_size(world))
        throw Error(Failure::input, reader.document.place(pointer),
                    "the position of one of its instances is too large a number");
    MemoryClaim claim;
    if (is_flat(world))
        claim = MemoryClaim(memory_of(scene.meshes[shown.mesh]) +
                                scene.meshes[shown.mesh].positions.size() * sizeof(Vec3),
                            reader.document.place(pointer));
    if (!is_flat(world))
        scene.instances.push_back({.name = name, .mesh = shown.mesh, .transform = world});
    else if (auto baked = flattened(scene.meshes[shown.mesh], world)) {
        scene.instances.push_back({.name = name,
                                   .mesh = Index(scene.meshes.size()),
                                   .transform = Matrix().setTranslation(baked->origin)});
        scene.meshes.push_back(std::move(baked->mesh));
    } else {
        reader.note_loss(Loss::dropped, pointer, "it is scaled to nothing; its mesh is left out");
    }
}

// Materials that others have replaced on all meshes.
void drop_unused_materials(Scene& scene) {
    std::vector<Index> place(scene.materials.size(), no_index);
    for (const Mesh& mesh : scene.meshes) place[mesh.material] = 0;
    std::vector<Material> used;
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (place[i] == no_index) continue;
        place[i] = Index(used.size());
        used.push_back(std::move(scene.materials[i]));
    }
    scene.materials = std::move(used);
    for (Mesh& mesh : scene.meshes) mesh.material = place[mesh.material];
}

constexpr std::size_t most_files = 256;  // of which one model is made

// What Illumination::by_model comes to.
ModelOptions settled(const ModelOptions& options, const tinygltf::Model& model) {
    ModelOptions result = options;
    if (options.illumination == Illumination::by_model)
        result.illumination =
            model.lights.empty() ? Illumination::environment : Illumination::lamps;
    return result;
}

Imported read(FileContent content, const ModelOptions& given, const Nesting& nesting) {
    Imported imported;
    Losses& opening = imported.losses;
    Amend at_time;
    if (given.time || !given.animation.empty())
        at_time = [&](const Document& whole, nlohmann::json& root) {
            return follow_pointers(whole, given, root, opening);
        };
    const Document document = open_document(std::move(content), opening, at_time);
    const tinygltf::Model& model = document.model;
    const ModelOptions options = settled(given, model);
    imported.illumination = options.illumination;
    LossTally losses;
    Reader reader{document, imported.scene, losses, options};
    reader.pose = read_pose(reader);
    expect_images(reader);
    offer_facets(reader);
    Walker walker{reader};
    walker.walk();
    if (!model.scenes.empty()) read_image_based_light(reader, chosen_scene(reader));
    drop_unused_materials(imported.scene);
    for (const Loss& loss : reader.primitive_losses.losses()) losses.add_alone(loss);
    if (!imported.scene.cameras.empty()) imported.scene.camera = 0;
    if (imported.scene.instances.empty() && !model.meshes.empty())
        reader.note_loss(Loss::dropped, "/meshes", "none of them is shown by the file's scene");
    imported.models.push_back({.file = document.file,
                               .format = "glTF 2.0",
                               .nodes = model.nodes.size(),
                               .animations = model.animations.size(),
                               .extensions = model.extensionsUsed});
    imported.files = document.files;
    std::ranges::copy(losses.losses(), std::back_inserter(imported.losses));
    show_external_assets(reader, walker.assets, nesting, read, imported);
    return imported;
}

// A file and the files that it shows.
Imported read_whole(FileContent content, const ModelOptions& options) {
    std::size_t left = most_files;
    const Nesting nesting = {
        .files = {std::filesystem::path(content.name).lexically_normal().string()}, .left = &left};
    Imported imported = read(std::move(content), options, nesting);
    set_attenuation(imported.scene);
    return imported;
}

// Where `work` runs out of memory that it did not ask for before.
template <class Work>
Imported within_memory(const std::string& name, Work&& work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        throw MemoryError(Failure::input, name, "is too large for the memory of this machine");
    }
}

}  // namespace
}  // namespace gltf

Imported read_gltf(const std::filesystem::path& file, const ModelOptions& options) {
    return gltf::within_memory(file.string(), [&] {
        gltf::FileContent content = {
            .name = file.string(), .folders = folders_of(file, options), .owned = read_bytes(file)};
        content.bytes = content.owned;
        Imported imported = gltf::read_whole(std::move(content), options);
        imported.files.push_back(file);
        return imported;
    });
}

Imported read_gltf(std::span<const std::byte> bytes, const std::string& name,
                   const ModelOptions& options) {
    check_file_size(bytes.size(), name);
    return gltf::within_memory(name, [&] {
        return gltf::read_whole({.name = name,
                                 .folders = folders_in_memory(name, options),
                                 .owned = {},
                                 .bytes = bytes},
                                options);
    });
}

}  // namespace penumbra
