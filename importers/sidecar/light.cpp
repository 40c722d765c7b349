// [[light]] -> Light.
#include "importers/sidecar/sidecar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr std::pair<const char*, Light::Type> types[] = {
    {"point", Light::Type::point},
    {"spot", Light::Type::spot},
    {"directional", Light::Type::directional},
};

constexpr std::pair<const char*, Penumbra::Layout> layouts[] = {
    {"axes", Penumbra::Layout::axes},
    {"sphere", Penumbra::Layout::sphere},
    {"grid", Penumbra::Layout::grid},
};

void read_attenuation(Section& section, Light& light) {
    if (section.is_false("attenuation")) return light.attenuation.reset();
    auto inner = section.table("attenuation");
    if (!inner) return;
    const bool fresh = !light.attenuation;
    Attenuation attenuation = light.attenuation.value_or(Attenuation{});
    inner->read("distance", attenuation.distance, positive);
    inner->read("power", attenuation.power, positive);
    inner->finish();
    if (fresh && !section.layer().setting) inner->require("distance");
    light.attenuation = attenuation;
}

// How many virtual sources: n of a sphere, [n, m] or n x n of a grid; axes are always 7.
void read_count(Section& section, Penumbra& penumbra, bool new_layout) {
    using Layout = Penumbra::Layout;
    if (penumbra.layout == Layout::axes) {
        if (section.has("count")) section.reject("count", "is fixed for pattern \"axes\": 7");
        penumbra.count = {7, 1};
    } else if (penumbra.layout == Layout::sphere) {
        if (new_layout) penumbra.count = {16, 1};
        section.read("count", penumbra.count[0], {.low = 1, .high = 4096});
    } else {
        if (new_layout) penumbra.count = {4, 4};
        constexpr Range side = {.low = 1, .high = 64};
        if (!section.is_number("count")) {
            section.read("count", penumbra.count, side);
        } else if (section.read("count", penumbra.count[0], side)) {
            penumbra.count[1] = penumbra.count[0];
        }
    }
}

// True when a target for the grid is given.
bool read_penumbra(Section& section, Light& light) {
    if (section.is_false("penumbra")) {
        light.penumbra.delta = 0;
        return false;
    }
    auto inner = section.table("penumbra");
    if (!inner) return false;
    const bool fresh = light.penumbra.delta == 0;
    const auto layout = light.penumbra.layout;
    inner->read("delta", light.penumbra.delta, non_negative);
    inner->read("pattern", light.penumbra.layout, layouts);
    read_count(*inner, light.penumbra, light.penumbra.layout != layout);
    const bool aimed = inner->read("target", light.penumbra.target);
    inner->finish();
    if (fresh && !section.layer().setting) inner->require("delta");
    return aimed;
}

// Half-angles. One that is not given makes room for the other.
void read_cone(Section& section, Light& light) {
    const bool inner =
        section.read_angle("inner", light.inner, {.low = 0, .high = 90, .open_high = true});
    const bool outer = section.read_angle(
        "outer", light.outer, {.low = 0, .high = 90, .open_low = true, .open_high = true});
    if (light.inner < light.outer) return;
    if (inner && outer) section.reject("inner", "must be smaller than 'outer'");
    if (outer) light.inner = light.outer * 2 / 3;
    if (inner) light.outer = std::min(light.inner * 1.5, (light.inner + radians(90)) / 2);
}

// What a light of another type has: almost always a forgotten `type`.
void refuse(Section& section, const Light& light, std::initializer_list<const char*> keys) {
    const auto* type = std::find_if(std::begin(types), std::end(types),
                                    [&](const auto& t) { return t.second == light.type; });
    for (const char* key : keys)
        if (section.has(key) && !section.is_false(key))
            section.reject(key, fmt::format("has no meaning for a {} light", type->first));
}

// The direction of a light that is given by a point.
void aim(Section& section, Light& light, const Vec3& target) {
    if (section.has("direction")) section.reject("target", "cannot stand beside 'direction'");
    if (!std::isnormal((target - light.position).length()))
        section.reject("target", "must differ from 'position'");
    light.direction = target - light.position;
}

void check_grid(Section& section, Light& light, bool aimed) {
    if (light.penumbra.layout != Penumbra::Layout::grid || light.penumbra.delta == 0) return;
    if (light.type != Light::Type::point) {
        if (!aimed) light.penumbra.target = light.position + light.direction;
    } else if (!aimed && section.table("penumbra") && !section.layer().setting) {
        section.fail("penumbra",
                     fmt::format("{} needs a 'target' that its grid faces", section.title()));
    } else if (light.penumbra.target == light.position) {
        section.reject("penumbra", "must face a 'target' away from 'position'");
    }
}

void read_light(Section& section, Light& light) {
    using Type = Light::Type;
    Vec3 target(0);
    section.read("name", light.name);
    section.read("type", light.type, types);
    section.read("position", light.position);
    const bool directed = section.read("direction", light.direction);
    const bool targeted = section.read("target", target);
    section.read_color("color", light.color);
    section.read("intensity", light.intensity, non_negative);
    read_attenuation(section, light);
    if (targeted) light.penumbra.target = target;
    const bool aimed = read_penumbra(section, light) || targeted;
    read_cone(section, light);
    section.finish();

    if (light.type == Type::point) refuse(section, light, {"direction", "inner", "outer"});
    if (light.type == Type::directional) refuse(section, light, {"attenuation", "inner", "outer"});
    if (targeted && light.type != Type::point) aim(section, light, target);
    if (directed && !std::isnormal(light.direction.length()))
        section.reject("direction", "must not have length zero");
    light.direction.normalize();
    check_grid(section, light, aimed);
}

}  // namespace

void lay_lights(const Layer& layer, Scene& scene) {
    for (Section& section : Section(layer, layer.table).list("light")) {
        Light light;
        read_light(section, light);
        if (light.type != Light::Type::directional) section.require("position");
        if (light.type != Light::Type::point && !section.has("target") && !section.has("direction"))
            section.fail("type", section.title() + " needs 'direction' or 'target'");
        scene.lights.push_back(std::move(light));
    }
}

void edit_lights(const Layer& layer, Scene& scene) {
    Section top(layer, layer.table);
    for (auto& [index, section] : top.edits("light", scene.lights.size(), "lights"))
        read_light(section, scene.lights[index]);
}

}  // namespace penumbra
