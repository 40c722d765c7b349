#include "image/oiio/encoder.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <new>
#include <system_error>

namespace penumbra {
namespace {

using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

bool is_tiff(const std::string& extension) { return extension == ".tif" || extension == ".tiff"; }

// The nearest depth that the format can store.
TypeDesc file_type(Depth depth, const std::string& extension) {
    if (extension == ".exr" || extension == ".hdr") return TypeDesc::FLOAT;
    if (depth == Depth::u8 || extension == ".jpg" || extension == ".jpeg") return TypeDesc::UINT8;
    if (depth == Depth::f32 && is_tiff(extension)) return TypeDesc::FLOAT;
    return TypeDesc::UINT16;
}

ImageSpec file_spec(const Raster& frame, const std::string& extension, const FileNotes& notes) {
    ImageSpec spec(frame.width, frame.height, frame.channels, file_type(frame.depth, extension));
    if (frame.channels == 2) spec.channelnames = {"Y", "A"};
    if (frame.channels % 2 == 0) spec.alpha_channel = frame.channels - 1;
    spec["oiio:UnassociatedAlpha"] = 1;
    spec["DateTime"] = "";  // or the same picture would have other bytes every second
    if (!notes.comment.empty() && extension == ".exr")
        spec.attribute("ImageDescription", notes.comment);
    if (notes.srgb) spec["oiio:ColorSpace"] = "sRGB";
    if (extension == ".exr" || is_tiff(extension)) spec["compression"] = "zip";
    if (extension == ".jpg" || extension == ".jpeg") spec["compression"] = "jpeg:95";
    return spec;
}

TypeDesc memory_type(Depth depth) {
    return depth == Depth::u8    ? TypeDesc(TypeDesc::UINT8)
           : depth == Depth::u16 ? TypeDesc(TypeDesc::UINT16)
                                 : TypeDesc(TypeDesc::FLOAT);
}

// A file that is open already. OpenImageIO's own files lose what a full disk refuses.
class OpenFile : public OIIO::Filesystem::IOProxy {
  public:
    OpenFile(int opened, const std::string& name) : IOProxy(name, Write), descriptor(opened) {}

    // Not "file", which OpenImageIO takes for a class of its own.
    const char* proxytype() const override { return "descriptor"; }
    void close() override { m_mode = Closed; }

    std::size_t write(const void* from, std::size_t size) override {
        const std::size_t done = pwrite(from, size, m_pos);
        m_pos += std::int64_t(done);
        return done;
    }
    std::size_t pwrite(const void* from, std::size_t size, std::int64_t at) override {
        const auto* bytes = static_cast<const char*>(from);
        std::size_t done = 0;
        while (done < size) {
            const ssize_t n = ::pwrite(descriptor, bytes + done, size - done, at + off_t(done));
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) {
                if (error == 0) error = n < 0 ? errno : ENOSPC;
                break;
            }
            done += std::size_t(n);
        }
        return done;
    }
    std::size_t size() const override {
        const off_t end = ::lseek(descriptor, 0, SEEK_END);
        return end < 0 ? 0 : std::size_t(end);
    }

    int error = 0;  ///< the system's, of the first write that failed
    const int descriptor;
};

// Calls `work` and turns whatever it throws into a problem.
template <class Work>
std::string guarded(Work work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return "not enough memory";
    } catch (const std::exception& error) {
        return reason(error.what());
    } catch (...) {
        return "unknown failure";
    }
}

class OiioEncoder : public RowEncoder {
  public:
    OiioEncoder(int descriptor, const std::string& name) : file_(descriptor, name) {}
    ~OiioEncoder() override {
        guarded([&] {
            output_.reset();  // it may still write
            return std::string();
        });
    }

    std::string open(const Raster& frame, const std::string& extension, const FileNotes& notes) {
        height_ = frame.height;
        type_ = memory_type(frame.depth);
        row_size_ =
            std::size_t(frame.width) * std::size_t(frame.channels) * std::size_t(frame.depth);
        return outcome([&] {
            output_ = ImageOutput::create(extension.substr(1));
            if (!output_) return false;
            tiff_ = is_tiff(extension);
            // libtiff reads back what it wrote, which OpenImageIO does not hand on.
            if (!tiff_ && !output_->set_ioproxy(&file_)) return false;
            return output_->open(tiff_ ? by_name() : file_.filename(),
                                 file_spec(frame, extension, notes));
        });
    }

    // A few rows at a time, always the same ones: some formats compress what comes together.
    std::string write(const std::byte* rows, int count) override {
        constexpr int together = 64;
        return outcome([&] {
            for (; count > 0; count -= std::min(count, together)) {
                const int part = std::min(count, together);
                if (!output_->write_scanlines(next_, next_ + part, 0, type_, rows)) return false;
                next_ += part;
                rows += row_size_ * std::size_t(part);
            }
            return true;
        });
    }

    std::string finish() override {
        return outcome([&] { return output_->close() && (!tiff_ || is_whole()); });
    }

  private:
    OpenFile file_;  // outlives `output`
    std::unique_ptr<ImageOutput> output_ = {};
    bool tiff_ = false;
    TypeDesc type_ = {};
    std::size_t row_size_ = 0;
    int height_ = 0, next_ = 0;

    std::string by_name() const { return "/proc/self/fd/" + std::to_string(file_.descriptor); }

    // libtiff writes its directory last and does not say whether it could.
    bool is_whole() const {
        const auto written = OIIO::ImageInput::create("tiff");
        ImageSpec spec;
        return written && written->open(by_name(), spec) && spec.height == height_;
    }

    template <class Work>
    std::string outcome(Work work) {
        return guarded([&]() -> std::string {
            const bool done = work();
            if (file_.error != 0) return std::generic_category().message(file_.error);
            if (done) return "";
            return reason(output_ ? output_->geterror() : OIIO::geterror());
        });
    }
};

}  // namespace

std::string reason(const std::string& message) {
    std::string text = message.substr(0, message.find('\n'));
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ' || c == 127) c = ' ';
    while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
    return text.empty() ? "damaged or incomplete file" : text;
}

OpenedEncoder open_encoder(const Raster& frame, const std::string& extension,
                           const FileNotes& notes, int descriptor) {
    OpenedEncoder result;
    result.problem = guarded([&] {
        auto encoder = std::make_unique<OiioEncoder>(descriptor, "picture" + extension);
        std::string problem = encoder->open(frame, extension, notes);
        if (problem.empty()) result.encoder = std::move(encoder);
        return problem;
    });
    return result;
}

}  // namespace penumbra
