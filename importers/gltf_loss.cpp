// What primitives have lost, once for all of them.
#include "gltf.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra::gltf {
namespace {

PrimitiveLoss& entry(Reader& reader, const std::string& what, const std::string& pointer) {
    auto& all = reader.primitive_losses;
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto& loss) { return loss.what == what; });
    PrimitiveLoss& loss = found == all.end() ? all.emplace_back() : *found;
    if (loss.primitives == 0) {
        loss.what = what;
        loss.pointer = pointer;
    }
    ++loss.primitives;
    return loss;
}

}  // namespace

void Reader::lose_in_primitive(const std::string& pointer, const std::string& what) {
    entry(*this, what, pointer);
}

void Reader::ignore_in_primitive(const std::string& pointer, const std::string& thing,
                                 std::size_t count) {
    PrimitiveLoss& loss = entry(*this, thing, pointer);
    loss.things = loss.things.value_or(0) + count;
}

void Reader::say_primitive_losses() {
    for (const PrimitiveLoss& loss : primitive_losses) {
        std::string text = loss.what;
        if (loss.things)
            text = fmt::format("{} {}{} ignored", *loss.things, loss.what,
                               *loss.things == 1 ? " is" : "s are");
        if (loss.primitives > 1) text += fmt::format(" (in {} primitives)", loss.primitives);
        lose(loss.pointer, text);
    }
    primitive_losses.clear();
}

}  // namespace penumbra::gltf
