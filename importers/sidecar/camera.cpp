// [camera] -> Camera.
#include "base/text/suggest.h"
#include "base/text/text.h"
#include "importers/sidecar/sidecar.h"
#include "prepare/complete.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace penumbra {

namespace {

struct CameraKeys {
    std::optional<Reference> name = {};
    std::optional<Vec3> position = {}, look_at = {}, up = {};
    std::optional<double> fov = {}, width = {};  ///< radians; scene units
};

template <class T, class Read>
std::optional<T> optional_of(Read read) {
    T value(0);
    return read(value) ? std::optional<T>(value) : std::nullopt;
}

CameraKeys read_keys(Section& s) {
    constexpr Range angle = {.low = 0, .high = 180, .open_low = true, .open_high = true};
    CameraKeys keys;
    s.read("name", keys.name);
    keys.position = optional_of<Vec3>([&](Vec3& v) { return s.read("position", v); });
    keys.look_at = optional_of<Vec3>([&](Vec3& v) { return s.read("look_at", v); });
    keys.up = optional_of<Vec3>([&](Vec3& v) { return s.read("up", v); });
    keys.fov = optional_of<double>([&](double& v) { return s.read_angle("fov", v, angle); });
    keys.width =
        optional_of<double>([&](double& v) { return s.read("orthographic", v, positive); });
    s.finish();
    if (keys.fov && keys.width) s.reject("orthographic", "cannot stand beside 'fov'");
    if (keys.up && !std::isnormal(keys.up->length())) s.reject("up", "must not have length zero");
    return keys;
}

bool any_besides_name(const CameraKeys& keys) {
    return keys.position || keys.look_at || keys.up || keys.fov || keys.width;
}

Index camera_named(const Scene& scene, const Reference& reference) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (scene.cameras[i].name == reference.name) return Index(i);
        names.push_back(scene.cameras[i].name);
    }
    // A number where none is called so.
    std::size_t number = 0;
    const char* const end = reference.name.data() + reference.name.size();
    const auto [rest, failure] = std::from_chars(reference.name.data(), end, number);
    if (failure == std::errc() && rest == end && number < scene.cameras.size())
        return Index(number);
    throw Error(reference.failure, reference.place,
                fmt::format("no camera '{}'{}", printable(reference.name),
                            names.empty() ? " (the scene has no cameras)"
                                          : hint(reference.name, names, "cameras")));
}

// A copy of the active camera; a new one when there is none, or when its position is given.
Index add_camera(Scene& scene, CameraAims& aims, bool from_nothing) {
    const Index base = from_nothing ? no_index : scene.camera;
    Camera camera = base != no_index ? scene.cameras[base] : default_camera();
    camera.name = "sidecar";
    scene.cameras.push_back(camera);
    const auto added = Index(scene.cameras.size() - 1);
    if (base == no_index) {
        aims.framed.insert(added);
        return added;
    }
    if (aims.framed.contains(base)) aims.framed.insert(added);
    if (const auto aim = aims.look_at.find(base); aim != aims.look_at.end())
        aims.look_at[added] = aim->second;
    return added;
}

void set_lens(Camera& camera, const CameraKeys& keys) {
    if (!keys.fov && !keys.width) return;
    camera.aspect = 0;  // no longer its author's view
    camera.side = Camera::Side::horizontal;
    camera.projection =
        keys.fov ? Camera::Projection::perspective : Camera::Projection::orthographic;
    if (keys.fov) camera.fov = *keys.fov;
    if (keys.width) camera.extent = *keys.width;
}

// A given position or point to look at ends the framing; the camera keeps looking at the point
// that was given last, else in its direction.
void turn(Camera& camera, Index index, const CameraKeys& keys, CameraAims& aims,
          const Bounds& box) {
    if (keys.position) camera.position = *keys.position;
    if (keys.look_at) aims.look_at[index] = *keys.look_at;
    if (!keys.position && !keys.look_at) return;
    const bool was_framed = aims.framed.erase(index) > 0;
    if (const auto aim = aims.look_at.find(index); aim != aims.look_at.end())
        camera.direction = aim->second - camera.position;
    else if (was_framed)
        camera.direction = box.center() - camera.position;
}

// Fits a camera without a position of its own to the scene. If it is orthographic then somebody
// gave its width, which stays.
void refit(Camera& camera, const Scene& scene, double aspect) {
    const double width = camera.extent;
    frame(camera, scene, aspect);
    camera.extent = width;
}

void check(const Section& section, const Camera& camera) {
    const double length = camera.direction.length();
    if (!std::isnormal(length))  // NaN too
        section.fail("look_at", "the camera stands at the point that it looks at");
    if (camera.direction.cross(camera.up).length() <= 1e-9 * length * camera.up.length())
        section.fail("up", "the camera looks along its 'up': give another 'up'");
}

}  // namespace

void lay_camera(const Layer& layer, Scene& scene, CameraAims& aims, const Bounds& box,
                double aspect) {
    auto section = Section(layer, layer.table).table("camera");
    if (!section) return;
    const CameraKeys keys = read_keys(*section);
    if (keys.name) scene.camera = camera_named(scene, *keys.name);
    if (!any_besides_name(keys)) return;

    if (!layer.setting || scene.camera == no_index)
        scene.camera = add_camera(scene, aims, !keys.name && !layer.setting && keys.position);
    Camera& camera = scene.cameras[scene.camera];
    set_lens(camera, keys);
    if (keys.up) camera.up = *keys.up;
    if (!(keys.position && keys.look_at)) check(*section, camera);
    // It need not be fitted to the scene where it is told where to stand.
    if (aims.framed.contains(scene.camera) && !keys.position) refit(camera, scene, aspect);
    turn(camera, scene.camera, keys, aims, box);
    check(*section, camera);
}

}  // namespace penumbra
