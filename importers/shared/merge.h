// Several models -> one scene.
#pragma once

#include "penumbra/importers.h"

namespace penumbra {

/// What one model file brought into a scene.
struct Model {
    std::size_t mesh = 0, meshes = 0;  ///< its meshes: [mesh, mesh + meshes) of Scene::meshes
    Scene placed = {};  ///< its instances, lights and cameras as the file has them, with the
                        ///< indices of the whole scene; the rest is moved out
};

/// Appends the materials, textures, meshes, losses and infos of a model (that has no spheres or
/// planes). Instances, lights and cameras follow with place_model().
Model add_model(Imported& whole, Imported&& part);

/// Appends the instances, lights and cameras of a model, transformed. The first camera of all
/// becomes the active one.
void place_model(Scene& whole, Scene placed, const Matrix& transform);

}  // namespace penumbra
