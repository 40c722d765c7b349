// glTF meshes -> Meshes, one a primitive.
#include "gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace penumbra::gltf {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

// A primitive and where it stands.
struct Part {
    Reader& reader;
    const tinygltf::Primitive& primitive;
    std::string pointer;  // "/meshes/0/primitives/1"

    const tinygltf::Model& model() const { return reader.document.model; }
    const tinygltf::Accessor& accessor(int index) const {
        return model().accessors[std::size_t(index)];
    }
    [[noreturn]] void fail(const std::string& below, const std::string& problem) const {
        throw Error(Failure::input, reader.document.place(pointer + below), problem);
    }
};

bool quantized(const Part& part) {
    const auto& used = part.model().extensionsUsed;
    return std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end();
}

// The component types that glTF 2.0, section 3.7.2.1, and KHR_mesh_quantization allow.
bool allowed_component(const Part& part, const std::string& name, int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return true;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return name[0] == 'T' || name[0] == 'C' || (name[0] == 'P' && quantized(part));
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_SHORT: return name[0] != 'C' && quantized(part);
    default: return false;
    }
}

// The accessor of an attribute, -1 if the primitive has none. Its type and count are checked.
int attribute(const Part& part, const std::string& name, std::initializer_list<int> types) {
    const auto found = part.primitive.attributes.find(name);
    if (found == part.primitive.attributes.end()) return -1;
    const tinygltf::Accessor& accessor = part.accessor(found->second);
    if (std::find(types.begin(), types.end(), accessor.type) == types.end())
        part.fail("/attributes/" + name,
                  fmt::format("accessor {} has the wrong type, a VEC{} is needed", found->second,
                              *types.begin()));
    if (!allowed_component(part, name, accessor.componentType))
        part.fail("/attributes/" + name,
                  fmt::format("accessor {} has the componentType {}, which is not allowed here",
                              found->second, accessor.componentType));
    const std::size_t count = part.accessor(part.primitive.attributes.at("POSITION")).count;
    if (accessor.count != count)
        part.fail("/attributes/" + name,
                  fmt::format("has {} elements, but POSITION has {}", accessor.count, count));
    return found->second;
}

// The corners that the primitive lists, or 0, 1, 2, ...; into a vector of numbers or triples.
void read_corners(const Part& part, std::size_t count, Index* out) {
    if (part.primitive.indices >= 0)
        read_indices(part.reader.document, part.primitive.indices, out);
    else
        std::iota(out, out + count, Index(0));
}

std::size_t corner_count(const Part& part) {
    const int indices = part.primitive.indices;
    if (indices < 0) return part.accessor(part.primitive.attributes.at("POSITION")).count;
    const tinygltf::Accessor& accessor = part.accessor(indices);
    // Of the component types only the unsigned ones are odd.
    if (accessor.type != TINYGLTF_TYPE_SCALAR || accessor.componentType % 2 == 0)
        part.fail("/indices",
                  fmt::format("accessor {} must hold single unsigned integers", indices));
    return accessor.count;
}

Triangles read_list(const Part& part, std::size_t count) {
    // One triple more takes up what makes no whole triangle.
    Triangles triangles((count + 2) / 3);
    read_corners(part, count, triangles.data()->data());
    if (count % 3 != 0) {
        triangles.pop_back();
        part.reader.lose(part.pointer,
                         fmt::format("{} indices at the end make no triangle", count % 3));
    }
    return triangles;
}

// glTF 2.0, section 3.7.2.1: strips and fans.
Triangles read_strip_or_fan(const Part& part, std::size_t count, bool fan) {
    std::vector<Index> corners(count);
    read_corners(part, count, corners.data());
    Triangles triangles;
    triangles.reserve(count);
    for (std::size_t i = 0; i + 2 < count; ++i) {
        if (fan)
            triangles.push_back({corners[i + 1], corners[i + 2], corners[0]});
        else if (i % 2 == 0)
            triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
        else
            triangles.push_back({corners[i], corners[i + 2], corners[i + 1]});
    }
    return triangles;
}

// What is no surface is left out, and said.
bool is_surface(const Part& part) {
    const auto lose = [&](std::size_t count, const char* what) {
        part.reader.lose(part.pointer,
                         fmt::format("{} {}{} ignored", count, what, count == 1 ? " is" : "s are"));
        return false;
    };
    const std::size_t n = corner_count(part);
    switch (part.primitive.mode) {
    case TINYGLTF_MODE_POINTS: return lose(n, "point");
    case TINYGLTF_MODE_LINE: return lose(n / 2, "line");
    case TINYGLTF_MODE_LINE_LOOP: return lose(n, "line");
    case TINYGLTF_MODE_LINE_STRIP: return lose(n == 0 ? 0 : n - 1, "line");
    default: return true;
    }
}

Triangles read_triangles(const Part& part) {
    const std::size_t count = corner_count(part);
    if (part.primitive.mode == TINYGLTF_MODE_TRIANGLES) return read_list(part, count);
    return read_strip_or_fan(part, count, part.primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN);
}

// The vertices that the triangles use; primitives that share one big buffer do not copy it whole.
// The triangles are made to count from the first of them.
Range used_vertices(const Part& part, Triangles& triangles) {
    Index low = no_index, high = 0;
    for (const auto& triangle : triangles)
        for (const Index corner : triangle) {
            low = std::min(low, corner);
            high = std::max(high, corner);
        }
    const std::size_t count = part.accessor(part.primitive.attributes.at("POSITION")).count;
    if (high >= count)
        part.fail("/indices",
                  fmt::format("index {} is used, but there are {} vertices", high, count));
    for (auto& triangle : triangles)
        for (Index& corner : triangle) corner -= low;
    return {.first = low, .count = std::size_t(high - low) + 1};
}

