// Features: images and vertex colours as the colour of a surface.
#include "fidelity/features_stage.h"

#include <functional>

namespace test {
namespace {

// A rough dielectric.
json matte_look() {
    return {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.8}}}};
}

struct Look {
    std::string image = png();
    std::string file = "picture.png";
    json sampler = {};
    json factor = {};     ///< baseColorFactor
    json transform = {};  ///< KHR_texture_transform
    bool colors = false;  ///< at the vertices
};

// A textured board.
Feature textured(const std::string& name, const Look& look, const Shape& shape = board(3)) {
    Gltf gltf = showing(shape, matte_look());
    json& material = gltf.root["materials"][0]["pbrMetallicRoughness"];
    material["baseColorTexture"] = texture(gltf, look.file, look.sampler);
    if (!look.factor.is_null()) material["baseColorFactor"] = look.factor;
    if (!look.transform.is_null()) {
        gltf.root["extensionsUsed"] = {"KHR_texture_transform"};
        material["baseColorTexture"]["extensions"]["KHR_texture_transform"] = look.transform;
    }
    if (look.colors)
        gltf.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
            gltf.accessor("VEC3", colors_of(shape));
    Feature feature = staged(name, gltf);
    feature.files[look.file] = look.image;
    return feature;
}

json wrap(int s, int t) { return {{"wrapS", s}, {"wrapT", t}}; }
constexpr int repeat = 10497, mirror = 33648, clamp = 33071;

Feature vertex_colors() {
    const Shape shape = egg();
    Gltf gltf = showing(shape, matte_look());
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        gltf.accessor("VEC3", colors_of(shape));
    return staged("vertex colours", gltf);
}

// The image lies by TEXCOORD_1; the first set is there too.
Feature second_coordinates() {
    const Shape shape = board(3);
    Gltf gltf = showing(shape, matte_look());
    std::vector<float> second;
    for (std::size_t i = 0; i < shape.texcoords.size(); i += 2)
        second.insert(second.end(), {shape.texcoords[i + 1] - 0.3F * shape.texcoords[i],
                                     0.8F * shape.texcoords[i]});
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        gltf.accessor("VEC2", second);
    json image = texture(gltf, "picture.png");
    image["texCoord"] = 1;
    gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = image;
    Feature feature = staged("second texture coordinates", gltf);
    feature.files["picture.png"] = png();
    return feature;
}

// By a sidecar: on a ball and on the floor.
Feature on_sphere_and_plane() {
    Feature feature = staged("on a sphere and a plane",
                             {.floor = "[[plane]]\nmaterial = \"floor\"\n[material.floor]\n"
                                       "texture = { file = \"picture.png\", size = 1.7 }\n",
                              .rest = ball_of("texture = \"picture.png\"\n")});
    feature.files["picture.png"] = png();
    return feature;
}

Feature obj_texture(const std::string& name, const std::string& options) {
    Feature feature =
        staged(name, obj_of(board()),
               "newmtl look\nKd 0.9 0.8 1\nmap_Kd " + options + " picture.png\nillum 1\n");
    feature.files["picture.png"] = png();
    return feature;
}

// One file with the image in it.
Feature binary() {
    Gltf gltf = showing(board(2), matte_look());
    gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = texture(gltf, "");
    const std::string content = png(4);
    gltf.root["images"][0] = {
        {"bufferView", gltf.view(std::vector<char>(content.begin(), content.end()))},
        {"mimeType", "image/png"}};
    Feature feature = staged("image in a .glb", gltf);
    feature.files.erase("model.gltf");
    feature.files["model.glb"] = gltf.glb();
    std::string& stage = feature.files["stage.toml"];
    stage.replace(stage.find("model.gltf"), 10, "model.glb");
    return feature;
}

Feature obj_vertex_colors() {
    return staged("OBJ vertex colours",
                  "v -1.2 0.1 0 1 0.2 0.1\nv 0.9 0.3 0.3 0.1 0.8 0.2\nv 1.3 1.6 -0.3 0.2 0.3 1\n"
                  "v -0.7 1.4 0.4 0.9 0.9 0.1\nusemtl look\nf 1 2 3\nf 1 3 4\n",
                  "newmtl look\nKd 1 1 1\nillum 1\n");
}

}  // namespace

std::vector<Feature> texture_features() {
    using Depth = penumbra::Depth;
    return {
        textured("colour texture", {}),
        textured("texture times factor", {.factor = {0.9, 0.5, 0.3, 1}}),
        vertex_colors(),
        textured("texture times vertex colours", {.colors = true}),
        obj_vertex_colors(),
        textured("on a curved mesh", {}, egg()),
        second_coordinates(),
        textured("wrap: mirror", {.sampler = wrap(mirror, mirror)}),
        textured("wrap: clamp", {.sampler = wrap(clamp, clamp)}),
        textured("wrap: clamp and mirror", {.sampler = wrap(clamp, mirror)}),
        textured("wrap: mirror and repeat", {.sampler = wrap(mirror, repeat)}),
        textured("nearest filter", {.sampler = {{"magFilter", 9728}, {"minFilter", 9728}}}),
        textured("16 bit PNG", {.image = png(3, Depth::u16)}),
        textured("grey PNG", {.image = png(1)}),
        textured("JPEG", {.image = picture_file(".jpg"), .file = "picture.jpg"}),
        textured("KHR_texture_transform",
                 {.transform = {{"offset", {0.2, 0.1}}, {"scale", {1.4, 0.8}}, {"rotation", 0.5}}}),
        on_sphere_and_plane(),
        binary(),
        obj_texture("Kd map with -s and -o", "-s 1.3 0.7 1 -o 0.2 0.35 0"),
        obj_texture("Kd map with -clamp and -mm", "-clamp on -mm 0.15 0.6")};
}

}  // namespace test
