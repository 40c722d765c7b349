// Statements of a material -> numbers.
#pragma once

#include "importers/obj/mtl/tally.h"
#include "importers/obj/mtl/text.h"

#include "penumbra/math.h"

#include <optional>
#include <string_view>
#include <vector>

namespace penumbra::obj {

/// The numbers of a material; what the file does not give is absent.
struct MtlValues {
    std::optional<Color> ambient = {}, diffuse = {}, specular = {}, emission = {}, filter = {};
    std::optional<float> shininess = {}, ior = {}, dissolve = {};
    std::optional<float> roughness = {}, metallic = {}, coat = {}, coat_roughness = {};
    std::optional<int> illum = {};
    std::vector<Statement> maps = {};  ///< statements that name a texture
};

/// Whether the operands of the statement `key`, in lower case, are a texture.
bool names_a_texture(std::string_view key);

MtlValues read_values(const MtlEntry& entry, LossTally& tally);

}  // namespace penumbra::obj
