#include "image/contents.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace penumbra {
namespace {

using namespace std::string_view_literals;

// The bytes of a file; beyond its end there are zeros.
struct Bytes {
    std::string_view text = {};
    bool big_endian = true;

    std::uint64_t byte(std::uint64_t at) const {
        return at < text.size() ? std::uint8_t(text[std::size_t(at)]) : 0;
    }
    std::uint64_t number(std::uint64_t at, int size) const {
        std::uint64_t value = 0;
        for (int i = 0; i < size; ++i)
            value = value << 8 | byte(at + std::uint64_t(big_endian ? i : size - 1 - i));
        return value;
    }
    std::string_view part(std::uint64_t at, std::uint64_t size) const {
        if (at >= text.size()) return {};
        return text.substr(std::size_t(at), std::size_t(size));
    }
};

// What is found, before it is put into words.
struct Found {
    bool associated_alpha = false;
    std::size_t pictures = 1;
    const char* kind = "";
    bool profile = false;
    bool gamma = false;  // other than sRGB's
};

// ICC.1, section 10.15, and the older textDescriptionType: names are ASCII or UTF-16.
bool names_srgb(std::string_view profile) {
    return profile.find("sRGB"sv) != profile.npos || profile.find("s\0R\0G\0B"sv) != profile.npos;
}

// What a zlib stream holds, up to the size of any profile that describes a display.
std::string inflated(std::string_view data) {
    std::string result(std::size_t(1) << 20, '\0');
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) return {};
    // zlib takes what it only reads as changeable.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
    stream.avail_in = uInt(data.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = uInt(result.size());
    inflate(&stream, Z_FINISH);
    result.resize(stream.total_out);
    inflateEnd(&stream);
    return result;
}

// iCCP: a name, a zero, the method, and the profile, which says what it is itself; what cannot be
// unpacked is known by its name.
bool names_srgb_packed(std::string_view chunk) {
    const std::size_t name = std::min(chunk.find('\0'), chunk.size());
    if (names_srgb(chunk.substr(0, name))) return true;
    return name + 2 < chunk.size() && names_srgb(inflated(chunk.substr(name + 2)));
}

// PNG specification, third edition: chunks; acTL is in front of the pixels. gAMA counts in hundred
// thousandths, sRGB and a profile have precedence over it.
Found in_png(const Bytes& file) {
    constexpr std::uint64_t srgb_gamma = 45455, slack = 500;
    Found found = {.kind = "frames"};
    bool told = false;
    for (std::uint64_t at = 8; at + 8 <= file.text.size();) {
        const std::uint64_t size = file.number(at, 4);
        const std::string_view type = file.part(at + 4, 4);
        if (type == "acTL") found.pictures = std::size_t(file.number(at + 8, 4));
        if (type == "iCCP") found.profile = !names_srgb_packed(file.part(at + 8, size));
        if (type == "iCCP" || type == "sRGB") told = true;
        if (const std::uint64_t gamma = file.number(at + 8, 4); type == "gAMA")
            found.gamma = gamma + slack < srgb_gamma || gamma > srgb_gamma + slack;
        if (type == "IDAT") break;
        at += 12 + size;
    }
    found.gamma = found.gamma && !told;
    return found;
}

// ITU-T T.81, annex B, and ICC.1, annex B.4.
Found in_jpeg(const Bytes& file) {
    Found found;
    for (std::uint64_t at = 2; at + 4 <= file.text.size() && file.byte(at) == 0xFF;) {
        const std::uint64_t marker = file.byte(at + 1), size = file.number(at + 2, 2);
        if (marker == 0xDA) break;
        const std::string_view data = file.part(at + 4, size - std::min<std::uint64_t>(size, 2));
        if (marker == 0xE2 && data.starts_with("ICC_PROFILE\0"sv) && data.size() > 13 &&
            data[12] == '\1')
            found.profile = !names_srgb(data);
        at += 2 + size;
    }
    return found;
}

// TIFF 6.0, section 2, and the layout of BigTIFF.
struct Directories {
    const Bytes& file;
    bool big;  // BigTIFF

