// The image module: everything that penumbra asks of OpenImageIO, behind ImageModule.
#include "base/descriptor.h"
#include "image/image_module.h"
#include "image/oiio/containers.h"
#include "image/oiio/encoder.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace penumbra {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

// ISO/IEC 14496-12, section 4.3, and AVIF's section 6: a file of boxes of which the first says that
// it holds AV1 pictures.
bool is_avif(std::string_view text) {
    constexpr std::size_t brands = 16, most = 256;
    if (text.size() < brands || text.substr(4, 4) != "ftyp") return false;
    const auto size = std::size_t(static_cast<unsigned char>(text[2])) << 8 |
                      std::size_t(static_cast<unsigned char>(text[3]));
    const std::string_view box = text.substr(0, std::min({size, most, text.size()}));
    for (std::size_t at = 8; at + 4 <= box.size(); at += 4)
        if (box.substr(at, 4) == "avif" || box.substr(at, 4) == "avis") return true;
    return false;
}

// OpenImageIO's name of the format, from the first bytes. Its own search would try every reader it
// has, those of films and medical scans included.
std::string format_of(std::span<const std::byte> file, const std::string& extension) {
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    const auto starts = [&](std::string_view magic) { return text.starts_with(magic); };
    using namespace std::string_view_literals;
    if (starts("\xff\xd8\xff")) return "jpeg";
    if (starts("RIFF") && text.size() > 12 && text.substr(8, 4) == "WEBP") return "webp";
    if (starts("II*\0"sv) || starts("MM\0*"sv) || starts("II+\0"sv) || starts("MM\0+"sv))
        return "tiff";
    if (starts("\x76\x2f\x31\x01")) return "openexr";
    if (starts("#?RADIANCE") || starts("#?RGBE")) return "hdr";
    if (starts("GIF8")) return "gif";
    if (starts("DDS ")) return "dds";
    if (starts("8BPS")) return "psd";
    if (starts("\0\0\0\x0cjP  "sv) || starts("\xff\x4f\xff\x51")) return "jpeg2000";
    if (starts("BM") && text.size() > 26) return "bmp";
    if (is_avif(text)) return "avif";
    if (text.size() > 2 && text[0] == 'P' &&
        ((text[1] >= '1' && text[1] <= '7') || text[1] == 'f' || text[1] == 'F'))
        return "pnm";
    // Formats of textures and renderings only; each reader is a way in. Not .iff: OpenImageIO 2.4
    // writes beyond its memory when such a file is damaged.
    constexpr std::array others = {".tga", ".tpic", ".sgi",  ".rgb", ".rgba",
                                   ".bw",  ".heic", ".heif", ".avif"};
    const auto other = std::find(others.begin(), others.end(), extension);
    return other == others.end() ? "" : extension.substr(1);
}

// The channels to read: R, G, B and alpha by name where a file has many, else the first ones.
std::vector<int> wanted_channels(const ImageSpec& spec) {
    const auto named = [&](const char* name) {
        const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
        return found == spec.channelnames.end() ? -1 : int(found - spec.channelnames.begin());
    };
    std::vector<int> channels;
    if (named("R") >= 0 && named("G") >= 0 && named("B") >= 0)
        channels = {named("R"), named("G"), named("B")};
    else if (spec.nchannels - (spec.alpha_channel >= 0) >= 3)
        channels = {0, 1, 2};
    else
        channels = {0};
    const bool alpha =
        spec.alpha_channel >= 0 && spec.alpha_channel < spec.nchannels &&
        std::find(channels.begin(), channels.end(), spec.alpha_channel) == channels.end();
    if (alpha) channels.push_back(spec.alpha_channel);
    return channels;
}

struct SampleType {
    Depth depth;
    TypeDesc type;
};

SampleType sample_type(const TypeDesc& stored) {
    if (stored.is_floating_point()) return {Depth::f32, TypeDesc::FLOAT};
    if (stored.basesize() > 1) return {Depth::u16, TypeDesc::UINT16};
    return {Depth::u8, TypeDesc::UINT8};
}

std::string size_problem(const ImageSpec& spec) {
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) return "it is empty";
    if (spec.depth > 1) return "it is a volume";
    const bool large = spec.width > max_image_side || spec.height > max_image_side ||
                       std::size_t(spec.width) * std::size_t(spec.height) > max_image_pixels;
    if (large || spec.nchannels > 64)
        return "it has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
               " pixels of " + std::to_string(spec.nchannels) + " channels, more than is supported";
    return "";
}

// Keeps `channels` of the `all` interleaved ones.
std::vector<std::byte> pick(const std::vector<std::byte>& samples, std::size_t sample_size, int all,
                            const std::vector<int>& channels) {
    const std::size_t texels = samples.size() / (sample_size * std::size_t(all));
    std::vector<std::byte> picked(texels * channels.size() * sample_size);
    std::byte* to = picked.data();
    for (std::size_t i = 0; i < texels; ++i) {
        for (const int channel : channels) {
            const std::size_t from = (i * std::size_t(all) + std::size_t(channel)) * sample_size;
            std::memcpy(to, samples.data() + from, sample_size);
            to += sample_size;
        }
    }
    return picked;
}

// What reading may take beside the samples: the file's own, tiles and strips.
std::size_t working_memory(const ImageSpec& spec) {
    const auto pixel = std::size_t(spec.nchannels) * std::size_t(spec.format.size());
    const auto tile = [](int side) { return std::size_t(std::max(side, 0)); };
    const std::size_t row_of_tiles =
        (std::size_t(spec.width) + tile(spec.tile_width)) * tile(spec.tile_height);
    const std::size_t picture = std::size_t(spec.width) * std::size_t(spec.height);
    return pixel * (picture + 2 * row_of_tiles);
}

