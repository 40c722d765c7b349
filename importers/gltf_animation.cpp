// glTF animations -> the stances of nodes at one instant (glTF 2.0, section 3.11 and appendix C).
#include "gltf.h"
#include "memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace penumbra::gltf {
namespace {

using Numbers = std::vector<double>;
using Times = std::vector<float>;

// The key times of accessors that were read already: most channels have the same ones.
using TimesByAccessor = std::map<int, Times>;

// What the keys of a sampler hold.
struct Track {
    const Document& document;
    const tinygltf::AnimationSampler& sampler;
    std::string pointer;       // "/animations/0/samplers/1"
    std::size_t elements = 1;  // of the output accessor, for each value
    int components = 1;        // of an element
    const Times* times = nullptr;

    [[noreturn]] void fail(const std::string& below, const std::string& problem) const {
        throw Error(Failure::input, document.place(pointer + below), problem);
    }
    const tinygltf::Accessor& accessor(int index) const {
        return document.model.accessors[std::size_t(index)];
    }
    bool cubic() const { return sampler.interpolation == "CUBICSPLINE"; }
    Numbers value(std::size_t key, std::size_t part) const;
};

// A cubic spline has three values a key: the tangent that comes in, the value, the tangent that
// goes out.
enum : std::size_t { tangent_in = 0, at_key = 1, tangent_out = 2 };

Numbers Track::value(std::size_t key, std::size_t part) const {
    const std::size_t index = cubic() ? 3 * key + part : key;
    std::vector<float> floats;
    resize_claimed(floats, elements * std::size_t(components), document.place(pointer));
    read_floats(document, sampler.output, {.first = index * elements, .count = elements},
                components, floats.data());
    return {floats.begin(), floats.end()};
}

// The track of a sampler whose values have `elements` elements of accessor type `type`; 0 elements:
// as many as the accessor has for each key.
Track read_track(const Document& document, const tinygltf::AnimationSampler& sampler,
                 const std::string& pointer, int type, std::size_t elements,
                 TimesByAccessor& known) {
    Track track = {.document = document, .sampler = sampler, .pointer = pointer};
    const tinygltf::Accessor& input = track.accessor(sampler.input);
    if (input.type != TINYGLTF_TYPE_SCALAR || input.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        track.fail("/input", fmt::format("accessor {} must hold single floats", sampler.input));
    const auto [times, fresh] = known.try_emplace(sampler.input);
    track.times = &times->second;
    if (fresh) {
        resize_claimed(times->second, input.count, document.place(pointer));
        read_floats(document, sampler.input, {.first = 0, .count = input.count}, 1,
                    times->second.data());
    }

    const tinygltf::Accessor& output = track.accessor(sampler.output);
    if (output.type != type)
        track.fail("/output",
                   fmt::format("accessor {} has the wrong type for what it moves", sampler.output));
    const std::size_t values = input.count * (track.cubic() ? 3 : 1);
    track.components = components(output);
    track.elements = elements != 0 ? elements : output.count / values;
    if (track.elements == 0 || output.count != values * track.elements)
        track.fail("/output", fmt::format("accessor {} has {} elements for {} values",
                                          sampler.output, output.count, values));
    return track;
}

Imath::Quatd quaternion(const Numbers& xyzw) {
    return unit_quaternion(xyzw.data()).value_or(Imath::Quatd());
}

Numbers numbers(const Imath::Quatd& q) { return {q.v.x, q.v.y, q.v.z, q.r}; }

// Hermite's spline; the tangents are for one second.
Numbers spline(const Track& track, std::size_t key, double t, double seconds) {
    const Numbers from = track.value(key, at_key), out = track.value(key, tangent_out),
                  to = track.value(key + 1, at_key), in = track.value(key + 1, tangent_in);
    const double t2 = t * t, t3 = t2 * t;
    Numbers result;
    for (std::size_t i = 0; i < from.size(); ++i)
        result.push_back((2 * t3 - 3 * t2 + 1) * from[i] + seconds * (t3 - 2 * t2 + t) * out[i] +
                         (3 * t2 - 2 * t3) * to[i] + seconds * (t3 - t2) * in[i]);
    return result;
}

Numbers line(const Track& track, std::size_t key, double t, bool rotation) {
    const Numbers from = track.value(key, at_key), to = track.value(key + 1, at_key);
    if (rotation) return numbers(Imath::slerpShortestArc(quaternion(from), quaternion(to), t));
    Numbers result;
    for (std::size_t i = 0; i < from.size(); ++i) result.push_back(from[i] + t * (to[i] - from[i]));
    return result;
}

// Before the first key and after the last one the value stays.
Numbers sample(const Track& track, double time, bool rotation) {
    const Times& times = *track.times;
    const auto after = std::upper_bound(times.begin(), times.end(), time,
                                        [](double t, float key) { return t < double(key); });
    if (after == times.begin()) return track.value(0, at_key);
    const auto key = std::size_t(after - times.begin()) - 1;
    if (after == times.end() || track.sampler.interpolation == "STEP")
        return track.value(key, at_key);
    const double seconds = double(*after) - double(times[key]);
    if (!(seconds > 0)) return track.value(key, at_key);  // the times do not increase
    const double t = std::clamp((time - double(times[key])) / seconds, 0.0, 1.0);
    return track.cubic() ? spline(track, key, t, seconds) : line(track, key, t, rotation);
}

// One channel of an animation.
struct Channel {
    Reader& reader;
    const tinygltf::Animation& animation;
    const tinygltf::AnimationChannel& channel;
    std::string pointer;  // "/animations/0"
    double time;
    TimesByAccessor& known;

    Numbers at_time(int type, std::size_t elements, bool rotation = false) const {
        const auto index = std::size_t(channel.sampler);
        return sample(read_track(reader.document, animation.samplers[index],
                                 fmt::format("{}/samplers/{}", pointer, index), type, elements,
                                 known),
                      time, rotation);
    }
    Vec3 vector() const {
        const Numbers n = at_time(TINYGLTF_TYPE_VEC3, 1);
        return {n[0], n[1], n[2]};
    }
    void apply(Stance& stance) const;
};

void Channel::apply(Stance& stance) const {
    if (channel.target_path == "translation")
        stance.translation = vector();
    else if (channel.target_path == "scale")
        stance.scale = vector();
    else if (channel.target_path == "rotation")
        stance.rotation = quaternion(at_time(TINYGLTF_TYPE_VEC4, 1, true));
    else if (channel.target_path == "weights")
        stance.weights = at_time(TINYGLTF_TYPE_SCALAR, 0);
    else
        reader.lose(pointer, fmt::format("its animation of a '{}' is ignored",
                                         printable(channel.target_path)));
}

// The animation that is asked for; none when no instant is.
std::optional<std::size_t> chosen_animation(Reader& reader) {
    const ModelOptions& options = reader.options;
    const auto& animations = reader.document.model.animations;
    if (!options.animation.empty()) {
        std::vector<std::string> names;
        for (const tinygltf::Animation& animation : animations) names.push_back(animation.name);
        return choose(reader.document, options.animation, names, "animation");
    }
    if (!options.time) return std::nullopt;
    if (!animations.empty()) return 0;
    reader.losses.push_back({reader.document.file, "it has no animation for the time asked for"});
    return std::nullopt;
}

}  // namespace

void animate(Reader& reader, std::vector<Stance>& stances) {
    const auto chosen = chosen_animation(reader);
    if (!chosen) return;
    const tinygltf::Model& model = reader.document.model;
    const tinygltf::Animation& animation = model.animations[*chosen];
    const std::string pointer = fmt::format("/animations/{}", *chosen);
    std::size_t pointers = 0;
    TimesByAccessor known;
    for (const tinygltf::AnimationChannel& source : animation.channels) {
        const Channel channel = {
            reader, animation, source, pointer, reader.options.time.value_or(0), known};
        const auto node = std::size_t(source.target_node);
        // glTF 2.0, section 3.11: a channel without a node is for an extension.
        if (source.target_path == "pointer")
            ++pointers;
        else if (source.target_node < 0)
            continue;
        else if (source.target_path != "weights" && model.nodes[node].matrix.size() == 16)
            reader.lose(pointer, fmt::format("node {} has a matrix and is not animated", node));
        else
            channel.apply(stances[node]);
    }
    if (pointers > 0)
        reader.lose(pointer, fmt::format("{} of its channels use KHR_animation_pointer and are "
                                         "ignored",
                                         pointers));
}

}  // namespace penumbra::gltf
