#include "memory.h"

#include "penumbra/scene.h"

#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace penumbra {

namespace {

constexpr double target_radius = 8;  // the scene's radius ends in [8, 16)
constexpr double most = 1e30;        // of what rescales a mesh: well within float32
constexpr double far_away = 64;      // radii from the origin where float32 begins to suffer

// The power of two that brings `length` into [target, 2 target).
double power_of_two_to(double target, double length) {
    return length > 0 && std::isfinite(length) ? std::exp2(-std::floor(std::log2(length / target)))
                                               : 1.0;
}

// The mean length of the transform's axes.
double scale_of(const Matrix& m) { return std::cbrt(std::abs(m.determinant())); }

double extent_of(const Mesh& mesh) {
    float extent = 0;
    for (const Vec3f& p : mesh.positions)
        extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return extent;
}

// Gives each mesh vertices near the scale of the world, by powers of two: POV-Ray applies some of
// its tolerances, and float32, in the mesh's own space.
void rescale_meshes(Scene& scene, double factor) {
    std::vector<double> largest(scene.meshes.size(), 0);
    for (const Instance& i : scene.instances)
        largest[i.mesh] = std::max(largest[i.mesh], scale_of(i.transform));
    for (std::size_t k = 0; k < scene.meshes.size(); ++k) {
        const double size = largest[k] * factor;
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

void move_and_scale(Scene& scene, const Vec3& offset, double factor) {
    const auto place = [&](Vec3& p) { p = (p - offset) * factor; };
    for (Instance& i : scene.instances)
        for (int column = 0; column < 3; ++column) i.transform[3][column] -= offset[column];
    rescale_meshes(scene, factor);
    for (Sphere& s : scene.spheres) {
        place(s.center);
        s.radius *= factor;
    }
    for (Plane& p : scene.planes) place(p.point);
    for (Light& l : scene.lights) {
        place(l.position);
        place(l.penumbra.target);
        if (l.type != Light::Type::directional) l.penumbra.delta *= factor;
        if (l.attenuation) l.attenuation->distance *= factor;
    }
    for (Camera& c : scene.cameras) {
        place(c.position);
        c.extent *= factor;
    }
    for (Material& m : scene.materials) {
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
    }
}

void expose(Scene& scene, double stops) {
    if (stops == 0) return;
    const double gain = std::exp2(stops);
    const auto scale = [&](Color& c) { c = Color(Vec3(c) * gain); };
    for (Light& l : scene.lights) l.intensity *= gain;
    for (Material& m : scene.materials) scale(m.emission);
    scale(scene.background);
    scale(scene.ambient);
    if (scene.sky) scene.sky->gain *= gain;
}

// One sample of a raster as linear light.
float linear_sample(const Texture& texture, std::size_t sample) {
    const std::byte* data = texture.raster.data.data();
    switch (texture.raster.depth) {
    case Depth::u8: {
        const float encoded = float(std::to_integer<unsigned>(data[sample])) / 255.0F;
        return texture.srgb ? srgb_to_linear(encoded) : encoded;
    }
    case Depth::u16: {
        std::uint16_t value = 0;
        std::memcpy(&value, data + 2 * sample, 2);
        const float encoded = float(value) / 65535.0F;
        return texture.srgb ? srgb_to_linear(encoded) : encoded;
    }
    case Depth::f32: break;
    }
    float value = 0;
    std::memcpy(&value, data + 4 * sample, 4);
    return value;
}

// Makes the sky's gain part of its image: POV-Ray 3.7 has none. Floats are rounded to the halves
// that it reads.
void develop_sky(Scene& scene) {
    if (!scene.sky) return;
    const Texture& source = scene.textures[scene.sky->texture];
    if (scene.sky->gain == 1 && source.raster.depth != Depth::f32) return;
    const Raster& in = source.raster;
    const MemoryClaim claim(in.data.size() + in.texels() * 3 * sizeof(float),
                            "texture " + source.name);
    Texture out = source;
    out.raster.depth = Depth::f32;
    out.raster.channels = 3;
    out.raster.data.resize(in.texels() * 3 * sizeof(float));
    for (std::size_t t = 0; t < in.texels(); ++t) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t channel = in.channels >= 3 ? c : 0;
            const double value =
                double(linear_sample(source, t * std::size_t(in.channels) + channel)) *
                scene.sky->gain;
            const float half = Imath::half(float(value));
            std::memcpy(out.raster.data.data() + sizeof(float) * (3 * t + c), &half, sizeof half);
        }
    }
    scene.textures.push_back(std::move(out));
    scene.sky = Sky{.texture = Index(scene.textures.size() - 1), .gain = 1};
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
    for (std::size_t t = 0; t < in.texels(); ++t) {
        for (int c = 0; c < 3; ++c) {
            const int source = in.channels >= 3 ? c : 0;
            const float value =
                linear_sample(texture, t * std::size_t(in.channels) + std::size_t(source)) *
                color[c];
            const auto word = std::uint16_t(std::lround(std::clamp(value, 0.0F, 1.0F) * 65535.0F));
            std::memcpy(out.raster.data.data() + 2 * (t * 3 + std::size_t(c)), &word, 2);
        }
    }
    return out;
}

// POV-Ray multiplies pigments by laying one over the other, which only works for surfaces that are
// opaque and whose highlight does not take the pigment's colour.
void tint_textures(Scene& scene) {
    for (Material& m : scene.materials) {
        auto* map = std::get_if<ImageMap>(&m.pattern);
        const bool own_tint = m.gloss && m.gloss->color.texture != no_index;
        const bool layers = (m.metallic == 0 || own_tint) && m.opacity == 1;
        if (map == nullptr || m.color == Color(1) || layers) continue;
        scene.textures.push_back(tinted(scene.textures[map->texture], m.color));
        map->texture = Index(scene.textures.size() - 1);
        m.color = Color(1);
    }
}

}  // namespace

NormalisedScene normalise(Scene scene, const RenderOptions& options) {
    const Bounds box = bounds(scene);
    const double radius = box.radius();
    NormalisedScene result;
    if (!box.empty() && box.center().length() > far_away * radius) result.offset = box.center();
    result.factor = box.empty() ? 1 : power_of_two_to(target_radius, radius);
    move_and_scale(scene, result.offset, result.factor);
    expose(scene, options.exposure);
    tint_textures(scene);
    develop_sky(scene);
    result.scene = std::move(scene);
    return result;
}

}  // namespace penumbra
