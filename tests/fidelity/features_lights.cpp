// Features: lights and their penumbra.
#include "fidelity/features_stage.h"

namespace test {
namespace {

const std::string balls =
    ball_of("color = [0.7, 0.5, 0.3]\n") + "[[sphere]]\ncenter = [1.1, 0.3, 0.9]\nradius = 0.3\n";

Feature lit(const std::string& name, const std::string& lights, const std::string& render = {}) {
    return staged(name, {.render = render, .lights = lights, .rest = balls});
}

Feature lit(const std::string& name, const json& light, const json& node,
            const std::string& render) {
    Gltf gltf =
        showing(rock(), {{"pbrMetallicRoughness",
                          {{"baseColorFactor", {0.35, 0.25, 0.2, 1}}, {"metallicFactor", 0}}}});
    gltf.root["extensionsUsed"] = {"KHR_lights_punctual"};
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    json lamp = node;
    lamp["extensions"]["KHR_lights_punctual"]["light"] = 0;
    gltf.root["scenes"][0]["nodes"].push_back(gltf.add("nodes", lamp));
    return staged(name, gltf, {.render = render, .lights = ""});
}

const std::string lamp = "[[light]]\nposition = [2.4, 3.6, 2.2]\n";

Feature penumbra(const std::string& name, const std::string& light, const std::string& pattern) {
    return lit("penumbra, " + name, light + "penumbra = { delta = " + pattern + " }\n");
}

const std::string spot = "[[light]]\ntype = \"spot\"\nposition = [2, 4, 2.5]\n"
                         "target = [0.2, 0.4, 0.1]\ninner = 8\nouter = 19\n";
const std::string sun = "[[light]]\ntype = \"directional\"\ndirection = [-0.5, -1, -0.7]\n"
                        "intensity = 0.8\n";

// With a mirror beside the balls, and the background where the environment is not seen.
std::vector<Feature> environments() {
    const std::string mirror = "[[sphere]]\ncenter = [-1.2, 0.5, 0.6]\nradius = 0.5\n"
                               "material = \"mirror\"\n[material.mirror]\nreflection = 0.9\n";
    const auto around = [&](const std::string& name, const std::string& keys) {
        return staged(
            "environment, " + name,
            {.lights = "[lighting]\nambient = 0\n[environment]\n" + keys, .rest = balls + mirror});
    };
    std::vector<Feature> all = {
        around("studio", "name = \"studio\"\n"),
        around("sunset, turned, 256 sources",
               "name = \"sunset\"\nrotate = -75\nsources = 256\nintensity = 0.8\n"),
        around("night, in mirrors only", "name = \"night\"\nsources = 16\nvisible = false\n"),
        around("image, EXR", "image = \"hall.exr\"\nrotate = 40\n")};
    all.back().files["hall.exr"] = picture_file(".exr");
    return all;
}

std::vector<Feature> gltf_lights() {
    const json above = {{"translation", {1.5, 3.2, 2.1}}, {"rotation", {-0.4, 0.25, 0.1, 0.87}}};
    std::vector<Feature> all;
    all.push_back(lit("point in candela, exposure",
                      {{"type", "point"}, {"intensity", 900}, {"color", {1, 0.8, 0.6}}}, above,
                      "exposure = -4.5\n"));
    all.push_back(lit("directional in lux, exposure",
                      {{"type", "directional"}, {"intensity", 50000}, {"color", {1, 0.9, 0.8}}},
                      above, "exposure = -14\n"));
    all.push_back(lit("spot cone (glTF)",
                      {{"type", "spot"},
                       {"intensity", 700},
                       {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.45}}}},
                      above, "exposure = -5\n"));
    all.back().loss = "the falloff of its cone is approximated by a smoothstep";
    all.push_back(lit("automatic exposure", {{"type", "point"}, {"intensity", 3000}},
                      {{"translation", {2.5, 6.2, 5.1}}}, ""));
    return all;
}

}  // namespace

std::vector<Feature> light_features() {
    std::vector<Feature> all = {
        lit("point", lamp),
        lit("several, coloured",
            lamp + "color = [1, 0.4, 0.2]\n[[light]]\nposition = [-3, 2, 2]\n"
                   "color = [0.2, 0.5, 1]\n[[light]]\nposition = [0.5, 0.9, 4]\nintensity = 0.2\n"),
        lit("attenuation", lamp + "intensity = 2\nattenuation = { distance = 2.1, power = 3.5 }\n"),
        lit("spot", spot),
        lit("directional", sun),
        lit("exposure", lamp, "exposure = -1.3\n"),
        penumbra("axes", lamp, "0.5, pattern = \"axes\""),
        penumbra("sphere", lamp, "0.5, pattern = \"sphere\", count = 21"),
        penumbra("grid", lamp, "0.5, pattern = \"grid\", count = [5, 3], target = [0, 0.5, 0]"),
        penumbra("grid of a spot light", spot, "0.3, pattern = \"grid\", count = 4"),
        penumbra("sphere of a directional light", sun, "0.12, pattern = \"sphere\", count = 12")};
    for (Feature& feature : environments()) all.push_back(std::move(feature));
    for (Feature& feature : gltf_lights()) all.push_back(std::move(feature));
    return all;
}

}  // namespace test
