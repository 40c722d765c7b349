// glTF nodes -> what a scene of the file shows.
#include "gltf.h"

#include "gltf_texture.h"
#include "invertible.h"
#include "memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>

namespace penumbra {
namespace gltf {
namespace {

// Walks a scene.
struct Walker {
    Reader& reader;

    const tinygltf::Model& model() const { return reader.document.model; }
    void walk();
    void node(int index, bool visible);
    void show_mesh(int node);
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

bool finite(const Matrix& matrix) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            if (!std::isfinite(matrix[row][column])) return false;
    return true;
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

// An Instance must have an inverse, so that a flattened mesh is placed by its vertices. None when
// no facet has an area left.
std::optional<Mesh> flattened(const Mesh& mesh, const Matrix& world) {
    Mesh flat = mesh;
    flat.normals.clear();
    for (Vec3f& position : flat.positions) position = Vec3f(Vec3(position) * world);
    const auto has_area = [&](const std::array<Index, 3>& t) {
        const Vec3f a = flat.positions[t[0]];
        return (flat.positions[t[1]] - a).cross(flat.positions[t[2]] - a).length() > 0;
    };
    if (std::none_of(flat.triangles.begin(), flat.triangles.end(), has_area)) return std::nullopt;
    return flat;
}

void Walker::show_mesh(int index) {
    const tinygltf::Node& node = model().nodes[std::size_t(index)];
    const Matrix& world = reader.pose.world[std::size_t(index)];
    const Form form = {
        .mesh = node.mesh, .skin = node.skin, .weights = reader.pose.weights[std::size_t(index)]};
    const auto& shown = read_mesh(reader, form);
    const auto instances = read_instances(reader, index);
    const bool posed = std::any_of(shown.begin(), shown.end(), [](auto& s) { return s.posed; });
    if (instances && posed)
        reader.lose(fmt::format("/nodes/{}/extensions/EXT_mesh_gpu_instancing", index),
                    "its mesh has a skin and is shown once");
    const MemoryClaim claim(
        times(times(instances ? instances->size() : 1, shown.size()), 2 * sizeof(Instance)),
        reader.document.place(fmt::format("/nodes/{}", index)));
    for (const ShownMesh& each : shown) {
        if (each.posed)
            place(each, index, Matrix());
        else if (!instances)
            place(each, index, world);
        else
            for (const Matrix& instance : *instances) place(each, index, instance * world);
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
        claim = MemoryClaim(memory_of(scene.meshes[shown.mesh]), reader.document.place(pointer));
    if (!is_flat(world))
        scene.instances.push_back({.name = name, .mesh = shown.mesh, .transform = world});
    else if (auto baked = flattened(scene.meshes[shown.mesh], world)) {
        scene.instances.push_back({.name = name, .mesh = Index(scene.meshes.size())});
        scene.meshes.push_back(std::move(*baked));
    } else {
        reader.lose(pointer, "it is scaled to nothing; its mesh is left out");
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

Imported read(const std::filesystem::path& file, const ModelOptions& options) {
    Imported imported;
    const Document document = open_document(file, options, imported.losses);
    const tinygltf::Model& model = document.model;
    Reader reader{document, imported.scene, imported.losses, options};
    reader.pose = read_pose(reader);
    expect_images(reader);
    Walker{reader}.walk();
    set_attenuation(imported.scene);
    drop_unused_materials(imported.scene);
    reader.say_primitive_losses();
    if (!imported.scene.cameras.empty()) imported.scene.camera = 0;
    if (imported.scene.instances.empty() && !model.meshes.empty())
        reader.lose("/meshes", "none of them is shown by the file's scene");
    imported.models.push_back({.file = document.file,
                               .format = "glTF 2.0",
                               .nodes = model.nodes.size(),
                               .animations = model.animations.size(),
                               .extensions = model.extensionsUsed});
    return imported;
}

}  // namespace
}  // namespace gltf

Imported read_gltf(const std::filesystem::path& file, const ModelOptions& options) {
    try {
        return gltf::read(file, options);
    } catch (const std::bad_alloc&) {
        throw MemoryError(Failure::input, file.string(),
                          "is too large for the memory of this machine");
    }
}

}  // namespace penumbra
