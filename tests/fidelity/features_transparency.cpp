// Features: what shines through a surface, and the look of MTL materials.
#include "fidelity/features_stage.h"

#include <fmt/format.h>

namespace test {
namespace {

// What is marked stands behind a ball.
Feature clear(const std::string& name, const std::string& material) {
    Stage stage = marked_stage();
    stage.rest += ball_of("specular = 0.5\n" + material);
    return staged(name, stage);
}

// A glTF material on an egg.
Feature clear(const std::string& name, const json& material, const json& extensions) {
    Gltf gltf = showing(egg(), material);
    for (const auto& [extension, members] : extensions.items()) {
        gltf.root["extensionsUsed"].push_back(extension);
        gltf.root["materials"][0]["extensions"][extension] = members;
    }
    return staged(name, gltf, marked_stage());
}

// A surface of water, seen from below at a flat angle: it mirrors what stands under it.
Feature total_reflection() {
    Stage stage = marked_stage();
    stage.camera = "[camera]\nposition = [0.4, 0.35, 3.4]\nlook_at = [0, 0.7, 0]\nfov = 50\n";
    stage.floor += "[[plane]]\npoint = [0, 1.3, 0]\nnormal = [0.05, 1, 0.02]\n"
                   "material = \"water\"\n[material.water]\nopacity = 0.05\nior = 1.45\n"
                   "color = [0.8, 0.9, 1]\n";
    return staged("total internal reflection", stage);
}

// The camera stands in a ball of tinted glass.
Feature inside_glass() {
    Stage stage = marked_stage();
    stage.rest += "[[sphere]]\ncenter = [0.7, 1.7, 5]\nradius = 1.1\nmaterial = \"glass\"\n"
                  "[material.glass]\nopacity = 0.05\nior = 1.3\ncolor = [1, 1, 1]\n"
                  "absorption = { color = [0.5, 0.8, 0.9], distance = 1.5 }\n";
    return staged("camera inside glass", stage);
}

// Balls of two kinds of glass within one another, none with the same middle.
Feature onion() {
    Stage stage = marked_stage();
    stage.render = "max_depth = 80\n";
    for (int i = 0; i < 32; ++i)
        stage.rest += fmt::format("[[sphere]]\ncenter = [{}, {}, 0.1]\nradius = {}\n"
                                  "material = \"{}\"\n",
                                  0.002 * i, 0.75 + 0.001 * i, 0.7 - 0.018 * i,
                                  i % 2 == 0 ? "thin" : "thick");
    stage.rest += "[material.thin]\nopacity = 0\nior = 1.02\ncolor = [1, 1, 1]\n"
                  "absorption = { color = [0.9, 0.7, 0.5], distance = 1.5 }\n"
                  "[material.thick]\nopacity = 0\nior = 1.06\ncolor = [1, 1, 1]\n";
    return staged("glass in glass, 32 deep", stage);
}

// A sheet between the eye and a light, before and behind other things.
Feature backlit(const std::string& name, const json& members, double alpha = 1) {
    Gltf gltf = showing(board(2), {{"pbrMetallicRoughness",
                                    {{"baseColorFactor", {0.1, 0.2, 0.9, alpha}},
                                     {"metallicFactor", 0},
                                     {"roughnessFactor", 0.4}}},
                                   {"alphaMode", alpha < 1 ? "BLEND" : "OPAQUE"}});
    const std::string extension = "KHR_materials_diffuse_transmission";
    gltf.root["extensionsUsed"].push_back(extension);
    if (members.contains("diffuseTransmissionColorTexture")) texture(gltf, "picture.png");
    gltf.root["materials"][0]["extensions"][extension] = members;
    Stage stage = marked_stage();
    stage.lights += "[[light]]\nposition = [-1.2, 3.1, -6.3]\ncolor = [1, 0.9, 0.7]\n";
    Feature feature = staged(name, gltf, stage);
    feature.files["picture.png"] = png();
    return feature;
}

// Clear glass and rough metal side by side in one image, of which the egg shows the glass.
Feature beside_metal() {
    Gltf gltf = showing(egg(), {{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.9, 1, 1}}}}});
    json& material = gltf.root["materials"][0];
    json image = texture(gltf, "picture.png");
    image["extensions"]["KHR_texture_transform"] = {{"scale", {0.3, 1}}, {"offset", {0.6, 0}}};
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = image;
    material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
    material["doubleSided"] = true;
    gltf.root["extensionsUsed"] = {"KHR_materials_transmission", "KHR_texture_transform"};
    Feature feature = staged("glass beside metal in one image", gltf, marked_stage());
    penumbra::Raster raster = {.width = 16, .height = 1, .channels = 3};
    for (int i = 0; i < 16; ++i)
        for (const int sample : {0, i < 8 ? 255 : 0, i < 8 ? 255 : 0})
            raster.data.push_back(std::byte(sample));
    const TempDir folder;
    save_raster(folder / "a.png", raster);
    feature.files["picture.png"] = read(folder / "a.png");
    return feature;
}

