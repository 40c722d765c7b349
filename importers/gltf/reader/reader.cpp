// What materials and primitives have lost, once for all of them.
#include "importers/gltf/reader/reader.h"

#include <fmt/format.h>

namespace penumbra::gltf {

std::string in_primitives(std::size_t count) { return fmt::format(" (in {} primitives)", count); }

void Reader::note_loss_in_material(Loss::Kind kind, const std::string& pointer,
                                   const std::string& what) {
    losses.add({kind, document.place(pointer), what});
}

void Reader::note_loss_in_primitive(Loss::Kind kind, const std::string& pointer,
                                    const std::string& what) {
    primitive_losses.add({kind, document.place(pointer), what});
}

void Reader::ignore_in_primitive(const std::string& pointer, const std::string& thing,
                                 std::size_t count) {
    primitive_losses.add_ignored(document.place(pointer), thing, count);
}

}  // namespace penumbra::gltf
