#include "scene/surface/vertex_textures.h"

#include <algorithm>

namespace penumbra {

VertexTextures vertex_textures(const Mesh& mesh, const Material& material) {
    const bool colored = std::holds_alternative<std::monostate>(material.pattern) ||
                         std::holds_alternative<ImageMap>(material.pattern);
    const auto tints = [](const Color& c) { return c != Color(1); };
    return {.tinted = colored && std::ranges::any_of(mesh.colors, tints),
            .faded = !mesh.alphas.empty() && material.alpha_map && !material.alpha_map->cutoff};
}

}  // namespace penumbra
