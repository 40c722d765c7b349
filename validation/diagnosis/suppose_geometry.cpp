// What if things stood elsewhere: objects, the camera's field of view, models that are turned.
#include "scene/objects.h"
#include "validation/diagnosis/experiment.h"
#include "validation/diagnosis/finding.h"
#include "validation/diagnosis/registration.h"
#include "validation/metrics/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::metrics {
namespace {

std::string looks_as_if(const std::string& what) { return "the reference looks as if " + what; }

std::string described(const Scene& scene, Index object) {
    const auto [kind, i] = place_of(scene, object);
    const std::string name = named(name_of(scene, object), i);
    switch (kind) {
    case ObjectKind::sphere: return "the sphere " + name;
    case ObjectKind::plane: return "the plane " + name;
    case ObjectKind::instance: break;
    }
    return "the object " + name;
}

void remove(Scene& scene, Index object) {
    const auto [kind, index] = place_of(scene, object);
    const auto i = std::ptrdiff_t(index);
    switch (kind) {
    case ObjectKind::instance: scene.instances.erase(scene.instances.begin() + i); break;
    case ObjectKind::sphere: scene.spheres.erase(scene.spheres.begin() + i); break;
    case ObjectKind::plane: scene.planes.erase(scene.planes.begin() + i); break;
    }
}

struct Suspect {
    Index object = no_index;
    double share = 0;      ///< of the error, in the pixels that show it
    double differing = 0;  ///< of those pixels
};

// What is known of the pixels of each object that can be seen, the most error first.
std::vector<Suspect> suspects(const Experiment& experiment) {
    const Scene& scene = experiment.scene();
    const std::size_t count = object_count(scene);
    std::vector<double> error(count), pixels(count), differing(count);
    const double step = display_step * display_step;
    for (int y = 0; y < experiment.objects().rows; ++y) {
        for (int x = 0; x < experiment.objects().cols; ++x) {
            const int object = experiment.objects().at<int>(y, x);
            if (object < 0) continue;
            const double squared = double(experiment.error().at<float>(y, x));
            error[std::size_t(object)] += squared;
            pixels[std::size_t(object)] += 1;
            if (squared > step) differing[std::size_t(object)] += 1;
        }
    }
    std::vector<Suspect> result;
    for (std::size_t i = 0; i < count; ++i)
        if (pixels[i] > 0)
            result.push_back({.object = Index(i),
                              .share = error[i] / experiment.total_error(),
                              .differing = differing[i] / pixels[i]});
    std::ranges::stable_sort(result, std::greater<>(), &Suspect::share);
    return result;
}

// ---- turned models ----------------------------------------------------------------------------

constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};

Matrix rotation(int axis, double angle) {
    Vec3 direction(0);
    direction[axis] = 1;
    Matrix result;
    result.setAxisAngle(direction, angle);
    return result;
}

Matrix translation(const Vec3& by) {
    Matrix result;
    result.setTranslation(by);
    return result;
}

void seek_angle(Experiment& experiment, const std::string& what, int axis,
                const std::function<void(Scene&, const Matrix&)>& turn) {
    const Found found = experiment.seek({.start = 0,
                                         .step = radians(1),
                                         .low = -radians(20),
                                         .high = radians(20),
                                         .blur = 1.5,
                                         .change = [&](double angle) -> Change {
                                             return [&turn, axis, angle](Variant& v) {
                                                 turn(v.scene, rotation(axis, angle));
                                             };
                                         }});
    if (found.value != 0)
        experiment.suppose(
            {found.left, "rotation",
             looks_as_if(fmt::format("{} were turned by {:+.2g} degrees about {}", what,
                                     degrees(found.value), axis_names[std::size_t(axis)]))});
}

// About the origin of its own file or node.
void suppose_turned(Experiment& experiment, Index instance) {
    const std::string what = described(experiment.scene(), instance);
    for (const int axis : {1, 0, 2}) {
        if (experiment.settled()) return;
        seek_angle(experiment, what, axis, [&](Scene& scene, const Matrix& turn) {
            Matrix& transform = scene.instances[instance].transform;
            transform = turn * transform;
        });
    }
}

// All meshes together, each about its own origin or about that of the world.
void suppose_all_turned(Experiment& experiment) {
    for (const int axis : {1, 0, 2}) {
        if (experiment.settled()) return;
        seek_angle(experiment, "all meshes", axis, [&](Scene& scene, const Matrix& turn) {
            for (Instance& i : scene.instances) i.transform = turn * i.transform;
        });
        if (experiment.settled()) return;
        const Matrix there = translation(-experiment.origin()),
                     back = translation(experiment.origin());
        seek_angle(experiment, "the scene's meshes", axis, [&](Scene& scene, const Matrix& turn) {
            for (Instance& i : scene.instances) i.transform = i.transform * there * turn * back;
        });
    }
}

