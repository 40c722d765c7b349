// Clean OBJ text -> Model.
#pragma once

#include "importers/obj/clean.h"

#include "penumbra/math.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace penumbra::obj {

struct Corner {
    Index position = 0;  ///< into Model::positions
    Index texcoord = no_index, normal = no_index;
    bool operator==(const Corner&) const = default;
};

struct Face {
    std::size_t first = 0;  ///< into Model::corners; ends where the next Face begins
    Index count = 0;
    Index line = 0;
    Index part = 0;       ///< into Model::parts
    Index smoothing = 0;  ///< group; 0: flat
};

/// Faces of one object and group with one material.
struct Part {
    std::string name = {};
    Index material = no_index;  ///< into Model::materials
};

/// What an OBJ file says, with every index in range and all numbers finite.
struct Model {
    std::string file = {};  ///< as the user wrote it
    std::vector<Vec3> positions = {};
    std::vector<Vec2> texcoords = {};
    std::vector<Vec3> normals = {};  ///< unit; zero where the file's cannot be used
    std::vector<Color> colors = {};  ///< linear; empty, or one or no_color per position
    std::vector<Corner> corners = {};
    std::vector<Face> faces = {};
    std::vector<Part> parts = {};
    std::vector<Named> materials = {};  ///< names in order of first use

    std::span<const Corner> corners_of(const Face& face) const {
        return std::span(corners).subspan(face.first, face.count);
    }
};

/// Parses a cleaned OBJ file, all pieces at once. Throws Error (input) with the line.
Model parse(const std::vector<Piece>& pieces, const std::string& file, Tally& tally);

}  // namespace penumbra::obj
