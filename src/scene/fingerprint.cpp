#include "scene/fingerprint.h"

#include "base/hash.h"

#include <span>
#include <string_view>
#include <type_traits>

namespace penumbra {

namespace {

// Every struct is taken apart by name, so that a new member is an error here until it is counted.
class Hasher {
  public:
    std::uint64_t result() const { return hash_.digest().low; }

    template <class T>
        requires std::is_arithmetic_v<T> || std::is_enum_v<T>
    void add(T value) {
        hash_.add(value);
    }
    void add(std::string_view text) { hash_.add(text); }
    template <class T>
    void add(const std::optional<T>& value) {
        add(value.has_value());
        if (value) add(*value);
    }
    template <class T, std::size_t n>
    void add(const std::array<T, n>& values) {
        for (const T& value : values) add(value);
    }
    template <class T>
    void add(const std::vector<T>& values) {
        add(values.size());
        if constexpr (is_plain<T>)
            hash_.add(std::as_bytes(std::span(values)));
        else
            for (const T& value : values) add(value);
    }
    template <class... T>
    void add(const std::variant<T...>& value) {
        add(value.index());
        std::visit([&](const auto& held) { add(held); }, value);
    }
    void add(std::monostate) {}
    template <class T>
    void add(const Imath::Vec2<T>& v) {
        add_all(v.x, v.y);
    }
    template <class T>
    void add(const Imath::Vec3<T>& v) {
        add_all(v.x, v.y, v.z);
    }
    void add(const Matrix& m) {
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column) add(m[row][column]);
    }

