// glTF skins: vertices -> where joints take them (glTF 2.0, section 3.7.3).
#include "base/memory.h"
#include "importers/gltf/nodes/mesh.h"
#include "importers/gltf/nodes/pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::gltf {
namespace {

// Joints and weights of some vertices, four of each a set.
struct Influences {
    std::size_t sets = 0;
    std::vector<std::vector<float>> joints = {}, weights = {};  // by set
};

// Four influences a vertex and set, in sets of attributes that are numbered from 0 on.
std::size_t count_sets(const Part& part) {
    const auto has = [&](const char* name, std::size_t set) {
        return attribute(part, fmt::format("{}_{}", name, set), {TINYGLTF_TYPE_VEC4}) >= 0;
    };
    std::size_t sets = 0;
    for (; has("JOINTS", sets) || has("WEIGHTS", sets); ++sets)
        if (has("JOINTS", sets) != has("WEIGHTS", sets))
            part.fail("/attributes",
                      fmt::format("has only one of JOINTS_{0} and WEIGHTS_{0}", sets));
    return sets;
}

Influences read_influences(const Part& part, std::size_t sets, const Elements& range) {
    Influences influences = {.sets = sets};
    const auto read = [&](const char* name, std::size_t set) {
        std::vector<float> numbers(range.count * 4);
        const auto found = part.primitive.attributes.find(fmt::format("{}_{}", name, set));
        read_floats(part.reader.document, found->second, range, 4, numbers.data());
        return numbers;
    };
    for (std::size_t set = 0; set < sets; ++set) {
        influences.joints.push_back(read("JOINTS", set));
        influences.weights.push_back(read("WEIGHTS", set));
    }
    return influences;
}

// The mean of the matrices of a vertex's joints. Weights need not add up to exactly one once they
// are rounded, so that they are divided by their sum; without any the first joint holds the vertex.
struct Blender {
    const Part& part;
    const std::vector<Matrix>& joints;
    std::size_t weightless = 0;

    Matrix blend(const Influences& influences, std::size_t vertex, std::size_t number);
};

Matrix Blender::blend(const Influences& influences, std::size_t vertex, std::size_t number) {
    Matrix sum(0.0);
    double total = 0;
    for (std::size_t set = 0; set < influences.sets; ++set) {
        for (std::size_t i = 4 * vertex; i < 4 * vertex + 4; ++i) {
            const double weight = double(influences.weights[set][i]);
            if (weight == 0) continue;
            const auto joint = std::size_t(influences.joints[set][i]);
            if (joint >= joints.size())
                part.fail(fmt::format("/attributes/JOINTS_{}", set),
                          fmt::format("vertex {} has the joint {}, but its skin has {} joints",
                                      number, joint, joints.size()));
            sum += joints[joint] * weight;
            total += weight;
        }
    }
    if (total > 0) return sum * (1 / total);
    ++weightless;
    return joints.front();
}

Vec3 row(const Matrix& m, int i) { return {m[i][0], m[i][1], m[i][2]}; }

// Normals go by the inverse transposed matrix, whose direction is that of the cofactors.
Vec3f turned_normal(const Matrix& m, const Vec3f& normal) {
    const Vec3 x = row(m, 0), y = row(m, 1), z = row(m, 2);
    const Vec3 n = y.cross(z) * normal.x + z.cross(x) * normal.y + x.cross(y) * normal.z;
    const double length = n.length();
    if (!(length > 0)) return normal;
    return Vec3f(n * (x.cross(y).dot(z) < 0 ? -1 / length : 1 / length));
}

Tangent turned_tangent(const Matrix& m, const Tangent& tangent) {
    Vec3 direction;
    m.multDirMatrix(Vec3(tangent.direction), direction);
    const double length = direction.length();
    if (!(length > 0)) return tangent;
    const bool mirrored = row(m, 0).cross(row(m, 1)).dot(row(m, 2)) < 0;
    return {Vec3f(direction / length), mirrored ? -tangent.handedness : tangent.handedness};
}

// All but the position.
void turn_vertex(const Matrix& m, std::size_t vertex, Mesh& mesh) {
    if (!mesh.normals.empty()) mesh.normals[vertex] = turned_normal(m, mesh.normals[vertex]);
    if (!mesh.tangents.empty()) mesh.tangents[vertex] = turned_tangent(m, mesh.tangents[vertex]);
}

bool fits_float(const Vec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <=
           double(std::numeric_limits<float>::max());
}

}  // namespace

