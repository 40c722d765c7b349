// All inputs of one picture -> one complete scene.
#include "complete.h"
#include "merge.h"
#include "normal_map.h"
#include "sidecar.h"
#include "suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace penumbra {

namespace {

// Of all meshes with normal maps together: POV-Ray reads about 100,000 facets a second.
constexpr std::size_t most_baked_facets = 100'000;

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
}

std::string extension_of(const fs::path& file) {
    std::string text = file.extension().string();
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return text;
}

Imported read_model(const fs::path& file, const ModelOptions& options) {
    return extension_of(file) == ".obj" ? read_obj(file, options) : read_gltf(file, options);
}

/// What is to be read, in the order in which it is laid over the scene.
struct Request {
    std::vector<Placement> models = {};
    std::vector<Layer> sidecars = {}, settings = {};

    template <class Visit>
    void for_each_layer(Visit visit) const {
        for (const Layer& layer : sidecars) visit(layer);
        for (const Layer& layer : settings) visit(layer);
    }
};

Request read_request(const std::vector<fs::path>& inputs, const LoadOptions& options) {
    Request request;
    for (const fs::path& input : inputs) {
        const std::string name = printable(input.string());
        if (!is_there(input)) throw Error(Failure::input, name, "no such file");
        if (extension_of(input) == ".toml")
            request.sidecars.push_back(read_sidecar(input));
        else if (is_model(input))
            request.models.push_back({.file = input});
        else
            throw Error(Failure::input, name,
                        "unknown file format (supported are .gltf, .glb, .obj and .toml)");
    }
    if (options.sidecar) request.sidecars.push_back(read_sidecar(*options.sidecar));
    for (const std::string& setting : options.settings)
        request.settings.push_back(read_setting(setting));
    request.for_each_layer([](const Layer& layer) { check_top_level(layer); });
    request.for_each_layer([&](const Layer& layer) { read_placements(layer, request.models); });
    return request;
}

void name_instances(Scene& placed, const std::string& name) {
    if (name.empty()) return;
    for (Instance& instance : placed.instances)
        instance.name = instance.name.empty() ? name : name + "/" + instance.name;
}

// A model's meshes with the material that replaces their own.
struct Replacement {
    std::size_t mesh = 0, meshes = 0;
    Reference material = {};
};

// The length of an Absorption has no place in a transform. Returns whether there is one.
bool scale_absorption(Scene& scene, double scale) {
    bool absorbs = false;
    for (Material& material : scene.materials)
        if (material.absorption) {
            material.absorption->distance *= scale;
            absorbs = true;
        }
    return absorbs;
}

// Reads every file once for each material that it gets, and places it as often as it is named; one
// that absorbs light also for each scale.
std::vector<Replacement> load_models(const std::vector<Placement>& placements,
                                     const ModelOptions& options, Imported& result) {
    std::map<std::tuple<fs::path, std::string, double>, Model> known;
    std::set<fs::path> absorbing;
    std::vector<Replacement> replacements;
    for (const Placement& placement : placements) {
        if (placement.named_by && !is_there(placement.file))
            throw Error(placement.named_by->failure, placement.named_by->place,
                        "no such file: " + printable(placement.file.string()));
        const fs::path file = placement.file.lexically_normal();
        const std::string material = placement.material ? placement.material->name : "";
        const double scale = mean_scale(placement.transform());
        auto found = known.find({file, material, absorbing.contains(file) ? scale : 1});
        if (found == known.end()) {
            Imported model = read_model(placement.file, options);
            const bool absorbs = scale_absorption(model.scene, scale);
            if (absorbs) absorbing.insert(file);
            const std::tuple key(file, material, absorbs ? scale : 1);
            found = known.emplace(key, add_model(result, std::move(model))).first;
            if (placement.material)
                replacements.push_back(
                    {found->second.mesh, found->second.meshes, *placement.material});
        }
        Scene placed = found->second.placed;
        name_instances(placed, placement.name);
        place_model(result.scene, std::move(placed), placement.transform());
    }
    return replacements;
}

void replace_materials(const std::vector<Replacement>& replacements, Scene& scene) {
    for (const Replacement& replacement : replacements) {
        const Index material = material_named(scene, replacement.material);
        for (std::size_t i = 0; i < replacement.meshes; ++i)
            scene.meshes[replacement.mesh + i].material = material;
    }
}

bool has_image(const Scene& scene, Index material) {
    return material < scene.materials.size() &&
           std::holds_alternative<ImageMap>(scene.materials[material].pattern);
}

// An image needs texture coordinates: without them the mesh gets the material's plain colour.
void drop_images_without_texcoords(Imported& result) {
    Scene& scene = result.scene;
    std::map<Index, Index> plain;
    for (Mesh& mesh : scene.meshes) {
        if (!mesh.texcoords.empty() || mesh.triangles.empty() || !has_image(scene, mesh.material))
            continue;
        const Material original = scene.materials[mesh.material];
        const auto [entry, fresh] = plain.emplace(mesh.material, Index(scene.materials.size()));
        if (fresh) {
            scene.materials.push_back(original);
            scene.materials.back().pattern = {};
        }
        mesh.material = entry->second;
        result.losses.push_back(
            {mesh.name.empty() ? "a mesh" : "mesh '" + mesh.name + "'",
             fmt::format("has no texture coordinates for the texture of material '{}'; its plain "
                         "colour is used",
                         original.name)});
    }
}

