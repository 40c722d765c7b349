// glTF nodes -> where they stand in the world.
#include "importers/gltf/nodes/pose.h"

#include "base/text/suggest.h"
#include "importers/gltf/reader/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace penumbra::gltf {
namespace {

Vec3 vector_of(const std::vector<double>& numbers, const Vec3& fallback) {
    return numbers.size() == 3 ? Vec3(numbers[0], numbers[1], numbers[2]) : fallback;
}

// The node as the file has it.
Trs own_trs(Reader& reader, std::size_t index) {
    const tinygltf::Model& model = reader.document.model;
    const tinygltf::Node& node = model.nodes[index];
    Trs trs;
    trs.translation = vector_of(node.translation, trs.translation);
    trs.scale = vector_of(node.scale, trs.scale);
    trs.weights = node.weights;
    if (trs.weights.empty() && node.mesh >= 0)
        trs.weights = model.meshes[std::size_t(node.mesh)].weights;
    if (node.rotation.size() != 4) return trs;

    const auto& q = node.rotation;
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (std::abs(length - 1) > 0.01)
        reader.note_loss(length > 0 ? Loss::approximated : Loss::dropped,
                         fmt::format("/nodes/{}/rotation", index),
                         fmt::format("it has length {:.3g} instead of 1 and is {}", length,
                                     length > 0 ? "normalised" : "ignored"));
    trs.rotation = unit_quaternion(q.data()).value_or(trs.rotation);
    return trs;
}

// glTF 2.0, section 3.5.3: column-major for column vectors is row-major for row vectors.
Matrix local_matrix(Reader& reader, std::size_t index, const Trs& trs) {
    const tinygltf::Node& node = reader.document.model.nodes[index];
    if (node.matrix.size() != 16) return trs.matrix();
    Matrix matrix;
    std::copy(node.matrix.begin(), node.matrix.end(), matrix.getValue());
    if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1) {
        reader.note_loss(Loss::approximated, fmt::format("/nodes/{}/matrix", index),
                         "its last row is not 0 0 0 1; it is taken as such");
        for (int row = 0; row < 4; ++row) matrix[row][3] = row == 3 ? 1 : 0;
    }
    return matrix;
}

// Parents before their children; the trees may be deep, so that they are walked without recursion.
std::vector<Matrix> world_matrices(Reader& reader, const std::vector<Trs>& transforms) {
    const auto& nodes = reader.document.model.nodes;
    std::vector<bool> child(nodes.size(), false);
    for (const tinygltf::Node& node : nodes)
        for (const int index : node.children) child[std::size_t(index)] = true;
    std::vector<Matrix> world;
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        world.push_back(local_matrix(reader, i, transforms[i]));
        if (!child[i]) open.push_back(i);
    }
    while (!open.empty()) {
        const std::size_t parent = open.back();
        open.pop_back();
        for (const int index : nodes[parent].children) {
            world[std::size_t(index)] *= world[parent];
            open.push_back(std::size_t(index));
        }
    }
    return world;
}

}  // namespace

Matrix Trs::matrix() const {
    Matrix scaled, moved;
    scaled.setScale(scale);
    moved.setTranslation(translation);
    return scaled * rotation.toMatrix44() * moved;
}

std::optional<Imath::Quatd> unit_quaternion(const double* xyzw) {
    const Imath::Quatd quaternion(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    // Scaled first: the squares of large numbers may be out of range.
    const double largest =
        std::max({std::abs(xyzw[0]), std::abs(xyzw[1]), std::abs(xyzw[2]), std::abs(xyzw[3])});
    if (!(largest > 0)) return std::nullopt;
    return (quaternion / largest).normalized();
}

std::size_t choose(const Document& document, const std::string& wanted,
                   std::vector<std::string> names, const std::string& what) {
    const auto named = std::find(names.begin(), names.end(), wanted);
    if (named != names.end() && !wanted.empty()) return std::size_t(named - names.begin());
    std::size_t number = 0;
    const char* const end = wanted.data() + wanted.size();
    const auto [rest, failure] = std::from_chars(wanted.data(), end, number);
    const bool numeric = failure == std::errc() && rest == end;
    if (numeric && number < names.size()) return number;

    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i].empty()) names[i] = std::to_string(i);
    const std::string there_are =
        names.empty()       ? fmt::format(" (the file has no {}s)", what)
        : names.size() == 1 ? fmt::format(" (the file has one {}: '{}')", what, printable(names[0]))
        : numeric           ? fmt::format(" (the file has {} {}s)", names.size(), what)
                            : hint(wanted, names, what + 's');
    throw Error(Failure::usage, document.file,
                fmt::format("there is no {} '{}'{}", what, printable(wanted), there_are));
}

Pose read_pose(Reader& reader) {
    std::vector<Trs> transforms;
    for (std::size_t i = 0; i < reader.document.model.nodes.size(); ++i)
        transforms.push_back(own_trs(reader, i));
    animate(reader, transforms);
    Pose pose = {.world = world_matrices(reader, transforms), .weights = {}};
    for (Trs& trs : transforms) pose.weights.push_back(std::move(trs.weights));
    return pose;
}

}  // namespace penumbra::gltf
