#include "prepare/surfaces/coincident_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

namespace penumbra {

namespace {

// A place, so rounded that what differs by rounding is the same.
using Place = std::array<double, 4>;

Place place_of(const Vec3& v, double last) {
    constexpr double grain = 1e6;
    return {std::round(v.x * grain), std::round(v.y * grain), std::round(v.z * grain),
            std::round(last * grain)};
}

// Of `shapes`, by their places, leaves one opaque one in each, and lets move(shape, first of that
// place, number) move those that light passes through.
template <class Shape, class Move>
void part(std::vector<Shape>& shapes, const std::vector<Place>& places,
          const std::vector<Material>& materials, PartedShapes& parted, Move move) {
    std::map<Place, std::vector<std::size_t>> sharing;
    for (std::size_t i = 0; i < shapes.size(); ++i) sharing[places[i]].push_back(i);
    std::vector<bool> dropped(shapes.size(), false);
    for (auto& [place, members] : sharing) {
        const auto is_opaque = [&](std::size_t i) { return opaque(materials[shapes[i].material]); };
        std::ranges::stable_partition(members, is_opaque);
        int number = 0;
        for (std::size_t k = 1; k < members.size(); ++k) {
            if (is_opaque(members[k])) {
                dropped[members[k]] = true;
                ++parted.dropped;
            } else {
                move(shapes[members[k]], shapes[members[0]], ++number);
                ++parted.moved;
            }
        }
    }
    std::size_t i = 0;
    std::erase_if(shapes, [&](const Shape&) { return dropped[i++]; });
}

}  // namespace

PartedShapes part_coincident_shapes(Scene& scene, double step, double factor) {
    PartedShapes parted;
    std::vector<Place> places;
    for (const Sphere& s : scene.spheres)
        places.push_back(place_of(s.center * factor, s.radius * factor));
    part(scene.spheres, places, scene.materials, parted,
         [&](Sphere& sphere, const Sphere&, int number) { sphere.radius += number * step; });
    places.clear();
    for (const Plane& p : scene.planes) {
        Vec3 normal = p.normal.normalized();
        if (std::tuple(normal.x, normal.y, normal.z) < std::tuple(0.0, 0.0, 0.0)) normal = -normal;
        places.push_back(place_of(normal, normal.dot(p.point) * factor));
    }
    part(scene.planes, places, scene.materials, parted,
         [&](Plane& plane, const Plane& first, int number) {
             plane.point += first.normal.normalized() * (number * step);
         });
    return parted;
}

}  // namespace penumbra
