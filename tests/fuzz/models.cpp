// glTF and OBJ: the input is the model's file.
#include "fuzz.h"

#include <algorithm>

namespace fuzz {
namespace {

namespace fs = std::filesystem;

using namespace penumbra;

// As little work as possible: check_scene() bakes normal maps, in fewer facets.
Imported load(const fs::path& file, const ModelOptions& model = {}) {
    return load_scene({file}, {.model = model, .normal_maps = NormalMaps::pixel});
}

void run_gltf(const char* name, Input input) {
    const fs::path file = sandbox().write(name, input);
    may_refuse([&] {
        Imported imported = load(file);
        const std::vector<ModelInfo> models = imported.models;
        check_scene(std::move(imported));
        for (const ModelInfo& model : models) {
            const auto& used = model.extensions;
            if (std::find(used.begin(), used.end(), "KHR_materials_variants") != used.end())
                may_refuse([&] { check_scene(load(file, {.variant = "a"})); });
            if (model.animations > 0) may_refuse([&] { check_scene(load(file, {.time = 0.375})); });
        }
    });
}

constexpr Input plain_mtl = "newmtl a\nKd 0.5 0.25 0.125\nmap_Kd a.png\n";

}  // namespace

void gltf(Input input) { run_gltf("model.gltf", input); }

void glb(Input input) { run_gltf("model.glb", input); }

void obj(Input input) {
    constexpr Input mark = "\n#mtl\n";
    const std::size_t end = std::min(input.find(mark), input.size());
    sandbox().write("model.mtl", end == input.size() ? plain_mtl : input.substr(end + mark.size()));
    const fs::path file = sandbox().write("model.obj", input.substr(0, end));
    may_refuse([&] { check_scene(load(file)); });
}

void mtl(Input input) {
    sandbox().write("model.mtl", input);
    may_refuse([&] { check_scene(load(sandbox().in / "square.obj")); });
}

}  // namespace fuzz
