// Attributes of glTF primitives, with their morph targets -> the vertices of a Mesh.
#include "gltf_mesh.h"
#include "memory.h"
#include "parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace penumbra::gltf {
namespace {

bool quantized(const Part& part) {
    const auto& used = part.model().extensionsUsed;
    return std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end();
}

// An attribute's name without its number says what its numbers may be: glTF 2.0, sections 3.7.2.1
// and 3.7.2.2 (`delta`: of a morph target), and KHR_mesh_quantization.
bool allowed_component(const Part& part, const std::string& name, int type, bool delta) {
    const auto is = [&](const char* kind) { return name.rfind(kind, 0) == 0; };
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return !is("JOINTS");
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return is("TEXCOORD") || is("COLOR") || is("WEIGHTS") || is("JOINTS") ||
               (is("POSITION") && quantized(part));
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        if (delta && (is("TEXCOORD") || is("COLOR"))) return true;
        return !is("COLOR") && !is("WEIGHTS") && !is("JOINTS") && quantized(part);
    default: return false;
    }
}

const char* word_for(int type) {
    return type == TINYGLTF_TYPE_VEC2 ? "VEC2" : type == TINYGLTF_TYPE_VEC3 ? "VEC3" : "VEC4";
}

// An accessor that is used for an attribute or a morph target of it.
struct Use {
    const Part& part;
    std::string name, below;  // "NORMAL", "/targets/0/NORMAL"
    int index = -1;

    void check(Types types, bool delta) const;
};

void Use::check(Types types, bool delta) const {
    const tinygltf::Accessor& accessor = part.accessor(index);
    if (std::find(types.begin(), types.end(), accessor.type) == types.end())
        part.fail(below, fmt::format("accessor {} has the wrong type, a {} is needed", index,
                                     word_for(*types.begin())));
    if (!allowed_component(part, name, accessor.componentType, delta))
        part.fail(below,
                  fmt::format("accessor {} has the componentType {}, which is not allowed here",
                              index, accessor.componentType));
    if (accessor.normalized && name.rfind("JOINTS", 0) == 0)
        part.fail(below, fmt::format("accessor {} must not be normalized", index));
    const std::size_t count = part.accessor(part.primitive.attributes.at("POSITION")).count;
    if (accessor.count != count)
        part.fail(below,
                  fmt::format("has {} elements, but POSITION has {}", accessor.count, count));
}

// Numbers of vertices: `width` of each that lie side by side, `stride` from one to the next.
struct Vertices {
    float* first;
    int width, stride;
};

// glTF 2.0, section 3.7.2.2: each target's deltas times its weight. In blocks, so that the deltas
// of a large mesh are not all in memory.
void add_deltas(const Use& use, double weight, const Range& range, const Vertices& out) {
    constexpr std::size_t block = std::size_t(1) << 16;
    const auto width = std::size_t(out.width), stride = std::size_t(out.stride);
    std::vector<float> deltas(std::min(block, range.count) * width);
    for (std::size_t start = 0; start < range.count; start += block) {
        const std::size_t count = std::min(block, range.count - start);
        read_floats(use.part.reader.document, use.index, range.part(start, count), out.width,
                    deltas.data());
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t c = 0; c < width; ++c) {
                float& number = out.first[(start + i) * stride + c];
                number = float(double(number) + weight * double(deltas[i * width + c]));
            }
    }
}

