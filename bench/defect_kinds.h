// Deliberate defects: pictures as a renderer with a fault would make them.
#pragma once

#include "penumbra/tracer.h"

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace defects {

using namespace penumbra;

/// A scene of the study with its picture.
struct Stage {
    std::string name = {};
    NormalisedScene scene = {};
    RenderOptions options = {};
    Image picture = {};
    std::vector<std::size_t> pixels = {};  ///< that show each object
    std::size_t behind = 0;                ///< pixels that show the background
};

struct Defect {
    std::string name = {};
    std::set<std::string> causes = {};  ///< that name it right
    /// Can the scene show it at all? Decided from the scene, not from the figures.
    std::function<bool(const Stage&)> applies = {};
    std::function<Image(const Stage&)> make = {};
};

Stage make_stage(const std::string& name, NormalisedScene scene, const RenderOptions& options);

/// Those of the picture as a whole.
std::vector<Defect> of_pictures();

/// In the order of the table.
std::vector<Defect> all_defects();

}  // namespace defects
