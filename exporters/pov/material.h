// Material -> POV-Ray textures.
#pragma once

#include "exporters/pov/pigment.h"

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
};

/// One of a stack of textures. Upper layers let a part of the lower ones through.
struct Layer {
    std::string pigment = {};  ///< what stands in pigment { }; of a tinted layer made for each tint
    Finish finish = {};
    bool tinted = false;    ///< the pigment is a vertex colour ...
    bool filter = false;    ///< ... that multiplies the layers below it
    const char* note = "";  ///< a comment
    Passing passing = {};   ///< of the tinted pigment
};

/// The layers of a look that shows specular lobes lobe `lobe`, lowest first.
std::vector<Layer> layers_of(const Plan& plan, const Look& look, std::size_t lobe = 0);

/// The declaration of the texture of a surface that is not there.
std::string nothing_text(const Plan& plan);

/// The declaration of a look, the textures it needs included; of a tinted one what its tints share.
std::string look_text(const Plan& plan, const Look& look);

/// Declarations that end in that of `name`, the look's texture at vertices of that tint.
std::string tint_declaration(const Plan& plan, const Look& look, const std::string& name,
                             const Tint& tint);

/// Can the look's texture stand in a list without a name?
bool is_single(const Plan& plan, const Look& look);

/// The pigment and finish of a single look of vertex colour `tint`, as it stands in texture { }.
std::string single_texture(const Plan& plan, const Look& look, const Color& tint);

}  // namespace penumbra::pov
