// Features: facets that are shown from their front alone.
#include "fidelity/features_stage.h"

#include <cmath>
#include <numbers>

namespace test {
namespace {

json clay() {
    return {{"name", "clay"},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {0.75, 0.4, 0.25, 1}},
              {"metallicFactor", 0},
              {"roughnessFactor", 0.5}}}};
}

// A leaning pipe, seen from outside and, through its upper end, from inside. Its normals, if it has
// any, are those of a cylinder.
Shape pipe(int around, bool smooth) {
    Shape shape;
    for (int i = 0; i <= around; ++i) {
        const double a = 2 * std::numbers::pi * i / around;
        const float x = float(std::cos(a)), z = float(std::sin(a));
        for (int j = 0; j < 2; ++j) {
            const float up = float(j);
            const float reach = 0.6F + 0.2F * up;
            shape.positions.insert(
                shape.positions.end(),
                {0.1F + reach * x + 0.1F * up, 0.1F + 1.1F * up + 0.2F * x, reach * z + 0.2F * up});
            if (smooth) shape.normals.insert(shape.normals.end(), {x, 0, z});
            shape.texcoords.insert(shape.texcoords.end(), {float(i) / float(around), up});
        }
    }
    for (int i = 0; i < around; ++i)
        for (const int vertex : {0, 1, 3, 0, 3, 2})
            shape.indices.push_back(std::uint16_t(2 * i + vertex));
    return shape;
}

// Among marked things, with light from two sides, and a mirror that sees the far side.
Stage stage() {
    Stage stage = marked_stage();
    stage.camera = "[camera]\nposition = [0.9, 3.1, 4.6]\nlook_at = [0.05, 0.55, 0]\nfov = 38\n";
    stage.lights += "[[light]]\nposition = [-2.5, 4.5, -3]\nintensity = 0.5\n";
    stage.rest += "[[plane]]\npoint = [0, 0, -2.2]\nnormal = [0.15, 0, 1]\nmaterial = \"mirror\"\n"
                  "[material.mirror]\ncolor = [0.2, 0.2, 0.25]\nreflection = 0.7\n";
    return stage;
}

Feature mirrored_nodes() {
    Gltf gltf = showing(pipe(9, false), clay());
    gltf.root["nodes"] = {
        {{"mesh", 0}, {"translation", {-0.8, 0, 0}}, {"scale", {0.7, 0.7, 0.7}}},
        {{"mesh", 0}, {"translation", {0.9, 0, 0}}, {"scale", {-0.7, 0.8, 0.7}}},
        {{"mesh", 0}, {"translation", {0, 0.7, 1.2}}, {"scale", {-0.3, -0.3, -0.3}}}};
    gltf.root["scenes"][0]["nodes"] = {0, 1, 2};
    return staged("single-sided, mirrored by its node", gltf, stage());
}

Feature cut_out() {
    Gltf gltf = showing(pipe(9, false));
    json material = clay();
    material["pbrMetallicRoughness"]["baseColorTexture"] = texture(gltf, "leaf.png");
    material["alphaMode"] = "MASK";
    gltf.root["meshes"][0]["primitives"][0]["material"] = gltf.add("materials", material);
    Feature feature = staged("single-sided, cut out", gltf, stage());
    feature.files["leaf.png"] = png(4);
    return feature;
}

Feature blended() {
    json material = clay();
    material["pbrMetallicRoughness"]["baseColorFactor"] = {0.2, 0.6, 0.8, 0.45};
    material["alphaMode"] = "BLEND";
    return staged("single-sided, blended", showing(pipe(9, false), material), stage());
}

Feature colored(const std::string& name, const Shape& shape) {
    Gltf gltf = showing(shape, clay());
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        gltf.accessor("VEC3", colors_of(shape));
    return staged(name, gltf, stage());
}

Feature smooth(int around) {
    Feature feature = staged("single-sided, smooth", showing(pipe(around, true), clay()), stage());
    feature.loss = "its backs are shown where they are seen at less than";
    return feature;
}

