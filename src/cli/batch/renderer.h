// Other renderers, as commands that the user gives.
#pragma once

#include "cli/options/arguments.h"

#include "penumbra/watch.h"

namespace penumbra::cli {

/// What a renderer's command may ask for.
struct RendererInput {
    std::filesystem::path pov = {};                 ///< the exported scene
    std::vector<std::filesystem::path> scene = {};  ///< the inputs, sidecars included
    std::filesystem::path folder = {};              ///< where it runs and leaves its picture
    int width = 0, height = 0;
    std::chrono::seconds timeout{600};
    std::size_t memory = 0;  ///< bytes that it may take
};

struct OtherPicture {
    Image image = {};
    std::string file = {};  ///< name in the folder
    std::string log = {};   ///< what the command printed
    std::vector<std::string> command = {};
    double seconds = 0;
};

/// Runs the command without a shell, its words filled in, and reads the picture that it leaves:
/// {out} is NAME.png, {out:exr} NAME.exr and so on. A word that is {scene} alone becomes one word
/// for each input. Throws Error (povray: missing, failed, timed out or without a picture;
/// interrupted).
OtherPicture run_renderer(const OtherRenderer& renderer, const RendererInput& input,
                          const Watch& watch);

}  // namespace penumbra::cli
