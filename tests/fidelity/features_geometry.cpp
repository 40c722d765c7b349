// Features: meshes and what places and poses them.
#include "fidelity/features_stage.h"

#include <cmath>

namespace test {
namespace {

const json clay = {
    {"pbrMetallicRoughness",
     {{"baseColorFactor", {0.75, 0.4, 0.25, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}}};

Feature strips_and_fans() {
    Gltf gltf;
    std::vector<float> ribbon, fan = {0.9F, 0.9F, 0.3F};
    for (int i = 0; i < 9; ++i) {
        const float z = 0.25F * float(i % 3);
        ribbon.insert(ribbon.end(), {-1.3F + 0.2F * float(i), i % 2 == 0 ? 0.1F : 1.3F, z});
        const double a = 0.7 * i;
        const float r = i % 2 == 0 ? 0.8F : 0.5F;
        fan.insert(fan.end(),
                   {0.9F + r * float(std::cos(a)), 0.9F + r * float(std::sin(a)), -0.2F});
    }
    json shown = clay;
    shown["doubleSided"] = true;  // the strip turns its back
    const int material = gltf.add("materials", shown);
    gltf.show({{"attributes", {{"POSITION", gltf.accessor("VEC3", ribbon)}}},
               {"mode", 5},
               {"material", material}});
    gltf.show({{"attributes", {{"POSITION", gltf.accessor("VEC3", fan)}}},
               {"mode", 6},
               {"material", material}});
    return staged("triangle strip and fan", gltf);
}

// A board of which some vertices are pulled forward.
Feature sparse() {
    Gltf gltf = showing(board(4), clay);
    const std::vector<std::uint16_t> which = {6, 12, 13, 18};
    const std::vector<float> where = {-0.4F, 0.4F, 0.9F, 0.1F,  0.9F, 0.6F,
                                      0.5F,  0.8F, 0.9F, 0.45F, 1.3F, 0.3F};
    const int indices = gltf.view(which), values = gltf.view(where);
    const int positions = gltf.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
    gltf.root["accessors"][positions]["sparse"] = {
        {"count", which.size()},
        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}}}};
    return staged("sparse accessor", gltf);
}

// The egg in 16 and 8 bits, KHR_mesh_quantization.
Feature quantised() {
    const Shape shape = egg();
    std::vector<std::int16_t> positions;
    std::vector<std::int8_t> normals;
    for (std::size_t i = 0; i < shape.vertices(); ++i) {
        for (std::size_t k = 0; k < 4; ++k) {  // rows of whole words
            const bool padding = k == 3;
            positions.push_back(
                std::int16_t(padding ? 0 : std::lround(10000 * shape.positions[3 * i + k])));
            normals.push_back(
                std::int8_t(padding ? 0 : std::lround(127 * shape.normals[3 * i + k])));
        }
    }
    Gltf gltf = showing(shape, clay);
    gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    json& attributes = gltf.root["meshes"][0]["primitives"][0]["attributes"];
    const auto accessor = [&](int view, int type, bool normalized) {
        return gltf.add("accessors", {{"bufferView", view},
                                      {"componentType", type},
                                      {"normalized", normalized},
                                      {"count", shape.vertices()},
                                      {"type", "VEC3"}});
    };
    attributes["POSITION"] = accessor(gltf.view(positions, {{"byteStride", 8}}), 5122, false);
    attributes["NORMAL"] = accessor(gltf.view(normals, {{"byteStride", 4}}), 5120, true);
    gltf.root["nodes"][0].update(
        {{"scale", {1.1e-4, 0.9e-4, 1e-4}}, {"translation", {-0.3, 0.1, 0}}});
    return staged("8 and 16 bit attributes", gltf);
}

Feature morphed() {
    const Shape shape = egg();
    Gltf gltf = showing(shape, clay);
    std::vector<float> moved, turned;
    for (std::size_t i = 0; i < shape.vertices(); ++i) {
        const float* p = &shape.positions[3 * i];
        moved.insert(moved.end(), {0.9F * p[1] * p[1], -0.4F * p[1], 0.3F * p[0]});
        turned.insert(turned.end(), {0.3F, -0.2F * p[1], 0.1F});
    }
    json target = {{"POSITION", gltf.accessor("VEC3", moved)}};
    target["NORMAL"] = gltf.accessor("VEC3", turned);
    gltf.root["meshes"][0]["primitives"][0]["targets"] = {target};
    gltf.root["meshes"][0]["weights"] = {0.6};
    return staged("morph target", gltf);
}

// An egg on two joints, the upper one bent.
Feature skinned() {
    const Shape shape = egg();
    Gltf gltf = showing(shape, clay);
    std::vector<std::uint8_t> joints;
    std::vector<float> weights;
    for (std::size_t i = 0; i < shape.vertices(); ++i) {
        const float up = std::min(1.0F, std::max(0.0F, shape.positions[3 * i + 1] - 0.3F));
        joints.insert(joints.end(), {0, 1, 0, 0});
        weights.insert(weights.end(), {1 - up, up, 0, 0});
    }
    json& attributes = gltf.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = gltf.accessor("VEC4", joints);
    attributes["WEIGHTS_0"] = gltf.accessor("VEC4", weights);
    std::vector<float> inverse = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    inverse.insert(inverse.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.5F, 0, 1});
    gltf.root["nodes"][0]["skin"] = 0;
    gltf.add("nodes", {{"children", {2}}});
    gltf.add("nodes",
             {{"translation", {0, 0.5, 0}}, {"rotation", {0.1, 0.2, 0.4, std::sqrt(0.79)}}});
    gltf.root["scenes"][0]["nodes"] = {0, 1};
    gltf.add("skins",
             {{"joints", {1, 2}}, {"inverseBindMatrices", gltf.accessor("MAT4", inverse)}});
    return staged("skin", gltf);
}