Matrix mirroring(int axis) {
    Vec3 scale(1);
    scale[axis] = -1;
    Matrix result;
    result.setScale(scale);
    return result;
}

void suppose_mirrored(Experiment& experiment, const std::string& what,
                      const std::function<void(Scene&, const Matrix&)>& place) {
    for (int axis = 0; axis < 3; ++axis) {
        const Trial trial = experiment.with([&](Variant& v) { place(v.scene, mirroring(axis)); });
        experiment.suppose(
            {trial.left, "handedness",
             looks_as_if(what + " were mirrored in " + axis_names[std::size_t(axis)])});
    }
}

void suppose_all_mirrored(Experiment& experiment) {
    const Matrix there = translation(-experiment.origin()), back = translation(experiment.origin());
    suppose_mirrored(experiment, "all meshes", [&](Scene& scene, const Matrix& mirror) {
        for (Instance& i : scene.instances) i.transform = i.transform * there * mirror * back;
    });
}

}  // namespace

void suppose_objects(Experiment& experiment) {
    int tried = 0;
    for (const Suspect& suspect : suspects(experiment)) {
        if (tried == 3 || suspect.share < 0.15) return;
        if (suspect.differing < 0.6) continue;
        ++tried;
        const Trial trial = experiment.with([&](Variant& v) { remove(v.scene, suspect.object); });
        experiment.suppose(
            {trial.left, "object",
             looks_as_if(described(experiment.scene(), suspect.object) + " were missing")});
    }
}

// Half pixels are what renderers disagree about: whether a pixel's middle or its corner counts.
void suppose_shift(Experiment& experiment) {
    const Registration found =
        register_pictures(experiment.test_encoded(), experiment.reference_encoded(), Moves::shift);
    if (found.left > 0.8) return;
    double dx = found.motion.dx * experiment.every(), dy = found.motion.dy * experiment.every();
    const double near_x = std::round(2 * dx) / 2, near_y = std::round(2 * dy) / 2;
    if (std::hypot(dx - near_x, dy - near_y) < 0.15) {
        dx = near_x + 0.0;  // never -0, which would show
        dy = near_y + 0.0;
    }
    if (std::hypot(dx, dy) < 0.05) return;
    const Trial trial = experiment.with([&](Variant& v) {
        v.overrides.dx = dx;
        v.overrides.dy = dy;
    });
    experiment.suppose(
        {trial.left, "shift",
         fmt::format("the test picture is shifted by ({:+.2g}, {:+.2g}) pixels", dx, dy)});
}

void suppose_view(Experiment& experiment) {
    const Registration zoom =
        register_pictures(experiment.test_encoded(), experiment.reference_encoded(), Moves::zoom);
    if (zoom.left > 0.7 || std::abs(zoom.motion.zoom) < 1e-4) return;
    const Camera& camera = experiment.scene().cameras[experiment.scene().camera];
    const bool parallel = camera.projection == Camera::Projection::orthographic;
    const Found found =
        experiment.seek({.start = 0,
                         .step = 1 / (1 - zoom.motion.zoom) - 1,
                         .low = -0.9,
                         .high = 4,
                         .blur = 1.5,
                         .change = [](double wider) -> Change {
                             return [=](Variant& v) {
                                 Camera& c = v.scene.cameras[v.scene.camera];
                                 c.fov = 2 * std::atan(std::tan(c.fov / 2) * (1 + wider));
                                 c.extent *= 1 + wider;
                             };
                         }});
    if (found.value == 0) return;
    const double more =
        degrees(2 * std::atan(std::tan(camera.fov / 2) * (1 + found.value)) - camera.fov);
    const std::string wider = parallel
                                  ? "a view " + more_or_less(1 + found.value, "wider", "narrower")
                                  : fmt::format("a field of view {:.1f} degrees {}", std::abs(more),
                                                more > 0 ? "wider" : "narrower");
    experiment.suppose({found.left, "fov", looks_as_if("the camera had " + wider)});
}

void suppose_rotations(Experiment& experiment) {
    if (experiment.scene().instances.empty()) return;
    int tried = 0;
    for (const Suspect& suspect : suspects(experiment)) {
        if (experiment.settled() || tried == 2 || suspect.share < 0.2) break;
        if (suspect.object >= experiment.scene().instances.size()) continue;
        ++tried;
        suppose_turned(experiment, suspect.object);
        if (!experiment.settled())
            suppose_mirrored(experiment, described(experiment.scene(), suspect.object),
                             [&](Scene& scene, const Matrix& mirror) {
                                 Matrix& transform = scene.instances[suspect.object].transform;
                                 transform = mirror * transform;
                             });
    }
    if (!experiment.settled() && tried > 0) suppose_all_mirrored(experiment);
    if (!experiment.settled()) suppose_all_turned(experiment);
}

}  // namespace penumbra::metrics