    void add(const Raster& raster) {
        const auto& [width, height, channels, depth, data] = raster;
        add_all(width, height, channels, depth, data);
    }
    void add(const Texture& texture) {
        const auto& [name, raster, srgb, bilinear, wrap_u, wrap_v] = texture;
        add_all(name, raster, srgb, bilinear, wrap_u, wrap_v);
    }
    void add(const ImageMap& map) {
        const auto& [texture, size, transform] = map;
        add_all(texture, size, transform);
    }
    void add(const Checker& checker) {
        const auto& [colors, size, origin] = checker;
        add_all(colors, size, origin);
    }
    void add(const Noise& noise) {
        const auto& [colors, size, octaves, origin] = noise;
        add_all(colors, size, octaves, origin);
    }
    void add(const AlphaMap& alpha_map) {
        const auto& [map, cutoff] = alpha_map;
        add_all(map, cutoff);
    }
    void add(const SpecularLobe& lobe) {
        const auto& [specular, shininess, reflection, roughness] = lobe;
        add_all(specular, shininess, reflection, roughness);
    }
    void add(const SpecularLobes& specular_lobes) {
        const auto& [color, level, lobes, mixed] = specular_lobes;
        add_all(color, level, lobes, mixed);
    }
    void add(const NormalMap& normal_map) {
        const auto& [map, scale] = normal_map;
        add_all(map, scale);
    }
    void add(const Blend& blend) {
        const auto& [map, other] = blend;
        add_all(map, other);
    }
    void add(const Absorption& absorption) {
        const auto& [color, distance] = absorption;
        add_all(color, distance);
    }
    void add(const Coat& coat) {
        const auto& [specular, shininess, reflection, grazing, roughness, mirrors] = coat;
        add_all(specular, shininess, reflection, grazing, roughness, mirrors);
    }
    void add(const Sheen& sheen) {
        const auto& [color, roughness] = sheen;
        add_all(color, roughness);
    }
    void add(const Material& material) {
        const auto& [name, color, pattern, ambient, diffuse, specular, shininess, metallic,
                     specular_color, reflection, roughness, mirrors, conserve_energy, emission,
                     diffuse_transmission, opacity, transmission, ior, fresnel, smooth, absorption,
                     coat, sheen, sides, emission_map, diffuse_transmission_map, alpha_map,
                     specular_lobes, normal_map, blend] = material;
        add_all(name, color, pattern, ambient, diffuse, specular, shininess, metallic,
                specular_color, reflection, roughness, mirrors, conserve_energy, emission,
                diffuse_transmission, opacity, transmission, ior, fresnel, smooth, absorption, coat,
                sheen, sides, emission_map, diffuse_transmission_map, alpha_map, specular_lobes,
                normal_map, blend);
    }
    void add(const Tangent& tangent) {
        const auto& [direction, handedness] = tangent;
        add_all(direction, handedness);
    }
    void add(const Mesh& mesh) {
        const auto& [name, positions, normals, texcoords, colors, alphas, tangents, triangles,
                     material] = mesh;
        add_all(name, positions, normals, texcoords, colors, alphas, tangents, triangles, material);
    }
    void add(const Instance& instance) {
        const auto& [name, mesh, transform, backdrop] = instance;
        static_cast<void>(backdrop);  // the picture is the same
        add_all(name, mesh, transform);
    }
    void add(const Sphere& sphere) {
        const auto& [name, center, radius, material, backdrop] = sphere;
        static_cast<void>(backdrop);
        add_all(name, center, radius, material);
    }
    void add(const Plane& plane) {
        const auto& [name, point, normal, material, backdrop, casts_shadow, in_mirrors] = plane;
        static_cast<void>(backdrop);
        add_all(name, point, normal, material, casts_shadow, in_mirrors);
    }
    void add(const Attenuation& attenuation) {
        const auto& [distance, power] = attenuation;
        add_all(distance, power);
    }
    void add(const Penumbra& penumbra) {
        const auto& [delta, layout, count, target] = penumbra;
        add_all(delta, layout, count, target);
    }
    void add(const Light& light) {
        const auto& [name, type, position, direction, color, intensity, inner, outer, attenuation,
                     penumbra] = light;
        add_all(name, type, position, direction, color, intensity, inner, outer, attenuation,
                penumbra);
    }
    void add(const Camera& camera) {
        const auto& [name, position, direction, up, projection, side, fov, extent, aspect] = camera;
        add_all(name, position, direction, up, projection, side, fov, extent, aspect);
    }
    void add(const Sky& sky) {
        const auto& [texture, gain, rotation] = sky;
        add_all(texture, gain, rotation);
    }
    void add(const Environment& environment) {
        const auto& [name, texture, rotation, before_camera, intensity, sources, visible, stage] =
            environment;
        add_all(name, texture, rotation, before_camera, intensity, sources, visible, stage);
    }
    void add(const Antialiasing& antialiasing) {
        const auto& [threshold, depth] = antialiasing;
        add_all(threshold, depth);
    }
    void add(const RenderOptions& options) {
        const auto& [width, height, samples, antialiasing, max_depth, exposure, threads] = options;
        static_cast<void>(threads);
        add_all(width, height, samples, antialiasing, max_depth, exposure);
    }

    template <class... T>
    void add_all(const T&... values) {
        (add(values), ...);
    }

  private:
    Hash hash_;

    // Numbers without padding between them.
    template <class T>
    static constexpr bool is_plain =
        std::is_arithmetic_v<T> || std::is_same_v<T, std::byte> || std::is_same_v<T, Vec3f> ||
        std::is_same_v<T, Vec2f> || std::is_same_v<T, std::array<Index, 3>>;
};

template <class... T>
PartFingerprint part(const char* name, const T&... values) {
    Hasher hasher;
    hasher.add_all(values...);
    return {name, hasher.result()};
}

}  // namespace

std::vector<PartFingerprint> fingerprints(const NormalisedScene& normalised) {
    const auto& [scene, factor, offset] = normalised;
    const auto& [materials, textures, meshes, instances, spheres, planes, lights, cameras, camera,
                 background, sky, mirror_sky, environment, ambient] = scene;
    return {part("camera", cameras, camera), part("lights", lights),
            part("materials or images", materials, textures),
            part("geometry", meshes, instances, spheres, planes, factor, offset),
            part("background or ambient light", background, sky, mirror_sky, environment, ambient)};
}

std::uint64_t fingerprint(const NormalisedScene& scene, const RenderOptions& options) {
    Hasher hasher;
    for (const PartFingerprint& part : fingerprints(scene)) hasher.add(part.value);
    hasher.add(options);
    return hasher.result();
}

}  // namespace penumbra