Feature animated() {
    Gltf gltf = showing(rock(), clay);
    const double h = std::sqrt(0.5);
    const int times = gltf.accessor("SCALAR", std::vector<float>{0, 1, 3});
    const int turns = gltf.accessor(
        "VEC4", std::vector<float>{0, 0, 0, 1, 0, float(h), 0, float(h), float(h), 0, 0, float(h)});
    const int ways =
        gltf.accessor("VEC3", std::vector<float>{0, 0, 0, -0.9F, 0.5F, 0, 0.6F, 0.8F, -1});
    const auto channel = [](int sampler, const char* path) {
        return json{{"sampler", sampler}, {"target", {{"node", 0}, {"path", path}}}};
    };
    gltf.root["animations"] = {
        {{"samplers",
          {{{"input", times}, {"output", turns}}, {{"input", times}, {"output", ways}}}},
         {"channels", {channel(0, "rotation"), channel(1, "translation")}}}};
    Feature feature = staged("animation at a time", gltf);
    feature.model.time = 1.7;
    return feature;
}

// Copies of the rock as nodes: {translation, scale}.
Gltf copies(const std::vector<json>& nodes) {
    Gltf gltf = showing(rock(), clay);
    gltf.root["nodes"] = nodes;
    json& shown = gltf.root["scenes"][0]["nodes"] = json::array();
    for (std::size_t i = 0; i < nodes.size(); ++i) shown.push_back(i);
    return gltf;
}

Feature instances() {
    return staged(
        "instances of one mesh",
        copies({{{"mesh", 0}, {"translation", {-1.2, 0, 0.2}}, {"scale", {0.6, 0.9, 0.6}}},
                {{"mesh", 0}, {"rotation", {0, 0.6, 0, 0.8}}, {"scale", {0.5, 0.5, 0.5}}},
                {{"mesh", 0}, {"translation", {0.9, 0.1, -0.8}}},
                {{"mesh", 0}, {"translation", {0.8, 0, 0.9}}, {"scale", {0.3, 0.4, 0.3}}}}));
}

Feature negative_scale() {
    return staged(
        "negative scale",
        copies({{{"mesh", 0}, {"translation", {-0.9, 0, 0}}, {"scale", {0.8, 0.8, 0.8}}},
                {{"mesh", 0}, {"translation", {0.9, 0, 0}}, {"scale", {-0.8, 0.8, 0.8}}},
                {{"mesh", 0}, {"translation", {0.1, 0.6, 1}}, {"scale", {-0.3, -0.3, -0.3}}}}));
}

