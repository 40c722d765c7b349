// Samplers of glTF animations -> values at one instant (glTF 2.0, section 3.11 and appendix C).
#include "importers/gltf/nodes/sampling.h"

#include "base/memory.h"
#include "importers/gltf/document/accessor.h"
#include "importers/gltf/document/document.h"
#include "importers/gltf/nodes/pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::gltf {
namespace {

using Numbers = std::vector<double>;
using Times = std::vector<float>;

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
    Numbers numbers;
    resize_claimed(numbers, elements * std::size_t(components), document.place(pointer));
    read_doubles(document, sampler.output, {.first = index * elements, .count = elements},
                 components, numbers.data());
    return numbers;
}

Track read_track(const SamplerAt& source, const ValueKind& kind, TimesByAccessor& known) {
    const auto& [document, sampler, pointer] = source;
    Track track = {.document = document, .sampler = sampler, .pointer = pointer};
    const tinygltf::Accessor& input = track.accessor(sampler.input);
    if (input.type != TINYGLTF_TYPE_SCALAR ||
        (input.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT &&
         input.componentType != TINYGLTF_COMPONENT_TYPE_DOUBLE))
        track.fail("/input", fmt::format("accessor {} must hold single floats", sampler.input));
    const auto [times, fresh] = known.try_emplace(sampler.input);
    track.times = &times->second;
    if (fresh) {
        resize_claimed(times->second, input.count, document.place(pointer));
        read_floats(document, sampler.input, {.first = 0, .count = input.count}, 1,
                    times->second.data());
    }

    const tinygltf::Accessor& output = track.accessor(sampler.output);
    if (output.type != kind.type)
        track.fail("/output",
                   fmt::format("accessor {} has the wrong type for what it moves", sampler.output));
    const std::size_t values = input.count * (track.cubic() ? 3 : 1);
    track.components = components(output);
    track.elements = kind.elements != 0 ? kind.elements : output.count / values;
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

}  // namespace

Numbers value_at(const SamplerAt& source, double time, const ValueKind& kind,
                 TimesByAccessor& known) {
    const Track track = read_track(source, kind, known);
    const Times& times = *track.times;
    const auto after = std::upper_bound(times.begin(), times.end(), time,
                                        [](double t, float key) { return t < double(key); });
    if (after == times.begin()) return track.value(0, at_key);
    const auto key = std::size_t(after - times.begin()) - 1;
    if (after == times.end() || kind.stepped || track.sampler.interpolation == "STEP")
        return track.value(key, at_key);
    const double seconds = double(*after) - double(times[key]);
    if (!(seconds > 0)) return track.value(key, at_key);  // the times do not increase
    const double t = std::clamp((time - double(times[key])) / seconds, 0.0, 1.0);
    return track.cubic() ? spline(track, key, t, seconds) : line(track, key, t, kind.rotation);
}

}  // namespace penumbra::gltf
