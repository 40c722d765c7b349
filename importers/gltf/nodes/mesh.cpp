// glTF meshes -> Meshes, one a primitive.
#include "importers/gltf/nodes/mesh.h"

#include "base/memory.h"
#include "importers/gltf/material/material.h"
#include "importers/gltf/nodes/pose.h"
#include "scene/transforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
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
        part.note_loss(Loss::dropped,
                       fmt::format("{} indices at the end make no triangle", count % 3));
    }
    return triangles;
}

// KHR_mesh_primitive_restart and EXT_mesh_primitive_restart: the largest number of the indices'
// type ends a strip, fan or loop, and another one begins.
std::optional<Index> restart_index(const Part& part) {
    const auto& used = part.model().extensionsUsed;
    const bool restarts = std::ranges::any_of(used, [](const std::string& name) {
        return name == "KHR_mesh_primitive_restart" || name == "EXT_mesh_primitive_restart";
    });
    if (!restarts || part.primitive.indices < 0) return std::nullopt;
    switch (part.accessor(part.primitive.indices).componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return Index(0xff);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return Index(0xffff);
    default: return Index(0xffffffff);
    }
}

// Calls `work` with the corners of each strip, fan or loop of the primitive.
template <class Work>
void for_each_run(const Part& part, std::size_t count, Work&& work) {
    std::vector<Index> corners;
    resize_claimed(corners, count, part.place());
    read_corners(part, count, corners.data());
    const std::optional<Index> restart = restart_index(part);
    auto first = corners.begin();
    while (restart && first != corners.end()) {
        const auto last = std::find(first, corners.end(), *restart);
        work(std::span<const Index>(first, last));
        first = last == corners.end() ? last : last + 1;
    }
    if (!restart) work(std::span<const Index>(corners));
}

// glTF 2.0, section 3.7.2.1: strips and fans.
void add_strip_or_fan(std::span<const Index> corners, bool fan, Triangles& triangles) {
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        if (fan)
            triangles.push_back({corners[i + 1], corners[i + 2], corners[0]});
        else if (i % 2 == 0)
            triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
        else
            triangles.push_back({corners[i], corners[i + 2], corners[i + 1]});
    }
}

Triangles read_strips_or_fans(const Part& part, std::size_t count, bool fan) {
    const MemoryClaim claim(times(count, sizeof(Triangles::value_type)), part.place());
    Triangles triangles;
    triangles.reserve(count);
    for_each_run(part, count, [&](std::span<const Index> corners) {
        add_strip_or_fan(corners, fan, triangles);
    });
    return triangles;
}

// How many lines the strips or loops of a primitive have.
std::size_t count_lines(const Part& part, std::size_t count, bool loop) {
    std::size_t lines = 0;
    if (!restart_index(part)) return loop || count == 0 ? count : count - 1;
    for_each_run(part, count, [&](std::span<const Index> corners) {
        lines += loop || corners.empty() ? corners.size() : corners.size() - 1;
    });
    return lines;
}

// What is no surface is left out, and said.
bool is_surface(const Part& part) {
    const auto note_loss = [&](std::size_t count, const char* what) {
        part.reader.ignore_in_primitive(part.pointer, what, count);
        return false;
    };
    const std::size_t n = corner_count(part);
    if (part.primitive.extensions.contains("KHR_gaussian_splatting")) {
        part.note_loss(Loss::dropped,
                       fmt::format("its {} Gaussian splats (KHR_gaussian_splatting) are left out: "
                                   "they have no surface",
                                   n));
        return false;
    }
    switch (part.primitive.mode) {
    case TINYGLTF_MODE_POINTS: return note_loss(n, "point");
    case TINYGLTF_MODE_LINE: return note_loss(n / 2, "line");
    case TINYGLTF_MODE_LINE_LOOP: return note_loss(count_lines(part, n, true), "line");
    case TINYGLTF_MODE_LINE_STRIP: return note_loss(count_lines(part, n, false), "line");
    default: return true;
    }
}

