#include "exporters/pov/files.h"

#include "base/text/text.h"
#include "exporters/shared/targets.h"
#include "scene/texture/texture_lookup.h"

#include "penumbra/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <system_error>

namespace penumbra::pov {

namespace fs = std::filesystem;

namespace {

void make_folder(const fs::path& folder) {
    std::error_code error;
    if (fs::create_directory(folder, error) || fs::is_directory(folder)) return;
    throw Error(Failure::output, folder.string(),
                "cannot make the folder: " +
                    (fs::exists(folder) ? "a file of that name is in the way" : error.message()));
}

constexpr float largest_half = 65504;

// OpenEXR's halves end at 65504; infinity would spread to every texel that is mixed with it.
void limit_floats(Raster& raster) {
    for (std::size_t i = 0; i + sizeof(float) <= raster.data.size(); i += sizeof(float)) {
        float value = 0;
        std::memcpy(&value, raster.data.data() + i, sizeof value);
        value = std::isnan(value) ? 0 : std::clamp(value, -largest_half, largest_half);
        std::memcpy(raster.data.data() + i, &value, sizeof value);
    }
}

}  // namespace

void check_name(const fs::path& file, PovStyle style) {
    const bool include = style == PovStyle::include;
    const std::string extension = lower_extension(file);
    if (extension == ".pov" || (include && extension == ".inc")) return;
    throw Error(Failure::output, file.string(),
                include ? "an include file of POV-Ray must end in .inc or .pov"
                        : "a POV-Ray scene must end in .pov");
}

std::string ini_text(const RenderOptions& render, const std::string& stem,
                     const std::string& extension) {
    std::string out = fmt::format("; Run in this folder: povray {0}.ini\n"
                                  "Input_File_Name=\"{0}{3}\"\n"
                                  "Output_File_Name=\"{0}.exr\"\n"
                                  "Output_File_Type=E\n"
                                  "Width={1}\n"
                                  "Height={2}\n",
                                  stem, render.width, render.height, extension);
    if (render.antialiasing)
        out += fmt::format("; {}\n"
                           "Antialias=On\n"
                           "Sampling_Method=2\n"
                           "Antialias_Threshold={}\n"
                           "Antialias_Depth={}\n"
                           "Antialias_Gamma=2.5\n"
                           "Jitter=Off\n",
                           to_string(sampling_of(render)), render.antialiasing->threshold,
                           render.antialiasing->depth);
    else if (render.samples > 1)
        out += fmt::format("; every pixel on a fixed grid of {0} x {0} rays\n"
                           "Antialias=On\n"
                           "Sampling_Method=1\n"
                           "Antialias_Threshold=0.0\n"
                           "Antialias_Depth={0}\n"
                           "Jitter=Off\n",
                           render.samples);
    else
        out += "Antialias=Off\n";
    return out + "Display=Off\nPause_When_Done=Off\n";
}

Raster baked(const Texture& texture, const TextureFile& file) {
    const Raster& in = texture.raster;
    const auto sample = std::size_t(in.depth), channels = std::size_t(in.channels);
    Raster out{.width = file.u.count, .height = file.v.count, .channels = 3, .depth = in.depth};
    out.data.resize(out.texels() * 3 * sample);
    std::byte* to = out.data.data();
    for (int row = 0; row < out.height; ++row) {
        // Rows of files count from the top, texture coordinates from the bottom.
        const int from_bottom = file.v.first + out.height - 1 - row;
        const int source_row = in.height - 1 - wrapped(from_bottom, in.height, texture.wrap_v);
        const std::size_t line = std::size_t(source_row) * std::size_t(in.width);
        for (int column = 0; column < out.width; ++column) {
            const int source = wrapped(file.u.first + column, in.width, texture.wrap_u);
            const std::byte* from =
                in.data.data() + (line + std::size_t(source)) * channels * sample;
            // POV-Ray decodes 8-bit grey files to 8 linear bits, so grey is written as RGB.
            for (std::size_t c = 0; c < 3; ++c, to += sample)
                std::memcpy(to, from + (channels >= 3 ? c * sample : 0), sample);
        }
    }
    if (out.depth == Depth::f32) limit_floats(out);
    return out;
}

std::vector<fs::path> texture_files(const Plan& plan, const fs::path& folder) {
    std::vector<fs::path> files;
    for (const TextureFile& texture : plan.textures) {
        if (texture.file.empty()) continue;
        const fs::path file = folder / texture.file;
        if (std::ranges::find(files, file) == files.end()) files.push_back(file);
    }
    return files;
}

std::vector<fs::path> target_files(const Plan& plan, const fs::path& file, PovStyle style) {
    const fs::path folder = file.parent_path();
    const std::string stem = file.stem().string();
    std::vector<fs::path> all = {file};
    if (plan.stem != stem) all.push_back(folder / (plan.stem + file.extension().string()));
    if (style == PovStyle::standalone) {
        all.push_back(folder / (stem + ".ini"));
        all.push_back(folder / (plan.stem + ".ini"));
        all.push_back(folder / (plan.stem + "_geometry.inc"));
    }
    const std::vector<fs::path> textures = texture_files(plan, folder);
    all.insert(all.end(), textures.begin(), textures.end());
    return all;
}

std::vector<fs::path> remove_old_textures(const Plan& plan, const fs::path& file,
                                          const ExportOptions& options) {
    for (const char* extension : {".pov", ".inc"}) {
        const fs::path other = fs::path(file).replace_extension(extension);
        if (other != file && is_own_file(other)) return {};
    }
    const fs::path textures = file.parent_path() / (plan.stem + "_textures");
    const auto chosen = [](const fs::path& old) {
        return old.extension() == ".png" || old.extension() == ".exr";
    };
    std::vector<fs::path> removed =
        remove_old_files(textures, chosen, texture_files(plan, file.parent_path()), options);
    std::error_code ignored;
    if (!removed.empty()) fs::remove(textures, ignored);  // which fails unless it is empty
    return removed;
}

void write_textures(const Plan& plan, const fs::path& folder, std::vector<fs::path>& files) {
    const std::string comment = fmt::format("texture of {}, {}", plan.stem, own_mark);
    for (std::size_t i = 0; i < plan.textures.size(); ++i) {
        const TextureFile& texture = plan.textures[i];
        if (texture.file.empty()) continue;
        const fs::path file = folder / texture.file;
        if (std::find(files.begin(), files.end(), file) != files.end()) continue;
        make_folder(file.parent_path());
        save_raster(file, baked(plan.scene->textures[i], texture), comment);
        files.push_back(file);
    }
}

}  // namespace penumbra::pov
