// What goes wrong outside the program's control, and what could not be carried over.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace penumbra {

/// What kind of thing failed; the program's exit code follows from it.
enum class Failure {
    usage,        ///< a wrong option or option value (exit 2)
    input,        ///< an input cannot be read or is invalid (exit 3)
    output,       ///< an output cannot be written (exit 4)
    povray,       ///< POV-Ray is missing, failed or timed out (exit 5)
    interrupted,  ///< stopped on request (exit 130)
};

/// The one exception of the library. what() reads "<place>: <problem>", where place is where a
/// person can look: "studio.toml:12:9", "chair.obj:7", "chair.gltf#/meshes/0/primitives/1"; or
/// just "<problem>" when the place is empty. One line, no trailing period, no control characters.
struct Error : std::runtime_error {
    Error(Failure kind, const std::string& place, const std::string& problem)
        : std::runtime_error(place.empty() ? problem : place + ": " + problem), failure(kind) {}

    Failure failure;
};

/// Something that an importer or exporter could not carry over, and what was done instead.
struct Loss {
    std::string place;  ///< "chair.gltf#/materials/2", or the name of the thing
    std::string what;   ///< "sheen is ignored"
    bool operator==(const Loss&) const = default;
};

using Losses = std::vector<Loss>;

}  // namespace penumbra
