// [environment] -> Environment.
#include "importers/sidecar/sidecar.h"
#include "scene/transforms.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>

namespace penumbra {

namespace {

enum class Choice { studio, overcast, sunset, night, none };

constexpr std::pair<const char*, Choice> names[] = {
    {"studio", Choice::studio}, {"overcast", Choice::overcast}, {"sunset", Choice::sunset},
    {"night", Choice::night},   {"none", Choice::none},
};

// What surrounds the scene can be said in three ways.
void refuse_two(Section& section) {
    const char* first = nullptr;
    for (const char* key : {"name", "image", "color"}) {
        if (!section.has(key)) continue;
        if (first != nullptr) section.reject(key, fmt::format("cannot stand beside '{}'", first));
        first = key;
    }
}

void read_surroundings(Section& section, Scene& scene, TextureFiles& files) {
    refuse_two(section);
    Choice choice = Choice::none;
    if (section.read("name", choice, names)) {
        if (choice == Choice::none) return scene.environment.reset();
        set_surroundings(scene, Surroundings(choice));
    }
    std::string file;
    if (section.read("image", file)) {
        const Index texture = load_texture(section, "image", file, scene, files);
        set_environment(scene, texture, std::filesystem::path(file).stem().string());
    }
    Color color;
    if (section.read_color("color", color)) set_uniform_environment(scene, color);
}

}  // namespace

void lay_environment(const Layer& layer, Scene& scene, TextureFiles& files) {
    Section top(layer, layer.table);
    auto section = top.table("environment");
    if (!section) return;
    read_surroundings(*section, scene, files);
    Environment unused;
    Environment& environment = scene.environment ? *scene.environment : unused;
    double turn = 0;
    if (section->read("rotate", turn)) environment.rotation = rotation_about(1, turn);
    section->read("intensity", environment.intensity, non_negative);
    section->read("sources", environment.sources, {.low = 0, .high = most_sources});
    section->read("visible", environment.visible);
    bool floor = environment.stage == Environment::Stage::floor;
    if (section->read("floor", floor))
        environment.stage = floor ? Environment::Stage::floor : Environment::Stage::plain;
    section->finish();
    if (!scene.environment && !section->has("name"))
        section->fail("", "there is no environment to change: give it a 'name', an 'image' or a "
                          "'color'");
}

}  // namespace penumbra
