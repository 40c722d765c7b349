// What the features are made of: a stage, shapes to put on it, and pictures to lay over them.
#pragma once

#include "fidelity/features.h"
#include "importers/gltf/gltf_builder.h"

#include "penumbra/image.h"

#include <array>

namespace test {

/// A sidecar in parts. A feature replaces what it is about; nothing in it is symmetric.
struct Stage {
    std::string background = "[0.1, 0.14, 0.22]";
    std::string render = {};  ///< further keys of [render]
    std::string camera = "[camera]\nposition = [0.9, 1.9, 5.2]\nlook_at = [0.05, 0.75, 0]\n"
                         "fov = 36\n";
    std::string lights = "[[light]]\nposition = [3.1, 5.2, 4.3]\ncolor = [1, 0.95, 0.85]\n"
                         "intensity = 0.9\n"
                         "[[light]]\nposition = [-4.2, 2.3, 3.5]\ncolor = [0.3, 0.4, 0.5]\n";
    std::string floor = "[[plane]]\nmaterial = \"floor\"\n"
                        "[material.floor]\ncolor = [0.5, 0.45, 0.4]\nspecular = 0\n";
    std::string rest = {};  ///< things, their materials, changes of the model's
};

/// A stage with marked things behind and before its middle, on a floor of tiles: for what one sees
/// through.
Stage marked_stage();
/// [[plane]] and material of that floor.
std::string tiles();

/// A stage with nothing but what `rest` puts on it.
Feature staged(const std::string& name, const Stage& stage);
/// `gltf` on a stage.
Feature staged(const std::string& name, const Gltf& gltf, const Stage& stage = {});
/// The model and its material library (named "model.mtl") on a stage.
Feature staged(const std::string& name, const std::string& obj, const std::string& mtl,
               const Stage& stage = {});

/// A ball in the stage's middle that wears `material`, the keys of a [material.ball].
std::string ball_of(const std::string& material);

struct Shape {
    std::vector<float> positions = {}, normals = {}, texcoords = {};
    std::vector<std::uint16_t> indices = {};
    std::size_t vertices() const { return positions.size() / 3; }
};

/// A smooth body 1.7 high that stands on the floor; its texture coordinates run from 0 to 1.
Shape egg();
/// A lump of few facets without normals.
Shape rock();
/// An upright square of parts x parts quads, leaning back; texture coordinates from -0.6 to 1.7.
Shape board(int parts = 1);

/// Each vertex its own colour, RGB floats.
std::vector<float> colors_of(const Shape& shape);

/// The accessors of `shape` as a primitive; `material` is added to the file unless it is null.
json primitive(Gltf& gltf, const Shape& shape, const json& material = {});
/// A file that shows the shape.
Gltf showing(const Shape& shape, const json& material = {});
/// Adds a texture of the image file `uri`, and returns the textureInfo of it.
json texture(Gltf& gltf, const std::string& uri, const json& sampler = {});
/// As an OBJ: v, vt, vn and f statements.
std::string obj_of(const Shape& shape);

/// A small picture without any symmetry, as the content of a .png file.
std::string png(int channels = 3, penumbra::Depth depth = penumbra::Depth::u8);
/// A gentle tangent-space normal map of size x size texels.
std::string normal_png(int size);
/// The same kind of picture in the format of the extension: ".jpg", ".exr".
std::string picture_file(const std::string& extension);

}  // namespace test
