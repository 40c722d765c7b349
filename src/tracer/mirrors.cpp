#include "tracer/mirrors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra {

Vec3 metallic_tint(double metallic, double cosine, const Vec3& pigment) {
    const double x = std::acos(std::clamp(cosine, -1.0, 1.0)) / (std::numbers::pi / 2);
    const double curve =
        std::clamp(0.014567225 / ((x - 1.12) * (x - 1.12)) - 0.011612903, 0.0, 1.0);
    return Vec3(1) + (pigment - Vec3(1)) * (metallic * (1 - curve));
}

Vec3 tint_of_mirror(const SurfacePoints& surfaces, std::size_t slot, double cosine) {
    const PreparedMaterial& material = *surfaces.material[slot];
    if (material.metallic == 0) return Vec3(1);
    return metallic_tint(material.metallic, cosine, surfaces.tint[slot]);
}

namespace {

// A normal in world space as one in the mesh's; not unit.
Vec3 normal_to_mesh(const Matrix& to_world, const Vec3& n) {
    const Matrix& m = to_world;  // the transpose: that of the inverse leads back
    return {m[0][0] * n.x + m[0][1] * n.y + m[0][2] * n.z,
            m[1][0] * n.x + m[1][1] * n.y + m[1][2] * n.z,
            m[2][0] * n.x + m[2][1] * n.y + m[2][2] * n.z};
}

}  // namespace

Vec3 displaced_normal(const PreparedScene& prepared, Index object, const Vec3& normal,
                      const Vec3& offset) {
    if (offset == Vec3(0)) return normal;
    if (!prepared.displaces_in_mesh(object)) return (normal + offset).normalized();
    const Vec3 there =
        normal_to_mesh(prepared.scene.instances[object].transform, normal).normalized();
    return prepared.facets->placed(object)
        .normal_to_world((there + offset).normalized())
        .normalized();
}

Vec3 reflection_of(const PreparedMaterial& material, const LobeMix& mix) {
    const Vec3 first = material.lobes[mix.first].reflection;
    if (mix.share == 0) return first;
    return first * (1 - mix.share) + material.lobes[mix.first + 1].reflection * mix.share;
}

double coat_reflectance(const PreparedCoat& coat, double cosine) {
    const double grazing = std::pow(1 - cosine, 5);
    return coat.lobe.reflection.x * (1 - grazing) + coat.grazing * grazing;
}

namespace {

// The product over the mirrors of what each leaves; reflectance(cosine) is that of all.
template <class Reflectance>
Vec3 kept_by(const PreparedLobe& lobe, const PreparedScene& prepared, bool mirrored,
             const SurfacePoints& surfaces, std::size_t slot, const Reflectance& reflectance) {
    const Vec3 view = surfaces.view[slot], normal = surfaces.normal[slot];
    const auto kept = [&](const Vec3& by, std::size_t count) {
        const Vec3 taken = reflectance(-view.dot(by)) * (1 / double(count));
        return Vec3(std::min(1.0, 1 - taken.x), std::min(1.0, 1 - taken.y),
                    std::min(1.0, 1 - taken.z));
    };
    if (mirrored) return kept(normal, 1);
    Vec3 product(1);
    for (const Vec3& offset : lobe.mirrors)
        product *= kept(displaced_normal(prepared, surfaces.object[slot], normal, offset),
                        lobe.mirrors.size());
    return product;
}

// The share that the sheen covers, seen at the angle of `cosine`.
double cover_at(const PreparedSheen& sheen, double cosine) {
    const double last = double(sheen.cover.size() - 1);
    const double raised = 2 * std::acos(-std::clamp(cosine, 0.0, 1.0)) / std::numbers::pi - 1;
    const double at = std::clamp(raised, 0.0, 1.0) * last;
    const double first = std::min(std::floor(at), last - 1), share = at - first;
    const auto i = std::size_t(first);
    return sheen.cover[i] * (1 - share) + sheen.cover[i + 1] * share;
}

}  // namespace

void find_kept(const PreparedScene& prepared, bool mirrored, SurfacePoints& surfaces,
               std::size_t slot) {
    const PreparedMaterial& material = *surfaces.material[slot];
    const LobeMix& mix = surfaces.lobes[slot];
    Vec3 by_coat(1);
    if (const auto& coat = material.coat; coat && coat->takes_reflected)
        by_coat = kept_by(coat->lobe, prepared, mirrored, surfaces, slot,
                          [&](double cosine) { return Vec3(coat_reflectance(*coat, cosine)); });
    const double cover =
        material.sheen ? cover_at(*material.sheen, -surfaces.view[slot].dot(surfaces.normal[slot]))
                       : 0;
    const Vec3 above = by_coat * (1 - cover);
    const auto kept_of = [&](std::size_t i) {
        const PreparedLobe& lobe = material.lobes[i];
        if (!material.conserves) return above;
        return above * kept_by(lobe, prepared, mirrored, surfaces, slot, [&](double cosine) {
                   return lobe.reflection * tint_of_mirror(surfaces, slot, cosine);
               });
    };
    Vec3 kept = kept_of(mix.first);
    surfaces.kept.set(slot, kept);
    if (mix.share > 0) {
        const Vec3 next = kept_of(mix.first + 1);
        surfaces.next_kept.set(slot, next);
        kept = kept * (1 - mix.share) + next * mix.share;
    }
    surfaces.pigment.set(slot, surfaces.pigment[slot] * kept);
    surfaces.emitted.set(slot, surfaces.emitted[slot] * kept);
    if (material.backlit) surfaces.from_behind.set(slot, surfaces.from_behind[slot] * kept);
    if (!material.sheen) return;
    // Both layers are matte: what they scatter is found at once.
    surfaces.pigment.set(slot, surfaces.pigment[slot] * surfaces.diffuse[slot] +
                                   material.sheen->tint * by_coat * (cover * surfaces.alpha[slot]));
    surfaces.diffuse[slot] = 1;
}

}  // namespace penumbra
