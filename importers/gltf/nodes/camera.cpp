// glTF cameras -> Cameras.
#include "importers/gltf/nodes/camera.h"

#include "importers/gltf/reader/reader.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra::gltf {

Vec3 direction_of(const Matrix& world) {
    Vec3 direction;
    world.multDirMatrix(Vec3(0, 0, -1), direction);
    return direction.length() > 0 ? direction.normalized() : Vec3(0, 0, -1);
}

namespace {

// None where there is none, or one that no picture has.
double usable_aspect(double aspect) {
    aspect = std::abs(aspect);
    return aspect >= 1e-3 && aspect <= 1e3 ? aspect : 0;
}

}  // namespace

void read_camera(Reader& reader, int index, const Matrix& world) {
    const tinygltf::Model& model = reader.document.model;
    const tinygltf::Node& node = model.nodes[std::size_t(index)];
    const tinygltf::Camera& source = model.cameras[std::size_t(node.camera)];
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
        reader.note_loss(Loss::dropped, fmt::format("/nodes/{}", index),
                         "its scale leaves the camera no view");
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
        camera.aspect = usable_aspect(source.orthographic.xmag / source.orthographic.ymag);
    } else {
        camera.fov = source.perspective.yfov;
        camera.aspect = usable_aspect(source.perspective.aspectRatio);
    }
    reader.scene.cameras.push_back(std::move(camera));
}

}  // namespace penumbra::gltf
