// What goes wrong outside the program's control, and what could not be carried over.
#pragma once

#include <cstddef>
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

/// What a caller could allow, so that what failed works the next time. Messages do not name it:
/// a program knows what its own options are called.
enum class Remedy {
    none,
    memory,   ///< more of it: set_memory_limit(), PovrayOptions::memory
    time,     ///< more of it: PovrayOptions::timeout
    program,  ///< another POV-Ray: PovrayOptions::binary
    resume,   ///< to go on from the checkpoint: RenderFileOptions::resume
    restart,  ///< not to: RenderFileOptions::resume
    replace,  ///< to replace files by others: ExportOptions::replace
};

/// The one exception of the library. what() reads "<place>: <problem>", where place is where a
/// person can look: "studio.toml:12:9", "chair.obj:7", "chair.gltf#/meshes/0/primitives/1"; or
/// just "<problem>" when the place is empty. One line, no trailing period, no control characters.
struct Error : std::runtime_error {
    Error(Failure kind, const std::string& place, const std::string& problem,
          Remedy help = Remedy::none)
        : std::runtime_error(place.empty() ? problem : place + ": " + problem), failure(kind),
          remedy(help) {}

    Failure failure;
    Remedy remedy;
};

/// Something that an importer or exporter could not carry over, and what was done instead.
struct Loss {
    enum class Kind {
        approximated,  ///< something near takes its place
        dropped,       ///< it is not shown at all
    };
    using enum Kind;  // Loss::dropped

    Kind kind = dropped;
    std::string place;      ///< "chair.gltf#/materials/2", or the name of the thing; of several the
                            ///< first
    std::string what;       ///< "sheen is ignored"; of several "sheen is ignored (3 times)"
    std::size_t count = 1;  ///< of the things that `what` is said of
    bool operator==(const Loss&) const = default;
};

using Losses = std::vector<Loss>;

/// "approximated" or "dropped", as JSON has it.
constexpr const char* to_string(Loss::Kind kind) {
    return kind == Loss::dropped ? "dropped" : "approximated";
}

}  // namespace penumbra
