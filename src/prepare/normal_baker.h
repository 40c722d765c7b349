// A mesh whose normal map becomes the normals of its vertices.
#pragma once

#include "prepare/subdivide.h"
#include "scene/normal_map.h"

namespace penumbra {

/// What is known of a mesh while it is divided.
struct NormalBaker {
    const NormalMap& map;
    const TextureLookup& lookup;      ///< of the map's texture
    double magnification = 1;         ///< of the mesh's area in the world
    Subdivision mesh;                 ///< has normals, tangents and texture coordinates
    std::vector<Vec3f> normals = {};  ///< the map's, unit, per vertex: see add_normals()
};

/// How far a facet's interpolated normals are from the map's.
struct FacetError {
    double mean = 0;  ///< of the squared distance of unit normals
    double area = 0;  ///< of the facet, in the world
};

/// Gives the vertices that have no normal yet that of the map where they are.
void add_normals(NormalBaker& baker);

FacetError error_of(const NormalBaker& baker, Index facet);

/// How many texels of the map lie on a facet.
double texels_on(const NormalBaker& baker, Index facet);

/// Of a mesh.
struct MeshError {
    double angle = 0;  ///< mean between interpolated and true normals
    double area = 0;   ///< in the world
};

/// Moves the normals of vertices to where the interpolated ones are nearest to the map's, in the
/// sense of least squares: a vertex among many texels then has their mean and not that of the one
/// it happens to lie on. Returns the error that is left.
MeshError fit_normals(NormalBaker& baker);

}  // namespace penumbra
