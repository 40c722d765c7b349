// EXT_mesh_gpu_instancing -> transforms.
#include "base/memory.h"
#include "importers/gltf/document/accessor.h"
#include "importers/gltf/nodes/pose.h"
#include "importers/gltf/reader/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace penumbra::gltf {
namespace {

// What an attribute of EXT_mesh_gpu_instancing has: `width` numbers an instance.
struct InstanceAttribute {
    const Reader& reader;
    std::string place;
    int accessor = -1;
    std::size_t count = 0;

    std::vector<float> read(int width) const {
        std::vector<float> numbers(count * std::size_t(width));
        if (accessor >= 0)
            read_floats(reader.document, accessor, {.first = 0, .count = count}, width,
                        numbers.data());
        return numbers;
    }
};

InstanceAttribute instance_attribute(const Reader& reader, const tinygltf::Value& attributes,
                                     const std::string& pointer, const std::string& name,
                                     int type) {
    InstanceAttribute found = {.reader = reader,
                               .place = reader.document.place(pointer + '/' + name)};
    if (!attributes.Has(name)) return found;
    found.accessor = attributes.Get(name).GetNumberAsInt();
    const tinygltf::Accessor& accessor =
        reader.document.model.accessors[std::size_t(found.accessor)];
    if (accessor.type != type)
        throw Error(Failure::input, found.place,
                    fmt::format("accessor {} has the wrong type, a VEC{} is needed", found.accessor,
                                type == TINYGLTF_TYPE_VEC4 ? 4 : 3));
    found.count = accessor.count;
    return found;
}

}  // namespace

std::optional<std::vector<Matrix>> read_instances(const Reader& reader, int node) {
    const auto& extensions = reader.document.model.nodes[std::size_t(node)].extensions;
    const auto found = extensions.find("EXT_mesh_gpu_instancing");
    if (found == extensions.end()) return std::nullopt;
    const std::string pointer =
        fmt::format("/nodes/{}/extensions/EXT_mesh_gpu_instancing/attributes", node);
    const tinygltf::Value& attributes = found->second.Get("attributes");
    const auto attribute = [&](const char* name, int type) {
        return instance_attribute(reader, attributes, pointer, name, type);
    };
    const InstanceAttribute moved = attribute("TRANSLATION", TINYGLTF_TYPE_VEC3),
                            turned = attribute("ROTATION", TINYGLTF_TYPE_VEC4),
                            scaled = attribute("SCALE", TINYGLTF_TYPE_VEC3);
    const std::size_t count = std::max({moved.count, turned.count, scaled.count});
    for (const InstanceAttribute& each : {moved, turned, scaled})
        if (each.accessor >= 0 && each.count != count)
            throw Error(
                Failure::input, each.place,
                fmt::format("has {} instances, but another attribute has {}", each.count, count));

    constexpr std::size_t numbers = 10 * sizeof(float);
    const MemoryClaim claim(times(count, numbers + sizeof(Matrix)), reader.document.place(pointer));
    const auto moves = moved.read(3), turns = turned.read(4), scales = scaled.read(3);
    std::vector<Matrix> matrices;
    matrices.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        Trs stance;
        if (!moves.empty()) stance.translation = {moves[3 * i], moves[3 * i + 1], moves[3 * i + 2]};
        if (!scales.empty()) stance.scale = {scales[3 * i], scales[3 * i + 1], scales[3 * i + 2]};
        if (!turns.empty()) {
            const std::array<double, 4> q = {turns[4 * i], turns[4 * i + 1], turns[4 * i + 2],
                                             turns[4 * i + 3]};
            stance.rotation = unit_quaternion(q.data()).value_or(stance.rotation);
        }
        matrices.push_back(stance.matrix());
    }
    return matrices;
}

}  // namespace penumbra::gltf
