#include "prepare/small_objects.h"

#include "prepare/scale.h"
#include "prepare/weld.h"
#include "scene/tolerances.h"
#include "scene/transforms.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace penumbra {
namespace {

// An instance or a sphere.
struct Object {
    std::string name;
    Vec3 center;
    double radius;     // of a sphere around it
    double length;     // of its longest side, in its own axes
    double thickness;  // of its shortest one
    Index instance = no_index;
};

Object object_of(const Instance& instance, const Mesh& mesh, const Bounds& box) {
    const auto& m = instance.transform;
    Vec3 sides = box.max - box.min;
    for (int axis = 0; axis < 3; ++axis)
        sides[axis] *= Vec3(m[axis][0], m[axis][1], m[axis][2]).length();
    const auto [shortest, longest] = std::minmax({sides.x, sides.y, sides.z});
    return {.name = instance.name.empty() ? mesh.name : instance.name,
            .center = box.center() * m,
            .radius = transformed(box, m).radius(),
            .length = longest,
            .thickness = shortest};
}

std::vector<Object> objects_of(const Scene& scene) {
    std::vector<std::optional<Bounds>> boxes(scene.meshes.size());
    std::vector<Object> objects;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        auto& box = boxes[instance.mesh];
        if (!box) box = box_around_facets(mesh);
        // A point has nothing to lose.
        if (!(box->radius() > 0)) continue;
        objects.push_back(object_of(instance, mesh, *box));
        objects.back().instance = Index(&instance - scene.instances.data());
    }
    for (const Sphere& sphere : scene.spheres) {
        const double diameter = 2 * sphere.radius;
        objects.push_back({sphere.name, sphere.center, sphere.radius, diameter, diameter});
    }
    return objects;
}

// An object without a name is told by where it is.
std::string description(const Object& object) {
    if (!object.name.empty()) return "'" + object.name + "'";
    const Vec3& c = object.center;
    return fmt::format("the object at ({:.6g}, {:.6g}, {:.6g})", c.x, c.y, c.z);
}

// ---- tolerances --------------------------------------------------------------------------------

// A flat sheet has no thickness that could be lost; float32 may leave it a little.
bool has_thickness(const Object& object) { return object.thickness > 1e-5 * object.length; }

// Is any edge so short? A body that is thin has such edges along its rim.
bool has_short_edge(const Mesh& mesh, const Matrix& transform, double least) {
    const auto corner = [&](Index vertex) {
        Vec3 direction;
        transform.multDirMatrix(Vec3(mesh.positions[vertex]), direction);
        return direction;
    };
    return std::ranges::any_of(mesh.triangles, [&](const auto& triangle) {
        for (std::size_t i = 0; i < 3; ++i) {
            const double length = (corner(triangle[i]) - corner(triangle[(i + 1) % 3])).length();
            if (length > 0 && length < least) return true;
        }
        return false;
    });
}

// The length of the shortest edge that has one, in the mesh's units; infinite without any.
double shortest_edge(const Mesh& mesh) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& triangle : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const double square =
                (Vec3(mesh.positions[triangle[i]]) - Vec3(mesh.positions[triangle[(i + 1) % 3]]))
                    .length2();
            if (square > 0) least = std::min(least, square);
        }
    return std::sqrt(least);
}

// No direction is shortened to less than this. Of the singular values s1 >= s2 >= s3 of the linear
// part, s3 = |det| / (s1 s2), and s1 s2 is at most half of the sum of all their squares.
double least_scale(const Matrix& m) {
    double squares = 0;
    for (int row = 0; row < 3; ++row) squares += Vec3(m[row][0], m[row][1], m[row][2]).length2();
    return squares > 0 ? 2 * std::abs(m.determinant()) / squares : 0;
}

