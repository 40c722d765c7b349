// Pictures are encoded row by row, so that they need not be in memory as a whole.
#pragma once

#include "penumbra/image.h"

#include <functional>
#include <memory>
#include <span>
#include <string>

namespace penumbra {

/// Writes one image file. Its functions say what went wrong ("": nothing) and never throw; after a
/// problem only the destructor may follow.
class RowEncoder {
  public:
    RowEncoder() = default;
    virtual ~RowEncoder() = default;
    RowEncoder(const RowEncoder&) = delete;
    RowEncoder& operator=(const RowEncoder&) = delete;

    /// The next `count` rows, from the top, as in Raster::data.
    virtual std::string write(const std::byte* rows, int count) = 0;
    /// After the last row.
    virtual std::string finish() = 0;
};

/// Where an encoder's bytes go, in order.
using ByteSink = std::function<void(std::span<const std::byte>)>;

/// What a file says of its samples.
struct FileNotes {
    bool srgb = false;         ///< they are sRGB-encoded, if the format has a mark for that
    std::string comment = {};  ///< ASCII, of .png and .exr; empty: none
};

/// Opened with a RowEncoder, or with a problem.
struct OpenedEncoder {
    std::unique_ptr<RowEncoder> encoder = {};
    std::string problem = {};
};

}  // namespace penumbra
