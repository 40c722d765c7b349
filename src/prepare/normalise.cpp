#include "base/memory.h"
#include "image/texels.h"
#include "prepare/scale.h"
#include "scene/check_options.h"
#include "scene/surface/looks.h"
#include "scene/tolerances.h"
#include "scene/transforms.h"

#include "penumbra/prepare.h"
#include "penumbra/render_options.h"
#include "penumbra/scene.h"

#include <half.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace penumbra {

namespace {

constexpr double most = 1e30;  // of what rescales a mesh: well within float32

double extent_of(const Mesh& mesh) {
    float extent = 0;
    for (const Vec3f& p : mesh.positions)
        extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return extent;
}

// Of each mesh the largest scale that its instances have.
std::vector<double> largest_scales(const Scene& scene) {
    std::vector<double> largest(scene.meshes.size(), 0);
    for (const Instance& i : scene.instances)
        largest[i.mesh] = std::max(largest[i.mesh], mean_scale(i.transform));
    return largest;
}

// The point of `mesh` that its vertices are to be counted from: 0 along an axis on which they are
// near enough at `scale` for a scene of this radius. Vertices on one side of an axis and far from 0
// have about one size, so that their differences are exact in float32.
Vec3f own_origin(const Mesh& mesh, double scale, double radius) {
    Vec3f origin(0);
    if (extent_of(mesh) * scale <= far_away * radius) return origin;
    const Bounds box = box_around_facets(mesh);
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(box.center()[axis]) * scale > far_away * radius)
            origin[axis] = float(box.center()[axis]);
    return origin;
}

// Where POV-Ray 3.7 mixes the textures of a facet's corners it takes a determinant for 0 whose
// square is below 1e-10, in the mesh's own units (source/backend/shape/triangle.cpp,
// Calculate_Smooth_T). At a radius of 8 that is far above float32's rounding and far below all but
// the smallest facets.
constexpr double scale_of_tinted = 8 / least_radius;

bool tinted(const Mesh& mesh) { return !mesh.colors.empty() || !mesh.alphas.empty(); }

// Gives each mesh vertices near the scale of the world, by powers of two: POV-Ray applies some of
// its tolerances, and float32, in the mesh's own space.
void rescale_meshes(Scene& scene, double factor) {
    std::vector<double> largest = largest_scales(scene);
    for (std::size_t k = 0; k < scene.meshes.size(); ++k) {
        const double size = largest[k] * factor * (tinted(scene.meshes[k]) ? scale_of_tinted : 1);
        largest[k] = size > 0 ? std::exp2(std::round(std::log2(size))) : 1;
        // Hostile transforms flatten a mesh that is far larger than they make it.
        if (!(largest[k] > 1 / most && largest[k] < most &&
              largest[k] * extent_of(scene.meshes[k]) < most))
            largest[k] = 1;
        const auto multiplier = float(largest[k]);
        if (multiplier != 1)
            for (Vec3f& p : scene.meshes[k].positions) p *= multiplier;
    }
    for (Instance& i : scene.instances) {
        const double linear = factor / largest[i.mesh];
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column) i.transform[row][column] *= linear;
        for (int column = 0; column < 3; ++column) i.transform[3][column] *= factor;
    }
}

// By name, so that a new member of Scene is an error here until it is known whether it has a
// length.
void move_and_scale(Scene& scene, const Vec3& offset, double factor) {
    auto& [materials, textures, meshes, instances, spheres, planes, lights, cameras, camera,
           background, sky, mirror_sky, environment, ambient] = scene;
    const auto place = [&](Vec3& p) { p = (p - offset) * factor; };
    for (Instance& i : instances)
        for (int column = 0; column < 3; ++column) i.transform[3][column] -= offset[column];
    rescale_meshes(scene, factor);
    for (Sphere& s : spheres) {
        place(s.center);
        s.radius *= factor;
    }
    for (Plane& p : planes) place(p.point);
    for (Light& l : lights) {
        place(l.position);
        place(l.penumbra.target);
        if (l.type != Light::Type::directional) l.penumbra.delta *= factor;
        if (l.attenuation) l.attenuation->distance *= factor;
    }
    for (Camera& c : cameras) {
        place(c.position);
        c.extent *= factor;
    }
    each_look(materials, [&](Material& m) {
        if (m.absorption) m.absorption->distance *= factor;
        if (auto* map = std::get_if<ImageMap>(&m.pattern)) map->size *= factor;
        if (auto* checker = std::get_if<Checker>(&m.pattern)) {
            checker->size *= factor;
            place(checker->origin);
        }
        if (auto* noise = std::get_if<Noise>(&m.pattern)) {
            noise->size *= factor;
            place(noise->origin);
        }
    });
}

void expose(Scene& scene, double stops) {
    if (stops == 0) return;
    const double gain = std::exp2(stops);
    const auto scale = [&](Color& c) { c = Color(Vec3(c) * gain); };
    for (Light& l : scene.lights) l.intensity *= gain;
    each_look(scene.materials, [&](Material& m) { scale(m.emission); });
    scale(scene.background);
    scale(scene.ambient);
    if (scene.sky) scene.sky->gain *= gain;
    if (scene.mirror_sky) scene.mirror_sky->gain *= gain;
}