std::vector<Matrix> joint_matrices(const Reader& reader, int index) {
    if (index < 0) return {};
    const tinygltf::Skin& skin = reader.document.model.skins[std::size_t(index)];
    const std::string place = reader.document.place(fmt::format("/skins/{}", index));
    if (skin.joints.empty()) throw Error(Failure::input, place + "/joints", "is empty");
    const MemoryClaim claim(skin.joints.size() * 3 * sizeof(Matrix), place);
    // glTF 2.0, section 5.28.1: without inverse bind matrices each is the identity.
    std::vector<double> inverse;
    if (const int accessor = skin.inverseBindMatrices; accessor >= 0) {
        const tinygltf::Accessor& source = reader.document.model.accessors[std::size_t(accessor)];
        if (source.type != TINYGLTF_TYPE_MAT4 ||
            (source.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT &&
             source.componentType != TINYGLTF_COMPONENT_TYPE_DOUBLE))
            throw Error(Failure::input, place + "/inverseBindMatrices",
                        fmt::format("accessor {} must hold MAT4 of floats", accessor));
        if (source.count < skin.joints.size())
            throw Error(Failure::input, place + "/inverseBindMatrices",
                        fmt::format("accessor {} has {} matrices for {} joints", accessor,
                                    source.count, skin.joints.size()));
        inverse.resize(skin.joints.size() * 16);
        read_doubles(reader.document, accessor, {.first = 0, .count = skin.joints.size()}, 16,
                     inverse.data());
    }
    std::vector<Matrix> matrices;
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        Matrix bind;
        if (!inverse.empty()) {
            std::copy_n(inverse.begin() + std::ptrdiff_t(16 * i), 16, bind.getValue());
            for (int r = 0; r < 4; ++r) bind[r][3] = r == 3 ? 1 : 0;  // an affine matrix
        }
        matrices.push_back(bind * reader.pose.world[std::size_t(skin.joints[i])]);
    }
    return matrices;
}

std::optional<Vec3> pose_vertices(const Part& part, const Elements& range,
                                  const std::vector<Matrix>& joints, Mesh& mesh) {
    const std::size_t sets = count_sets(part);
    if (sets == 0) return std::nullopt;
    std::vector<Vec3> positions;  // in the world, where float32 may be too coarse
    resize_claimed(positions, range.count, part.place());
    Blender blender = {part, joints};
    // In blocks, so that the influences of a large mesh are not all in memory.
    constexpr std::size_t block = std::size_t(1) << 16;
    for (std::size_t start = 0; start < range.count; start += block) {
        const std::size_t count = std::min(block, range.count - start);
        const Influences influences = read_influences(part, sets, range.part(start, count));
        for (std::size_t i = 0; i < count; ++i) {
            const Matrix joint = blender.blend(influences, i, range[start + i]);
            positions[start + i] = Vec3(mesh.positions[start + i]) * joint;
            turn_vertex(joint, start + i, mesh);
        }
    }
    if (const auto bad = std::ranges::find_if_not(positions, fits_float); bad != positions.end())
        part.fail("", fmt::format("skin {} takes vertex {} too far away", part.key.skin,
                                  range[std::size_t(bad - positions.begin())]));
    if (blender.weightless > 0)
        part.note_loss(
            Loss::approximated,
            fmt::format("{} of its vertices have no weights; they follow the first joint of "
                        "skin {}",
                        blender.weightless, part.key.skin));
    return set_positions(positions, mesh);
}

}  // namespace penumbra::gltf
