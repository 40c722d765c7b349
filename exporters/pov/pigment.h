// Colours, images and patterns -> what stands in pigment { }.
#pragma once

#include "exporters/pov/plan.h"

#include <string>

namespace penumbra::pov {

/// The light that a pigment lets through: in its own colour, and as it is.
struct Passing {
    float filter = 0, transmit = 0;
    bool none() const { return filter == 0 && transmit == 0; }
};

/// "rgb ...", "rgbt ..." or "rgbft ...".
std::string color(const Color& c, const Passing& passing);

/// What a pattern would take over from a #default pigment; other warps than turbulence, and
/// transforms, cannot be undone.
std::string own_pattern(const Plan& plan);

/// The transforms that lay the image, or a pattern of it, where it belongs.
std::string image_placement(const Plan& plan, const Look& look, const ImageMap& map);

/// What undoes these transforms in a part of a texture that they are written after, and that they
/// are not meant for. POV-Ray applies them to the normals of all textures of a texture_map.
std::string without_placement(const Plan& plan, const Look& look, const ImageMap& map);

/// `png "file.png" gamma srgb interpolate 2`, as it stands in image_map and image_pattern.
std::string image_file(const Plan& plan, const ImageMap& map);

/// The image alone. What wears it counts as opaque when POV-Ray looks for shadows.
std::string image_map(const Plan& plan, const Look& look, const ImageMap& map,
                      const Passing& passing);

/// The image, translucent for shadows too if it lets light through.
std::string image_pigment(const Plan& plan, const Look& look, const ImageMap& map,
                          const Passing& passing);

/// The look's pattern or colour.
std::string pigment(const Plan& plan, const Look& look, const Passing& passing);

/// The pigment of a sky.
std::string sky_pigment(const Plan& plan, const Sky& sky);

}  // namespace penumbra::pov
