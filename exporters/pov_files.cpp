#include "pov_files.h"

#include "penumbra/image.h"

#include <fmt/format.h>

#include <algorithm>
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

}  // namespace

std::string ini_text(const RenderOptions& render, const std::string& stem) {
    std::string out = fmt::format("; Run in this folder: povray {0}.ini\n"
                                  "Input_File_Name=\"{0}.pov\"\n"
                                  "Output_File_Name=\"{0}.exr\"\n"
                                  "Output_File_Type=E\n"
                                  "Width={1}\n"
                                  "Height={2}\n",
                                  stem, render.width, render.height);
    if (render.samples > 1)
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

void write_textures(const Plan& plan, const fs::path& folder, std::vector<fs::path>& files) {
    for (std::size_t i = 0; i < plan.textures.size(); ++i) {
        const TextureFile& texture = plan.textures[i];
        if (texture.file.empty()) continue;
        const fs::path file = folder / texture.file;
        if (std::find(files.begin(), files.end(), file) != files.end()) continue;
        make_folder(file.parent_path());
        save_raster(file, baked(plan.scene->textures[i], texture));
        files.push_back(file);
    }
}

}  // namespace penumbra::pov
