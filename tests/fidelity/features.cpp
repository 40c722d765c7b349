#include "fidelity/features.h"

namespace test {

std::vector<Feature> features() {
    std::vector<Feature> all;
    const auto add = [&](const std::string& group, std::vector<Feature> some) {
        for (Feature& feature : some) {
            feature.group = group;
            all.push_back(std::move(feature));
        }
    };
    add("geometry", geometry_features());
    add("cameras", camera_features());
    add("lights", light_features());
    add("surfaces", surface_features());
    add("rough mirrors", mirror_features());
    add("sides", side_features());
    add("textures", texture_features());
    add("maps", map_features());
    add("transparency", transparency_features());
    add("coplanar", coplanar_features());
    add("MTL", mtl_features());
    add("picture", picture_features());
    return all;
}

}  // namespace test
