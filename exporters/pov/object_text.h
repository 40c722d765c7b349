// Pieces of the text of lights and objects.
#pragma once

#include "penumbra/scene.h"

#include <cstddef>
#include <string>

namespace penumbra::pov {

/// "lamp: point light, 7 virtual sources (axes, delta 0.5)", to stand in a comment.
std::string light_title(const Light& light, std::size_t count);

/// " interior { ... }" of an object that rays may go on behind (`passed`) or that asks for
/// Fresnel's term. POV-Ray counts what a ray has entered by it: two objects without one are the
/// same to it.
std::string interior(const Material& m, bool passed);

/// The transform that brings an object to its place, or nothing. Its last row is a translation.
std::string placement(const Matrix& m);

}  // namespace penumbra::pov
