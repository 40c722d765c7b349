#include "exporters/tachyon/images.h"

#include "base/text/ascii.h"
#include "exporters/shared/targets.h"
#include "image/texels.h"

#include <algorithm>
#include <string_view>

namespace penumbra::tachyon {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_name = 80;  // src/imap.c, AllocateImageFile
constexpr std::size_t most_images = 39;   // src/tachyon.h, MAXIMGS
constexpr std::string_view mark = "P6\n# penumbra\n";

// `stem` as one word of ASCII, which is all that Tachyon reads; different ones stay different.
std::string safe_stem(const std::string& stem) {
    std::string safe;
    for (const char c : stem) {
        const bool plain = is_letter_or_digit(c) || c == '-' || c == '_' || c == '.';
        safe += plain ? std::string(1, c) : fmt::format("={:02x}", static_cast<unsigned char>(c));
    }
    return safe;
}

// Whether `name` is one that an export of this stem gives its images: "chair-12.ppm".
bool is_image_name(std::string_view name, const std::string& stem) {
    if (!name.starts_with(stem + "-") || !name.ends_with(".ppm")) return false;
    const std::string_view number = name.substr(stem.size() + 1, name.size() - stem.size() - 5);
    return !number.empty() && std::ranges::all_of(number, is_digit);
}

TexelSource texels_of(const Texture& texture) {
    return {.raster = &texture.raster, .srgb = texture.srgb};
}

// In linear light, as Tachyon computes without gamma.
std::string ppm(const Texture& texture) {
    const TexelReader texels(texels_of(texture));
    const Raster& raster = texture.raster;
    std::string out = fmt::format("{}{} {}\n255\n", mark, raster.width, raster.height);
    out.reserve(out.size() + 3 * raster.texels());
    for (int y = 0; y < raster.height; ++y) {
        for (int x = 0; x < raster.width; ++x) {
            const Color c = texels.color(x, y);
            for (int k = 0; k < 3; ++k)
                out += char(int(std::clamp(c[k], 0.0F, 1.0F) * 255.0F + 0.5F));
        }
    }
    return out;
}

}  // namespace

Color mean(const Texture& texture) { return mean_of(texels_of(texture)); }

fs::path image_file(const fs::path& scene, Index texture) {
    return scene.parent_path() /
           fmt::format("{}-{}.ppm", safe_stem(scene.stem().string()), texture);
}

std::optional<std::string> image_name(Output& out, Index texture) {
    const fs::path image = image_file(out.file, texture);
    std::string name = image.filename().string();
    if (std::find(out.images.begin(), out.images.end(), image) != out.images.end()) return name;
    if (out.images.size() == most_images) return std::nullopt;
    if (name.size() > longest_name)
        throw Error(Failure::output, image.string(),
                    fmt::format("Tachyon reads names of images of at most {} bytes; give the scene "
                                "a shorter name",
                                longest_name));
    write_file(image, std::string_view(ppm(out.scene.textures[texture])));
    out.images.push_back(image);
    return name;
}

std::vector<fs::path> remove_old_images(const Output& out) {
    const std::string stem = safe_stem(out.file.stem().string());
    const fs::path folder = out.file.has_parent_path() ? out.file.parent_path() : ".";
    const auto chosen = [&](const fs::path& file) {
        return is_image_name(file.filename().string(), stem);
    };
    return remove_old_files(folder, chosen, out.images, out.options);
}

}  // namespace penumbra::tachyon
