#include "scene/view.h"

#include "scene/defects.h"

#include <cassert>
#include <cmath>

namespace penumbra {

View view_of(const Camera& camera, int width, int height) {
    assert(width >= 1 && height >= 1);
    assert(camera_defects(camera).empty());
    const Vec3 forward = camera.direction.normalized();
    const Vec3 right = forward.cross(camera.up).normalized();
    const Vec3 up = right.cross(forward);
    const bool orthographic = camera.projection == Camera::Projection::orthographic;
    const double side = orthographic ? camera.extent : 2 * std::tan(camera.fov / 2);
    const double aspect = double(width) / height;
    const bool horizontal = camera.side == Camera::Side::horizontal;
    const double across = horizontal ? side : side * aspect;
    const double along = horizontal ? side / aspect : side;
    return {.orthographic = orthographic,
            .location = camera.position,
            .right = right * across,
            .up = up * along,
            .direction = forward};
}

}  // namespace penumbra
