// What the mirrors of a surface have in common: their normals, and how much they reflect.
#pragma once

#include "tracer/surface_points.h"

namespace penumbra {

/// POV-Ray's tint of metallic highlights and reflections: 1 + m (1 - F)(P - 1), where F is its
/// empirical Fresnel curve of the angle whose cosine is given (source/backend/render/trace.cpp of
/// 3.7, ComputePhongColour).
Vec3 metallic_tint(double metallic, double cosine, const Vec3& pigment);

/// The same for what the surface point reflects, met at the angle of `cosine`.
Vec3 tint_of_mirror(const SurfacePoints& surfaces, std::size_t slot, double cosine);

/// The normal of a virtual mirror of `object`: in world space, or where vertices have textures of
/// their own, in that of the mesh. All are unit.
Vec3 displaced_normal(const PreparedScene& prepared, Index object, const Vec3& normal,
                      const Vec3& offset);

/// What the lobes of a surface point reflect together, not tinted.
Vec3 reflection_of(const PreparedMaterial& material, const LobeMix& mix);

/// What a mirror of the coat reflects at the angle of `cosine`.
double coat_reflectance(const PreparedCoat& coat, double cosine);

/// Sets what the mirrors of surface point `slot` leave to its other terms, for a ray that was
/// mirrored before or not.
void find_kept(const PreparedScene& prepared, bool mirrored, SurfacePoints& surfaces,
               std::size_t slot);

}  // namespace penumbra
