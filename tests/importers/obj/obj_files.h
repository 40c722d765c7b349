// Small OBJ files and what was read from them.
#pragma once

#include "support/support.h"

#include "penumbra/importers.h"

#include <string>
#include <vector>

namespace test {

using penumbra::Imported;
using penumbra::Loss;
using penumbra::Mesh;
using penumbra::Scene;
using penumbra::Vec3;

/// Four corners of the unit square.
inline const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

inline Imported read_text(const std::string& text) {
    const TempDir folder;
    return penumbra::read_obj(write(folder / "m.obj", text));
}

/// The message without the folder.
inline std::string message(const std::string& text) {
    const TempDir folder;
    const std::string prefix = folder.path.string() + '/';
    std::string result = message_of([&] { penumbra::read_obj(write(folder / "m.obj", text)); });
    if (result.starts_with(prefix)) result.erase(0, prefix.size());
    return result;
}

/// "m.obj:7: what" of every loss.
inline std::vector<std::string> losses(const Imported& imported) {
    std::vector<std::string> result;
    for (const Loss& loss : imported.losses)
        result.push_back(fs::path(loss.place).filename().string() + ": " + loss.what);
    return result;
}

using Lines = std::vector<std::string>;

inline double area(const Scene& scene) {
    double sum = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const auto& t : mesh.triangles) {
            const Vec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
            sum += (b - a).cross(c - a).length() / 2;
        }
    return sum;
}

inline std::size_t facets(const Scene& scene) {
    std::size_t sum = 0;
    for (const Mesh& mesh : scene.meshes) sum += mesh.triangles.size();
    return sum;
}

}  // namespace test
