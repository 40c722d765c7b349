// OBJ file -> text that tinyobjloader reads rightly, and what it would not hand on.
#pragma once

#include "importers/obj/text/tally.h"
#include "importers/obj/text/words.h"

#include "penumbra/math.h"

#include <cstddef>
#include <string>
#include <vector>

namespace penumbra::obj {

/// How many statements, or corners of faces, there are.
struct Counts {
    std::size_t positions = 0, texcoords = 0, normals = 0, faces = 0, corners = 0;
};

/// From a face on: the object, group, material (names) or smoothing group (a number).
struct Change {
    enum class Of { object, group, material, smoothing };
    Of of = Of::object;
    std::size_t face = 0;  ///< in the piece
    std::string name = {};
    Index number = 0;
    Index line = 0;
};

/// Colours of vertices that follow one another.
struct ColorRun {
    std::size_t vertex = 0;  ///< the first, in the piece
    std::size_t count = 0;
};

/// One line of ZBrush's colours: of vertices that stand before it.
struct Polypaint {
    std::size_t vertices = 0;  ///< how many v of the piece stand before it
    std::size_t count = 0;     ///< of colours
    Index line = 0;
};

/// A v whose position is infinite or no number; it stands as 0 0 0 in the text.
struct NotFinite {
    std::size_t vertex = 0;  ///< in the piece
    Index line = 0;
    std::string word = {};
};

/// A run of whole lines of an OBJ file.
struct Piece {
    Index first_line = 1;
    std::string text = {};  ///< statements v vt vn f only, on their original lines
    Counts counts = {};     ///< of them
    std::vector<Index> face_lines = {};
    std::vector<Change> changes = {};
    std::vector<NotFinite> not_finite = {};
    std::vector<Color> colors = {};  ///< as in the file, of those v that have one
    std::vector<ColorRun> color_runs = {};
    float brightest = 0;            ///< of the colours' components
    std::vector<Color> paint = {};  ///< of #MRGB, sRGB
    std::vector<Polypaint> polypaint = {};
    Index bad_polypaint = 0;            ///< the first line of #MRGB that cannot be read; 0: none
    std::vector<Named> libraries = {};  ///< operands of mtllib
};

/// Checks and cleans an OBJ file, all pieces at once. Throws Error (input) with the line.
std::vector<Piece> clean_obj(std::string bytes, const std::string& file, Tally& tally);

}  // namespace penumbra::obj
