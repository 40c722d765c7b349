// What the manifest of the asset folder says of its models.
#pragma once

#include "support/support.h"

#include <map>
#include <regex>
#include <sstream>

namespace test {

// The models of the asset folder that must load: [[asset]] tables of its manifest.
inline std::vector<std::string> models_that_load() {
    std::istringstream lines(read(assets() / "MANIFEST.toml"));
    const std::regex pair("(\\w+) = \"(.*)\"");
    std::vector<std::string> files;
    std::map<std::string, std::string> asset;
    const auto finish = [&] {
        const bool model = asset["kind"] == "gltf" || asset["kind"] == "obj";
        const bool loads = asset["expect"] == "load" || asset["expect"] == "load-with-warnings";
        if (model && loads) files.push_back(asset["file"]);
        asset.clear();
    };
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (line == "[[asset]]") finish();
        if (std::regex_match(line, match, pair)) asset[match[1]] = match[2];
    }
    finish();
    return files;
}

}  // namespace test
