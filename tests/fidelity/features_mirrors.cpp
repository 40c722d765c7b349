// Features: reflections that are the mean of several mirror images.
#include "fidelity/features_stage.h"

namespace test {
namespace {

const std::string gold = "color = [0.9, 0.6, 0.2]\nambient = 0\ndiffuse = 0.05\nspecular = 0\n"
                         "reflection = 0.9\nmetallic = 1\n";
const std::string glass = "color = [0.8, 0.95, 0.9]\nopacity = 0.1\ntransmission = 1\nior = 1.5\n"
                          "fresnel = true\nreflection = 1\nroughness = 0.4\n";
const std::string plastic = "color = [0.1, 0.3, 0.6]\nreflection = 1\nfresnel = true\nior = 1.5\n";

// With a sharp and a rough mirror around, which see the ball and one another.
Stage stage(const std::string& rest) {
    Stage stage = marked_stage();
    stage.rest += "[[plane]]\npoint = [0, 0, -2.2]\nnormal = [0.15, 0, 1]\nmaterial = \"sharp\"\n"
                  "[material.sharp]\ncolor = [0.2, 0.2, 0.25]\nreflection = 0.7\n"
                  "[[sphere]]\ncenter = [-1.1, 0.35, 0.9]\nradius = 0.35\nmaterial = \"steel\"\n"
                  "[material.steel]\ncolor = [0.6, 0.6, 0.65]\ndiffuse = 0.1\nreflection = 0.8\n"
                  "metallic = 1\nroughness = 0.35\n" +
                  rest;
    return stage;
}

Feature worn(const std::string& name, const std::string& material) {
    return staged(name, stage(ball_of(material)));
}

// The surface of a glTF body, placed so that its space is turned and stretched, with the keys of a
// sidecar laid over it.
Feature modelled(const std::string& name, Gltf gltf, const std::string& material) {
    gltf.root["materials"][0]["name"] = "surface";
    gltf.root["nodes"][0]["rotation"] = {0.1, 0.3, 0.2, 0.927};
    gltf.root["nodes"][0]["scale"] = {1.1, 0.7, 0.9};
    return staged(name, gltf, stage("[material.surface]\n" + material));
}

Gltf body(const Shape& shape, bool two_sided = true) {
    return showing(shape, {{"doubleSided", two_sided}});
}

Gltf colored(const Shape& shape) {
    Gltf gltf = body(shape);
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        gltf.accessor("VEC3", colors_of(shape));
    return gltf;
}

// POV-Ray follows the rays of each of three vertices: 3 x 8 of them at every hit.
Feature faded() {
    const Shape shape = egg();
    Gltf gltf = body(shape);
    std::vector<float> colors;
    for (std::size_t i = 0; i < shape.vertices(); ++i)
        colors.insert(colors.end(), {1, 0.8F, 0.5F, 0.2F + 0.2F * float(i / 3 % 5)});
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        gltf.accessor("VEC4", colors);
    gltf.root["materials"][0]["alphaMode"] = "BLEND";
    gltf.root["materials"][0]["name"] = "surface";
    Stage shallow = stage("[material.surface]\nreflection = 0.6\nroughness = 0.4\n");
    shallow.render = "max_depth = 3\n";
    return staged("rough mirror, alpha of vertices", gltf, shallow);
}

// An image that is turned and stretched in both directions.
json turned_texture(Gltf& gltf) {
    json image = texture(gltf, "picture.png");
    gltf.root["extensionsUsed"].push_back("KHR_texture_transform");
    image["extensions"]["KHR_texture_transform"] = {{"scale", {2, 0.75}}, {"rotation", 0.3}};
    return image;
}

Feature masked(const std::string& name, bool turned) {
    Gltf gltf = body(board());
    gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] =
        turned ? turned_texture(gltf) : texture(gltf, "picture.png");
    gltf.root["materials"][0]["alphaMode"] = "MASK";
    Feature feature = modelled(name, std::move(gltf), "reflection = 0.6\nroughness = 0.4\n");
    feature.files["picture.png"] = png(4);
    return feature;
}

// Lobes of which each has mirrors of its own, chosen by an image.
Feature mapped_roughness() {
    Gltf gltf = body(egg());
    json& pbr = gltf.root["materials"][0]["pbrMetallicRoughness"];
    pbr["baseColorFactor"] = {0.9, 0.6, 0.3, 1};
    pbr["metallicRoughnessTexture"] = turned_texture(gltf);
    Stage around = stage("");
    around.lights = "[environment]\nname = \"overcast\"\nsources = 4\n";
    Feature feature = staged("rough metal, turned roughness map", gltf, around);
    feature.files["picture.png"] = png();
    feature.loss = "texture: mixed from";
    return feature;
}

Feature textured() {
    Gltf gltf = body(egg());
    gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] =
        texture(gltf, "picture.png");
    Feature feature =
        modelled("rough metal, textured", std::move(gltf), gold + "roughness = 0.4\n");
    feature.files["picture.png"] = png();
    return feature;
}

