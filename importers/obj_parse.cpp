#include "memory.h"
#include "obj.h"
#include "parallel.h"

#include "penumbra/image.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <istream>
#include <iterator>
#include <streambuf>

namespace penumbra::obj {

namespace {

static_assert(sizeof(tinyobj::real_t) == sizeof(double), "link tinyobjloader_double");

// A text as a stream, without a copy.
struct TextBuffer : std::streambuf {
    explicit TextBuffer(std::string_view text) {
        char* begin = const_cast<char*>(text.data());  // is only read
        setg(begin, begin, begin + text.size());
    }
};

// The line of statement `n`, from 0, of those that begin with `start`.
Index line_of(std::string_view text, std::string_view start, std::size_t n) {
    Index line = 1;
    for (std::size_t at = 0; at < text.size(); ++line) {
        if (text.substr(at).starts_with(start) && n-- == 0) return line;
        at = std::min(text.find('\n', at), text.size()) + 1;
    }
    return line;
}

// Receives tinyobjloader's callbacks, which follow the order of the piece, and puts what they say
// where it belongs in the whole file's arrays.
struct Parser {
    const Piece& piece;
    const Counts& totals;
    Tally& tally;
    Model& model;
    const Counts first;   // of the piece
    Counts next = first;  // so far

    Index line_of(std::string_view statement, std::size_t n) const {
        return piece.first_line + obj::line_of(piece.text, statement, n) - 1;
    }

    [[noreturn]] void fail(Index line, const std::string& problem) const {
        throw Error(Failure::input, place_of(model.file, line), problem);
    }

    template <class Vector>
    void check_finite(const Vector& value, std::string_view statement, std::size_t n) const {
        for (unsigned i = 0; i < Vector::dimensions(); ++i)
            if (!(std::abs(value[int(i)]) <= double(std::numeric_limits<float>::max())))
                fail(line_of(statement, n),
                     fmt::format("{}has a number that is too large; the limit is 3.4e38",
                                 statement));
    }

    void vertex(const Vec3& p) {
        check_finite(p, "v ", next.positions - first.positions);
        model.positions.at(next.positions++) = p;
    }

    void texcoord(const Vec2& t) {
        check_finite(t, "vt ", next.texcoords - first.texcoords);
        model.texcoords.at(next.texcoords++) = t;
    }

    void normal(const Vec3& n) {
        const double length = n.length();
        model.normals.at(next.normals++) =
            length > 0 && std::isfinite(length) ? n / length : Vec3(0);
    }

    void face(std::span<const tinyobj::index_t> given) {
        const Index line = piece.face_lines.at(next.faces - first.faces);
        model.faces.at(next.faces++) = {
            .first = next.corners, .count = Index(given.size()), .line = line};
        for (const tinyobj::index_t& index : given)
            model.corners.at(next.corners++) = {
                resolve(index.vertex_index, next.positions, totals.positions, "vertex", line),
                resolve(index.texcoord_index, next.texcoords, totals.texcoords,
                        "texture coordinate", line),
                resolve(index.normal_index, next.normals, totals.normals, "normal", line)};
    }

    // One-based or relative -> zero-based; tinyobjloader gives 0 for what is absent. A relative
    // index refers to what was read before, an absolute one may come before its vertex. Indices
    // into what the file has nothing of at all are a fault of the writing program that does no
    // harm; any other that is out of range makes the file's content doubtful.
    Index resolve(int index, std::size_t before, std::size_t total, const char* what,
                  Index line) const {
        if (index == 0) return no_index;
        const long result = index > 0 ? index - 1L : long(before) + index;
        if (result < 0)
            fail(line, fmt::format("{} {} of the {} before this line does not exist", what, index,
                                   before));
        if (std::size_t(result) < total) return Index(result);
        if (total > 0 || std::string_view(what) == "vertex")
            fail(line, fmt::format("{} {} of {} does not exist", what, index, total));
        tally.add(fmt::format("{} indices are ignored: the file has no {}s", what, what), line);
        return no_index;
    }
};

Parser& parser_of(void* user) { return *static_cast<Parser*>(user); }

// Vec3 is double here, so every number arrives as tinyobjloader reads it.
tinyobj::callback_t callbacks() {
    tinyobj::callback_t result;
    result.vertex_cb = [](void* user, double x, double y, double z, double) {
        parser_of(user).vertex({x, y, z});
    };
    result.normal_cb = [](void* user, double x, double y, double z) {
        parser_of(user).normal({x, y, z});
    };
    result.texcoord_cb = [](void* user, double u, double v, double) {
        parser_of(user).texcoord({u, v});
    };
    result.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
        parser_of(user).face({indices, std::size_t(count)});
    };
    return result;
}

void parse_piece(Parser& parser) {
    TextBuffer buffer(parser.piece.text);
    std::istream stream(&buffer);
    std::string warnings, errors;
    if (!tinyobj::LoadObjWithCallback(stream, callbacks(), &parser, nullptr, &warnings, &errors))
        throw Error(Failure::input, parser.model.file, "is not an OBJ file: " + printable(errors));
}

Counts operator+(Counts a, const Counts& b) {
    a.positions += b.positions;
    a.texcoords += b.texcoords;
    a.normals += b.normals;
    a.faces += b.faces;
    a.corners += b.corners;
    return a;
}

// The names and the smoothing group that hold from some face on.
struct Naming {
    Model& model;
    std::string object = {}, group = {};
    Index material = no_index, smoothing = 0, part = no_index;
    std::unordered_map<std::string, Index> parts = {}, materials = {};

