// Pieces of the text of lights and objects.
#pragma once

#include "penumbra/scene.h"

#include <cstddef>
#include <string>

namespace penumbra::pov {

/// "lamp: point light, 7 virtual sources (axes, delta 0.5)", to stand in a comment.
std::string light_title(const Light& light, std::size_t count);

/// " interior { ... }", or nothing where the material has none of its own.
std::string interior(const Material& m);

/// The transform that brings an object to its place, or nothing. Its last row is a translation.
std::string placement(const Matrix& m);

}  // namespace penumbra::pov
