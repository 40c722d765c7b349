// Boxes around what a scene consists of.
#pragma once

#include "tracer/accel/box_tree.h"

#include "penumbra/scene.h"

namespace penumbra {

/// A little larger than the sphere, for float32 rounding.
Bounds box_of(const Sphere& sphere);

/// Boxes around runs of facets, of all instances.
BoxTree boxes_of_facets(const Scene& scene);

/// The same of those that let light through.
BoxTree boxes_of_translucent_facets(const Scene& scene);

/// Boxes around spheres; the items are objects.
BoxTree boxes_of_spheres(const Scene& scene);

}  // namespace penumbra