// OpenEXR's halves end at 65504; infinity would spread to every texel that is mixed with it.
float nearest_half(double value) {
    constexpr double largest = 65504;
    if (std::isnan(value)) return 0;
    return Imath::half(float(std::clamp(value, -largest, largest)));
}

// Makes the sky's gain part of its image: POV-Ray 3.7 has none. Floats are rounded to the halves
// that it reads.
void develop(std::optional<Sky>& sky, std::vector<Texture>& textures) {
    if (!sky) return;
    const Texture& source = textures[sky->texture];
    if (sky->gain == 1 && source.raster.depth != Depth::f32) return;
    const Raster& in = source.raster;
    const MemoryClaim claim(in.data.size() + in.texels() * 3 * sizeof(float),
                            "texture " + source.name);
    Texture out = source;
    out.raster.depth = Depth::f32;
    out.raster.channels = 3;
    out.raster.data.resize(in.texels() * 3 * sizeof(float));
    const LinearSamples samples(in, source.srgb);
    for (std::size_t t = 0; t < in.texels(); ++t) {
        const Color color = samples.color(t);
        for (int c = 0; c < 3; ++c) {
            const float half = nearest_half(double(color[c]) * sky->gain);
            std::memcpy(out.raster.data.data() + sizeof(float) * (3 * t + std::size_t(c)), &half,
                        sizeof half);
        }
    }
    textures.push_back(std::move(out));
    sky->texture = Index(textures.size() - 1);
    sky->gain = 1;
}

// The texture times `color`, in 16-bit linear: both renderers then read the same numbers.
Texture tinted(const Texture& texture, const Color& color) {
    const Raster& in = texture.raster;
    const MemoryClaim claim(in.data.size() + in.texels() * 6, "texture " + texture.name);
    Texture out = texture;
    out.name += "_tinted";
    out.srgb = false;
    out.raster.channels = 3;
    out.raster.depth = Depth::u16;
    out.raster.data.resize(in.texels() * 3 * 2);
    const LinearSamples samples(in, texture.srgb);
    for (std::size_t t = 0; t < in.texels(); ++t) {
        const Color product = samples.color(t) * color;
        for (int c = 0; c < 3; ++c) {
            const float value = std::clamp(product[c], 0.0F, 1.0F);
            const auto word = std::uint16_t(std::lround(value * 65535.0F));
            std::memcpy(out.raster.data.data() + 2 * (t * 3 + std::size_t(c)), &word, 2);
        }
    }
    return out;
}

// A finish scatters light from behind by one number, so the image has the colour.
void tint_transmission(Scene& scene, Material& m) {
    Color& color = m.diffuse_transmission;
    const float strongest = std::max({color.x, color.y, color.z});
    if (!m.diffuse_transmission_map || color == Color(strongest)) return;
    Index& texture = m.diffuse_transmission_map->texture;
    scene.textures.push_back(tinted(scene.textures[texture], color / strongest));
    texture = Index(scene.textures.size() - 1);
    color = Color(strongest);
}

// POV-Ray multiplies pigments by laying one over the other, which only works for surfaces that are
// opaque and whose highlight does not take the pigment's colour.
void tint_textures(Scene& scene) {
    each_look(scene.materials, [&](Material& m) {
        tint_transmission(scene, m);
        auto* map = std::get_if<ImageMap>(&m.pattern);
        const bool own_tint =
            m.specular_color || (m.specular_lobes && m.specular_lobes->color.texture != no_index);
        const bool layers = (m.metallic == 0 || own_tint) && m.opacity == 1;
        if (map == nullptr || m.color == Color(1) || layers) return;
        scene.textures.push_back(tinted(scene.textures[map->texture], m.color));
        map->texture = Index(scene.textures.size() - 1);
        m.color = Color(1);
    });
}

}  // namespace

void center_meshes(Scene& scene, double radius) {
    const std::vector<double> scales = largest_scales(scene);
    std::vector<Vec3f> origins;
    origins.reserve(scales.size());
    for (std::size_t k = 0; k < scales.size(); ++k) {
        origins.push_back(own_origin(scene.meshes[k], scales[k], radius));
        if (origins[k] != Vec3f(0))
            for (Vec3f& p : scene.meshes[k].positions) p -= origins[k];
    }
    for (Instance& i : scene.instances) {
        const Vec3f& origin = origins[i.mesh];
        if (origin == Vec3f(0)) continue;
        const Vec3 there = Vec3(origin) * i.transform;
        for (int column = 0; column < 3; ++column) i.transform[3][column] = there[column];
    }
}

double normalising_factor(const Bounds& box) {
    const double radius = box.radius();
    return radius > 0 && std::isfinite(radius)
               ? std::exp2(-std::floor(std::log2(radius / least_radius)))
               : 1.0;
}

NormalisedScene normalise(Scene scene, const RenderOptions& options) {
    check(options);
    assert(defects(scene).empty());
    const Bounds box = bounds(scene);
    NormalisedScene result;
    result.offset = local_origin(box);
    center_meshes(scene, box.radius());
    result.factor = normalising_factor(box);
    light_by_environment(scene);
    move_and_scale(scene, result.offset, result.factor);
    expose(scene, options.exposure);
    tint_textures(scene);
    develop(scene.sky, scene.textures);
    develop(scene.mirror_sky, scene.textures);
    result.scene = std::move(scene);
    return result;
}

}  // namespace penumbra