Decoded read_samples(ImageInput& input, const MayTake& may_take) {
    const ImageSpec spec = input.spec();
    if (std::string problem = size_problem(spec); !problem.empty()) return {{}, problem};

    const auto channels = wanted_channels(spec);
    const int end = *std::max_element(channels.begin(), channels.end()) + 1;
    const auto [depth, type] = sample_type(spec.format);
    Raster raster = {spec.width, spec.height, int(channels.size()), depth, {}};
    const std::size_t bytes = raster.texels() * std::size_t(end) * std::size_t(depth);
    if (!may_take(bytes)) return {{}, no_memory};
    raster.data.resize(bytes);
    if (!may_take(working_memory(spec))) return {{}, no_memory};
    if (!input.read_image(0, 0, 0, end, type, raster.data.data()))
        return {{}, reason(input.geterror())};
    if (end != raster.channels || !std::is_sorted(channels.begin(), channels.end()))
        raster.data = pick(raster.data, std::size_t(depth), end, channels);
    return {std::move(raster), ""};
}

// A file for the formats that OpenImageIO cannot keep in memory; removed at the end.
struct TemporaryFile {
    std::string path;

    explicit TemporaryFile(const std::string& extension) {
        path = (std::filesystem::temp_directory_path() / ("penumbra-XXXXXX" + extension)).string();
        const Descriptor opened(::mkstemps(path.data(), int(extension.size())));
        if (!opened) throw std::system_error(errno, std::generic_category(), path);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() { ::unlink(path.c_str()); }

    void write(std::span<const std::byte> content) const {
        std::ofstream out(path, std::ios::binary);
        out.write(reinterpret_cast<const char*>(content.data()), std::streamsize(content.size()));
        if (!out.flush()) throw std::runtime_error(path + " cannot be written");
    }
};

ImageSpec open_config() {
    ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;  // straight alpha, as glTF and POV-Ray take it
    return config;
}

Decoded decode_memory(ImageInput& input, std::span<const std::byte> file, const std::string& format,
                      const MayTake& may_take) {
    OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(file.data()), file.size());
    input.set_ioproxy(&memory);
    ImageSpec spec;
    if (!input.open("memory." + format, spec, open_config())) return {{}, reason(input.geterror())};
    Decoded decoded = read_samples(input, may_take);
    input.close();  // before the memory goes
    return decoded;
}

// Straight colours and, from a second decoding, their alpha.
Decoded decode_webp(std::span<const std::byte> file, const MayTake& may_take) {
    const auto input = ImageInput::create("webp");
    if (!input) return {{}, reason(OIIO::geterror())};
    Decoded decoded = decode_memory(*input, file, "webp", may_take);
    const auto opaque = without_alpha(file);
    if (!decoded.problem.empty() || decoded.raster.channels != 4 || opaque.empty()) return decoded;

    const auto again = ImageInput::create("webp");  // reopened, the first would mix both up
    const Decoded colors = decode_memory(*again, opaque, "webp", may_take);
    if (!colors.problem.empty() || colors.raster.channels != 3 ||
        colors.raster.texels() != decoded.raster.texels())
        return decoded;
    for (std::size_t i = 0; i < colors.raster.texels(); ++i)
        std::copy_n(&colors.raster.data[i * 3], 3, &decoded.raster.data[i * 4]);
    return decoded;
}

Decoded decode_file(std::span<const std::byte> file, const std::string& extension,
                    const MayTake& may_take) {
    const std::string format = format_of(file, extension);
    if (format.empty()) return {{}, file.empty() ? "it is empty" : "unknown format"};
    const Opening opening = opening_of(file, format);
    if (opening.pixels > max_image_pixels) return {{}, "it has more pixels than are supported"};
    if (!may_take(opening.memory)) return {{}, no_memory};
    if (format == "webp") return decode_webp(file, may_take);

    const auto input = ImageInput::create(format);
    if (!input) return {{}, reason(OIIO::geterror())};
    if (input->supports("ioproxy")) return decode_memory(*input, file, format, may_take);

    const TemporaryFile temporary(extension.empty() ? '.' + format : extension);
    temporary.write(file);
    ImageSpec spec;
    if (!input->open(temporary.path, spec, open_config())) return {{}, reason(input->geterror())};
    return read_samples(*input, may_take);
}

// Calls `work` and turns whatever it throws into a problem.
template <class Result, class Work>
Result guarded(Work work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return {{}, no_memory};
    } catch (const std::exception& error) {
        return {{}, reason(error.what())};
    } catch (...) {
        return {{}, "unknown failure"};
    }
}

Decoded decode(std::span<const std::byte> file, const std::string& extension,
               const MayTake& may_take) {
    return guarded<Decoded>([&] { return decode_file(file, extension, may_take); });
}

}  // namespace
}  // namespace penumbra

extern "C" __attribute__((visibility("default"))) const void* penumbra_image_module() {
    static const penumbra::ImageModule module = {penumbra::image_module_abi, penumbra::decode,
                                                 penumbra::open_encoder};
    // One image at a time needs no pool of threads, and none is left to join at exit.
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);
    // What it checks by itself, where it allocates before we know what: a picture of eight
    // channels.
    OIIO::attribute("limits:imagesize_MB",
                    int(penumbra::max_image_pixels * 8 * sizeof(float) >> 20));
    return &module;
}
