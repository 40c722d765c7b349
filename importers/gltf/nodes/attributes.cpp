// Attributes of glTF primitives, with their morph targets -> the vertices of a Mesh.
#include "base/memory.h"
#include "base/parallel.h"
#include "importers/gltf/material/material.h"
#include "importers/gltf/nodes/attribute_use.h"
#include "importers/gltf/nodes/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

namespace penumbra::gltf {
namespace {

// Of a target without a weight nothing is seen; of a weight without a target the author expects
// something.
void check_weights(const Part& part) {
    const auto& weights = part.key.weights;
    const std::size_t targets = std::min(part.primitive.targets.size(), weights.size());
    if (std::any_of(weights.begin() + std::ptrdiff_t(targets), weights.end(),
                    [](double w) { return w != 0; }))
        part.note_loss(Loss::dropped,
                       fmt::format("it has {} morph targets for {} weights; the others are ignored",
                                   targets, weights.size()));
}

// Unit normals; those of length zero, or that are not finite, become the mean of the facets around
// them. In double, as the square of a float may be out of range.
void repair_normals(const Part& part, Mesh& mesh) {
    const std::size_t not_finite =
        replace_not_finite(&mesh.normals.front().x, mesh.normals.size(), 3, 0);
    std::atomic<bool> complete = true;
    for_each_block(mesh.normals.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const Vec3 normal(mesh.normals[i]);
            if (const double length = normal.length(); length > 1e-6)
                mesh.normals[i] = Vec3f(normal / length);
            else
                complete = false;
        }
    });
    if (complete) return;
    std::vector<Vec3> sums;
    resize_claimed(sums, mesh.normals.size(), part.place());
    std::fill(sums.begin(), sums.end(), Vec3(0));
    const auto is_missing = [&](std::size_t i) { return !(Vec3(mesh.normals[i]).length() > 1e-6); };
    for (const auto& triangle : mesh.triangles) {
        const auto corner = [&](std::size_t i) { return Vec3(mesh.positions[triangle[i]]); };
        for (const Index vertex : triangle)
            if (is_missing(vertex))
                sums[vertex] += (corner(1) - corner(0)).cross(corner(2) - corner(0));
    }
    std::size_t missing = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (!is_missing(i)) continue;
        ++missing;
        mesh.normals[i] = sums[i].length() > 0 ? Vec3f(sums[i].normalized()) : Vec3f(0, 1, 0);
    }
    part.reader.note_loss_in_primitive(
        Loss::approximated, part.pointer + "/attributes/NORMAL",
        fmt::format("{} of {} normals {}; those of the facets are used", missing,
                    mesh.normals.size(),
                    not_finite > 0 ? "have no length or are not finite" : "have no length"));
}

void read_normals(const Part& part, const Elements& range, Mesh& mesh) {
    if (attribute(part, "NORMAL", {TINYGLTF_TYPE_VEC3}) < 0) return;
    resize_claimed(mesh.normals, range.count, part.place());
    read_vertices(part, "NORMAL", range, 3, &mesh.normals.front().x);
    repair_normals(part, mesh);
}

bool has_normal_map(const Part& part) {
    const int material = material_of(part.reader, part.primitive);
    return material >= 0 && part.model().materials[std::size_t(material)].normalTexture.index >= 0;
}