// Unit normals; those of length zero become the mean of the facets around them. In double, as the
// square of a float may be out of range.
void repair_normals(const Part& part, Mesh& mesh) {
    std::map<Index, Vec3> missing;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        const Vec3 normal(mesh.normals[i]);
        if (const double length = normal.length(); length > 1e-6)
            mesh.normals[i] = Vec3f(normal / length);
        else
            missing.emplace(Index(i), Vec3(0));
    }
    if (missing.empty()) return;
    part.reader.lose(part.pointer + "/attributes/NORMAL",
                     fmt::format("{} of {} normals have no length; those of the facets are used",
                                 missing.size(), mesh.normals.size()));
    for (const auto& triangle : mesh.triangles) {
        const auto corner = [&](std::size_t i) { return Vec3(mesh.positions[triangle[i]]); };
        for (const Index vertex : triangle)
            if (const auto found = missing.find(vertex); found != missing.end())
                found->second += (corner(1) - corner(0)).cross(corner(2) - corner(0));
    }
    for (const auto& [vertex, sum] : missing)
        mesh.normals[vertex] = sum.length() > 0 ? Vec3f(sum.normalized()) : Vec3f(0, 1, 0);
}

void read_texcoords(const Part& part, Range range, Mesh& mesh) {
    const TextureUse use = base_texture_use(part.reader, part.primitive.material);
    const std::string name = fmt::format("TEXCOORD_{}", use.texcoord);
    const int accessor = attribute(part, name, {TINYGLTF_TYPE_VEC2});
    if (accessor < 0) {
        if (!use.used) return;
        part.reader.lose(part.pointer, fmt::format("it has no {}; its texture is left out", name));
        mesh.material = untextured(part.reader, mesh.material);
        return;
    }
    mesh.texcoords.resize(range.count);
    read_floats(part.reader.document, accessor, range, 2, &mesh.texcoords.front().x);
    const auto& m = use.transform;
    for (Vec2f& t : mesh.texcoords) {
        if (use.transformed)
            t = {float(m[0] * t.x + m[2] * t.y + m[4]), float(m[1] * t.x + m[3] * t.y + m[5])};
        t.y = 1 - t.y;  // glTF's v runs down
    }
}

void read_colors(const Part& part, Range range, Mesh& mesh) {
    const int accessor = attribute(part, "COLOR_0", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4});
    if (accessor < 0) return;
    mesh.colors.resize(range.count);
    read_floats(part.reader.document, accessor, range, 3, &mesh.colors.front().x);

    const int material = part.primitive.material;
    if (part.accessor(accessor).type != TINYGLTF_TYPE_VEC4 || material < 0 ||
        part.model().materials[std::size_t(material)].alphaMode == "OPAQUE")
        return;
    std::vector<float> all(range.count * 4);
    read_floats(part.reader.document, accessor, range, 4, all.data());
    for (std::size_t i = 3; i < all.size(); i += 4)
        if (all[i] != 1) {
            part.reader.lose(part.pointer + "/attributes/COLOR_0",
                             "the vertices' alpha is ignored");
            return;
        }
}

// No mesh where the primitive has nothing to show.
std::optional<Mesh> read_primitive(const Part& part) {
    const int positions = attribute(part, "POSITION", {TINYGLTF_TYPE_VEC3});
    if (positions < 0) {
        part.reader.lose(part.pointer, "it has no POSITION and is left out");
        return std::nullopt;
    }
    // Without the extension its accessors would be all zeros.
    if (part.primitive.extensions.count("KHR_draco_mesh_compression") != 0 &&
        part.accessor(positions).bufferView < 0)
        part.fail("", "is compressed with KHR_draco_mesh_compression, which is not supported");
    if (!is_surface(part)) return std::nullopt;

    Mesh mesh;
    mesh.triangles = read_triangles(part);
    if (mesh.triangles.empty()) {
        part.reader.lose(part.pointer, "it has no whole triangle and is left out");
        return std::nullopt;
    }
    const Range range = used_vertices(part, mesh.triangles);
    mesh.positions.resize(range.count);
    read_floats(part.reader.document, positions, range, 3, &mesh.positions.front().x);
    if (const int normals = attribute(part, "NORMAL", {TINYGLTF_TYPE_VEC3}); normals >= 0) {
        mesh.normals.resize(range.count);
        read_floats(part.reader.document, normals, range, 3, &mesh.normals.front().x);
        repair_normals(part, mesh);
    }
    mesh.material = read_material(part.reader, part.primitive.material);
    read_texcoords(part, range, mesh);
    read_colors(part, range, mesh);
    return mesh;
}

}  // namespace

const std::vector<Index>& read_mesh(Reader& reader, int index) {
    const auto [place, fresh] = reader.meshes.try_emplace(index);
    if (!fresh) return place->second;
    const tinygltf::Mesh& source = reader.document.model.meshes[std::size_t(index)];
    for (std::size_t i = 0; i < source.primitives.size(); ++i) {
        const Part part = {reader, source.primitives[i],
                           fmt::format("/meshes/{}/primitives/{}", index, i)};
        std::optional<Mesh> mesh = read_primitive(part);
        if (!mesh) continue;
        mesh->name = source.name.empty() ? fmt::format("mesh{}", index) : source.name;
        place->second.push_back(Index(reader.scene.meshes.size()));
        reader.scene.meshes.push_back(std::move(*mesh));
    }
    return place->second;
}

}  // namespace penumbra::gltf
