// Samplers of glTF animations -> values at one instant (glTF 2.0, section 3.11 and appendix C).
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace tinygltf {
struct AnimationSampler;
}

namespace penumbra::gltf {

struct Document;

/// The key times of accessors that were read already, in seconds: most channels have the same ones.
using TimesByAccessor = std::map<int, std::vector<float>>;

/// What a sampler's values are.
struct ValueKind {
    int type;                  ///< of the accessor that holds them
    std::size_t elements = 1;  ///< of the accessor for each value; 0: as many as there are
    bool rotation = false;     ///< quaternions, x y z w
    bool stepped = false;      ///< nothing lies between two of them
};

/// A sampler, and where it stands: "/animations/0/samplers/1".
struct SamplerAt {
    const Document& document;
    const tinygltf::AnimationSampler& sampler;
    std::string pointer;
};

/// The sampler's value at `time`, in seconds; before the first key and after the last one it stays.
/// Throws Error (input) where its accessors are not of that kind.
std::vector<double> value_at(const SamplerAt& source, double time, const ValueKind& kind,
                             TimesByAccessor& known);

}  // namespace penumbra::gltf
