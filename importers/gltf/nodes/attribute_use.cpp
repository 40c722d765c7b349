// The accessor of an attribute or of a morph target -> numbers of vertices.
#include "importers/gltf/nodes/attribute_use.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::gltf {
namespace {

bool quantized(const Part& part) {
    const auto& used = part.model().extensionsUsed;
    return std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end();
}

// An attribute's name without its number says what its numbers may be: glTF 2.0, sections 3.7.2.1
// and 3.7.2.2 (`delta`: of a morph target), and KHR_mesh_quantization.
bool allowed_component(const Part& part, const std::string& name, int type, bool delta) {
    const auto is = [&](const char* kind) { return name.starts_with(kind); };
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
    case TINYGLTF_COMPONENT_TYPE_DOUBLE: return !is("JOINTS");
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return is("TEXCOORD") || is("COLOR") || is("WEIGHTS") || is("JOINTS") ||
               (is("POSITION") && quantized(part));
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        if (delta && (is("TEXCOORD") || is("COLOR"))) return true;
        return !is("COLOR") && !is("WEIGHTS") && !is("JOINTS") && quantized(part);
    default: return false;
    }
}

const char* word_for(int type) {
    return type == TINYGLTF_TYPE_VEC2 ? "VEC2" : type == TINYGLTF_TYPE_VEC3 ? "VEC3" : "VEC4";
}

}  // namespace

void Use::check(Types types, bool delta) const {
    const tinygltf::Accessor& accessor = part.accessor(index);
    if (std::find(types.begin(), types.end(), accessor.type) == types.end())
        part.fail(below, fmt::format("accessor {} has the wrong type, a {} is needed", index,
                                     word_for(*types.begin())));
    if (!allowed_component(part, name, accessor.componentType, delta))
        part.fail(below,
                  fmt::format("accessor {} has the componentType {}, which is not allowed here",
                              index, accessor.componentType));
    if (accessor.normalized && name.starts_with("JOINTS"))
        part.fail(below, fmt::format("accessor {} must not be normalized", index));
    const std::size_t count = part.accessor(part.primitive.attributes.at("POSITION")).count;
    if (accessor.count != count)
        part.fail(below,
                  fmt::format("has {} elements, but POSITION has {}", accessor.count, count));
}

namespace {

// The largest of the whole numbers that stand for fractions; 0 for floats.
float largest_whole(int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return 127;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 255;
    case TINYGLTF_COMPONENT_TYPE_SHORT: return 32767;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 65535;
    default: return 0;
    }
}

// glTF 2.0, section 3.7.2.1: whole numbers of colours are normalized, and those of texture
// coordinates unless KHR_mesh_quantization allows others. Some writers forget to say so.
bool lacks_normalized(const Use& use) {
    const tinygltf::Accessor& accessor = use.part.accessor(use.index);
    if (accessor.normalized || largest_whole(accessor.componentType) == 0) return false;
    return use.name.starts_with("COLOR") ||
           (use.name.starts_with("TEXCOORD") && !quantized(use.part));
}

}  // namespace

void note_unnormalized(const Use& use) {
    if (lacks_normalized(use))
        use.part.reader.note_loss_in_primitive(
            Loss::approximated, use.part.pointer + use.below,
            "its whole numbers are not marked as normalized, as glTF asks; they are read as if "
            "they were");
}

void read_use(const Use& use, const Elements& range, int width, float* out) {
    const auto read = use.name == "POSITION" ? read_floats : read_any_floats;
    read(use.part.reader.document, use.index, range, width, out);
    if (!lacks_normalized(use)) return;
    const float largest = largest_whole(use.part.accessor(use.index).componentType);
    for (std::size_t i = 0; i < range.count * std::size_t(width); ++i)
        out[i] = std::max(out[i] / largest, -1.0F);
}

std::size_t replace_not_finite(float* numbers, std::size_t vertices, std::size_t width,
                               float instead) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < vertices; ++i) {
        bool replaced = false;
        for (std::size_t c = 0; c < width; ++c) {
            float& number = numbers[i * width + c];
            if (std::isfinite(number)) continue;
            number = instead;
            replaced = true;
        }
        count += replaced ? 1 : 0;
    }
    return count;
}

namespace {

// glTF 2.0, section 3.7.2.2: each target's deltas times its weight. In blocks, so that the deltas
// of a large mesh are not all in memory.
void add_deltas(const Use& use, double weight, const Elements& range, const Vertices& out) {
    constexpr std::size_t block = std::size_t(1) << 16;
    const auto width = std::size_t(out.width), stride = std::size_t(out.stride);
    std::vector<float> deltas(std::min(block, range.count) * width);
    for (std::size_t start = 0; start < range.count; start += block) {
        const std::size_t count = std::min(block, range.count - start);
        read_use(use, range.part(start, count), out.width, deltas.data());
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t c = 0; c < width; ++c) {
                float& number = out.first[(start + i) * stride + c];
                number = float(double(number) + weight * double(deltas[i * width + c]));
            }
    }
}

}  // namespace

void morph(const Part& part, const std::string& name, const Elements& range, const Vertices& out) {
    const auto& targets = part.primitive.targets;
    const auto& weights = part.key.weights;
    for (std::size_t t = 0; t < std::min(targets.size(), weights.size()); ++t) {
        const auto found = targets[t].find(name);
        if (found == targets[t].end() || weights[t] == 0) continue;
        const Use use = {part, name, fmt::format("/targets/{}/{}", t, name), found->second};
        if (name.starts_with("COLOR"))
            use.check({TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, true);
        else
            use.check({out.width == 2 ? TINYGLTF_TYPE_VEC2 : TINYGLTF_TYPE_VEC3}, true);
        Vertices morphed = out;
        morphed.width = std::min(out.width, components(part.accessor(use.index)));
        add_deltas(use, weights[t], range, morphed);
    }
}

}  // namespace penumbra::gltf
