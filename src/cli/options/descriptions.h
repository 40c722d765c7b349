// The commands as the help names them.
#pragma once

#include "cli/options/arguments.h"

namespace penumbra::cli {

struct Description {
    Command command;
    const char* name;
    const char* what;
    const char* example;
};

inline constexpr Description descriptions[] = {
    {Command::render, "render", "Render a scene with the native ray tracer",
     "  penumbra render chair.glb -o chair.png --size 1280x720"},
    {Command::export_scene, "export",
     "Write the equivalent POV-Ray 3.7 scene, or a similar one of Tachyon",
     "  penumbra export chair.glb -o chair.pov && povray chair.ini\n"
     "  penumbra export chair.glb -o chair.dat && tachyon chair.dat -shade_phong"},
    {Command::validate, "validate",
     "Render with both renderers, compare the pictures and write a report",
     "  penumbra validate chair.glb --sidecar studio.toml --report chair-report\n"
     "  penumbra validate --each --jobs 2 scenes/*.toml --report all\n"
     "  penumbra validate --manifest cases.toml --summary markdown"},
    {Command::compare, "compare", "Measure how alike two pictures are",
     "  penumbra compare ours.exr theirs.png --report difference --profile similar\n"
     "  penumbra compare out/ golden/ --report difference --jobs 2"},
    {Command::calibrate, "calibrate", "Propose limits from pairs that are known to be good",
     "  penumbra calibrate monday/ tuesday/ --margin 2"},
    {Command::info, "info", "Say what a scene holds and what of it can be reproduced",
     "  penumbra info chair.glb --json"},
};

}  // namespace penumbra::cli
