// glTF nodes, cameras and lights -> Scene.
#include "gltf.h"

#include <ImathQuat.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <set>

namespace penumbra {
namespace gltf {
namespace {

// Walks the default scene.
struct Walker {
    Reader& reader;
    std::set<int> skins = {};
    std::vector<std::size_t> inverse_square =
        {};  // lights whose attenuation needs the scene's size

    const tinygltf::Model& model() const { return reader.document.model; }
    void walk();
    void node(int index, const Matrix& world);
    void instances(int node, const Matrix& world);
    void camera(int node, const Matrix& world);
    void light(int node, int index, const Matrix& world);
    Matrix local_matrix(int index);
    void set_attenuation();
};

bool hidden(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_node_visibility");
    if (found == node.extensions.end() || !found->second.Has("visible")) return false;
    const tinygltf::Value& visible = found->second.Get("visible");
    return visible.IsBool() && !visible.Get<bool>();
}

int light_of(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_lights_punctual");
    if (found == node.extensions.end() || !found->second.Has("light")) return -1;
    return found->second.Get("light").GetNumberAsInt();
}

// The roots of what is shown: the default scene, else the first one, else every node that is no
// other's child (glTF 2.0, section 3.5.1, leaves the last two to us).
std::vector<int> roots(const tinygltf::Model& model) {
    if (!model.scenes.empty())
        return model.scenes[std::size_t(std::max(model.defaultScene, 0))].nodes;
    std::vector<bool> child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
        for (const int index : node.children) child[std::size_t(index)] = true;
    std::vector<int> found;
    for (std::size_t i = 0; i < child.size(); ++i)
        if (!child[i]) found.push_back(int(i));
    return found;
}

Vec3 vector_of(const std::vector<double>& numbers, const Vec3& fallback) {
    return numbers.size() == 3 ? Vec3(numbers[0], numbers[1], numbers[2]) : fallback;
}

bool finite(const Matrix& matrix) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            if (!std::isfinite(matrix[row][column])) return false;
    return true;
}

// glTF 2.0, section 3.5.3: column-major for column vectors is row-major for row vectors, and
// T * R * S becomes S * R * T.
Matrix Walker::local_matrix(int index) {
    const tinygltf::Node& node = model().nodes[std::size_t(index)];
    const std::string pointer = fmt::format("/nodes/{}", index);
    if (node.matrix.size() == 16) {
        Matrix matrix;
        std::copy(node.matrix.begin(), node.matrix.end(), matrix.getValue());
        if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1) {
            reader.lose(pointer + "/matrix", "its last row is not 0 0 0 1; it is taken as such");
            for (int row = 0; row < 4; ++row) matrix[row][3] = row == 3 ? 1 : 0;
        }
        return matrix;
    }
    Matrix scale, rotation, translation;
    scale.setScale(vector_of(node.scale, Vec3(1)));
    translation.setTranslation(vector_of(node.translation, Vec3(0)));
    if (node.rotation.size() == 4) {
        const auto& q = node.rotation;
        const Imath::Quatd quaternion(q[3], q[0], q[1], q[2]);
        const double length = quaternion.length();
        if (std::abs(length - 1) > 0.01)
            reader.lose(pointer + "/rotation",
                        fmt::format("it has length {:.3g} instead of 1 and is {}", length,
                                    length > 0 ? "normalised" : "ignored"));
        if (length > 0) rotation = quaternion.normalized().toMatrix44();
    }
    return scale * rotation * translation;
}

// The tree may be deep, so that it is walked without recursion; in the order of the file.
void Walker::walk() {
    struct Entry {
        int node;
        Matrix parent;
    };
    std::vector<Entry> open;
    const auto push = [&](const std::vector<int>& nodes, const Matrix& parent) {
        for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) open.push_back({*i, parent});
    };
    push(roots(model()), Matrix());
    std::vector<bool> seen(model().nodes.size(), false);
    while (!open.empty()) {
        const auto [index, parent] = open.back();
        open.pop_back();
        const std::string pointer = fmt::format("/nodes/{}", index);
        if (seen[std::size_t(index)])
            throw Error(Failure::input, reader.document.place(pointer),
                        "is in the scene twice: a root of a scene must be no other node's child");
        seen[std::size_t(index)] = true;
        const tinygltf::Node& source = model().nodes[std::size_t(index)];
        if (hidden(source)) continue;
        const Matrix world = local_matrix(index) * parent;
        if (!finite(world))
            throw Error(Failure::input, reader.document.place(pointer),
                        "its position in the world is too large a number");
        node(index, world);
        push(source.children, world);
    }
}

