// Material -> the layers of a POV-Ray texture, as values.
#pragma once

#include "exporters/pov/pigment.h"

#include "penumbra/light_model.h"

#include <optional>
#include <string>
#include <vector>

namespace penumbra::pov {

/// POV-Ray's finish. What it leaves out has no effect: specular 0, brilliance 1.
struct Finish {
    Color ambient = Color(0), emission = Color(0);
    float diffuse = 0, diffuse_behind = 0, phong = 0, phong_size = 40, metallic = 0;
    Color reflection = Color(0);
    float reflection_metallic = 0;
    bool fresnel = false;
    std::optional<float> grazing = {};  ///< reflection along the surface: Schlick's curve
    bool conserve_energy = false;       ///< what it reflects is taken from the layers below
};

/// One of a stack of textures. Upper layers let a part of the lower ones through.
struct Layer {
    std::string pigment = {};  ///< what stands in pigment { }; of a tinted layer made for each tint
    Finish finish = {};
    bool tinted = false;    ///< the pigment is a vertex colour ...
    bool filter = false;    ///< ... that multiplies the layers below it
    const char* note = "";  ///< a comment
    Passing passing = {};   ///< of the tinted pigment
    VirtualMirror mirror = {};
    bool by_angle = false;  ///< the pigment asks the angle to the normal
};

/// The layers of a look that shows specular lobes lobe `lobe`, lowest first.
std::vector<Layer> layers_of(const Plan& plan, const Look& look, std::size_t lobe = 0);

/// Those of each of the textures of which the mean is a frosted look where light goes in. POV-Ray
/// bends rays by the normal of the uppermost layer alone.
std::vector<std::vector<Layer>> frosted_layers(const Plan& plan, const Look& look);

}  // namespace penumbra::pov