// Around each part of a mesh that hangs together.
std::vector<Bounds> boxes_of_parts(const Mesh& mesh) {
    std::unordered_map<Vec3f, Index, PointHash> places;
    std::vector<Index> parent(mesh.positions.size());
    for (Index i = 0; i < parent.size(); ++i)
        parent[i] = places.try_emplace(mesh.positions[i], i).first->second;
    const auto root = [&](Index i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (const auto& [a, b, c] : mesh.triangles)
        for (const Index other : {b, c}) parent[root(other)] = root(a);
    std::map<Index, Bounds> boxes;
    for (const auto& triangle : mesh.triangles)
        for (const Index vertex : triangle)
            boxes[root(vertex)].extend(Vec3(mesh.positions[vertex]));
    std::vector<Bounds> found;
    for (const auto& [first, box] : boxes) found.push_back(box);
    return found;
}

// The objects, those with short edges taken apart.
std::vector<Object> parts_of(const Scene& scene, const std::vector<Object>& whole, double least) {
    std::map<Index, std::vector<Bounds>> known;  // by mesh
    std::map<Index, double> shortest;            // edges, by mesh
    const auto may_have_short_edge = [&](const Instance& instance) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const auto [edge, fresh] = shortest.try_emplace(instance.mesh);
        if (fresh) edge->second = shortest_edge(mesh);
        constexpr double rounding = 1e-9;
        return edge->second * least_scale(instance.transform) < least * (1 + rounding) &&
               has_short_edge(mesh, instance.transform, least);
    };
    std::vector<Object> parts;
    for (const Object& object : whole) {
        if (object.instance == no_index || (has_thickness(object) && object.thickness < least) ||
            !may_have_short_edge(scene.instances[object.instance])) {
            parts.push_back(object);
            continue;
        }
        const Instance& instance = scene.instances[object.instance];
        const auto [boxes, fresh] = known.try_emplace(instance.mesh);
        if (fresh) boxes->second = boxes_of_parts(scene.meshes[instance.mesh]);
        for (const Bounds& box : boxes->second)
            parts.push_back(object_of(instance, scene.meshes[instance.mesh], box));
    }
    return parts;
}

void note_eaten(const Scene& scene, const std::vector<Object>& whole, const Bounds& box,
                Losses& losses) {
    const double least = shadow_margin / normalising_factor(box);
    const std::vector<Object> objects = parts_of(scene, whole, least);
    const Object* smallest = nullptr;
    std::size_t count = 0;
    for (const Object& object : objects) {
        if (!has_thickness(object) || object.thickness >= least) continue;
        ++count;
        if (smallest == nullptr || object.thickness < smallest->thickness) smallest = &object;
    }
    if (smallest == nullptr) return;
    losses.push_back(
        {Loss::approximated, "tolerances",
         fmt::format("{} of {} objects {} thinner than {:.2g}, below which POV-Ray's tolerance "
                     "leaves out shadows in a scene that measures {:.3g} across; the thinnest is "
                     "{}, of {:.2g}",
                     count, objects.size(), count == 1 ? "is" : "are", least, 2 * box.radius(),
                     description(*smallest), smallest->thickness),
         count});
}

// ---- pixels ------------------------------------------------------------------------------------

// How many pixels an object spans; infinity where the camera is in reach of it.
double pixels_across(const Object& object, const View& view, int height) {
    const double picture = view.up.length();  // in the plane at distance 1
    if (view.orthographic) return 2 * object.radius / picture * height;
    const double distance = (object.center - view.location).length();
    if (distance <= object.radius) return std::numeric_limits<double>::infinity();
    return 2 * object.radius / (distance * picture) * height;
}

// The one that is farthest from the middle of most of them.
const Object& outlier(const std::vector<Object>& objects) {
    Vec3 middle;
    std::vector<double> along(objects.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::transform(objects, along.begin(),
                               [&](const Object& o) { return o.center[axis]; });
        const auto half = along.begin() + std::ptrdiff_t(along.size() / 2);
        std::ranges::nth_element(along, half);
        middle[axis] = *half;
    }
    return *std::ranges::max_element(objects, {},
                                     [&](const Object& o) { return (o.center - middle).length(); });
}

void note_invisible(const std::vector<Object>& objects, const Bounds& box, const View& view,
                    int height, Losses& losses) {
    if (objects.empty()) return;
    const auto seen = [&](const Object& o) { return pixels_across(o, view, height) >= 1; };
    if (std::ranges::any_of(objects, seen)) return;
    if (objects.size() == 1) {
        losses.push_back({Loss::dropped, "camera",
                          fmt::format("it is so far away that {} is smaller than a pixel",
                                      description(objects[0]))});
        return;
    }
    const Object& far = outlier(objects);
    losses.push_back(
        {Loss::dropped, "camera",
         fmt::format("it shows {} objects within {:.3g}, so that each is smaller than a pixel; "
                     "the farthest from the others is {} at ({:.6g}, {:.6g}, {:.6g})",
                     objects.size(), 2 * box.radius(), description(far), far.center.x, far.center.y,
                     far.center.z),
         objects.size()});
}

}  // namespace

Losses losses_by_size(const Scene& scene, const Bounds& box, int width, int height) {
    assert(scene.camera < scene.cameras.size());
    Losses losses;
    const std::vector<Object> objects = objects_of(scene);
    note_eaten(scene, objects, box, losses);
    const View view = view_of(scene.cameras[scene.camera], width, height);
    note_invisible(objects, box, view, height, losses);
    return losses;
}

}  // namespace penumbra
