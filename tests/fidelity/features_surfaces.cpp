// Features: what surfaces without images look like.
#include "fidelity/features_stage.h"

namespace test {
namespace {

Feature worn(const std::string& name, const std::string& material) {
    return staged(name, {.rest = ball_of(material)});
}

// The material of a glTF file, on an egg.
Feature imported(const std::string& name, const json& material, const json& extensions = {}) {
    Gltf gltf = showing(egg(), material);
    for (const auto& [extension, members] : extensions.items()) {
        gltf.root["extensionsUsed"].push_back(extension);
        gltf.root["materials"][0]["extensions"][extension] = members;
    }
    return staged(name, gltf);
}

json surface(double metallic, double roughness) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {0.8, 0.5, 0.2, 1}},
              {"metallicFactor", metallic},
              {"roughnessFactor", roughness}}}};
}

// Two mirrors that face one another, and a ball between.
Feature recursion(const std::string& name, int depth) {
    return staged(name, {.render = "max_depth = " + std::to_string(depth) + "\n",
                         .rest = "[[plane]]\npoint = [0, 0, -1.5]\nnormal = [0.15, 0, 1]\n"
                                 "material = \"mirror\"\n"
                                 "[[plane]]\npoint = [0, 0, 6]\nnormal = [0, 0.06, -1]\n"
                                 "material = \"mirror\"\n"
                                 "[material.mirror]\nreflection = [0.8, 0.85, 0.9]\n"
                                 "diffuse = 0.1\n" +
                                 ball_of("color = [0.9, 0.3, 0.1]\n")});
}

Feature variant() {
    Gltf gltf = showing(egg(), surface(0, 0.6));
    const int other = gltf.add(
        "materials", {{"pbrMetallicRoughness",
                       {{"baseColorFactor", {0.2, 0.5, 0.9, 1}}, {"metallicFactor", 0.3}}}});
    const std::string extension = "KHR_materials_variants";
    gltf.root["extensionsUsed"] = {extension};
    gltf.root["extensions"][extension]["variants"] = {{{"name", "day"}}, {{"name", "night"}}};
    gltf.root["meshes"][0]["primitives"][0]["extensions"][extension]["mappings"] = {
        {{"material", other}, {"variants", {1}}}};
    Feature feature = staged("material variant", gltf);
    feature.model.variant = "night";
    return feature;
}

Feature coated() {
    Feature feature = imported("clearcoat",
                               {{"pbrMetallicRoughness",
                                 {{"baseColorFactor", {0.4, 0.05, 0.05, 1}},
                                  {"metallicFactor", 0},
                                  {"roughnessFactor", 0.8}}}},
                               {{"KHR_materials_clearcoat",
                                 {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.35}}}});
    feature.loss = "clearcoat is approximate";
    return feature;
}

std::vector<Feature> gltf_surfaces() {
    return {
        imported("metallic-roughness, dielectric", surface(0, 0.35)),
        imported("metallic-roughness, metal", surface(1, 0.3)),
        imported("specular-glossiness", json::object(),
                 {{"KHR_materials_pbrSpecularGlossiness",
                   {{"diffuseFactor", {0.3, 0.5, 0.2, 1}},
                    {"specularFactor", {0.2, 0.2, 0.2}},
                    {"glossinessFactor", 0.7}}}}),
        imported("specular-glossiness, a metal", json::object(),
                 {{"KHR_materials_pbrSpecularGlossiness",
                   {{"diffuseFactor", {0.02, 0.01, 0, 1}},
                    {"specularFactor", {0.8, 0.6, 0.2}},
                    {"glossinessFactor", 0.6}}}}),
        imported("specular colour", surface(0, 0.35),
                 {{"KHR_materials_specular", {{"specularColorFactor", {0.1, 0.4, 1}}}},
                  {"KHR_materials_ior", {{"ior", 1.9}}}}),
        imported("metal by an infinite ior", surface(0, 0.4),
                 {{"KHR_materials_specular", {{"specularColorFactor", {0.8, 0.6, 0.2}}}},
                  {"KHR_materials_ior", {{"ior", 0}}}}),
        imported("ior of the highlight", surface(0, 0.3), {{"KHR_materials_ior", {{"ior", 2.1}}}}),
        coated(),
        imported("emissive strength",
                 {{"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 1}}}},
                  {"emissiveFactor", {0.3, 0.1, 0.05}}},
                 {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1.6}}}}),
        imported("unlit", surface(0, 1), {{"KHR_materials_unlit", json::object()}}),
        variant()};
}

}  // namespace

std::vector<Feature> surface_features() {
    std::vector<Feature> all = {
        worn("diffuse and highlight", "color = [0.7, 0.3, 0.2]\nspecular = 0.6\nshininess = 25\n"),
        worn("coloured highlight",
             "color = [0.2, 0.3, 0.5]\nspecular = 0.9\nspecular_color = [1, 0.3, 0.1]\n"
             "reflection = [0.1, 0.2, 0.3]\nshininess = 9\n"),
        worn("coloured highlight of glass",
             "color = [0.2, 0.3, 0.5]\nspecular = 0.9\nspecular_color = [1, 0.3, 0.1]\n"
             "reflection = 0.4\nmetallic = 1\nshininess = 9\nopacity = 0.3\ntransmission = 0.6\n"
             "ior = 1.3\nfresnel = true\n"),
        worn("metallic tint",
             "color = [0.8, 0.5, 0.1]\nspecular = 0.8\nmetallic = 0.9\nreflection = 0.5\n"
             "shininess = 15\n"),
        worn("coloured mirror", "reflection = [0.9, 0.6, 0.3]\ndiffuse = 0.1\n"),
        recursion("recursion to depth 3", 3),
        recursion("recursion to depth 12", 12),
        worn("emission", "color = [0.2, 0.4, 0.3]\nemission = [0.5, 0.2, 0.1]\n"),
        worn("checker", "checker = { colors = [[0.8, 0.7, 0.2], [0.1, 0.2, 0.4]], size = 0.37 }\n"),
        worn("noise", "noise = { colors = [[0.1, 0.2, 0.3], [0.9, 0.6, 0.3]], size = 0.21 }\n"),
        worn("noise, 5 octaves",
             "noise = { colors = [[0.1, 0.2, 0.3], [0.9, 0.6, 0.3]], size = 0.4, octaves = 5 }\n")};
    for (Feature& feature : gltf_surfaces()) all.push_back(std::move(feature));
    return all;
}

}  // namespace test