// Glass and coloured metal that blend into one another.
Feature into_metal(const std::string& name, const std::string& image, const json& volume) {
    Gltf gltf =
        showing(egg(), {{"pbrMetallicRoughness", {{"baseColorFactor", {0.9, 0.7, 0.4, 1}}}}});
    json& material = gltf.root["materials"][0];
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = texture(gltf, "picture.png");
    material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
    gltf.root["extensionsUsed"] = {"KHR_materials_transmission"};
    const bool bends = !volume.is_null();
    if (bends) {
        material["extensions"]["KHR_materials_volume"] = volume;
        gltf.root["extensionsUsed"].push_back("KHR_materials_volume");
    }
    Feature feature = staged(name, gltf, marked_stage());
    feature.files["picture.png"] = image;
    feature.loss = "texture: mixed from";
    if (bends) feature.parity = 0.9995;  // what bends light magnifies rounding
    return feature;
}

// Glass with a light of its own by an image, all of it clear or the half of a faint one.
Feature glowing(const std::string& name, bool faint) {
    Gltf gltf = showing(egg());
    json material = {{"pbrMetallicRoughness",
                      {{"baseColorFactor", {0.9, 0.7, 0.5, faint ? 0.5 : 1}},
                       {"metallicFactor", 0},
                       {"roughnessFactor", 0}}},
                     {"alphaMode", faint ? "BLEND" : "OPAQUE"},
                     {"doubleSided", true},
                     {"emissiveFactor", {0.9, 0.5, 0.7}}};
    material["emissiveTexture"] = texture(gltf, "picture.png");
    if (!faint) material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
    gltf.root["extensionsUsed"] = {"KHR_materials_transmission"};
    gltf.root["materials"] = {material};
    gltf.root["meshes"][0]["primitives"][0]["material"] = 0;
    Feature feature = staged(name, gltf, marked_stage());
    feature.files["picture.png"] = png();
    return feature;
}

json smooth_white() {
    return {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}}};
}

Feature mtl(const std::string& name, const std::string& values) {
    return staged(name, obj_of(egg()), "newmtl look\n" + values, marked_stage());
}

}  // namespace

