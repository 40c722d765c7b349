// Features: surfaces that lie on one another, in whole or in part.
#include "fidelity/features_stage.h"

namespace test {
namespace {

const char* const lifted = "that lie in one plane with others are lifted off it";
const char* const left_out = "that lie exactly on others are left out";

json paint(const std::vector<double>& color) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", color}, {"metallicFactor", 0}, {"roughnessFactor", 0.6}}},
            {"doubleSided", true}};
}

const json wall_paint = paint({0.75, 0.7, 0.6, 1}), red_paint = paint({0.7, 0.15, 0.1, 1}),
           blue_paint = paint({0.1, 0.2, 0.6, 1});

json glaze() {
    json material = paint({0.9, 0.8, 0.1, 0.5});
    material["alphaMode"] = "BLEND";
    return material;
}

// An upright rectangle that leans back, so that nothing in it is a round number.
Shape sheet(float left, float bottom, float right, float top, bool turned = false) {
    Shape shape;
    for (const auto& [x, y] : {std::pair{left, bottom}, {right, bottom}, {right, top}, {left, top}})
        shape.positions.insert(shape.positions.end(), {x, y, 0.07F - 0.3F * y + 0.11F * x});
    shape.texcoords = {0, 0, 1, 0, 1, 1, 0, 1};
    if (turned)
        shape.indices = {0, 2, 1, 0, 3, 2};
    else
        shape.indices = {0, 1, 2, 0, 2, 3};
    return shape;
}

Shape box(float half, float bottom) {
    Shape shape;
    for (int i = 0; i < 8; ++i)
        shape.positions.insert(shape.positions.end(),
                               {(i & 1) != 0 ? half : -half, (i & 2) != 0 ? bottom + 1.2F : bottom,
                                (i & 4) != 0 ? half : -half});
    shape.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return shape;
}

Feature told(Feature feature, const std::string& loss) {
    feature.loss = loss;
    return feature;
}

// Shapes in the order of the file.
Gltf painted(const std::vector<std::pair<Shape, json>>& parts) {
    Gltf gltf;
    for (const auto& [shape, material] : parts) gltf.show(primitive(gltf, shape, material));
    return gltf;
}

const Shape wall = sheet(-1.5F, 0.1F, 1.4F, 1.9F);

Feature decal(const std::string& name, const Shape& shape, const json& material) {
    return told(staged(name, painted({{wall, wall_paint}, {shape, material}})), lifted);
}

Feature masked_decal() {
    Gltf gltf = painted({{wall, wall_paint}, {sheet(-0.9F, 0.3F, 1, 1.6F), red_paint}});
    json& material = gltf.root["materials"][1];
    material["pbrMetallicRoughness"]["baseColorTexture"] = texture(gltf, "picture.png");
    material["alphaMode"] = "MASK";
    Feature feature = told(staged("masked decal", gltf), lifted);
    feature.files["picture.png"] = png(4);
    return feature;
}

// Floors that overlap in part, each with its picture.
Feature overlapping_tiles() {
    const auto tile = [](float left, float near, float size) {
        Shape shape;
        for (const auto& [x, z] : {std::pair{left, near},
                                   {left + size, near},
                                   {left + size, near - size},
                                   {left, near - size}})
            shape.positions.insert(shape.positions.end(), {x, 0.4F, z});
        shape.texcoords = {0, 0, 1, 0, 1, 1, 0, 1};
        shape.indices = {0, 1, 2, 0, 2, 3};
        return shape;
    };
    Gltf gltf = painted({{tile(-1.6F, 1.2F, 1.7F), red_paint},
                         {tile(-0.4F, 0.8F, 1.9F), wall_paint},
                         {tile(0.3F, 1.5F, 1), blue_paint}});
    for (int i = 0; i < 2; ++i)
        gltf.root["materials"][i]["pbrMetallicRoughness"]["baseColorTexture"] =
            texture(gltf, "picture.png");
    Feature feature = told(staged("floors that overlap in part", gltf), lifted);
    feature.files["picture.png"] = png();
    return feature;
}

// Two meshes, each shown alone and both in one place.
Feature shared_meshes(const std::string& name, const json& first, const json& second,
                      const std::string& loss) {
    Gltf gltf = painted({{box(0.4F, 0.2F), first}, {box(0.4F, 0.2F), second}});
    gltf.root["nodes"] = {{{"mesh", 0}, {"rotation", {0, 0.3, 0, 0.953939}}},
                          {{"mesh", 1}, {"rotation", {0, 0.3, 0, 0.953939}}},
                          {{"mesh", 0}, {"translation", {-1.3, 0, 0.2}}},
                          {{"mesh", 1}, {"translation", {1.2, 0, -0.3}}}};
    gltf.root["scenes"][0]["nodes"] = {0, 1, 2, 3};
    return told(staged(name, gltf), loss);
}

