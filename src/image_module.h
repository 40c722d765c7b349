// What src/image.cpp asks of the image module, the shared library that holds OpenImageIO.
#pragma once

#include "penumbra/image.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// A decoded file; `problem` says why there is none.
struct Decoded {
    Raster raster = {};
    std::string problem = {};  ///< empty: success
};

/// The bytes of an image file; `problem` says why there are none.
struct Encoded {
    std::vector<std::byte> file = {};
    std::string problem = {};  ///< empty: success
};

/// The module's functions. They never throw and may be called from several threads at once.
struct ImageModule {
    int abi;  ///< image_module_abi of the build that made the module

    /// `extension`, such as ".tga", decides only about files whose first bytes do not tell.
    Decoded (*decode)(std::span<const std::byte> file, const std::string& extension);

    /// Writes the samples as they are, in the format of `extension` and the nearest depth that it
    /// has. `srgb` adds the format's mark for sRGB-encoded samples.
    Encoded (*encode)(const Raster& raster, const std::string& extension, bool srgb);
};

/// Changes with every change of ImageModule or of the types it uses.
inline constexpr int image_module_abi = 1;

/// The one symbol of the module, of type const ImageModule*().
inline constexpr const char* image_module_entry = "penumbra_image_module";

/// The loaded module; the first call loads it. Throws std::runtime_error with the reason.
const ImageModule& image_module();

/// The longest side and the number of pixels that are read: enough for any texture, and a bound on
/// what a small malicious file can make us allocate.
inline constexpr int max_image_side = 32768;
inline constexpr std::size_t max_image_pixels = std::size_t(64) << 20;

}  // namespace penumbra
