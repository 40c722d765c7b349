// Which sides of its facets a mesh shows: a rule that the tracer and the exporters share.
//
// A facet's front is the side from which its corners run counter-clockwise, in the space of its
// mesh; glTF 2.0, section 3.7.4, has it so, for an instance that mirrors as well, whose winding it
// turns over. POV-Ray can leave backs out, by an interior texture, but asks the normal which side a
// ray meets: for a flat facet that is the winding, for a smooth one the interpolated normal n. A
// front that leans away from the ray counts as a back there, and would be a hole in every smooth
// silhouette. So let a be the angle by which the normals of a mesh lean away from their facets at
// most. A ray d that meets a front has d . n <= sin a; what has more is the back of a facet for
// sure, and that alone is hidden. Backs that are met at less than the angle a stay visible.
#pragma once

#include "penumbra/scene.h"

#include <vector>

namespace penumbra {

/// What an instance shows of the backs of its facets.
struct Backs {
    bool hidden = false;  ///< any
    /// Those are hidden that a ray meets at this many degrees to the surface or more, by the
    /// normal that shades it.
    int from = 0;
    int lean = 0;  ///< degrees by which its normals lean away from its facets; 0 to 90

    /// The same as POV-Ray's pattern `aoi` counts it, the angle to the normal in half turns: a ray
    /// along the surface has 1/2, one against the back 1.
    float half_turns() const { return 0.5F + float(from) / 180; }
};

/// For every instance. Precondition: the indices of instances and facets are in range.
std::vector<Backs> backs(const Scene& scene);

/// Normals that are all but equal make a flat facet: POV-Ray then ignores them
/// (source/backend/parser/parse.cpp of 3.7, Parse_Mesh2). Precondition: the mesh has normals.
inline bool flat_by_normals(const Mesh& mesh, const std::array<Index, 3>& corners) {
    const auto equal = [](const Vec3f& a, const Vec3f& b) {
        const Vec3 difference = Vec3(a) - Vec3(b);
        return difference.dot(difference) <= 1e-10;
    };
    const Vec3f& first = mesh.normals[corners[0]];
    return equal(first, mesh.normals[corners[1]]) && equal(first, mesh.normals[corners[2]]);
}

}  // namespace penumbra