// Some images can only vary opaque surfaces; a sidecar may have made theirs translucent.
void drop_maps_of_translucent_materials(Imported& result) {
    for (Material& m : result.scene.materials) {
        if (m.opacity == 1 || (!m.gloss && !m.emission_map)) continue;
        m.gloss.reset();
        m.emission_map.reset();
        result.losses.push_back({fmt::format("material '{}'", m.name),
                                 "its gloss and emission images are dropped: it is translucent"});
    }
}

// A setting of a material that nobody has is a typing error.
void check_used(const NewMaterials& made, const Scene& scene) {
    for (const auto& [index, reference] : made) {
        // By name: a copy without the image is the same material.
        const auto wears = [&, &name = reference.name](const auto& thing) {
            return scene.materials[thing.material].name == name;
        };
        if (std::any_of(scene.meshes.begin(), scene.meshes.end(), wears) ||
            std::any_of(scene.spheres.begin(), scene.spheres.end(), wears) ||
            std::any_of(scene.planes.begin(), scene.planes.end(), wears))
            continue;
        Scene others;
        for (std::size_t i = 0; i < scene.materials.size(); ++i)
            if (!made.contains(Index(i))) others.materials.push_back(scene.materials[i]);
        material_named(others, reference);
    }
}

void set_penumbra(Scene& scene, double delta) {
    for (Light& light : scene.lights) light.penumbra.delta = delta;
}

void lay_layers(const Request& request, const ModelOptions& options, Imported& result) {
    Scene& scene = result.scene;
    TextureFiles files;
    NewMaterials made;
    const auto replacements = load_models(request.models, options, result);
    result.auto_exposure = !scene.lights.empty();  // a glTF file's
    request.for_each_layer([&](const Layer& layer) { lay_materials(layer, scene, files, made); });
    replace_materials(replacements, scene);
    request.for_each_layer([&](const Layer& layer) {
        lay_globals(layer, result, files);
        lay_objects(layer, scene);
        lay_lights(layer, scene);
    });
    drop_images_without_texcoords(result);
    drop_maps_of_translucent_materials(result);

    const double aspect = double(result.render.width) / result.render.height;
    const Bounds box = stage(scene);
    CameraAims aims;
    request.for_each_layer(
        [&](const Layer& layer) { lay_camera(layer, scene, aims, box, aspect); });
    complete(scene, aspect);
    if (const std::size_t count = drop_coincident_facets(scene); count > 0)
        result.losses.push_back(
            {"facets", fmt::format("{} that lie exactly on others are left out: which of them "
                                   "shows would be a matter of rounding",
                                   count)});
    check_used(made, scene);
    // After complete(), so that the rig's lights can be changed as well.
    for (const Layer& layer : request.settings) edit_lights(layer, scene);
}

}  // namespace

bool is_model(const fs::path& file) {
    const std::string extension = extension_of(file);
    return extension == ".gltf" || extension == ".glb" || extension == ".obj";
}

Losses settle_normal_maps(Scene& scene, NormalMaps choice) {
    switch (choice) {
    case NormalMaps::bake: return bake_normal_maps(scene, {.facets = most_baked_facets});
    case NormalMaps::drop: return drop_normal_maps(scene);
    case NormalMaps::pixel: complete_tangents(scene); break;
    }
    return {};
}

Imported load_scene(const std::vector<fs::path>& inputs, const LoadOptions& options) {
    if (inputs.empty() && !options.sidecar) throw Error(Failure::usage, "", "no input is given");
    if (options.penumbra && !(std::isfinite(*options.penumbra) && *options.penumbra >= 0))
        throw Error(Failure::usage, "--penumbra",
                    fmt::format("must be a finite number of 0 or more, not {}", *options.penumbra));
    for (const fs::path& folder : options.model.allowed_paths)
        if (std::error_code ignored; !fs::is_directory(folder, ignored))
            throw Error(Failure::usage, "--allow-path",
                        fmt::format("'{}' is not a folder", printable(folder.string())));
    const Request request = read_request(inputs, options);
    Imported result;
    lay_layers(request, options.model, result);
    for (const Layer& layer : request.sidecars)
        result.models.push_back({.file = layer.name, .format = "sidecar"});
    if (options.penumbra) set_penumbra(result.scene, *options.penumbra);
    if (const auto found = defects(result.scene); !found.empty())
        throw Error(Failure::input, inputs.empty() ? options.sidecar->string() : inputs[0].string(),
                    found[0]);
    const Losses settled = settle_normal_maps(result.scene, options.normal_maps);
    result.losses.insert(result.losses.end(), settled.begin(), settled.end());
    return result;
}

}  // namespace penumbra
