// Renders a scene with both renderers and compares, as `penumbra validate` does.
#pragma once

#include "penumbra/compare.h"
#include "penumbra/exporters.h"
#include "penumbra/importers.h"
#include "penumbra/povray.h"
#include "penumbra/tracer.h"

#include <cstdlib>

namespace test {

using namespace penumbra;

struct Parity {
    double parity = 0, exactness = 0, max_error = 0, ssim = 0, flip = 0, flip_tile = 0;
    PixelPair worst = {};
    Verdict verdict = Verdict::error;
    Losses losses = {};
    Image ours = {}, theirs = {};
};

/// Is there a POV-Ray to compare with?
inline bool have_povray() {
    try {
        return !povray_version().empty();
    } catch (const Error&) {
        return false;
    }
}

/// `folder` takes the exported files.
inline Parity parity_of(const NormalisedScene& scene, const RenderOptions& options,
                        const std::filesystem::path& folder) {
    Image ours = render(scene, options);
    const Exported exported = write_pov(scene, options, folder / "scene.pov");
    PovrayRun theirs = run_povray(folder / "scene.ini", options.width, options.height,
                                  {.threads = options.threads});
    const Comparison c = compare(ours, theirs.image, {.background = scene.scene.background});
    return {.parity = c.value("parity"),
            .exactness = c.value("exactness"),
            .max_error = c.value("max_error"),
            .ssim = c.value("ssim"),
            .flip = c.value("flip"),
            .flip_tile = c.value("flip_tile"),
            .worst = c.worst,
            .verdict = c.verdict,
            .losses = exported.losses,
            .ours = std::move(ours),
            .theirs = std::move(theirs.image)};
}

/// Meters the light where nobody says how to expose it, as the program does.
inline void meter(Imported& imported) {
    if (!imported.auto_exposure) return;
    imported.render.exposure = 0;
    imported.render.exposure =
        metered_exposure(normalise(imported.scene, imported.render), imported.render);
}

/// The same for files, at the size width x height.
inline Parity parity_of(const std::filesystem::path& input, int width, int height,
                        const std::filesystem::path& folder) {
    Imported imported = load_scene({input}, {.settings = {"render.size=[" + std::to_string(width) +
                                                          "," + std::to_string(height) + "]"}});
    meter(imported);
    const NormalisedScene scene = normalise(std::move(imported.scene), imported.render);
    Parity result = parity_of(scene, imported.render, folder);
    result.losses.insert(result.losses.begin(), imported.losses.begin(), imported.losses.end());
    return result;
}

}  // namespace test
