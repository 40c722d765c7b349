// Images as Tachyon reads them.
#pragma once

#include "exporters/tachyon/output.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::tachyon {

/// The mean of a texture, in linear light.
Color mean(const Texture& texture);

/// The .ppm beside the .dat `scene` for the texture of this index.
std::filesystem::path image_file(const std::filesystem::path& scene, Index texture);

/// The name of the .ppm beside the .dat that holds the texture of this index; writes it unless that
/// is done. None when Tachyon has no room for another image. Throws Error (output): see
/// write_tachyon().
std::optional<std::string> image_name(Output& out, Index texture);

/// Removes the images of an earlier export of this name that this one does not need, and returns
/// them.
std::vector<std::filesystem::path> remove_old_images(const Output& out);

}  // namespace penumbra::tachyon
