// Material -> POV-Ray textures.
#pragma once

#include "pov_plan.h"

#include <string>
#include <vector>

namespace penumbra::pov {

/// POV-Ray's finish. What it leaves out has no effect: specular 0, brilliance 1.
struct Finish {
    Color ambient = Color(0), emission = Color(0);
    float diffuse = 0, phong = 0, phong_size = 40, metallic = 0;
    Color reflection = Color(0);
    float reflection_metallic = 0;
};

/// One of a stack of textures. Upper layers let a part of the lower ones through.
struct Layer {
    std::string pigment = {};  ///< what stands in pigment { }; of a tinted layer made for each tint
    Finish finish = {};
    bool tinted = false;  ///< the pigment is a vertex colour ...
    bool filter = false;  ///< ... that multiplies the layers below it
    float transmit = 0;   ///< of the tinted pigment
};

/// The layers of a look, lowest first.
std::vector<Layer> layers_of(const Plan& plan, const Look& look);

/// "{ rgb ... }" of a tinted layer.
std::string tinted_pigment(const Layer& layer, const Color& tint);

/// The identifiers of a tinted look: the finish of its tinted layer, the layer below and above it.
inline std::string finish_name(const Look& look) { return "Finish_" + look.name; }
inline std::string below_name(const Look& look) { return "Below_" + look.name; }
inline std::string above_name(const Look& look) { return "Above_" + look.name; }

}  // namespace penumbra::pov