Feature gpu_instances() {
    Gltf gltf = showing(rock(), clay);
    const int places = gltf.accessor(
                  "VEC3", std::vector<float>{-1.1F, 0, 0, 0.2F, 0.2F, -0.7F, 0.9F, 0, 0.5F}),
              sizes = gltf.accessor(
                  "VEC3", std::vector<float>{0.6F, 0.8F, 0.6F, 1, 0.7F, 1, 0.4F, 0.5F, 0.3F});
    gltf.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", places}, {"SCALE", sizes}};
    return staged("EXT_mesh_gpu_instancing", gltf);
}

// A sheared rock: turned inside of a node that is scaled unevenly; a branch of the tree is hidden.
Feature node_tree() {
    Gltf gltf = copies({{{"scale", {1.5, 0.7, 0.8}}, {"children", {1}}},
                        {{"rotation", {0, 0, 0.38, 0.92}}, {"mesh", 0}},
                        {{"mesh", 0}, {"translation", {-1, 0.2, 1}}, {"scale", {0.4, 0.4, 0.4}}},
                        {{"mesh", 0}, {"translation", {1.2, 0, 1}}}});
    gltf.root["scenes"][0]["nodes"] = {0, 2, 3};
    gltf.root["extensionsUsed"] = {"KHR_node_visibility"};
    gltf.root["nodes"][3]["extensions"]["KHR_node_visibility"]["visible"] = false;
    return staged("node tree, hidden node", gltf);
}

const std::string red = "newmtl look\nKd 0.7 0.3 0.25\nKs 0.4 0.4 0.4\nNs 80\nillum 2\n";

// A folded screen: smooth over its left folds, sharp over the others.
Feature smoothing_groups() {
    std::string obj;
    for (int i = 0; i < 6; ++i) {
        const std::string x = std::to_string(-1.2 + 0.5 * i), z = i % 2 == 0 ? " 0" : " 0.55";
        obj += "v " + x + " 0" + z + "\nv " + x + " 1." + std::to_string(7 - i) + z + "\n";
    }
    obj += "usemtl look\n";
    for (int i = 0; i < 5; ++i) {
        const auto point = [&](int k) { return " " + std::to_string(2 * i + k); };
        obj += (i < 3 ? "s 1\nf" : "s off\nf") + point(1) + point(3) + point(4) + point(2) + "\n";
    }
    return staged("OBJ smoothing groups", obj, red);
}

Feature concave_polygon() {
    return staged("OBJ concave polygon",
                  "v -1.2 0.1 0\nv -0.2 0.6 0\nv 0.3 0.05 0\nv 0.5 0.7 0\nv 1.4 0.5 0\n"
                  "v 0.7 1.1 0\nv 1.0 1.8 0\nv 0.1 1.2 0\nv -0.9 1.6 0\nv -0.5 0.9 0\n"
                  "usemtl look\nf 1 2 3 4 5 6 7 8 9 10\n",
                  red);
}

Stage shapes() {
    return {.rest = "[[sphere]]\ncenter = [-0.6, 0.6, 0]\nradius = 0.6\n"
                    "[[sphere]]\ncenter = [0.7, 0.35, 0.7]\nradius = 0.35\nmaterial = \"floor\"\n"
                    "[[plane]]\npoint = [0, 0, -1.5]\nnormal = [-0.4, 0.1, 1]\n"};
}

// The rock a thousandth as large and, where it is put, as far away as the Earth's radius in metres
// is in kilometres: POV-Ray's tolerances know neither.
Feature tiny_and_far() {
    return staged(
        "small, far from the origin", showing(rock(), clay),
        {.camera = "[camera]\nposition = [6.3719, 0.0019, 0.0052]\nlook_at = [6.371, 0.0008, 0]\n"
                   "fov = 36\n",
         .lights = "[[light]]\nposition = [6.3741, 0.0052, 0.0043]\n",
         .rest = "translate = [6.371, 0, 0]\nscale = 0.001\n"});
}

}  // namespace

std::vector<Feature> geometry_features() {
    return {staged("flat facets", showing(rock(), clay)),
            staged("smooth facets", showing(egg(), clay)),
            strips_and_fans(),
            sparse(),
            quantised(),
            morphed(),
            skinned(),
            animated(),
            node_tree(),
            instances(),
            gpu_instances(),
            negative_scale(),
            smoothing_groups(),
            concave_polygon(),
            staged("spheres and planes", shapes()),
            tiny_and_far()};
}

}  // namespace test
