// The objects of a scene under one number: its instances, then its spheres, then its planes.
#pragma once

#include "penumbra/scene.h"

#include <cassert>

namespace penumbra {

enum class ObjectKind { instance, sphere, plane };

/// One of Scene::instances, spheres or planes.
struct ObjectPlace {
    ObjectKind kind = ObjectKind::instance;
    std::size_t index = 0;
};

inline std::size_t object_count(const Scene& scene) {
    return scene.instances.size() + scene.spheres.size() + scene.planes.size();
}

/// Where object number `object` stands. Precondition: object < object_count(scene).
inline ObjectPlace place_of(const Scene& scene, Index object) {
    assert(object < object_count(scene));
    std::size_t i = object;
    if (i < scene.instances.size()) return {ObjectKind::instance, i};
    i -= scene.instances.size();
    if (i < scene.spheres.size()) return {ObjectKind::sphere, i};
    return {ObjectKind::plane, i - scene.spheres.size()};
}

/// The object's material, into Scene::materials.
inline Index material_index(const Scene& scene, Index object) {
    const auto [kind, i] = place_of(scene, object);
    switch (kind) {
    case ObjectKind::sphere: return scene.spheres[i].material;
    case ObjectKind::plane: return scene.planes[i].material;
    case ObjectKind::instance: break;
    }
    return scene.meshes[scene.instances[i].mesh].material;
}

/// Whether the object is of the surroundings: see Instance::backdrop.
inline bool is_backdrop(const Scene& scene, Index object) {
    const auto [kind, i] = place_of(scene, object);
    switch (kind) {
    case ObjectKind::sphere: return scene.spheres[i].backdrop;
    case ObjectKind::plane: return scene.planes[i].backdrop;
    case ObjectKind::instance: break;
    }
    return scene.instances[i].backdrop;
}

/// The object's name; an instance without one has its mesh's. May be empty.
inline const std::string& name_of(const Scene& scene, Index object) {
    const auto [kind, i] = place_of(scene, object);
    switch (kind) {
    case ObjectKind::sphere: return scene.spheres[i].name;
    case ObjectKind::plane: return scene.planes[i].name;
    case ObjectKind::instance: break;
    }
    const Instance& instance = scene.instances[i];
    return instance.name.empty() ? scene.meshes[instance.mesh].name : instance.name;
}

}  // namespace penumbra