// A sheet whose picture lies on itself.
Feature folded() {
    Shape shape = sheet(-1.5F, 0.1F, 1.2F, 1.8F);
    for (const auto& [x, y] : {std::pair{-0.6F, 0.4F}, {-0.7F, 1.5F}})
        shape.positions.insert(shape.positions.end(), {x, y, 0.07F - 0.3F * y + 0.11F * x});
    shape.texcoords.insert(shape.texcoords.end(), {0.2F, 1.3F, 0.9F, 1.6F});
    for (const int corner : {1, 4, 5, 1, 5, 2}) shape.indices.push_back(std::uint16_t(corner));
    Gltf gltf = painted({{shape, wall_paint}});
    gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] =
        texture(gltf, "picture.png");
    Feature feature = told(staged("a sheet folded onto itself", gltf), lifted);
    feature.files["picture.png"] = png();
    return feature;
}

// A blended sheet that its mesh has twice.
Feature twice() {
    Shape shape = sheet(-1.2F, 0.2F, 1.1F, 1.7F);
    for (const int corner : {0, 1, 2, 0, 2, 3}) shape.indices.push_back(std::uint16_t(corner));
    return decal("blended facets twice in a mesh", shape, glaze());
}

Feature on_the_floor() {
    Shape rug = sheet(0, 0, 0, 0);
    rug.positions = {-1.5F, 0, 1, 1, 0, 1.4F, 1.3F, 0, -1, -1.2F, 0, -0.8F};
    rug.indices = {0, 2, 1, 0, 3, 2};  // its front is below
    return told(staged("flat on a plane, facing down", painted({{rug, red_paint}})), lifted);
}

Feature coincident_spheres() {
    return told(staged("spheres in one place",
                       {.rest = "[[sphere]]\ncenter = [-0.2, 0.8, 0]\nradius = 0.8\n"
                                "material = \"glaze\"\n"
                                "[[sphere]]\ncenter = [-0.2, 0.8, 0]\nradius = 0.8\n"
                                "material = \"marked\"\n"
                                "[material.glaze]\ncolor = [0.3, 0.5, 0.9]\nopacity = 0.4\n"
                                "[material.marked]\nchecker = { colors = [[0.9, 0.2, 0.1], "
                                "[0.8, 0.8, 0.7]], size = 0.23 }\n"}),
                "that lie exactly on others are lifted off them");
}

}  // namespace

std::vector<Feature> coplanar_features() {
    const Shape sticker = sheet(-0.9F, 0.3F, 1, 1.6F);
    return {decal("decal on a wall", sticker, red_paint),
            decal("decal that hangs over the wall", sheet(-0.6F, 0.8F, 1.9F, 2.1F), blue_paint),
            masked_decal(),
            decal("blended decal", sheet(-0.8F, 0.4F, 0.9F, 1.5F), glaze()),
            told(staged("blended decal, before the wall",
                        painted({{sheet(-0.7F, 0.4F, 1.1F, 1.4F), glaze()}, {wall, wall_paint}})),
                 lifted),
            told(staged("three layers", painted({{wall, wall_paint},
                                                 {sticker, red_paint},
                                                 {sheet(-0.2F, 0.8F, 1.2F, 1.7F), blue_paint},
                                                 {sheet(-1.2F, 0.2F, 0.4F, 1.2F), glaze()}})),
                 lifted),
            overlapping_tiles(),
            folded(),
            twice(),
            on_the_floor(),
            told(staged("decal with its back to the viewer, on a body",
                        painted({{box(0.7F, 0.1F), wall_paint},
                                 {[] {
                                      Shape shape = sheet(0, 0, 0, 0, true);
                                      shape.positions = {-0.5F, 0.3F, 0.7F, 0.5F,  0.4F, 0.7F,
                                                         0.4F,  1.1F, 0.7F, -0.4F, 1,    0.7F};
                                      return shape;
                                  }(),
                                  red_paint}})),
                 lifted),
            shared_meshes("meshes shown often, in one place", red_paint, blue_paint, left_out),
            shared_meshes("the same, one of them blended", glaze(), blue_paint, lifted),
            coincident_spheres()};
}

}  // namespace test