void Walker::node(int index, const Matrix& world) {
    const tinygltf::Node& source = model().nodes[std::size_t(index)];
    if (source.mesh >= 0) instances(index, world);
    if (source.camera >= 0) camera(index, world);
    if (const int light_index = light_of(source); light_index >= 0)
        light(index, light_index, world);
}

// A matrix that has no inverse up to rounding: it flattens what it is applied to.
bool is_flat(const Matrix& m) {
    double volume = 1;
    for (int row = 0; row < 3; ++row) volume *= Vec3(m[row][0], m[row][1], m[row][2]).length();
    return std::abs(m.determinant()) <= 1e-12 * volume;
}

// An Instance must have an inverse, so that a flattened mesh is placed by its vertices. None when
// no facet has an area left.
std::optional<Mesh> flattened(const Mesh& mesh, const Matrix& world) {
    Mesh flat = mesh;
    flat.normals.clear();
    for (Vec3f& position : flat.positions) position = Vec3f(Vec3(position) * world);
    const auto has_area = [&](const std::array<Index, 3>& t) {
        const Vec3f a = flat.positions[t[0]];
        return (flat.positions[t[1]] - a).cross(flat.positions[t[2]] - a).length() > 0;
    };
    if (std::none_of(flat.triangles.begin(), flat.triangles.end(), has_area)) return std::nullopt;
    return flat;
}

void Walker::instances(int index, const Matrix& world) {
    const tinygltf::Node& node = model().nodes[std::size_t(index)];
    const std::string pointer = fmt::format("/nodes/{}", index);
    const auto& mesh = model().meshes[std::size_t(node.mesh)];
    const auto& weights = node.weights.empty() ? mesh.weights : node.weights;
    if (std::any_of(weights.begin(), weights.end(), [](double w) { return w != 0; }))
        reader.lose(pointer, "its morph targets are ignored");
    if (node.skin >= 0) skins.insert(node.skin);
    const std::string name = node.name.empty() ? fmt::format("node{}", index) : node.name;
    const bool flat = is_flat(world);
    for (const Index part : read_mesh(reader, node.mesh)) {
        if (!flat)
            reader.scene.instances.push_back({.name = name, .mesh = part, .transform = world});
        else if (auto baked = flattened(reader.scene.meshes[part], world)) {
            reader.scene.instances.push_back(
                {.name = name, .mesh = Index(reader.scene.meshes.size())});
            reader.scene.meshes.push_back(std::move(*baked));
        } else {
            reader.lose(pointer, "it is scaled to nothing; its mesh is left out");
        }
    }
}

// Both look along -z (glTF 2.0, section 3.10, and KHR_lights_punctual).
Vec3 direction_of(const Matrix& world) {
    Vec3 direction;
    world.multDirMatrix(Vec3(0, 0, -1), direction);
    return direction.length() > 0 ? direction.normalized() : Vec3(0, 0, -1);
}

void Walker::camera(int index, const Matrix& world) {
    const tinygltf::Node& node = model().nodes[std::size_t(index)];
    const tinygltf::Camera& source = model().cameras[std::size_t(node.camera)];
    Camera camera;
    camera.name = !source.name.empty() ? source.name
                  : !node.name.empty() ? node.name
                                       : fmt::format("camera{}", reader.scene.cameras.size());
    camera.position = world.translation();
    camera.direction = direction_of(world);
    world.multDirMatrix(Vec3(0, 1, 0), camera.up);
    camera.side = Camera::Side::vertical;
    if (camera.direction.cross(camera.up).length() < 1e-9 * camera.up.length() ||
        camera.up.length() == 0) {
        reader.lose(fmt::format("/nodes/{}", index), "its scale leaves the camera no view");
        return;
    }
    if (source.type == "orthographic") {
        camera.projection = Camera::Projection::orthographic;
        camera.extent = 2 * std::abs(source.orthographic.ymag);
        if (camera.extent == 0)
            throw Error(
                Failure::input,
                reader.document.place(fmt::format("/cameras/{}/orthographic/ymag", node.camera)),
                "must not be 0");
    } else {
        camera.fov = source.perspective.yfov;
    }
    reader.scene.cameras.push_back(std::move(camera));
}

