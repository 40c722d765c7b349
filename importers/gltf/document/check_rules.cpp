// Checked JSON -> which rules it breaks that nothing here depends on.
#include "base/loss_tally.h"
#include "importers/gltf/document/checks.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

namespace penumbra::gltf {
namespace {

using nlohmann::json;

const json* member(const json& object, std::string_view path) {
    const json::json_pointer pointer{std::string(path)};
    return object.contains(pointer) ? &object[pointer] : nullptr;
}

// KHR_materials_ior, section "Extending Materials".
void check_iors(const json& root, const std::string& file, LossTally& found) {
    constexpr std::string_view path = "/extensions/KHR_materials_ior/ior";
    for (std::size_t i = 0; root.contains("materials") && i < root["materials"].size(); ++i) {
        const json* const ior = member(root["materials"][i], path);
        if (ior == nullptr) continue;
        const double value = ior->get<double>();
        if (value > 0 && value < 1)
            found.add({Loss::approximated, fmt::format("{}#/materials/{}{}", file, i, path),
                       fmt::format("is {}, but KHR_materials_ior allows 0 and what is at least 1; "
                                   "it is used as it is",
                                   ior->dump())});
    }
}

bool declares(const json& root, std::string_view extension) {
    if (!root.contains("extensionsUsed")) return false;
    for (const json& name : root["extensionsUsed"])
        if (name.get_ref<const std::string&>() == extension) return true;
    return false;
}

struct NewComponent {
    int type;
    std::string_view extension;
};

constexpr std::array new_components = {NewComponent{5130, "KHR_accessor_float64"},
                                       NewComponent{5131, "KHR_accessor_float16"}};

// glTF 2.1 has these types, 2.0 by extensions.
void check_components(const json& root, const std::string& file, LossTally& found) {
    if (!root.contains("accessors") || root["asset"]["version"] != "2.0") return;
    const json& accessors = root["accessors"];
    for (const auto& [type, extension] : new_components) {
        if (declares(root, extension)) continue;
        for (std::size_t i = 0; i < accessors.size(); ++i)
            if (accessors[i]["componentType"] == type)
                found.add({Loss::approximated,
                           fmt::format("{}#/accessors/{}/componentType", file, i),
                           fmt::format("is {}, which needs {} in extensionsUsed; it is read as "
                                       "if that were there",
                                       type, extension)});
    }
}

}  // namespace

void check_rules(const json& root, const std::string& file, Losses& losses) {
    LossTally found([](std::size_t count) { return fmt::format(" (in {} places)", count); });
    check_iors(root, file, found);
    check_components(root, file, found);
    std::ranges::copy(found.losses(), std::back_inserter(losses));
}

}  // namespace penumbra::gltf
