// What src/image/image.cpp asks of the image module, the shared library that holds OpenImageIO.
#pragma once

#include "image/row_encoder.h"

#include "penumbra/image.h"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// A decoded file; `problem` says why there is none.
struct Decoded {
    Raster raster = {};
    std::string problem = {};  ///< empty: success
};

/// Asked before so many bytes of memory are taken, for which a file's header calls; what was
/// allowed before is in use by then. Where the answer is no, `problem` becomes no_memory.
using MayTake = std::function<bool(std::size_t)>;

inline constexpr const char* no_memory = "not enough memory";

/// The module's functions. They never throw and may be called from several threads at once.
struct ImageModule {
    int abi;  ///< image_module_abi of the build that made the module

    /// `extension`, such as ".tga", decides only about files whose first bytes do not tell.
    Decoded (*decode)(std::span<const std::byte> file, const std::string& extension,
                      const MayTake& may_take);

    /// Will write samples as they are into the empty file that `descriptor` stands for, open for
    /// reading and writing, in the format of `extension` and the nearest depth that it has. `frame`
    /// needs no data.
    OpenedEncoder (*open_encoder)(const Raster& frame, const std::string& extension,
                                  const FileNotes& notes, int descriptor);
};

/// Changes with every change of ImageModule or of the types it uses.
inline constexpr int image_module_abi = 4;

/// The one symbol of the module, of type const ImageModule*().
inline constexpr const char* image_module_entry = "penumbra_image_module";

/// The loaded module; the first call loads it. Throws std::runtime_error with the reason.
const ImageModule& image_module();

/// The longest side and the number of pixels that are read: enough for any texture, and a bound on
/// what a small malicious file can make us allocate.
inline constexpr int max_image_side = 32768;
inline constexpr std::size_t max_image_pixels = std::size_t(64) << 20;

}  // namespace penumbra
