#include "render/picture_identity.h"

#include "scene/fingerprint.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra {

namespace {

// The value of `name` in an identity; "" if it has none.
std::string_view value_in(std::string_view identity, std::string_view name) {
    while (!identity.empty()) {
        const std::string_view entry = identity.substr(0, identity.find(';'));
        identity.remove_prefix(std::min(entry.size() + 1, identity.size()));
        if (entry.starts_with(name) && entry.substr(name.size()).starts_with('='))
            return entry.substr(name.size() + 1);
    }
    return {};
}

void append(std::string& list, const std::string& item) {
    list += (list.empty() ? "" : "; ") + item;
}

}  // namespace

std::vector<PictureTrait> picture_traits(const NormalisedScene& scene,
                                         const RenderOptions& options) {
    // By name, so that a new member is an error here until it is counted.
    const auto& [width, height, samples, antialiasing, max_depth, exposure, threads] = options;
    static_cast<void>(threads);
    std::vector<PictureTrait> traits = {
        {"size", fmt::format("{}x{}", width, height), true},
        {"samples", antialiasing ? "adaptive" : std::to_string(samples), true},
        {"max_depth", std::to_string(max_depth), true},
        {"exposure", fmt::format("{}", exposure), true},
    };
    if (antialiasing) {
        traits.push_back({"antialias", fmt::format("{}", antialiasing->threshold), true});
        traits.push_back({"antialias_depth", std::to_string(antialiasing->depth), true});
    }
    for (const auto& [name, value] : fingerprints(scene))
        traits.push_back({name, fmt::format("{:016x}", value)});
    return traits;
}

std::string identity_of(const std::vector<PictureTrait>& traits) {
    std::string text;
    for (const auto& [name, value, readable] : traits)
        text += fmt::format("{}{}={}", text.empty() ? "" : ";", name, value);
    return text;
}

std::string difference_from(std::string_view identity, const std::vector<PictureTrait>& traits) {
    std::string settings, others;
    for (const auto& [name, value, readable] : traits) {
        const std::string_view theirs = value_in(identity, name);
        if (theirs == value) continue;
        if (readable && !theirs.empty())
            append(settings, fmt::format("{} {}, now {}", name, theirs, value));
        else
            append(others, name + " changed");
    }
    // With another size, say, the camera of a scene that has none is another as well.
    return settings.empty() ? others : settings;
}

}  // namespace penumbra