// Any direction along the surface.
Vec3 along(const Vec3& normal) {
    const Vec3 axis = std::abs(normal.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    return normal.cross(axis).normalized();
}

// Only normal maps need tangents. Without normals they have no meaning (glTF 2.0, section 3.7.2.1).
void read_tangents(const Part& part, const Elements& range, Mesh& mesh) {
    if (mesh.normals.empty() || !has_normal_map(part) ||
        attribute(part, "TANGENT", {TINYGLTF_TYPE_VEC4}) < 0)
        return;
    static_assert(sizeof(Tangent) == 4 * sizeof(float));  // x, y, z and the handedness
    resize_claimed(mesh.tangents, range.count, part.place());
    float* const numbers = &mesh.tangents.front().direction.x;
    read_any_floats(part.reader.document, part.primitive.attributes.at("TANGENT"), range, 4,
                    numbers);
    morph(part, "TANGENT", range, {.first = numbers, .width = 3, .stride = 4});
    const std::size_t not_finite = replace_not_finite(numbers, range.count, 4, 0);
    std::size_t missing = 0;
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
        Tangent& tangent = mesh.tangents[i];
        const Vec3 direction(tangent.direction);
        const double length = direction.length();
        if (!(length > 1e-6)) ++missing;
        tangent.direction =
            Vec3f(length > 1e-6 ? direction / length : along(Vec3(mesh.normals[i])));
        tangent.handedness = tangent.handedness < 0 ? -1.0F : 1.0F;
    }
    if (missing > 0)
        part.reader.note_loss_in_primitive(
            Loss::approximated, part.pointer + "/attributes/TANGENT",
            fmt::format("{} of {} tangents {}; any direction is used", missing,
                        mesh.tangents.size(),
                        not_finite > 0 ? "have no length or are not finite" : "have no length"));
}

void read_texcoords(const Part& part, const Elements& range, Mesh& mesh) {
    const int material =
        material_on(part.reader, material_of(part.reader, part.primitive), part.primitive);
    const TextureUse use = texture_use(part.reader, material);
    const std::string name = fmt::format("TEXCOORD_{}", use.texcoord);
    if (attribute(part, name, {TINYGLTF_TYPE_VEC2}) < 0) {
        if (!use.used) return;
        part.note_loss(Loss::dropped, fmt::format("it has no {}; its texture is left out", name));
        mesh.material = untextured(part.reader, material);
        return;
    }
    mesh.texcoords = read_texcoord_set(part, name, range);
}

}  // namespace

Index fading(Reader& reader, Index material) {
    if (reader.scene.materials[material].alpha_map) return material;
    const auto [known, fresh] = reader.cache.fading.try_emplace(material, Index(0));
    if (fresh) {
        known->second = Index(reader.scene.materials.size());
        reader.scene.materials.emplace_back(reader.scene.materials[material]);
        reader.scene.materials.back().alpha_map = AlphaMap{};
    }
    return known->second;
}

namespace {

// glTF 2.0, section 3.9.4: alpha has a meaning only where the material is not opaque.
void read_alphas(const Part& part, const Elements& range, int accessor, Mesh& mesh) {
    const int material = material_of(part.reader, part.primitive);
    if (part.accessor(accessor).type != TINYGLTF_TYPE_VEC4 || material < 0) return;
    const std::string& mode = part.model().materials[std::size_t(material)].alphaMode;
    if (mode == "OPAQUE") return;
    std::vector<float> all, alphas;
    resize_claimed(all, range.count * 4, part.place());
    resize_claimed(alphas, range.count, part.place());
    read_vertices(part, "COLOR_0", range, 4, all.data());
    replace_not_finite(all.data(), range.count, 4, 1);  // read_colors() has said so
    for (std::size_t i = 0; i < range.count; ++i)
        alphas[i] = std::clamp(all[4 * i + 3], 0.0F, 1.0F);
    if (std::all_of(alphas.begin(), alphas.end(), [](float a) { return a == 1; })) return;
    if (mode == "MASK")
        return part.reader.note_loss_in_primitive(
            Loss::dropped, part.pointer + "/attributes/COLOR_0",
            "the vertices' alpha is ignored (alphaMode MASK)");
    mesh.alphas = std::move(alphas);
    mesh.material = fading(part.reader, mesh.material);
    const bool both_vary = std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                                       [&](const std::array<Index, 3>& t) {
                                           const auto differ = [&](const auto& of) {
                                               return of[t[0]] != of[t[1]] || of[t[0]] != of[t[2]];
                                           };
                                           return differ(mesh.colors) && differ(mesh.alphas);
                                       });
    if (both_vary)
        part.reader.note_loss_in_primitive(
            Loss::approximated, part.pointer + "/attributes/COLOR_0",
            "between vertices their colours are mixed by their alpha too: approximate");
}

