// The table of features: for each a small scene that shows it, made of the files that a user would
// write. features_test shows them to both renderers; docs/fidelity.md has the figures.
#pragma once

#include "penumbra/importers.h"

#include <map>
#include <string>
#include <vector>

namespace test {

struct Feature {
    std::string group = {}, name = {};
    /// By name; "stage.toml" is the input and names the others.
    std::map<std::string, std::string> files = {};
    penumbra::ModelOptions model = {};
    std::string loss = {};  ///< part of what import or export must say; empty: nothing is lost
    double parity = 0.9999, exactness = 0.999;  ///< at least
};

/// All of them, in the order of the table.
std::vector<Feature> features();

std::vector<Feature> geometry_features();
std::vector<Feature> camera_features();
std::vector<Feature> light_features();
std::vector<Feature> side_features();
std::vector<Feature> surface_features();
std::vector<Feature> mirror_features();
std::vector<Feature> texture_features();
std::vector<Feature> map_features();
std::vector<Feature> transparency_features();
std::vector<Feature> coplanar_features();
std::vector<Feature> mtl_features();
std::vector<Feature> picture_features();

}  // namespace test
