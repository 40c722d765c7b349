#include "prepare/surfaces/narrow_facets.h"

#include "prepare/scale.h"
#include "prepare/surfaces/seen.h"
#include "prepare/surfaces/world_facets.h"
#include "scene/transforms.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace penumbra {

namespace {

// The camera's pixels.
struct Pixels {
    Vec3 eye;
    double width = 0;  // of one: in all of the picture, or at the distance of 1
    bool orthographic = false;

    double at(const Bounds& box) const { return orthographic ? width : width * distance(eye, box); }
};

// Counts the facets of an instance that are narrower than `least`, and a pixel wide.
std::size_t narrow_facets(const Scene& scene, const Instance& instance, const Pixels& pixels,
                          double least) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    std::size_t count = 0;
    for (const auto& [first, second, third] : mesh.triangles) {
        const Vec3 a = moved(mesh.positions[first], instance.transform),
                   b = moved(mesh.positions[second], instance.transform),
                   c = moved(mesh.positions[third], instance.transform);
        const double area = (b - a).cross(c - a).length();
        const double longest = std::max({(b - a).length(), (c - a).length(), (c - b).length()});
        if (!(area > 0) || area >= least * longest) continue;
        Bounds box;
        for (const Vec3& corner : {a, b, c}) box.extend(corner);
        if (area > pixels.at(box) * longest) ++count;
    }
    return count;
}

}  // namespace

Losses losses_by_narrowness(const Scene& scene, const Bounds& box, int width, int height) {
    assert(scene.camera < scene.cameras.size());
    const double least = least_overlap / normalising_factor(box);
    const View view = view_of(scene.cameras[scene.camera], width, height);
    const Pixels pixels = {view.location, view.up.length() / height, view.orthographic};
    std::size_t narrow = 0;
    Index first = no_index;
    for (Index i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[instance.mesh];
        // All of it is so far from the eye that what is narrow is less than a pixel wide.
        if (pixels.at(transformed(box_around(mesh.positions), instance.transform)) >= least)
            continue;
        const std::size_t count = narrow_facets(scene, instance, pixels, least);
        if (count > 0 && narrow == 0) first = i;
        narrow += count;
    }
    if (narrow == 0) return {};
    return {
        {Loss::approximated, "tolerances",
         fmt::format("{} facets that can be seen are narrower than {:.2g}, too small to be told "
                     "from what they lie on in a scene that measures {:.3g} across: what is "
                     "close behind them and their shadows may be lost; the first is of {}",
                     narrow, least, 2 * box.radius(), described(scene, first)),
         narrow}};
}

}  // namespace penumbra
