// glTF animations -> the poses of nodes at one instant (glTF 2.0, section 3.11).
#include "importers/gltf/nodes/pose.h"
#include "importers/gltf/nodes/sampling.h"
#include "importers/gltf/reader/reader.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra::gltf {
namespace {

// One channel of an animation.
struct Channel {
    Reader& reader;
    const tinygltf::Animation& animation;
    const tinygltf::AnimationChannel& channel;
    std::string pointer;  // "/animations/0"
    double time;
    TimesByAccessor& known;

    std::vector<double> at_time(const ValueKind& kind) const {
        const auto index = std::size_t(channel.sampler);
        return value_at({reader.document, animation.samplers[index],
                         fmt::format("{}/samplers/{}", pointer, index)},
                        time, kind, known);
    }
    Vec3 vector() const {
        const auto n = at_time({.type = TINYGLTF_TYPE_VEC3});
        return {n[0], n[1], n[2]};
    }
    void apply(Trs& trs) const;
};

void Channel::apply(Trs& trs) const {
    if (channel.target_path == "translation")
        trs.translation = vector();
    else if (channel.target_path == "scale")
        trs.scale = vector();
    else if (channel.target_path == "rotation")
        trs.rotation =
            unit_quaternion(at_time({.type = TINYGLTF_TYPE_VEC4, .rotation = true}).data())
                .value_or(Imath::Quatd());
    else if (channel.target_path == "weights")
        trs.weights = at_time({.type = TINYGLTF_TYPE_SCALAR, .elements = 0});
    else
        reader.note_loss(
            Loss::dropped, pointer,
            fmt::format("its animation of a '{}' is ignored", printable(channel.target_path)));
}

}  // namespace

std::optional<std::size_t> chosen_animation(const Document& document, const ModelOptions& options) {
    const auto& animations = document.model.animations;
    if (options.time && !std::isfinite(*options.time))
        throw Error(Failure::usage, document.file,
                    fmt::format("the time must be a finite number, not {}", *options.time));
    if (!options.animation.empty()) {
        std::vector<std::string> names;
        for (const tinygltf::Animation& animation : animations) names.push_back(animation.name);
        return choose(document, options.animation, names, "animation");
    }
    if (!options.time || animations.empty()) return std::nullopt;
    return 0;
}

void animate(Reader& reader, std::vector<Trs>& transforms) {
    const auto chosen = chosen_animation(reader.document, reader.options);
    if (!chosen && reader.options.time)
        reader.losses.add_alone({Loss::approximated, reader.document.file,
                                 "it has no animation for the time asked for"});
    if (!chosen) return;
    const tinygltf::Model& model = reader.document.model;
    const tinygltf::Animation& animation = model.animations[*chosen];
    const std::string pointer = fmt::format("/animations/{}", *chosen);
    TimesByAccessor known;
    for (const tinygltf::AnimationChannel& source : animation.channels) {
        const Channel channel = {
            reader, animation, source, pointer, reader.options.time.value_or(0), known};
        // glTF 2.0, section 3.11: a channel without a node is for an extension. Pointers have been
        // followed.
        if (source.target_path == "pointer" || source.target_node < 0) continue;
        const auto node = std::size_t(source.target_node);
        if (source.target_path != "weights" && model.nodes[node].matrix.size() == 16)
            reader.note_loss(Loss::dropped, pointer,
                             fmt::format("node {} has a matrix and is not animated", node));
        else
            channel.apply(transforms[node]);
    }
}

}  // namespace penumbra::gltf
