// A rough mirror as several sharp ones. The tracer and the exporter both call this and nothing
// else.
//
// A microfacet mirror shows the mean of what mirrors with the normals of its facets show. K fixed
// displacements a_k of the normal N, N_k = normalize(N + a_k), are such normals: the same K must
// serve every N, so they are spread evenly in space, and of each the part across N tilts it. Their
// lengths are those for which the directions N_k lie nearest to GGX of width alpha = roughness^2 in
// the mean over all N (least energy distance over a range of kernels, at alpha 0.04, 0.16 and
// 0.36).
#include "penumbra/light_model.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace penumbra {

namespace {

constexpr double longest = 0.95;  // of a displacement: N + a must not vanish

// The corners of a solid with all that comes from them by mirroring and turning the axes around.
void add_corners(double x, double y, double z, double length, std::vector<Vec3>& out) {
    const double scale = length / std::sqrt(x * x + y * y + z * z);
    for (int turn = 0; turn < 3; ++turn) {
        for (int signs = 0; signs < 8; ++signs) {
            const auto sign = [&](double value, int bit) {
                return (signs >> bit & 1) != 0 ? -value : value;
            };
            const Vec3 corner = Vec3(sign(x, 0), sign(y, 1), sign(z, 2)) * scale;
            if (std::ranges::find(out, corner) == out.end()) out.push_back(corner);
        }
        std::swap(x, y);
        std::swap(x, z);
    }
}

// In units of alpha.
std::vector<Vec3> displacements(int count) {
    constexpr double golden = std::numbers::phi;
    std::vector<Vec3> out;
    if (count != 32) out.emplace_back(0, 0, 0);
    switch (count) {
    case 7: add_corners(1, 0, 0, 1.37, out); break;
    case 13: add_corners(0, 1, golden, 1.39, out); break;  // an icosahedron
    case 19:
        add_corners(1, 0, 0, 0.7, out);
        add_corners(1, 1, 0, 1.85, out);  // a cuboctahedron
        break;
    case 32:
        add_corners(0, 1, golden, 0.68, out);
        add_corners(1, 1, 1, 1.88, out);  // a dodecahedron, its other corners below
        add_corners(0, 1 / golden, golden, 1.88, out);
        break;
    default: break;
    }
    return out;
}

// POV-Ray takes a normal's `gradient` at four points about the shading point, the corners of a
// tetrahedron at a distance that it keeps in float32 (source/backend/texture/normal.cpp of 3.7,
// Perturb_Normal): this is what comes out, in its own numbers.
Vec3 displacement_of(const Vec3& axis, float amount) {
    static const std::array<Vec3, 4> pyramid = {
        Vec3(0.942809041, -0.333333333, 0), Vec3(-0.471404521, -0.333333333, 0.816496581),
        Vec3(-0.471404521, -0.333333333, -0.816496581), Vec3(0, 1, 0)};
    constexpr double delta = double(0.02F);
    const double scale = double(amount) * -5 * 0.02 / delta;
    Vec3 sum(0);
    for (const Vec3& corner : pyramid) sum += corner * (scale * (0.5 + delta * axis.dot(corner)));
    return sum;
}

}  // namespace

bool is_mirror_count(int count) {
    return count == 1 || count == 7 || count == 13 || count == 19 || count == 32;
}

std::vector<VirtualMirror> virtual_mirrors(float roughness, int count) {
    assert(is_mirror_count(count));
    std::vector<VirtualMirror> mirrors;
    if (count == 1 || !(roughness > 0)) return {VirtualMirror{}};
    const double alpha = double(roughness) * double(roughness);
    for (const Vec3& direction : displacements(count)) {
        const double length = direction.length();
        if (length == 0) {
            mirrors.emplace_back();
            continue;
        }
        const Vec3 axis = direction / length;
        // Over a length of 1 the pattern rises by 1: the displacement is -0.4/3 times the amount.
        const auto amount = float(-7.5 * std::min(length * alpha, longest));
        mirrors.push_back({axis, amount, displacement_of(axis, amount)});
    }
    return mirrors;
}

bool takes_reflected(const Material& material) {
    return material.conserve_energy && material.opacity >= 1 && !material.fresnel;
}

bool mirrors(const Coat& coat) { return coat.reflection > 0 || coat.grazing > 0; }

bool frosts(const Material& m) {
    return m.opacity < 1 && m.ior != 1 && m.roughness > 0 && m.mirrors > 1 && !m.alpha_map &&
           !m.specular_lobes && !m.blend && !m.coat;
}

bool blurs(const Material& material) {
    const auto rough = [](const Color& reflection, float roughness) {
        return reflection != Color(0) && roughness > 0;
    };
    if (material.blend && blurs(material.blend->other.front())) return true;
    if (material.opacity < 1) return false;
    if (const auto& coat = material.coat;
        coat && mirrors(*coat) && coat->roughness > 0 && coat->mirrors > 1)
        return true;
    if (material.mirrors == 1) return false;
    if (!material.specular_lobes) return rough(material.reflection, material.roughness);
    return std::ranges::any_of(material.specular_lobes->lobes, [&](const SpecularLobe& lobe) {
        return rough(lobe.reflection, lobe.roughness);
    });
}

}  // namespace penumbra