void read_colors(const Part& part, const Elements& range, Mesh& mesh) {
    const int accessor = attribute(part, "COLOR_0", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4});
    for (const auto& [name, ignored] : part.primitive.attributes)
        if (name.starts_with("COLOR_") && name != "COLOR_0")
            part.note_loss(
                Loss::dropped,
                fmt::format("its {} is ignored; only COLOR_0 has a meaning", printable(name)));
    if (accessor < 0) return;
    note_unnormalized({part, "COLOR_0", "/attributes/COLOR_0", accessor});
    resize_claimed(mesh.colors, range.count, part.place());
    read_vertices(part, "COLOR_0", range, 3, &mesh.colors.front().x);
    const std::size_t replaced = replace_not_finite(&mesh.colors.front().x, range.count, 3, 1);
    if (replaced > 0)
        part.reader.note_loss_in_primitive(
            Loss::approximated, part.pointer + "/attributes/COLOR_0",
            fmt::format("{} of {} colours are not finite numbers; 1 takes their place", replaced,
                        range.count));
    // glTF 2.0, section 3.7.2.2: morphed colours are clamped.
    if (!part.key.weights.empty() && !part.primitive.targets.empty())
        for (Color& color : mesh.colors)
            for (int c = 0; c < 3; ++c) color[c] = std::clamp(color[c], 0.0F, 1.0F);
    read_alphas(part, range, accessor, mesh);
}

}  // namespace

int attribute(const Part& part, const std::string& name, Types types) {
    const auto found = part.primitive.attributes.find(name);
    if (found == part.primitive.attributes.end()) return -1;
    Use{part, name, "/attributes/" + name, found->second}.check(types, false);
    return found->second;
}

void read_vertices(const Part& part, const std::string& name, const Elements& range, int width,
                   float* out) {
    read_use({part, name, "/attributes/" + name, part.primitive.attributes.at(name)}, range, width,
             out);
    morph(part, name, range, {.first = out, .width = width, .stride = width});
}

std::vector<Vec2f> read_texcoord_set(const Part& part, const std::string& name,
                                     const Elements& range) {
    const std::string below = "/attributes/" + name;
    note_unnormalized({part, name, below, part.primitive.attributes.at(name)});
    std::vector<Vec2f> texcoords;
    resize_claimed(texcoords, range.count, part.place());
    read_vertices(part, name, range, 2, &texcoords.front().x);
    const std::size_t replaced = replace_not_finite(&texcoords.front().x, range.count, 2, 0);
    if (replaced > 0)
        part.reader.note_loss_in_primitive(
            Loss::approximated, part.pointer + below,
            fmt::format("{} of {} texture coordinates are not finite numbers; 0 takes their place",
                        replaced, range.count));
    for (Vec2f& t : texcoords) t.y = 1 - t.y;  // glTF's v runs down
    return texcoords;
}

namespace {

// Doubles keep what float32 cannot where they are far from the origin.
Vec3 read_positions(const Part& part, const Elements& range, Mesh& mesh) {
    const int index = part.primitive.attributes.at("POSITION");
    resize_claimed(mesh.positions, range.count, part.place());
    if (part.accessor(index).componentType != TINYGLTF_COMPONENT_TYPE_DOUBLE) {
        read_vertices(part, "POSITION", range, 3, &mesh.positions.front().x);
        return Vec3(0);
    }
    std::vector<Vec3> positions;
    resize_claimed(positions, range.count, part.place());
    read_doubles(part.reader.document, index, range, 3, &positions.front().x);
    constexpr double most = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int c = 0; c < 3; ++c)
            if (std::abs(positions[i][c]) > most)
                part.fail("/attributes/POSITION",
                          fmt::format("vertex {} is too far away", range[i]));
    const Vec3 origin = set_positions(positions, mesh);
    morph(part, "POSITION", range, {.first = &mesh.positions.front().x, .width = 3, .stride = 3});
    return origin;
}

}  // namespace

Vec3 read_attributes(const Part& part, const Elements& range, Mesh& mesh) {
    check_weights(part);
    const Vec3 origin = read_positions(part, range, mesh);
    read_normals(part, range, mesh);
    read_tangents(part, range, mesh);
    read_texcoords(part, range, mesh);
    read_colors(part, range, mesh);
    return origin;
}

}  // namespace penumbra::gltf
