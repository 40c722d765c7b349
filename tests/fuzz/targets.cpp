#include "fuzz.h"

#include <algorithm>
#include <array>

namespace fuzz {
namespace {

constexpr auto all = std::to_array<Target>({{"gltf", gltf},
                                            {"glb", glb},
                                            {"obj", obj},
                                            {"mtl", mtl},
                                            {"sidecar", sidecar},
                                            {"compare", compare}});

}  // namespace

std::span<const Target> targets() { return all; }

const Target* target_named(std::string_view name) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Target& one) { return name == one.name; });
    return found == all.end() ? nullptr : &*found;
}

}  // namespace fuzz
