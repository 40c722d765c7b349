// All inputs of one picture -> one complete scene.
#include "base/text/text.h"
#include "importers/fit_materials.h"
#include "importers/shared/file_names.h"
#include "importers/shared/formats.h"
#include "importers/shared/merge.h"
#include "importers/sidecar/sidecar.h"
#include "prepare/complete.h"
#include "prepare/same_corners.h"
#include "prepare/small_objects.h"
#include "prepare/surfaces/narrow_facets.h"
#include "prepare/surfaces/near_surfaces.h"
#include "scene/surface/vertex_textures.h"
#include "scene/transforms.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace penumbra {

namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
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

std::string known_extensions() {
    std::vector<std::string> known = model_extensions();
    known.emplace_back(".toml");
    return listed(known, "and");
}

Request read_request(const std::vector<fs::path>& inputs, const LoadOptions& options) {
    Request request;
    for (const fs::path& input : inputs) {
        const std::string name = printable(input.string());
        if (!is_there(input)) throw Error(Failure::input, name, "no such file");
        if (lower_extension(input) == ".toml")
            request.sidecars.push_back(read_sidecar(input));
        else if (is_model(input))
            request.models.push_back({.file = input});
        else
            throw Error(Failure::input, name,
                        fmt::format("unknown file format (supported are {})", known_extensions()));
    }
    if (options.sidecar) request.sidecars.push_back(read_sidecar(*options.sidecar));
    for (const std::string& setting : options.settings)
        request.settings.push_back(read_setting(setting));
    request.for_each_layer([](const Layer& layer) { check_top_level(layer); });
    request.for_each_layer([&](const Layer& layer) { read_placements(layer, request.models); });
    for (Placement& model : request.models) model.file = find_spelled(model.file);
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
                                     const LoadOptions& options, Imported& result,
                                     std::set<Illumination>& made_for) {
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
            Imported model = read_model(placement.file, options.model);
            made_for.insert(model.illumination);
            if (options.sides)
                for (Material& m : model.scene.materials) m.sides = *options.sides;
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
        for (Instance& instance : placed.instances) instance.backdrop = placement.backdrop;
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

// A setting of a material that nobody has is a typing error.
void check_used(const NewMaterials& made, const Scene& scene) {
    for (const auto& [index, reference] : made) {
        // By name: a copy without the image is the same material.
        const auto uses_it = [&, &name = reference.name](const auto& thing) {
            return scene.materials[thing.material].name == name;
        };
        if (std::any_of(scene.meshes.begin(), scene.meshes.end(), uses_it) ||
            std::any_of(scene.spheres.begin(), scene.spheres.end(), uses_it) ||
            std::any_of(scene.planes.begin(), scene.planes.end(), uses_it))
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

// Nobody says how large the picture is to be: as large as the usual one allows, with the shape that
// the camera's author had in mind.
void take_shape(const Camera& camera, RenderOptions& render) {
    if (camera.aspect == 0) return;
    const double width = std::min<double>(render.width, render.height * camera.aspect);
    const double height = width / camera.aspect;
    render.width = std::max(1, int(std::lround(width)));
    render.height = std::max(1, int(std::lround(height)));
}

void separate_coincident_facets(Imported& result) {
    Scene& scene = result.scene;
    if (!may_coincide(scene)) return;
    if (const std::size_t count = lift_back_to_back_facets(scene); count > 0)
        result.losses.push_back(
            {Loss::approximated, "facets",
             fmt::format("{} that lie back to back are moved apart by a little, "
                         "each towards the side that it shows",
                         count),
             count});
    if (const std::size_t count = drop_coincident_facets(scene); count > 0)
        result.losses.push_back(
            {Loss::approximated, "facets",
             fmt::format("{} that lie exactly on others are left out: which of them "
                         "shows would be a matter of rounding",
                         count),
             count});
}

bool says_environment(const Request& request) {
    bool found = false;
    request.for_each_layer(
        [&](const Layer& layer) { found |= layer.table.contains("environment"); });
    return found;
}

// Without lights a scene gets an environment, if that is wanted and nobody says that there is none.
void light_scene(const Request& request, const LoadOptions& options, Scene& scene) {
    const bool wanted = options.studio != Studio::black && !says_environment(request);
    if (wanted && scene.lights.empty() && !scene.environment) {
        Environment& studio = set_surroundings(scene, Surroundings::studio);
        studio.sources = options.studio_sources;
        studio.visible = false;
        studio.stage =
            options.studio == Studio::floor ? Environment::Stage::floor : Environment::Stage::plain;
    }
    if (options.sources && scene.environment) scene.environment->sources = *options.sources;
}

bool says_background(const Request& request) {
    bool found = false;
    request.for_each_layer([&](const Layer& layer) {
        const toml::table* render = layer.table["render"].as_table();
        found |= render != nullptr && render->contains("background");
    });
    return found;
}

constexpr float middle_grey = 0.18F;

// Before black, what is dark in the light of its own few lamps could not be told from nothing.
void give_background(Imported& result) {
    result.scene.background = Color(middle_grey);
    result.plain_background = result.auto_exposure;
    if (!result.auto_exposure) result.scene.background *= float(std::exp2(-result.render.exposure));
}

// Returns the bounds of what they lay; nothing, and leaves `result` as far as it is, where models
// have surfaces that are not made for the light that there is. `made_for` is what they are made
// for.
std::optional<Bounds> lay_layers(const Request& request, const LoadOptions& options,
                                 Imported& result, std::set<Illumination>& made_for) {
    Scene& scene = result.scene;
    TextureFiles files;
    NewMaterials made;
    const auto replacements = load_models(request.models, options, result, made_for);
    const bool own_lights = !scene.lights.empty();
    result.auto_exposure = own_lights;
    request.for_each_layer([&](const Layer& layer) { lay_materials(layer, scene, files, made); });
    replace_materials(replacements, scene);
    bool sized = false;
    request.for_each_layer([&](const Layer& layer) {
        sized |= lay_globals(layer, result, files);
        lay_environment(layer, scene, files);
        lay_objects(layer, scene);
        lay_lights(layer, scene);
    });
    for (const auto& [file, texture] : files) result.files.push_back(file);
    drop_images_without_texcoords(result);
    drop_maps_of_translucent_materials(result);

    const double aspect = double(result.render.width) / result.render.height;
    const Bounds box = stage(scene);
    CameraAims aims;
    request.for_each_layer(
        [&](const Layer& layer) { lay_camera(layer, scene, aims, box, aspect); });
    if (!sized && scene.camera != no_index) take_shape(scene.cameras[scene.camera], result.render);
    light_scene(request, options, scene);
    result.illumination = scene.environment ? Illumination::environment : Illumination::lamps;
    made_for.erase(result.illumination);
    if (!made_for.empty()) return std::nullopt;
    if (own_lights && options.studio != Studio::black && !scene.environment && !scene.sky &&
        !says_background(request))
        give_background(result);
    complete(scene, aspect);
    separate_coincident_facets(result);
    const Losses parted = part_surfaces(scene);
    result.losses.insert(result.losses.end(), parted.begin(), parted.end());
    check_used(made, scene);
    // After complete(), so that the rig's lights can be changed as well.
    for (const Layer& layer : request.settings) edit_lights(layer, scene);
    return std::optional(box);
}

struct Laid {
    Imported imported = {};
    Bounds box = {};
};

// What the light will be is only known in the end; where a guess was wrong the models are read
// again.
Illumination likely_illumination(const Request& request, const LoadOptions& options) {
    if (says_environment(request)) return Illumination::environment;
    if (options.studio == Studio::black) return options.model.illumination;
    const auto has_lights = [](const Layer& sidecar) { return sidecar.table.contains("light"); };
    return std::ranges::any_of(request.sidecars, has_lights) ? Illumination::lamps
                                                             : Illumination::by_model;
}

Laid lay_well_lit(const Request& request, const LoadOptions& given) {
    LoadOptions options = given;
    options.model.illumination = likely_illumination(request, given);
    while (true) {
        Laid laid;
        std::set<Illumination> made_for;
        if (const auto box = lay_layers(request, options, laid.imported, made_for)) {
            laid.box = *box;
            return laid;
        }
        options.model.illumination = laid.imported.illumination;
    }
}

// Frosted glass whose vertices have colours of their own.
Losses clear_glass(const Scene& scene) {
    Losses losses;
    for (const Mesh& mesh : scene.meshes)
        if (const Material& m = scene.materials[mesh.material];
            frosts(m) && vertex_textures(mesh, m).any())
            losses.push_back({Loss::approximated, mesh.name,
                              "its rough glass is shown as clear: its vertices have colours"});
    return losses;
}

}  // namespace

Imported load_scene(const std::vector<fs::path>& given, const LoadOptions& options) {
    std::vector<fs::path> inputs;
    for (const fs::path& input : given) inputs.push_back(find_spelled(input));
    if (inputs.empty() && !options.sidecar) throw Error(Failure::usage, "", "no input is given");
    if (options.penumbra && !(std::isfinite(*options.penumbra) && *options.penumbra >= 0))
        throw Error(Failure::usage, "penumbra",
                    fmt::format("must be a finite number of 0 or more, not {}", *options.penumbra));
    for (const fs::path& folder : options.model.allowed_paths)
        if (std::error_code ignored; !fs::is_directory(folder, ignored))
            throw Error(Failure::usage, "allowed_paths",
                        fmt::format("'{}' is not a folder", printable(folder.string())));
    const Request request = read_request(inputs, options);
    auto [result, box] = lay_well_lit(request, options);
    result.files.insert(result.files.end(), inputs.begin(), inputs.end());
    if (options.sidecar) result.files.push_back(*options.sidecar);
    std::ranges::sort(result.files);
    const auto again = std::ranges::unique(result.files);
    result.files.erase(again.begin(), again.end());
    for (const Layer& layer : request.sidecars)
        result.models.push_back({.file = layer.name, .format = "sidecar"});
    if (options.penumbra) set_penumbra(result.scene, *options.penumbra);
    if (const auto found = defects(result.scene); !found.empty())
        throw Error(Failure::input, inputs.empty() ? options.sidecar->string() : inputs[0].string(),
                    found[0]);
    const Losses by_size =
        losses_by_size(result.scene, box, result.render.width, result.render.height);
    result.losses.insert(result.losses.end(), by_size.begin(), by_size.end());
    const Losses clear = clear_glass(result.scene);
    result.losses.insert(result.losses.end(), clear.begin(), clear.end());
    const Losses near =
        losses_by_nearness(result.scene, box, result.render.width, result.render.height);
    result.losses.insert(result.losses.end(), near.begin(), near.end());
    const Losses narrow =
        losses_by_narrowness(result.scene, box, result.render.width, result.render.height);
    result.losses.insert(result.losses.end(), narrow.begin(), narrow.end());
    const Losses settled = settle_normal_maps(result.scene, options.normal_maps);
    result.losses.insert(result.losses.end(), settled.begin(), settled.end());
    // What keeps its normal maps is not final: nothing of it can be exported.
    if (options.normal_maps == NormalMaps::pixel) return result;
    const Losses backs = shown_backs(result.scene);
    result.losses.insert(result.losses.end(), backs.begin(), backs.end());
    return result;
}

}  // namespace penumbra
