#include "importers/obj/parse.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "importers/obj/colors.h"
#include "importers/obj/text/encoding.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <istream>
#include <limits>
#include <streambuf>
#include <unordered_map>

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

// The line in the file.
Index line_in(const Piece& piece, std::string_view start, std::size_t n) {
    return piece.first_line + line_of(piece.text, start, n) - 1;
}

// Receives tinyobjloader's callbacks, which follow the order of the piece, and puts what they say
// where it belongs in the whole file's arrays.
struct Parser {
    const Piece& piece;
    const Counts& totals;
    Tally& tally;
    Model& model;
    std::vector<std::size_t>& too_large;  // v of the piece beyond float32
    const Counts first;                   // of the piece
    Counts next = first;                  // so far

    [[noreturn]] void fail(Index line, const std::string& problem) const {
        throw Error(Failure::input, place_of(model.file, line), problem);
    }

    template <class Vector>
    static bool fits(const Vector& value) {
        bool result = true;
        for (unsigned i = 0; i < Vector::dimensions(); ++i)
            result = result && std::abs(value[int(i)]) <= double(std::numeric_limits<float>::max());
        return result;
    }

    void vertex(const Vec3& p) {
        Vec3& position = model.positions.at(next.positions++);
        if (fits(p)) {
            position = p;
            return;
        }
        make_room(too_large, model.file);
        too_large.push_back(next.positions - 1 - first.positions);
    }

    void texcoord(const Vec2& t) {
        Vec2& texcoord = model.texcoords.at(next.texcoords++);
        texcoord = t;
        if (!fits(t)) mend(texcoord);
    }

    void mend(Vec2& texcoord) const {
        const std::string what = "a number of vt that is not finite is taken as 0";
        if (!tally.losses.add_again(what))
            tally.add(Loss::approximated, what,
                      line_in(piece, "vt ", next.texcoords - first.texcoords - 1));
        for (double& value : std::span(&texcoord[0], 2))
            if (!fits(Vec2(value))) value = 0;
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
        tally.add(Loss::dropped,
                  fmt::format("{} indices are ignored: the file has no {}s", what, what), line);
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

// Whether a face uses a vertex whose position is not finite decides what it is: an error, for
// nobody knows where it should be, or left over.
void check_positions(const std::vector<Piece>& pieces, const std::vector<Counts>& firsts,
                     const std::vector<std::vector<std::size_t>>& too_large, const Model& model,
                     Tally& tally) {
    const auto none = [](const auto& list) { return list.empty(); };
    if (std::ranges::all_of(pieces, none, &Piece::not_finite) &&
        std::ranges::all_of(too_large, none))
        return;
    const MemoryClaim claim(model.positions.size() / 8, model.file);
    std::vector<bool> used(model.positions.size());
    for (const Corner& corner : model.corners) used[corner.position] = true;
    const std::string unused = "a vertex that is not finite is ignored: no face uses it";
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const std::size_t first = firsts[i].positions;
        for (const NotFinite& v : pieces[i].not_finite) {
            if (used[first + v.vertex])
                throw Error(Failure::input, place_of(model.file, v.line),
                            fmt::format("v has the number '{}', which is not finite", v.word));
            tally.add(Loss::dropped, unused, v.line);
        }
        for (const std::size_t vertex : too_large[i]) {
            const bool known = !used[first + vertex] && tally.losses.add_again(unused);
            if (known) continue;  // its line takes time to be found
            const Index line = line_in(pieces[i], "v ", vertex);
            if (used[first + vertex])
                throw Error(Failure::input, place_of(model.file, line),
                            "v has a number that is too large; the limit is 3.4e38");
            tally.add(Loss::dropped, unused, line);
        }
    }
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
                   .colors = vertex_colors(pieces, file, tally),
                   .corners = std::vector<Corner>(totals.corners),
                   .faces = std::vector<Face>(totals.faces)};
    std::vector<Tally> tallies(pieces.size(), Tally{.file = file});
    std::vector<std::vector<std::size_t>> too_large(pieces.size());
    for_each_in_parallel(pieces.size(), [&](std::size_t i) {
        Parser parser = {.piece = pieces[i],
                         .totals = totals,
                         .tally = tallies[i],
                         .model = model,
                         .too_large = too_large[i],
                         .first = firsts[i]};
        parse_piece(parser);
    });
    for (const Tally& part : tallies) tally.losses.append(part.losses);
    check_positions(pieces, firsts, too_large, model, tally);
    name_faces(pieces, model);
    return model;
}

}  // namespace penumbra::obj
