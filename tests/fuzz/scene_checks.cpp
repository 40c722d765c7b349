// What holds for every scene that was let in.
#include "canary.h"
#include "fuzz.h"

#include "penumbra/exporters.h"
#include "penumbra/tracer.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>

namespace fuzz {
namespace {

namespace fs = std::filesystem;

using namespace penumbra;

// Larger scenes are left to the tests: here as many inputs as possible must pass in a second.
constexpr std::size_t most_facets = 300, most_things = 64, most_sources = 64, most_texels = 1 << 14;
constexpr RenderOptions quick = {.width = 16, .height = 12, .max_depth = 3, .threads = 1};

double source_count(const Light& light) {
    if (!(light.penumbra.delta > 0)) return 1;
    switch (light.penumbra.layout) {
    case Penumbra::Layout::axes: return 7;
    case Penumbra::Layout::sphere: return light.penumbra.count[0];
    case Penumbra::Layout::grid: return double(light.penumbra.count[0]) * light.penumbra.count[1];
    }
    return 1;
}

bool is_small(const Scene& scene) {
    std::size_t texels = 0;
    for (const Texture& texture : scene.textures) texels += texture.raster.texels();
    double sources = 0;
    for (const Light& light : scene.lights) sources += source_count(light);
    return facet_count(scene) <= most_facets && texels <= most_texels && sources <= most_sources &&
           scene.instances.size() + scene.spheres.size() + scene.planes.size() <= most_things &&
           scene.meshes.size() <= most_things && scene.materials.size() <= most_things;
}

void check_defects(const Scene& scene, const char* when) {
    if (const auto found = defects(scene); !found.empty())
        finding(std::string("the scene is defective ") + when + ": " + found[0]);
}

void check_confined(const Scene& scene) {
    for (const Texture& texture : scene.textures) {
        const auto& data = texture.raster.data;
        if (std::search(data.begin(), data.end(), canary_texels.begin(), canary_texels.end()) !=
            data.end())
            finding("the input reads a file outside of its folder");
    }
}

// Printable ASCII and ends of lines: no text of the input gets out of a comment or a string.
void check_plain(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    for (const char c : text)
        if (c != '\n' && (c < ' ' || c > '~'))
            finding(file.filename().string() + " has a character that is not printable ASCII");
}

void check_export(const NormalisedScene& scene, const RenderOptions& options,
                  const Losses& losses) {
    const Exported exported =
        write_pov(scene, options, sandbox().out / "scene.pov", {.losses = losses});
    std::size_t written = 0;
    for (const auto& entry : fs::recursive_directory_iterator(sandbox().out))
        if (entry.is_regular_file()) ++written;
    if (written != exported.files.size()) finding("an export has written other files than it says");
    for (const fs::path& file : exported.files) {
        for (const char c : file.filename().string())
            if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_' && c != '-')
                finding("a file is named " + file.filename().string());
        if (file.extension() != ".png" && file.extension() != ".exr") check_plain(file);
        fs::remove(file);
    }
}

void check_picture(const NormalisedScene& scene, const RenderOptions& options, bool metered) {
    const Image image = render(scene, options);
    if (image.width != options.width || image.height != options.height ||
        image.pixels.size() != std::size_t(options.width) * std::size_t(options.height))
        finding("the picture has another size than was asked for");
    if (!metered) return;
    const double exposure = metered_exposure(scene, options);
    if (!(std::abs(exposure) <= 32)) finding("the metered exposure is out of range");
}

}  // namespace

void check_scene(Imported imported) {
    Scene& scene = imported.scene;
    check_defects(scene, "after load_scene()");
    check_confined(scene);
    if (!is_small(scene)) return;

    RenderOptions options = quick;
    options.exposure = imported.render.exposure;
    bake_normal_maps(scene, {.facets = most_facets});
    check_defects(scene, "after bake_normal_maps()");
    if (!is_small(scene)) return;
    const NormalisedScene normalised = normalise(std::move(scene), options);
    check_defects(normalised.scene, "after normalise()");
    check_export(normalised, options, imported.losses);
    check_picture(normalised, options, imported.auto_exposure);
}

}  // namespace fuzz