Feature one_sided_glass() {
    Feature feature = modelled("frosted glass, single-sided", body(egg(), false), glass);
    feature.loss = "its backs are shown";
    return feature;
}

// Cloth with an image, turned and stretched.
Feature cloth() {
    Gltf gltf = body(egg());
    json& material = gltf.root["materials"][0];
    material["pbrMetallicRoughness"]["baseColorTexture"] = texture(gltf, "picture.png");
    material["pbrMetallicRoughness"]["roughnessFactor"] = 0.8;
    material["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", {0.9, 0.6, 0.3}},
                                                     {"sheenRoughnessFactor", 0.3}};
    gltf.root["extensionsUsed"] = {"KHR_materials_sheen"};
    Feature feature = modelled("sheen, glTF cloth", std::move(gltf), "");
    feature.files["picture.png"] = png();
    feature.loss = "sheen is approximate";
    return feature;
}

// A glTF body whose surface is as rough as its volume is thick.
Feature frosted_body() {
    Gltf gltf = body(egg());
    json& material = gltf.root["materials"][0];
    material["pbrMetallicRoughness"]["roughnessFactor"] = 0.45;
    material["extensions"] = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                              {"KHR_materials_volume",
                               {{"thicknessFactor", 1},
                                {"attenuationDistance", 0.6},
                                {"attenuationColor", {0.3, 0.8, 0.6}}}}};
    gltf.root["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_volume"};
    return modelled("frosted glass, glTF body", std::move(gltf), "");
}

}  // namespace

std::vector<Feature> mirror_features() {
    return {worn("rough mirror", "reflection = [0.8, 0.6, 0.5]\nroughness = 0.3\n"),
            worn("rough dielectric", plastic + "roughness = 0.5\n"),
            worn("rough metal", gold + "roughness = 0.6\n"),
            worn("rough metal, very", gold + "roughness = 1\n"),
            worn("rough metal, 13 mirrors", gold + "roughness = 0.4\nmirrors = 13\n"),
            worn("rough metal, 19 mirrors", gold + "roughness = 0.4\nmirrors = 19\n"),
            worn("rough metal, 32 mirrors", gold + "roughness = 0.4\nmirrors = 32\n"),
            worn("rough metal, checker",
                 gold + "roughness = 0.3\n"
                        "checker = { colors = [[0.8, 0.7, 0.2], [0.1, 0.2, 0.4]], size = 0.37 }\n"),
            worn("rough mirror of a coloured highlight",
                 "reflection = 0.7\nspecular_color = [1, 0.4, 0.3]\nmetallic = 1\n"
                 "roughness = 0.3\n"),
            worn("what is reflected taken from the rest",
                 "color = [0.7, 0.3, 0.2]\nreflection = 1\nmetallic = 1\nspecular = 0.5\n"
                 "specular_color = [0.1, 0.2, 0.3]\nroughness = 0.3\nconserve_energy = true\n"),
            worn("clear coat, sharp", "color = [0.7, 0.3, 0.2]\n"
                                      "coat = { specular = 0.4, shininess = 90 }\n"),
            worn("clear coat, rough, on a rough metal",
                 gold + "roughness = 0.5\ncoat = { roughness = 0.3, specular = 0.4 }\n"),
            worn("see-through and rough: sharp", "reflection = 0.3\nroughness = 0.4\n"
                                                 "opacity = 0.5\n"),
            modelled("rough dielectric, smooth body", body(egg()), plastic + "roughness = 0.4\n"),
            modelled("rough dielectric, flat facets", body(rock()), plastic + "roughness = 0.4\n"),
            modelled("rough metal, single-sided", body(egg(), false), gold + "roughness = 0.4\n"),
            modelled("rough metal, vertex colours", colored(egg()), gold + "roughness = 0.4\n"),
            modelled("rough dielectric, vertex colours", colored(rock()),
                     plastic + "roughness = 0.4\n"),
            faded(),
            masked("rough mirror, alpha mask", false),
            masked("rough mirror, turned alpha mask", true),
            mapped_roughness(),
            textured(),
            worn("frosted glass", glass),
            worn("frosted glass, 19 ways, half of it scattered",
                 "color = [0.8, 0.95, 0.9]\ntransmission = 1\nior = 1.5\nreflection = 0.5\n"
                 "roughness = 0.4\nopacity = 0.5\ndiffuse = 0.6\nspecular = 0.4\nmirrors = 19\n"),
            one_sided_glass(),
            frosted_body(),
            worn("sheen",
                 "color = [0.1, 0.2, 0.5]\nsheen = { color = [1, 0.8, 0.6], roughness = 0.5 }\n"),
            worn("sheen under a rough coat",
                 "color = [0.5, 0.2, 0.1]\nsheen = { color = 0.7, roughness = 0.2 }\n"
                 "coat = { roughness = 0.3, specular = 0.4 }\n"),
            worn("sheen over a rough metal",
                 gold + "roughness = 0.4\nconserve_energy = true\n"
                        "sheen = { color = [0.2, 0.5, 0.9], roughness = 0.3 }\n"),
            cloth()};
}

}  // namespace test
