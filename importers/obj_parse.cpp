#include "obj.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <cmath>
#include <istream>
#include <streambuf>

namespace penumbra::obj {

namespace {

static_assert(sizeof(tinyobj::real_t) == sizeof(double), "link tinyobjloader_double");

// A text as a stream, without a copy.
struct TextBuffer : std::streambuf {
    explicit TextBuffer(std::string& text) {
        setg(text.data(), text.data(), text.data() + text.size());
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

// Receives tinyobjloader's callbacks, which follow the order of the file.
struct Parser {
    Text text;
    Model model = {};
    std::size_t smoothing = 0, usemtl = 0;  // changes so far
    Index group = 0;
    std::string object = {}, group_name = {};
    Index material = no_index;
    Index part = no_index;
    std::unordered_map<std::string, Index> parts = {}, materials = {};

    [[noreturn]] void fail(Index line, const std::string& problem) const {
        throw Error(Failure::input, place_of(model.file, line), problem);
    }

    template <class Vector>
    void check_finite(const Vector& value, std::string_view statement, std::size_t n) const {
        for (unsigned i = 0; i < Vector::dimensions(); ++i)
            if (!(std::abs(value[int(i)]) <= double(std::numeric_limits<float>::max())))
                fail(line_of(text.text, statement, n),
                     fmt::format("{}has a number that is too large; the limit is 3.4e38",
                                 statement));
    }

    void vertex(const Vec3& p) {
        check_finite(p, "v ", model.positions.size());
        model.positions.push_back(p);
    }

    void texcoord(const Vec2& t) {
        check_finite(t, "vt ", model.texcoords.size());
        model.texcoords.push_back(t);
    }

    void normal(const Vec3& n) {
        const double length = n.length();
        model.normals.push_back(length > 0 && std::isfinite(length) ? n / length : Vec3(0));
    }

    std::string part_name() const {
        if (object.empty() || object == group_name) return group_name;
        return group_name.empty() ? object : object + '/' + group_name;
    }

    // The part for the current object, group and material.
    Index current_part() {
        if (part != no_index) return part;
        const std::string key = fmt::format("{}\n{}\n{}", object, group_name, material);
        const auto [found, fresh] = parts.try_emplace(key, Index(model.parts.size()));
        if (fresh) model.parts.push_back({part_name(), material});
        return part = found->second;
    }

    void use_material(const std::string& name) {
        const Index line = text.usemtl_lines.at(usemtl++);
        part = no_index;
        material = no_index;
        if (name.empty()) return;
        const auto [found, fresh] = materials.try_emplace(name, Index(model.materials.size()));
        if (fresh) model.materials.push_back({name, line});
        material = found->second;
    }

    void face(std::span<const tinyobj::index_t> given) {
        const auto& changes = text.smoothing;
        while (smoothing < changes.size() && changes[smoothing].first <= model.faces.size())
            group = changes[smoothing++].second;
        const Face face = {.first = model.corners.size(),
                           .count = Index(given.size()),
                           .line = text.face_lines.at(model.faces.size()),
                           .part = current_part(),
                           .smoothing = group};
        for (const tinyobj::index_t& index : given)
            model.corners.push_back(
                {resolve(index.vertex_index, model.positions.size(), "vertex", face.line),
                 resolve(index.texcoord_index, model.texcoords.size(), "texture coordinate",
                         face.line),
                 resolve(index.normal_index, model.normals.size(), "normal", face.line)});
        model.faces.push_back(face);
    }

    // One-based or relative -> zero-based; tinyobjloader gives 0 for what is absent. A relative
    // index refers to what was read before, an absolute one may come before its vertex.
    Index resolve(int index, std::size_t count, const char* what, Index line) const {
        if (index >= 0) return index == 0 ? no_index : Index(index - 1);
        const long result = long(count) + index;
        if (result < 0)
            fail(line, fmt::format("{} {} of the {} before this line does not exist", what, index,
                                   count));
        return Index(result);
    }

    // Indices into what the file has nothing of at all are a fault of the writing program that
    // does no harm; any other that is out of range makes the file's content doubtful.
    void check(Index Corner::*member, std::size_t count, const char* what, Tally& tally) {
        for (const Face& face : model.faces)
            for (std::size_t i = face.first; i < face.first + face.count; ++i) {
                Index& index = model.corners[i].*member;
                if (index < count) continue;
                if (index == no_index && member != &Corner::position) continue;
                if (count > 0 || member == &Corner::position)
                    fail(face.line,
                         fmt::format("{} {} of {} does not exist", what, index + 1, count));
                tally.add(fmt::format("{} indices are ignored: the file has no {}s", what, what),
                          face.line);
                index = no_index;
            }
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
    result.usemtl_cb = [](void* user, const char* name, int) {
        parser_of(user).use_material(name);
    };
    // An object begins without a group.
    result.object_cb = [](void* user, const char* name) {
        parser_of(user).object = name;
        parser_of(user).group_name.clear();
        parser_of(user).part = no_index;
    };
    result.group_cb = [](void* user, const char** names, int count) {
        std::string& name = parser_of(user).group_name;
        name.clear();
        for (int i = 0; i < count; ++i) (name += i ? " " : "") += names[i];
        parser_of(user).part = no_index;
    };
    return result;
}

}  // namespace

Model parse(Text text, const std::string& file, Tally& tally) {
    Parser parser = {.text = std::move(text)};
    parser.model.file = file;
    parser.model.colors = std::move(parser.text.colors);
    parser.model.faces.reserve(parser.text.face_lines.size());
    parser.model.corners.reserve(3 * parser.text.face_lines.size());
    TextBuffer buffer(parser.text.text);
    std::istream stream(&buffer);
    std::string warnings, errors;
    if (!tinyobj::LoadObjWithCallback(stream, callbacks(), &parser, nullptr, &warnings, &errors))
        throw Error(Failure::input, file, "is not an OBJ file: " + printable(errors));
    const Model& model = parser.model;
    parser.check(&Corner::position, model.positions.size(), "vertex", tally);
    parser.check(&Corner::texcoord, model.texcoords.size(), "texture coordinate", tally);
    parser.check(&Corner::normal, model.normals.size(), "normal", tally);
    return std::move(parser.model);
}

}  // namespace penumbra::obj