    int offset_size() const { return big ? 8 : 4; }
    std::uint64_t count_size() const { return big ? 8 : 2; }
    std::uint64_t entry_size() const { return big ? 20 : 12; }
    std::uint64_t entries(std::uint64_t at) const {
        return std::min(file.number(at, int(count_size())), file.text.size() / entry_size());
    }
    std::uint64_t next(std::uint64_t at) const {
        return file.number(at + count_size() + entries(at) * entry_size(), offset_size());
    }
    // Where the value of a tag is, or its offset; 0 where the directory has no such tag.
    std::uint64_t value(std::uint64_t at, std::uint64_t tag) const {
        for (std::uint64_t i = 0; i < entries(at); ++i) {
            const std::uint64_t entry = at + count_size() + i * entry_size();
            if (file.number(entry, 2) == tag) return entry + (big ? 12 : 8);
        }
        return 0;
    }
    // What lies elsewhere in the file.
    std::string_view data(std::uint64_t value) const {
        const int size = offset_size();
        return file.part(file.number(value, size), file.number(value - std::uint64_t(size), size));
    }
};

Found in_tiff(const Bytes& file) {
    constexpr std::uint64_t extra_samples = 338, icc_profile = 34675, subfile = 254;
    constexpr std::size_t most = 10000;  // of pages: the list may lead back to itself
    const Directories list = {file, file.number(2, 2) == 43};
    const std::uint64_t first = file.number(list.big ? 8 : 4, list.offset_size());
    Found found = {.kind = "pages"};
    if (const std::uint64_t value = list.value(first, extra_samples))
        found.associated_alpha = file.number(value, 2) == 1;
    if (const std::uint64_t value = list.value(first, icc_profile))
        found.profile = !names_srgb(list.data(value));
    std::uint64_t at = list.next(first);
    for (std::size_t i = 0; at != 0 && at < file.text.size() && i < most; ++i) {
        const std::uint64_t kind = list.value(at, subfile);
        const bool reduced = kind != 0 && (file.number(kind, 4) & 1) != 0;
        if (!reduced) ++found.pictures;
        at = list.next(at);
    }
    return found;
}

// The blocks of GIF89a, sections 20 to 26.
Found in_gif(const Bytes& file) {
    Found found = {.pictures = 0, .kind = "frames"};
    const auto table = [&](std::uint64_t flags) {
        return (flags & 0x80) != 0 ? std::uint64_t(3) << ((flags & 7) + 1) : 0;
    };
    std::uint64_t at = 13 + table(file.byte(10));
    const auto skip_data = [&] {
        while (at < file.text.size() && file.byte(at) != 0) at += 1 + file.byte(at);
        ++at;
    };
    while (at < file.text.size()) {
        const std::uint64_t kind = file.byte(at);
        if (kind == 0x21) {
            at += 2;
        } else if (kind == 0x2C) {
            ++found.pictures;
            at += 11 + table(file.byte(at + 9));
        } else {
            break;
        }
        skip_data();
    }
    return found;
}

// WebP Container Specification.
Found in_webp(const Bytes& file) {
    Found found = {.pictures = 0, .kind = "frames"};
    for (std::uint64_t at = 12; at + 8 <= file.text.size();) {
        const std::uint64_t size = file.number(at + 4, 4);
        const std::string_view type = file.part(at, 4);
        if (type == "ANMF") ++found.pictures;
        if (type == "ICCP") found.profile = !names_srgb(file.part(at + 8, size));
        at += 8 + size + size % 2;
    }
    return found;
}

// OpenEXR File Layout: of a file of several parts each has a header, which an empty name ends, and
// so does the list of headers.
Found in_exr(const Bytes& file) {
    Found found = {.associated_alpha = true, .kind = "parts"};
    constexpr std::uint64_t multipart = 0x1000;
    if ((file.number(4, 4) & multipart) == 0) return found;
    const auto past_name = [&](std::uint64_t at) {
        while (file.byte(at) != 0) ++at;
        return at + 1;
    };
    found.pictures = 0;
    for (std::uint64_t at = 8; at < file.text.size() && file.byte(at) != 0; ++at) {
        ++found.pictures;
        while (file.byte(at) != 0) {
            at = past_name(past_name(at));  // of an attribute and of its type
            at += 4 + file.number(at, 4);
        }
    }
    return found;
}

Found in_file(std::string_view text) {
    const Bytes big = {text, true}, little = {text, false};
    if (text.starts_with("\x89PNG"sv)) return in_png(big);
    if (text.starts_with("\xff\xd8\xff"sv)) return in_jpeg(big);
    if (text.starts_with("II*\0"sv) || text.starts_with("II+\0"sv)) return in_tiff(little);
    if (text.starts_with("MM\0*"sv) || text.starts_with("MM\0+"sv)) return in_tiff(big);
    if (text.starts_with("GIF8"sv)) return in_gif(little);
    if (text.starts_with("RIFF"sv) && big.part(8, 4) == "WEBP") return in_webp(little);
    if (text.starts_with("\x76\x2f\x31\x01"sv)) return in_exr(little);
    return {};
}

}  // namespace

Contents contents_of(std::span<const std::byte> file) {
    const Found found = in_file({reinterpret_cast<const char*>(file.data()), file.size()});
    Contents result = {.associated_alpha = found.associated_alpha};
    if (found.pictures > 1)
        result.unread.push_back("has " + std::to_string(found.pictures) + " " + found.kind +
                                ", and only the first is read");
    if (found.profile)
        result.unread.emplace_back(
            "has a colour profile (ICC) other than sRGB, and its samples are taken as sRGB");
    if (found.gamma)
        result.unread.emplace_back(
            "has a gamma (gAMA) other than that of sRGB, and its samples are taken as sRGB");
    return result;
}

}  // namespace penumbra
