#include "importers/obj/left_out.h"

#include "importers/obj/text/encoding.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace penumbra::obj {

namespace {

// What tells statements that are left out apart; words as in "Wavefront Advanced Visualizer 4.0,
// appendix B1: Object Files".
struct LeftOut {
    std::string_view keyword = {};
    std::string_view what = {};
};

constexpr std::string_view free_form = "free-form curves and surfaces are ignored";
constexpr std::string_view display = "display attributes (bevel, lod, ...) are ignored";
constexpr auto statements = std::to_array<LeftOut>({
    {"p", "points (p) are ignored"},
    {"l", "lines (l) are ignored"},
    {"curv", free_form},
    {"curv2", free_form},
    {"surf", free_form},
    {"bzp", free_form},
    {"bsp", free_form},
    {"cdc", free_form},
    {"cdp", free_form},
    {"res", free_form},
    {"bevel", display},
    {"c_interp", display},
    {"d_interp", display},
    {"lod", display},
    {"ctech", display},
    {"stech", display},
    {"shadow_obj", "shadow objects (shadow_obj) are ignored"},
    {"trace_obj", "ray tracing objects (trace_obj) are ignored"},
    {"maplib", "texture map libraries (maplib) are ignored"},
    {"usemap", "texture maps outside of materials (usemap) are ignored"},
    {"call", "'call' is not followed"},
    {"csh", "'csh' is not run"},
});

// Say nothing without the element that they describe, which is counted.
constexpr auto of_free_form =
    std::to_array<std::string_view>({"vp", "deg", "bmat", "step", "cstype", "parm", "trim", "hole",
                                     "scrv", "sp", "end", "con", "mg"});

}  // namespace

std::string left_out(std::string_view keyword) {
    for (const LeftOut& entry : statements)
        if (keyword == entry.keyword) return std::string(entry.what);
    if (std::ranges::find(of_free_form, keyword) != of_free_form.end()) return "";
    return fmt::format("unknown keyword '{}' is ignored", printable(keyword));
}

}  // namespace penumbra::obj
