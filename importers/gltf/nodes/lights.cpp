// KHR_lights_punctual -> Lights.
#include "importers/gltf/nodes/lights.h"

#include "importers/gltf/nodes/camera.h"
#include "importers/gltf/reader/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::gltf {
namespace {

int light_of(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_lights_punctual");
    if (found == node.extensions.end() || !found->second.Has("light")) return -1;
    return found->second.Get("light").GetNumberAsInt();
}

// POV-Ray's smoothstep between two cosines that comes nearest to glTF's squared ramp: least
// largest difference, 0.061 as long as the inner cone is not too narrow.
void set_cone(Light& light, double inner, double outer) {
    const double full = std::cos(inner), none = std::cos(outer);
    const double from = none + 0.2046 * (full - none), to = none + 1.1406 * (full - none);
    light.inner = std::acos(std::min(to, 1.0));
    light.outer = std::acos(from);
}

}  // namespace

void read_light(Reader& reader, int index, const Matrix& world) {
    const tinygltf::Model& model = reader.document.model;
    const int light_index = light_of(model.nodes[std::size_t(index)]);
    if (light_index < 0) return;
    const tinygltf::Light& source = model.lights[std::size_t(light_index)];
    const std::string pointer =
        fmt::format("/extensions/KHR_lights_punctual/lights/{}", light_index);
    const std::string& node_name = model.nodes[std::size_t(index)].name;
    Light light;
    light.name = !source.name.empty() ? source.name
                 : !node_name.empty() ? node_name
                                      : fmt::format("light{}", reader.scene.lights.size());
    light.position = world.translation();
    light.direction = direction_of(world);
    if (source.color.size() == 3)
        light.color = Color(float(source.color[0]), float(source.color[1]), float(source.color[2]));
    // Our diffuse term has no 1 / pi: it is part of the source.
    light.intensity = source.intensity / std::numbers::pi;

    if (source.type == "directional") {
        light.type = Light::Type::directional;
    } else if (source.type == "point" || source.type == "spot") {
        if (source.range > 0) reader.note_loss(Loss::dropped, pointer, "its range is ignored");
    } else {
        reader.note_loss(
            Loss::dropped, pointer,
            fmt::format("its type '{}' is unknown; it is left out", printable(source.type)));
        return;
    }
    if (source.type == "spot") {
        light.type = Light::Type::spot;
        const double outer = std::clamp(source.spot.outerConeAngle, 0.002, radians(89.9));
        set_cone(light, std::clamp(source.spot.innerConeAngle, 0.0, outer - 0.001), outer);
        reader.note_loss(Loss::approximated, pointer,
                         "the falloff of its cone is approximated by a smoothstep");
    }
    reader.scene.lights.push_back(std::move(light));
}

// I / d^2 as 2 / (1 + (d/f)^2) * I / (2 f^2): with f a thousandth of the scene's radius the two
// differ by a millionth at that radius.
void set_attenuation(Scene& scene) {
    const double radius = bounds(scene).radius();
    const double f = 1e-3 * (radius > 0 ? radius : 1);
    for (Light& light : scene.lights) {
        if (light.type == Light::Type::directional) continue;
        light.attenuation = Attenuation{.distance = f, .power = 2};
        light.intensity /= 2 * f * f;
    }
}

}  // namespace penumbra::gltf