std::vector<Feature> transparency_features() {
    const json half = {{"pbrMetallicRoughness",
                        {{"baseColorFactor", {0.2, 0.6, 0.8, 0.45}}, {"metallicFactor", 0}}},
                       {"alphaMode", "BLEND"},
                       {"doubleSided", true}};
    json tinted = smooth_white();
    tinted["pbrMetallicRoughness"]["baseColorFactor"] = {0.9, 0.5, 0.2, 1};
    tinted["doubleSided"] = true;
    const json all_of_it = {{"transmissionFactor", 1}};
    return {clear("opacity", "color = [0.2, 0.6, 0.3]\nopacity = 0.4\n"),
            clear("opacity (glTF)", half, json::object()),
            clear("opacity 0 and emission",
                  "color = [0.9, 1, 0.8]\nopacity = 0\nemission = [0.3, 0.1, 0.2]\n"),
            clear("opacity and emission",
                  "color = [0.2, 0.6, 0.3]\nopacity = 0.4\nemission = [0.3, 0.1, 0.2]\n"),
            glowing("emission map on clear glass", false),
            glowing("emission map on a blended surface", true),
            clear("refraction", "color = [1, 1, 1]\nopacity = 0.1\nior = 1.5\n"),
            total_reflection(),
            clear("Fresnel reflection",
                  "color = [1, 1, 1]\nopacity = 0.05\nior = 1.6\nfresnel = true\nreflection = 1\n"),
            clear("tinted transmission, coloured shadow",
                  "color = [0.9, 0.4, 0.1]\nopacity = 0.1\ntransmission = 1\n"),
            clear("absorption", "color = [1, 1, 1]\nopacity = 0.05\nior = 1.2\n"
                                "absorption = { color = [0.9, 0.4, 0.2], distance = 0.8 }\n"),
            inside_glass(),
            onion(),
            beside_metal(),
            into_metal("glass and metal mixed by an image", png(), {}),
            into_metal("the same with thickness", png(),
                       {{"thicknessFactor", 1},
                        {"attenuationDistance", 0.9},
                        {"attenuationColor", {0.8, 0.6, 0.5}}}),
            backlit("diffuse transmission", {{"diffuseTransmissionFactor", 0.6},
                                             {"diffuseTransmissionColorFactor", {1, 0.3, 0.2}}}),
            backlit("diffuse transmission, image",
                    {{"diffuseTransmissionFactor", 0.8},
                     {"diffuseTransmissionColorFactor", {1, 0.7, 0.5}},
                     {"diffuseTransmissionColorTexture", {{"index", 0}}}}),
            backlit("diffuse transmission of what is half there",
                    {{"diffuseTransmissionFactor", 0.6}}, 0.5),
            clear("transmission (glTF)", tinted, {{"KHR_materials_transmission", all_of_it}}),
            clear("volume (glTF)", smooth_white(),
                  {{"KHR_materials_transmission", all_of_it},
                   {"KHR_materials_ior", {{"ior", 1.4}}},
                   {"KHR_materials_volume",
                    {{"thicknessFactor", 1},
                     {"attenuationDistance", 0.7},
                     {"attenuationColor", {0.3, 0.8, 0.5}}}}})};
}

std::vector<Feature> mtl_features() {
    const std::string base = "Kd 0.6 0.3 0.2\nKs 0.5 0.5 0.5\nNs 90\n";
    std::vector<Feature> all = {
        mtl("Ka, Kd, Ks, Ns, illum 2", base + "Ka 0.9 0.4 1\nillum 2\n"),
        mtl("Ke", base + "Ke 0.1 0.3 0.5\nillum 2\n"),
        mtl("illum 0", base + "illum 0\n"),
        mtl("illum 3, mirror", base + "illum 3\n"),
        mtl("illum 4, glass", base + "illum 4\nd 0.3\n"),
        mtl("illum 5, Fresnel mirror", base + "illum 5\nNi 1.8\n"),
        mtl("illum 6, refraction", base + "illum 6\nd 0.2\nNi 1.4\n"),
        mtl("illum 7, Fresnel and refraction", base + "illum 7\nd 0.1\nNi 1.5\n"),
        mtl("d", base + "illum 2\nd 0.5\n"),
        mtl("Tf", "Kd 0 0 0\nKs 0.2 0.2 0.2\nNs 90\nillum 4\nd 0.15\n"
                  "Tf 0.3 0.9 0.5\n"),
        mtl("Pr, Pm", "Kd 0.9 0.6 0.2\nPr 0.3\nPm 0.8\n"),
        mtl("Pc, clear coat", "Kd 0.5 0.1 0.1\nPr 0.8\nPm 0\nPc 1\nPcr 0.35\n")};
    all.back().loss = "Pc is approximate";
    // Curved mirrors over a floor of tiles up to the horizon turn the rounding of a normal into
    // another tile.
    for (std::size_t i = 3; i < 8; ++i) all[i].parity = 0.9995;
    return all;
}

}  // namespace test
