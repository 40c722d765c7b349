#include "importers/shared/merge.h"

#include "scene/texture/image_maps.h"
#include "scene/transforms.h"

#include <cassert>
#include <iterator>

namespace penumbra {

namespace {

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
    from.clear();
}

void shift(Index& index, std::size_t by) {
    if (index != no_index) index += Index(by);
}

void shift_textures(Material& material, std::size_t by) {
    each_image_map(material, [&](ImageMap& map, MapUse) { shift(map.texture, by); });
}

Vec3 turned(const Vec3& direction, const Matrix& transform) {
    Vec3 result(0);
    transform.multDirMatrix(direction, result);
    return result.normalized();
}

// A rotation that turns directions as `transform` does, or nearly so: it may scale as well.
Matrix rotation_of(const Matrix& transform) {
    Matrix m;
    for (int row = 0; row < 3; ++row) {
        const Vec3 axis =
            Vec3(transform[row][0], transform[row][1], transform[row][2]).normalized();
        for (int column = 0; column < 3; ++column) m[row][column] = axis[column];
    }
    return is_rotation(m) ? m : Matrix();
}

// Lengths that have no direction scale by the mean of the transform's scales.
void transform_all(Scene& part, const Matrix& transform) {
    if (transform == Matrix()) return;
    const double scale = mean_scale(transform);
    for (Instance& instance : part.instances) instance.transform *= transform;
    for (Light& light : part.lights) {
        light.position = light.position * transform;
        light.direction = turned(light.direction, transform);
        light.penumbra.target = light.penumbra.target * transform;
        if (light.attenuation) light.attenuation->distance *= scale;
        if (light.type != Light::Type::directional) light.penumbra.delta *= scale;
    }
    for (Camera& camera : part.cameras) {
        camera.position = camera.position * transform;
        camera.direction = turned(camera.direction, transform);
        camera.up = turned(camera.up, transform);
        camera.extent *= scale;
    }
    if (part.environment) part.environment->rotation *= rotation_of(transform);
}

}  // namespace

Model add_model(Imported& whole, Imported&& part) {
    Scene& to = whole.scene;
    // By name, so that a new member of Scene is an error here until it has been looked at.
    auto& [materials, textures, meshes, instances, spheres, planes, lights, cameras, camera,
           background, sky, mirror_sky, environment, ambient] = part.scene;
    assert(spheres.empty() && planes.empty() && !sky && !mirror_sky);
    const Model range = {.mesh = to.meshes.size(), .meshes = meshes.size()};
    for (Material& material : materials) shift_textures(material, to.textures.size());
    for (Mesh& mesh : meshes) shift(mesh.material, to.materials.size());
    for (Instance& instance : instances) shift(instance.mesh, to.meshes.size());
    if (environment) shift(environment->texture, to.textures.size());
    append(to.materials, materials);
    append(to.textures, textures);
    append(to.meshes, meshes);
    append(whole.models, part.models);
    append(whole.files, part.files);
    append(whole.losses, part.losses);
    return {.mesh = range.mesh, .meshes = range.meshes, .placed = std::move(part.scene)};
}

void place_model(Scene& whole, Scene placed, const Matrix& transform) {
    transform_all(placed, transform);
    if (whole.camera == no_index && !placed.cameras.empty())
        whole.camera =
            Index(whole.cameras.size() + (placed.camera == no_index ? 0 : placed.camera));
    append(whole.instances, placed.instances);
    append(whole.lights, placed.lights);
    append(whole.cameras, placed.cameras);
    if (!whole.environment) whole.environment = std::move(placed.environment);
}

}  // namespace penumbra