void morph(const Part& part, const std::string& name, const Range& range, const Vertices& out) {
    const auto& targets = part.primitive.targets;
    const auto& weights = part.form.weights;
    for (std::size_t t = 0; t < std::min(targets.size(), weights.size()); ++t) {
        const auto found = targets[t].find(name);
        if (found == targets[t].end() || weights[t] == 0) continue;
        const Use use = {part, name, fmt::format("/targets/{}/{}", t, name), found->second};
        if (name.rfind("COLOR", 0) == 0)
            use.check({TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, true);
        else
            use.check({out.width == 2 ? TINYGLTF_TYPE_VEC2 : TINYGLTF_TYPE_VEC3}, true);
        Vertices morphed = out;
        morphed.width = std::min(out.width, components(part.accessor(use.index)));
        add_deltas(use, weights[t], range, morphed);
    }
}

// Of a target without a weight nothing is seen; of a weight without a target the author expects
// something.
void check_weights(const Part& part) {
    const auto& weights = part.form.weights;
    const std::size_t targets = std::min(part.primitive.targets.size(), weights.size());
    if (std::any_of(weights.begin() + std::ptrdiff_t(targets), weights.end(),
                    [](double w) { return w != 0; }))
        part.lose(fmt::format("it has {} morph targets for {} weights; the others are ignored",
                              targets, weights.size()));
}

// Unit normals; those of length zero become the mean of the facets around them. In double, as the
// square of a float may be out of range.
void repair_normals(const Part& part, Mesh& mesh) {
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
    part.reader.lose_in_primitive(
        part.pointer + "/attributes/NORMAL",
        fmt::format("{} of {} normals have no length; those of the facets are used", missing,
                    mesh.normals.size()));
}

void read_normals(const Part& part, const Range& range, Mesh& mesh) {
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
void read_tangents(const Part& part, const Range& range, Mesh& mesh) {
    if (mesh.normals.empty() || !has_normal_map(part) ||
        attribute(part, "TANGENT", {TINYGLTF_TYPE_VEC4}) < 0)
        return;
    static_assert(sizeof(Tangent) == 4 * sizeof(float));  // x, y, z and the handedness
    resize_claimed(mesh.tangents, range.count, part.place());
    float* const numbers = &mesh.tangents.front().direction.x;
    read_floats(part.reader.document, part.primitive.attributes.at("TANGENT"), range, 4, numbers);
    morph(part, "TANGENT", range, {.first = numbers, .width = 3, .stride = 4});
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
        part.reader.lose_in_primitive(
            part.pointer + "/attributes/TANGENT",
            fmt::format("{} of {} tangents have no length; any direction is used", missing,
                        mesh.tangents.size()));
}

void read_texcoords(const Part& part, const Range& range, Mesh& mesh) {
    const int material = material_of(part.reader, part.primitive);
    const TextureUse use = texture_use(part.reader, material);
    const std::string name = fmt::format("TEXCOORD_{}", use.texcoord);
    if (attribute(part, name, {TINYGLTF_TYPE_VEC2}) < 0) {
        if (!use.used) return;
        part.lose(fmt::format("it has no {}; its texture is left out", name));
        mesh.material = untextured(part.reader, material);
        return;
    }
    resize_claimed(mesh.texcoords, range.count, part.place());
    read_vertices(part, name, range, 2, &mesh.texcoords.front().x);
    for (Vec2f& t : mesh.texcoords) t.y = 1 - t.y;  // glTF's v runs down
}

}  // namespace

Index fading(Reader& reader, Index material) {
    if (reader.scene.materials[material].coverage) return material;
    const auto [known, fresh] = reader.looks.fading.try_emplace(material, Index(0));
    if (fresh) {
        known->second = Index(reader.scene.materials.size());
        reader.scene.materials.push_back(Material(reader.scene.materials[material]));
        reader.scene.materials.back().coverage = Coverage{};
    }
    return known->second;
}

namespace {

// glTF 2.0, section 3.9.4: alpha has a meaning only where the material is not opaque.
void read_alphas(const Part& part, const Range& range, int accessor, Mesh& mesh) {
    const int material = material_of(part.reader, part.primitive);
    if (part.accessor(accessor).type != TINYGLTF_TYPE_VEC4 || material < 0) return;
    const std::string& mode = part.model().materials[std::size_t(material)].alphaMode;
    if (mode == "OPAQUE") return;
    std::vector<float> all, alphas;
    resize_claimed(all, range.count * 4, part.place());
    resize_claimed(alphas, range.count, part.place());
    read_vertices(part, "COLOR_0", range, 4, all.data());
    for (std::size_t i = 0; i < range.count; ++i)
        alphas[i] = std::clamp(all[4 * i + 3], 0.0F, 1.0F);
    if (std::all_of(alphas.begin(), alphas.end(), [](float a) { return a == 1; })) return;
    if (mode == "MASK")
        return part.reader.lose_in_primitive(part.pointer + "/attributes/COLOR_0",
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
        part.reader.lose_in_primitive(
            part.pointer + "/attributes/COLOR_0",
            "between vertices their colours are mixed by their alpha too: approximate");
}

void read_colors(const Part& part, const Range& range, Mesh& mesh) {
    const int accessor = attribute(part, "COLOR_0", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4});
    for (const auto& [name, ignored] : part.primitive.attributes)
        if (name.rfind("COLOR_", 0) == 0 && name != "COLOR_0")
            part.lose(
                fmt::format("its {} is ignored; only COLOR_0 has a meaning", printable(name)));
    if (accessor < 0) return;
    resize_claimed(mesh.colors, range.count, part.place());
    read_vertices(part, "COLOR_0", range, 3, &mesh.colors.front().x);
    // glTF 2.0, section 3.7.2.2: morphed colours are clamped.
    if (!part.form.weights.empty() && !part.primitive.targets.empty())
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

void read_vertices(const Part& part, const std::string& name, const Range& range, int width,
                   float* out) {
    read_floats(part.reader.document, part.primitive.attributes.at(name), range, width, out);
    morph(part, name, range, {.first = out, .width = width, .stride = width});
}

void read_attributes(const Part& part, const Range& range, Mesh& mesh) {
    check_weights(part);
    resize_claimed(mesh.positions, range.count, part.place());
    read_vertices(part, "POSITION", range, 3, &mesh.positions.front().x);
    read_normals(part, range, mesh);
    read_tangents(part, range, mesh);
    read_texcoords(part, range, mesh);
    read_colors(part, range, mesh);
}

}  // namespace penumbra::gltf
