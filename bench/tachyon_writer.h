// Scene -> Tachyon's scene file, for comparing speed: the same geometry, light and recursion.
#pragma once

#include "penumbra/error.h"
#include "penumbra/scene.h"

#include <filesystem>

namespace penumbra::bench {

/// Writes `scene` as a .dat of Tachyon 0.99 and the images of its planes beside it, as .ppm. Run
/// Tachyon in that folder, with -shade_phong. Its picture is linear where penumbra's is sRGB.
/// Instances are expanded and virtual sources become lights. The losses say what Tachyon lacks.
/// Throws Error (output).
Losses write_tachyon(const NormalisedScene& scene, const RenderOptions& options,
                     const std::filesystem::path& file);

}  // namespace penumbra::bench
