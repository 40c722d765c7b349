// Samples -> picture file, row by row.
#pragma once

#include "base/file.h"
#include "image/image_module.h"
#include "image/row_encoder.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// The image module. Throws Error of that kind at `place` when it cannot be loaded.
const ImageModule& module_for(Failure failure, const std::string& place);

/// How a picture file keeps linear colours.
struct PictureFormat {
    Raster frame = {};      ///< three channels, no data; integers are sRGB-encoded
    bool positive = false;  ///< negative values become 0
    bool srgb() const { return frame.depth != Depth::f32; }
};

/// By the extension of `file`. Throws Error (output).
PictureFormat picture_format(const std::filesystem::path& file, int width, int height,
                             const SaveOptions& options);

/// Appends the pixels as a file of that format keeps them.
void append_samples(std::span<const Color> pixels, const PictureFormat& format,
                    std::vector<std::byte>& samples);

/// A picture file in the making. All throw Error (output).
class SampleWriter {
  public:
    /// `frame` has no data. `srgb` adds the format's mark for sRGB-encoded samples. `comment` is
    /// kept in .png and .exr files.
    SampleWriter(const std::filesystem::path& file, const Raster& frame, bool srgb,
                 std::string comment = "");
    /// The next whole rows from the top, as in Raster::data. They are kept until there are enough
    /// of them to be worth encoding, so that small pictures cost nothing while they are rendered.
    void append(std::span<const std::byte> rows);
    /// After the last row: the file appears.
    void finish();

  private:
    void encode(std::size_t rows);

    std::filesystem::path file_;
    Raster frame_;
    FileNotes notes_;
    StagedFile staged_;
    std::unique_ptr<RowEncoder> encoder_ =
        {};  // opened late: the image module may still be loading
    std::size_t row_size_, rows_together_ = 0;
    std::vector<std::byte> kept_ = {};
};

}  // namespace penumbra
