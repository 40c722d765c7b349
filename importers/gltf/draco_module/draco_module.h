// What importers/gltf/document/draco.cpp asks of the Draco module.
//
// The module is a shared library of its own because the shared libdraco brings a tinygltf of its
// own, whose symbols would clash with those of ours in one program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

enum class DracoNumber { i8, u8, i16, u16, u32, f32 };

/// An attribute that is wanted: `width` numbers of that type for each vertex.
struct DracoWish {
    std::uint32_t id = 0;  ///< the attribute's unique id
    DracoNumber number = DracoNumber::f32;
    int width = 3;
};

/// A decompressed mesh; `problem` says why there is none.
struct DracoMesh {
    std::vector<std::byte> indices = {};  ///< three std::uint32_t a facet
    std::size_t facets = 0, vertices = 0;
    std::vector<std::vector<std::byte>> attributes = {};  ///< as wished, in that order
    std::string problem = {};                             ///< empty: success
};

/// The module's functions. They never throw.
struct DracoModule {
    int abi;  ///< draco_module_abi of the build that made the module
    DracoMesh (*decode)(std::span<const std::byte> data, std::span<const DracoWish> wishes);
    /// How many facets the data say they have, 0 where decode() refuses so many; nothing is
    /// decompressed for it.
    std::uint64_t (*facets)(std::span<const std::byte> data);
};

/// Changes with every change of DracoModule or of the types it uses.
inline constexpr int draco_module_abi = 2;

/// The one symbol of the module, of type const DracoModule*().
inline constexpr const char* draco_module_entry = "penumbra_draco_module";

}  // namespace penumbra