Triangles read_triangles(const Part& part) {
    const std::size_t count = corner_count(part);
    if (part.primitive.mode == TINYGLTF_MODE_TRIANGLES) return read_list(part, count);
    return read_strips_or_fans(part, count, part.primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN);
}

// The vertices that the triangles use; these are made to count from the first of them. Primitives
// that share one big buffer do not copy it whole: where few of a long range are used, `chosen` is a
// list of them.
Elements used_vertices(const Part& part, Triangles& triangles, std::vector<Index>& chosen) {
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

// The joints' matrices for vertices that are counted from `origin`.
std::vector<Matrix> counted_from(const Vec3& origin, std::vector<Matrix> joints) {
    if (origin != Vec3(0))
        for (Matrix& joint : joints) joint = Matrix().setTranslation(origin) * joint;
    return joints;
}

// Adds to `shown` what the primitive has to show.
void read_primitive(const Part& part, const std::vector<Matrix>& joints, const std::string& name,
                    std::vector<ShownMesh>& shown) {
    if (attribute(part, "POSITION", {TINYGLTF_TYPE_VEC3}) < 0) {
        part.note_loss(Loss::dropped, "it has no POSITION and is left out");
        return;
    }
    if (!is_surface(part)) return;

    Mesh mesh;
    mesh.name = name;
    mesh.triangles = read_triangles(part);
    if (mesh.triangles.empty()) {
        part.note_loss(Loss::dropped, "it has no whole triangle and is left out");
        return;
    }
    std::vector<Index> chosen;
    const Elements range = used_vertices(part, mesh.triangles, chosen);
    mesh.material = read_material(
        part.reader,
        material_on(part.reader, material_of(part.reader, part.primitive), part.primitive));
    const Vec3 own_origin = read_attributes(part, range, mesh);
    std::optional<Vec3> origin;
    if (!joints.empty())
        origin = pose_vertices(part, range, counted_from(own_origin, joints), mesh);
    if (!joints.empty() && !origin)
        part.note_loss(
            Loss::approximated,
            fmt::format("it has no joints and weights for skin {}; it stands where its node "
                        "does",
                        part.key.skin));
    std::vector<Mesh>& meshes = part.reader.scene.meshes;
    for (Mesh& laid : lay_by_one_set(part, range, std::move(mesh))) {
        shown.push_back({.mesh = Index(meshes.size()),
                         .posed = origin.has_value(),
                         .origin = origin.value_or(own_origin)});
        meshes.push_back(std::move(laid));
    }
}

}  // namespace

std::vector<std::array<Index, 3>> read_facets(const Part& part) {
    return is_surface(part) ? read_triangles(part) : Triangles();
}

Vec3 set_positions(const std::vector<Vec3>& positions, Mesh& mesh) {
    Bounds box;
    for (const Vec3& p : positions) box.extend(p);
    const Vec3 origin = local_origin(box);
    for (std::size_t i = 0; i < positions.size(); ++i)
        mesh.positions[i] = Vec3f(positions[i] - origin);
    return origin;
}

const std::vector<ShownMesh>& read_mesh(Reader& reader, const MeshKey& key) {
    const auto [place, fresh] = reader.meshes.try_emplace(key);
    if (!fresh) return place->second;
    const tinygltf::Mesh& source = reader.document.model.meshes[std::size_t(key.mesh)];
    const std::string name = source.name.empty() ? fmt::format("mesh{}", key.mesh) : source.name;
    const std::vector<Matrix> joints = joint_matrices(reader, key.skin);
    for (std::size_t i = 0; i < source.primitives.size(); ++i) {
        const Part part = {reader, source.primitives[i], key,
                           fmt::format("/meshes/{}/primitives/{}", key.mesh, i)};
        read_primitive(part, joints, name, place->second);
    }
    return place->second;
}

}  // namespace penumbra::gltf
