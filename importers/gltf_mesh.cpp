// glTF meshes -> Meshes, one a primitive.
#include "gltf_mesh.h"

#include "memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace penumbra::gltf {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

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
    Triangles triangles;
    resize_claimed(triangles, (count + 2) / 3, part.place());
    read_corners(part, count, triangles.data()->data());
    if (count % 3 != 0) {
        triangles.pop_back();
        part.lose(fmt::format("{} indices at the end make no triangle", count % 3));
    }
    return triangles;
}

// glTF 2.0, section 3.7.2.1: strips and fans.
Triangles read_strip_or_fan(const Part& part, std::size_t count, bool fan) {
    std::vector<Index> corners;
    resize_claimed(corners, count, part.place());
    read_corners(part, count, corners.data());
    const MemoryClaim claim(times(count, sizeof(Triangles::value_type)), part.place());
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
        part.reader.ignore_in_primitive(part.pointer, what, count);
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

// The vertices that the triangles use; these are made to count from the first of them. Primitives
// that share one big buffer do not copy it whole: where few of a long range are used, `chosen` is a
// list of them.
Range used_vertices(const Part& part, Triangles& triangles, std::vector<Index>& chosen) {
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
    const std::size_t corners = 3 * triangles.size(), spread = std::size_t(high - low) + 1;
    if (spread <= 2 * corners) {
        for (auto& triangle : triangles)
            for (Index& corner : triangle) corner -= low;
        return {.first = low, .count = spread};
    }
    resize_claimed(chosen, corners, part.place());
    std::copy_n(triangles.data()->data(), corners, chosen.begin());
    std::ranges::sort(chosen);
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (auto& triangle : triangles)
        for (Index& corner : triangle)
            corner = Index(std::ranges::lower_bound(chosen, corner) - chosen.begin());
    return {.first = low, .count = chosen.size(), .chosen = chosen};
}

// Adds to `shown` what the primitive has to show.
void read_primitive(const Part& part, const std::vector<Matrix>& joints, const std::string& name,
                    std::vector<ShownMesh>& shown) {
    if (attribute(part, "POSITION", {TINYGLTF_TYPE_VEC3}) < 0) {
        part.lose("it has no POSITION and is left out");
        return;
    }
    if (!is_surface(part)) return;

    Mesh mesh;
    mesh.name = name;
    mesh.triangles = read_triangles(part);
    if (mesh.triangles.empty()) {
        part.lose("it has no whole triangle and is left out");
        return;
    }
    std::vector<Index> chosen;
    const Range range = used_vertices(part, mesh.triangles, chosen);
    mesh.material = read_material(part.reader, material_of(part.reader, part.primitive));
    read_attributes(part, range, mesh);
    const bool posed = !joints.empty() && pose_vertices(part, range, joints, mesh);
    if (!joints.empty() && !posed)
        part.lose(fmt::format("it has no joints and weights for skin {}; it stands where its node "
                              "does",
                              part.form.skin));
    std::vector<Mesh>& meshes = part.reader.scene.meshes;
    for (Mesh& laid : lay_by_one_set(part, range, std::move(mesh))) {
        shown.push_back({.mesh = Index(meshes.size()), .posed = posed});
        meshes.push_back(std::move(laid));
    }
}

}  // namespace

const std::vector<ShownMesh>& read_mesh(Reader& reader, const Form& form) {
    const auto [place, fresh] = reader.meshes.try_emplace(form);
    if (!fresh) return place->second;
    const tinygltf::Mesh& source = reader.document.model.meshes[std::size_t(form.mesh)];
    const std::string name = source.name.empty() ? fmt::format("mesh{}", form.mesh) : source.name;
    const std::vector<Matrix> joints = joint_matrices(reader, form.skin);
    for (std::size_t i = 0; i < source.primitives.size(); ++i) {
        const Part part = {reader, source.primitives[i], form,
                           fmt::format("/meshes/{}/primitives/{}", form.mesh, i)};
        read_primitive(part, joints, name, place->second);
    }
    return place->second;
}

}  // namespace penumbra::gltf