// POV-Ray's smoothstep between two cosines that comes nearest to glTF's squared ramp: least
// largest difference, 0.061 as long as the inner cone is not too narrow.
void set_cone(Light& light, double inner, double outer) {
    const double full = std::cos(inner), none = std::cos(outer);
    const double from = none + 0.2046 * (full - none), to = none + 1.1406 * (full - none);
    light.inner = std::acos(std::min(to, 1.0));
    light.outer = std::acos(from);
}

void Walker::light(int index, int light_index, const Matrix& world) {
    const tinygltf::Light& source = model().lights[std::size_t(light_index)];
    const std::string pointer =
        fmt::format("/extensions/KHR_lights_punctual/lights/{}", light_index);
    const std::string& node_name = model().nodes[std::size_t(index)].name;
    Light light;
    light.name = !source.name.empty() ? source.name
                 : !node_name.empty() ? node_name
                                      : fmt::format("light{}", reader.scene.lights.size());
    light.position = world.translation();
    light.direction = direction_of(world);
    if (source.color.size() == 3)
        light.color = Color(float(source.color[0]), float(source.color[1]), float(source.color[2]));
    // Our diffuse term has no 1 / pi: it is part of the source.
    light.intensity = source.intensity / std::numbers::pi;

    if (source.type == "directional") {
        light.type = Light::Type::directional;
    } else if (source.type == "point" || source.type == "spot") {
        inverse_square.push_back(reader.scene.lights.size());
        if (source.range > 0) reader.lose(pointer, "its range is ignored");
    } else {
        reader.lose(pointer, fmt::format("its type '{}' is unknown; it is left out",
                                         printable(source.type)));
        return;
    }
    if (source.type == "spot") {
        light.type = Light::Type::spot;
        const double outer = std::clamp(source.spot.outerConeAngle, 0.002, radians(89.9));
        set_cone(light, std::clamp(source.spot.innerConeAngle, 0.0, outer - 0.001), outer);
        reader.lose(pointer, "the falloff of its cone is approximated by a smoothstep");
    }
    reader.scene.lights.push_back(std::move(light));
}

// I / d^2 as 2 / (1 + (d/f)^2) * I / (2 f^2): with f a thousandth of the scene's radius the two
// differ by a millionth at that radius.
void Walker::set_attenuation() {
    if (inverse_square.empty()) return;
    const double radius = bounds(reader.scene).radius();
    const double f = 1e-3 * (radius > 0 ? radius : 1);
    for (const std::size_t index : inverse_square) {
        Light& light = reader.scene.lights[index];
        light.attenuation = Attenuation{.distance = f, .power = 2};
        light.intensity /= 2 * f * f;
    }
}

Imported read(const std::filesystem::path& file) {
    Imported imported;
    const Document document = open_document(file, imported.losses);
    const tinygltf::Model& model = document.model;
    Reader reader{document, imported.scene, imported.losses};
    Walker walker{reader};
    walker.walk();
    walker.set_attenuation();
    if (!imported.scene.cameras.empty()) imported.scene.camera = 0;
    const auto ignored = [&](const std::string& pointer, std::size_t count, const char* instead) {
        if (count == 0) return;
        reader.lose(pointer, fmt::format("{} of them {} ignored; {}", count,
                                         count == 1 ? "is" : "are", instead));
    };
    ignored("/animations", model.animations.size(), "the nodes are shown where they stand");
    ignored("/skins", walker.skins.size(), "their meshes keep the pose of their vertices");
    if (imported.scene.instances.empty() && !model.meshes.empty())
        reader.lose("/meshes", "none of them is shown by the file's scene");
    imported.models.push_back({.file = document.file,
                               .format = "glTF 2.0",
                               .nodes = model.nodes.size(),
                               .animations = model.animations.size(),
                               .extensions = model.extensionsUsed});
    return imported;
}

}  // namespace
}  // namespace gltf

Imported read_gltf(const std::filesystem::path& file) {
    try {
        return gltf::read(file);
    } catch (const std::bad_alloc&) {
        throw Error(Failure::input, file.string(), "is too large for the memory of this machine");
    }
}

}  // namespace penumbra
