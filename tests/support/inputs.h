// Small input files and what load_scene() makes of them.
#pragma once

#include "support/support.h"

#include "penumbra/importers.h"

#include <algorithm>
#include <vector>

namespace test {

using namespace penumbra;

/// A folder with inputs; everything in it is loaded by its name.
struct Inputs {
    TempDir folder = {};

    Inputs& file(const std::string& name, const std::string& text) {
        write(folder / name, text);
        return *this;
    }

    Imported load(const std::vector<std::string>& names, const LoadOptions& options = {}) const {
        std::vector<fs::path> files;
        for (const std::string& name : names) files.push_back(folder / name);
        return load_scene(files, options);
    }

    Imported set(const std::vector<std::string>& names,
                 const std::vector<std::string>& settings) const {
        return load(names, {.settings = settings});
    }

    std::string problem(const std::vector<std::string>& names,
                        const LoadOptions& options = {}) const {
        std::string message = message_of([&] { load(names, options); });
        const std::string prefix = folder.path.string() + "/";
        for (auto at = message.find(prefix); at != message.npos; at = message.find(prefix))
            message.erase(at, prefix.size());
        return message;
    }

    std::string set_problem(const std::vector<std::string>& names,
                            const std::string& setting) const {
        return problem(names, {.settings = {setting}});
    }
};

/// One facet in the x-z plane with its right angle at the origin.
inline const char* const facet_obj = R"(
v 0 0 0
v 1 0 0
v 0 0 1
usemtl paint
f 1 2 3
)";

inline const char* const studio = R"(
[lighting]
ambient = 0.5
[[sphere]]
material = "floor"
[[plane]]
point = [0, -1, 0]
material = "floor"
[material.floor]
diffuse = 0.5
specular = 0.25
[[light]]
name = "lamp"
position = [3, 5, 4]
penumbra = { delta = 0.1, pattern = "sphere", count = 9 }
)";

struct StudioFiles : Inputs {
    StudioFiles() { file("studio.toml", studio); }
};

inline const Material& material_of(const Scene& scene, const std::string& name) {
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                    [&](const Material& m) { return m.name == name; });
    REQUIRE(found != scene.materials.end());
    return *found;
}

inline bool near(const Vec3& a, const Vec3& b) { return (a - b).length() < 1e-9; }

}  // namespace test