    void change(const Change& change) {
        if (change.of == Change::Of::smoothing) {
            smoothing = change.number;
            return;
        }
        part = no_index;
        switch (change.of) {
        case Change::Of::object:  // begins without a group
            object = change.name;
            group.clear();
            break;
        case Change::Of::group: group = change.name; break;
        default: use_material(change);
        }
    }

    void use_material(const Change& change) {
        material = no_index;
        if (change.name.empty()) return;
        const auto [found, fresh] =
            materials.try_emplace(change.name, Index(model.materials.size()));
        if (fresh) model.materials.push_back({change.name, change.line});
        material = found->second;
    }

    std::string part_name() const {
        if (object.empty() || object == group) return group;
        return group.empty() ? object : object + '/' + group;
    }

    // The part for the current object, group and material.
    Index current_part() {
        if (part != no_index) return part;
        const std::string key = fmt::format("{}\n{}\n{}", object, group, material);
        const auto [found, fresh] = parts.try_emplace(key, Index(model.parts.size()));
        const MemoryClaim claim(fresh ? 4 * key.size() + 256 : 0, model.file);
        if (fresh) model.parts.push_back({part_name(), material});
        return part = found->second;
    }

    void name(std::size_t from, std::size_t to) {
        for (; from < to; ++from) {
            model.faces[from].part = current_part();
            model.faces[from].smoothing = smoothing;
        }
    }
};

void name_faces(const std::vector<Piece>& pieces, Model& model) {
    Naming naming = {.model = model};
    std::size_t first = 0, named = 0;
    for (const Piece& piece : pieces) {
        for (const Change& change : piece.changes) {
            naming.name(named, first + change.face);
            named = first + change.face;
            naming.change(change);
        }
        first += piece.counts.faces;
    }
    naming.name(named, first);
}

// The format does not say in what space colours are. Programs store what they display: sRGB.
// Blender, for one, encodes them on export and decodes them on import.
std::vector<Color> linear_colors(const std::vector<Piece>& pieces, const Counts& totals,
                                 Tally& tally) {
    std::vector<Color> colors;
    float brightest = 0;
    Index first_bare = 0;
    for (const Piece& piece : pieces) {
        std::ranges::copy(piece.colors, std::back_inserter(colors));
        brightest = std::max(brightest, piece.brightest);
        if (first_bare == 0) first_bare = piece.first_bare;
    }
    if (colors.empty()) return {};
    if (colors.size() < totals.positions) {
        tally.add(fmt::format("vertex colours are ignored: only {} of {} vertices have one",
                              colors.size(), totals.positions),
                  first_bare);
        return {};
    }
    if (brightest > 1) tally.add("vertex colours exceed 1; they are taken as 0 to 255", 0);
    const float scale = brightest > 1 ? 1.0F / 255 : 1.0F;
    tbb::parallel_for(std::size_t(0), colors.size(), [&](std::size_t i) {
        for (float& value : std::span(&colors[i][0], 3))
            value = srgb_to_linear(std::min(value * scale, 1.0F));
    });
    return colors;
}

// Of a Model's arrays, in bytes.
std::size_t size_of(const Counts& counts) {
    return (counts.positions + counts.normals) * sizeof(Vec3) + counts.texcoords * sizeof(Vec2) +
           counts.corners * sizeof(Corner) + counts.faces * sizeof(Face) +
           counts.positions * sizeof(Color);
}

}  // namespace

Model parse(const std::vector<Piece>& pieces, const std::string& file, Tally& tally) {
    std::vector<Counts> firsts = {{}};
    for (const Piece& piece : pieces) firsts.push_back(firsts.back() + piece.counts);
    const Counts totals = firsts.back();
    const MemoryClaim claim(size_of(totals), file);
    Model model = {.file = file,
                   .positions = std::vector<Vec3>(totals.positions),
                   .texcoords = std::vector<Vec2>(totals.texcoords),
                   .normals = std::vector<Vec3>(totals.normals),
                   .colors = linear_colors(pieces, totals, tally),
                   .corners = std::vector<Corner>(totals.corners),
                   .faces = std::vector<Face>(totals.faces)};
    std::vector<Tally> tallies(pieces.size(), Tally(file));
    for_each_in_parallel(pieces.size(), [&](std::size_t i) {
        Parser parser = {.piece = pieces[i],
                         .totals = totals,
                         .tally = tallies[i],
                         .model = model,
                         .first = firsts[i]};
        parse_piece(parser);
    });
    for (const Tally& part : tallies) tally.append(part);
    name_faces(pieces, model);
    return model;
}

}  // namespace penumbra::obj