// Two sheets, each of two colours that lie back to back: one folded, of one mesh, the other of two.
Feature back_to_back(const std::string& name, const std::vector<std::uint16_t>& backs,
                     const std::string& loss) {
    Gltf gltf;
    const std::vector<float> fold = {-1.1F, 0,    0, -0.5F, 0,    0.6F, 0, 0,    0.1F,
                                     -1.1F, 1.2F, 0, -0.5F, 1.2F, 0.6F, 0, 1.2F, 0.1F};
    const int positions = gltf.accessor("VEC3", fold);
    const auto show = [&](const std::vector<std::uint16_t>& indices, const json& color) {
        json material = clay();
        material["pbrMetallicRoughness"]["baseColorFactor"] = color;
        return json{{"attributes", {{"POSITION", positions}}},
                    {"indices", gltf.accessor("SCALAR", indices)},
                    {"material", gltf.add("materials", material)}};
    };
    gltf.add("meshes", {{"primitives",
                         {show({0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4}, {0.8, 0.2, 0.1, 1}),
                          show(backs, {0.1, 0.3, 0.8, 1})}}});
    gltf.root["nodes"] = {{{"mesh", 0}},
                          {{"mesh", 0}, {"translation", {0.2, 0, 0.4}}, {"scale", {-1, 1, -0.8}}}};
    gltf.root["scenes"] = {{{"nodes", {0, 1}}}};
    Feature feature = staged(name, gltf, stage());
    feature.loss = loss;
    return feature;
}

// Two walls that are seen from behind, and a ball of glass after them.
Feature doll_house() {
    Gltf gltf;
    Shape wall;
    wall.positions = {-1.4F, 0, 1.2F, 1.5F, 0, 1.4F, 1.4F, 1.3F, 1.3F, -1.5F, 1.2F, 1.1F};
    wall.indices = {0, 2, 1, 0, 3, 2};
    gltf.add("meshes", {{"primitives", {primitive(gltf, wall, clay())}}});
    gltf.root["nodes"] = {{{"mesh", 0}},
                          {{"mesh", 0}, {"translation", {0.3, 0.1, 0.3}}, {"scale", {1, 0.8, 1}}}};
    gltf.root["scenes"] = {{{"nodes", {0, 1}}}};
    Stage glass = stage();
    glass.rest += ball_of("opacity = 0.1\nior = 1.4\ncolor = [0.9, 1, 0.9]\nspecular = 0.5\n");
    return staged("single-sided, glass seen through two backs", gltf, glass);
}

// A bowl of paper that is seen from its back and, in a mirror, from its front.
Feature paper() {
    json material = clay();
    material["extensions"]["KHR_materials_diffuse_transmission"] = {
        {"diffuseTransmissionFactor", 0.6}, {"diffuseTransmissionColorFactor", {0.9, 0.6, 0.3}}};
    Gltf gltf = showing(pipe(9, false), material);
    gltf.root["extensionsUsed"].push_back("KHR_materials_diffuse_transmission");
    return staged("single-sided, diffuse transmission", gltf, stage());
}

// OBJ shows both sides unless it is told otherwise.
Feature sides_of_obj() {
    Stage told = stage();
    told.rest += "[material.look]\nsides = \"front\"\n";
    return staged("sides of the sidecar", obj_of(pipe(9, false)),
                  "newmtl look\nKd 0.7 0.3 0.25\nKs 0.4 0.4 0.4\nNs 80\nillum 2\n", told);
}

}  // namespace

std::vector<Feature> side_features() {
    json both = clay();
    both["doubleSided"] = true;
    Feature colors = colored("single-sided, smooth vertex colours", pipe(48, true));
    colors.loss = "the backs of its facets are shown: ";
    return {staged("double-sided", showing(pipe(9, false), both), stage()),
            staged("single-sided, flat", showing(pipe(9, false), clay()), stage()),
            smooth(24),
            mirrored_nodes(),
            cut_out(),
            blended(),
            colored("single-sided, vertex colours", pipe(9, false)),
            colors,
            back_to_back("single-sided, back to back", {4, 1, 0, 3, 4, 0, 5, 2, 1, 4, 5, 1},
                         "that lie back to back are moved apart"),
            back_to_back("single-sided, back to back along other diagonals",
                         {1, 0, 3, 4, 1, 3, 2, 1, 4, 5, 2, 4}, "lie in one plane with others"),
            doll_house(),
            paper(),
            sides_of_obj()};
}

}  // namespace test
