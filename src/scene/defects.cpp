#include "scene/defects.h"

#include "scene/texture/image_maps.h"
#include "scene/transforms.h"
#include "scene/vertex_arrays.h"

#include "penumbra/light_model.h"
#include "penumbra/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

bool finite(double value) { return std::isfinite(value); }
template <class V>
bool finite_vector(const V& v) {
    return finite(v.x) && finite(v.y) && finite(v.z);
}

// Collects one sentence per broken rule, at most a few per kind of thing.
struct Examiner {
    const Scene& scene;
    std::vector<std::string> found = {};

    void require(bool rule, std::string sentence) {
        if (!rule) found.push_back(std::move(sentence));
    }

    void material_of(Index index, const std::string& who) {
        require(index < scene.materials.size(),
                fmt::format("{} refers to material {} of {}", who, index, scene.materials.size()));
    }

    void material(const Material& m) {
        const std::string who = fmt::format("material '{}'", m.name);
        if (m.blend)
            for (const Material& other : m.blend->other)
                if (!other.blend) material(other);
        require(finite_vector(m.color) && finite_vector(m.ambient) && finite_vector(m.emission) &&
                    finite_vector(m.reflection) && finite(m.diffuse) && finite(m.specular) &&
                    finite(m.shininess) && finite(m.metallic) &&
                    finite_vector(m.specular_color.value_or(Color(0))) &&
                    finite_vector(m.diffuse_transmission),
                who + " has a number that is not finite");
        require(m.opacity >= 0 && m.opacity <= 1, who + " has an opacity outside [0, 1]");
        require(m.roughness >= 0 && m.roughness <= 1, who + " has a roughness outside [0, 1]");
        require(is_mirror_count(m.mirrors),
                who + " has a number of mirrors that is not 1, 7, 13, 19 or 32");
        if (m.coat)
            require(m.coat->roughness >= 0 && m.coat->roughness <= 1 &&
                        is_mirror_count(m.coat->mirrors) && finite(m.coat->specular) &&
                        finite(m.coat->shininess) && finite(m.coat->reflection) &&
                        finite(m.coat->grazing),
                    who + " has a coat with a number out of range");
        if (m.sheen)
            require(m.sheen->roughness >= 0 && m.sheen->roughness <= 1 &&
                        finite_vector(m.sheen->color),
                    who + " has a sheen with a number out of range");
        require(m.ior > 0 && finite(m.ior),
                who + " has an index of refraction that is not positive");
        maps(m, who);
        if (const auto* map = std::get_if<ImageMap>(&m.pattern)) {
            require(map->texture < scene.textures.size(), who + " refers to a missing texture");
            require(map->size > 0 && finite(map->size),
                    who + " has a texture size that is not positive");
        } else if (const auto* checker = std::get_if<Checker>(&m.pattern)) {
            require(checker->size > 0 && finite(checker->size),
                    who + " has a checker size that is not positive");
        } else if (const auto* noise = std::get_if<Noise>(&m.pattern)) {
            require(noise->size > 0 && finite(noise->size),
                    who + " has a noise size that is not positive");
            require(noise->octaves >= 1 && noise->octaves <= 10,
                    who + " has noise octaves outside 1 to 10");
        }
    }

    void map(const ImageMap& map, const std::string& who, const char* what) {
        require(map.texture < scene.textures.size(),
                fmt::format("{} refers to a missing texture for its {}", who, what));
        const auto& t = map.transform;
        require(std::all_of(t.begin(), t.end(), finite) && t[0] * t[4] - t[1] * t[3] != 0,
                fmt::format("{} lays its {} flat", who, what));
    }

    void maps(const Material& m, const std::string& who) {
        each_image_map(m, [&](const ImageMap& image, MapUse use) {
            const bool left_out = image.texture == no_index;
            switch (use) {
            case MapUse::pattern: return;
            case MapUse::emission: return map(image, who, "emission");
            case MapUse::transmission: return map(image, who, "diffuse transmission");
            case MapUse::blend: return map(image, who, "second look");
            case MapUse::normal: return map(image, who, "normal map");
            case MapUse::alpha: return left_out ? void() : map(image, who, "alpha map");
            case MapUse::lobe_color:
                return left_out ? void() : map(image, who, "specular lobes' colour");
            case MapUse::lobe_level:
                return left_out ? void() : map(image, who, "specular lobes' level");
            }
        });
        const std::size_t lobes = m.specular_lobes ? m.specular_lobes->lobes.size() : 1;
        require(lobes >= 1 && lobes <= 32,
                fmt::format("{} has {} specular lobes, not 1 to 32", who, lobes));
        if (m.specular_lobes)
            for (const SpecularLobe& lobe : m.specular_lobes->lobes)
                require(lobe.roughness >= 0 && lobe.roughness <= 1,
                        who + " has a specular lobe with a roughness outside [0, 1]");
        require(m.opacity == 1 || !m.specular_lobes,
                who + " is translucent and has specular lobes, which need it opaque");
        require(m.opacity == 1 || !m.diffuse_transmission_map,
                who + " is translucent and has an image of diffuse transmission, which needs it "
                      "opaque");
        require(!m.blend || (m.blend->other.size() == 1 && !m.alpha_map &&
                             !m.blend->other[0].blend && !m.blend->other[0].alpha_map),
                who + " has a second look that is not one alone, or has an alpha map beside it");
        require(m.transmission >= 0 && m.transmission <= 1,
                who + " has a transmission outside [0, 1]");
        require(!m.absorption || (m.absorption->distance > 0 && finite(m.absorption->distance)),
                who + " has an absorption distance that is not positive");
    }

    void mesh(const Mesh& m) {
        const std::string who = fmt::format("mesh '{}'", m.name);
        const std::size_t count = m.positions.size();
        require(count < no_index && m.triangles.size() < no_index,
                who + " has more vertices or facets than can be numbered");
        bool fits = true;
        each_vertex_array(m, [&](const auto& v) { fits &= v.empty() || v.size() == count; });
        require(fits, who + " has per-vertex data of unequal lengths");
        require(std::all_of(m.positions.begin(), m.positions.end(), finite_vector<Vec3f>),
                who + " has a position that is not finite");
        require(std::all_of(m.normals.begin(), m.normals.end(), finite_vector<Vec3f>),
                who + " has a normal that is not finite");
        require(indices_in_range(m), who + " has a facet that refers to a missing vertex");
        material_of(m.material, who);
    }

    void instance(const Instance& i) {
        const std::string who = fmt::format("instance '{}'", i.name);
        require(i.mesh < scene.meshes.size(), who + " refers to a missing mesh");
        require(penumbra::finite(i.transform) && std::isnormal(i.transform.determinant()),
                who + " has a transform that cannot be inverted");
    }

    void sphere(const Sphere& s) {
        const std::string who = fmt::format("sphere '{}'", s.name);
        require(finite_vector(s.center) && s.radius > 0 && finite(s.radius),
                who + " has a radius that is not positive");
        material_of(s.material, who);
    }

    void plane(const Plane& p) {
        const std::string who = fmt::format("plane '{}'", p.name);
        require(finite_vector(p.point) && finite_vector(p.normal) && p.normal.length() > 0,
                who + " has no usable normal");
        material_of(p.material, who);
    }

    void light(const Light& l) {
        const std::string who = fmt::format("light '{}'", l.name);
        require(finite_vector(l.position) && finite_vector(l.direction) && finite_vector(l.color) &&
                    finite(l.intensity),
                who + " has a number that is not finite");
        require(l.type == Light::Type::point || l.direction.length() > 0,
                who + " has a direction of length zero");
        require(l.type != Light::Type::spot ||
                    (l.inner >= 0 && l.outer > l.inner && l.outer < radians(90)),
                who + " has spot angles that are not 0 <= inner < outer < 90 degrees");
        require(!l.attenuation || (l.attenuation->distance > 0 && l.attenuation->power > 0),
                who + " has an attenuation that is not positive");
        require(l.penumbra.delta >= 0 && finite(l.penumbra.delta) && l.penumbra.count[0] >= 1 &&
                    l.penumbra.count[1] >= 1,
                who + " has a penumbra that is not positive");
    }

    void image_of(const Texture& t) {
        const auto& [width, height, channels, depth, data] = t.raster;
        require(width >= 1 && height >= 1 && channels >= 1 && channels <= 4 &&
                    data.size() == t.raster.texels() * std::size_t(channels) * std::size_t(depth),
                fmt::format("texture '{}' has no image, or not all of it", t.name));
    }

    // An image of all directions.
    void surrounding(Index texture, const Matrix& rotation, const std::string& who) {
        require(texture < scene.textures.size(), who + " refers to a missing texture");
        require(is_rotation(rotation), who + " is turned by what is no rotation");
    }

    void sky(const Sky& s, const std::string& who) {
        surrounding(s.texture, s.rotation, who);
        require(finite(s.gain), who + " has a number that is not finite");
    }

    void environment(const Environment& e) {
        surrounding(e.texture, e.rotation, "the environment");
        require(finite(e.intensity) && e.intensity >= 0,
                "the environment has an intensity that is not 0 or more");
        require(e.sources >= 0 && e.sources <= most_sources,
                fmt::format("the environment has sources that are not 0 to {}", most_sources));
    }

    void camera(const Camera& c) {
        const std::string who = fmt::format("camera '{}'", c.name);
        require(finite_vector(c.position) && finite_vector(c.direction) && finite_vector(c.up) &&
                    c.direction.cross(c.up).length() > 1e-12 * c.direction.length() * c.up.length(),
                who + " looks along its up vector or nowhere");
        require(c.fov > 0 && c.fov < std::numbers::pi,
                who + " has a field of view outside 0 to 180 degrees");
        require(c.extent > 0 && finite(c.extent), who + " has an extent that is not positive");
    }
};

}  // namespace

// By name, so that a new member of Scene is an error here until it has been looked at.
std::vector<std::string> defects(const Scene& scene) {
    const auto& [materials, textures, meshes, instances, spheres, planes, lights, cameras, camera,
                 background, sky, mirror_sky, environment, ambient] = scene;
    Examiner examine{scene};
    for (const Material& m : materials) examine.material(m);
    for (const Texture& t : textures) examine.image_of(t);
    for (const Mesh& m : meshes) examine.mesh(m);
    for (const Instance& i : instances) examine.instance(i);
    examine.require(instances.size() < no_index, "there are more instances than can be numbered");
    for (const Sphere& s : spheres) examine.sphere(s);
    for (const Plane& p : planes) examine.plane(p);
    for (const Light& l : lights) examine.light(l);
    for (const Camera& c : cameras) examine.camera(c);
    if (sky) examine.sky(*sky, "the sky");
    if (mirror_sky) examine.sky(*mirror_sky, "the sky in mirrors");
    if (environment) examine.environment(*environment);
    examine.require(camera < cameras.size(), "the scene has no camera");
    return std::move(examine.found);
}

std::vector<std::string> surface_defects(const Scene& scene) {
    Examiner examine{scene};
    for (const Material& m : scene.materials) examine.material(m);
    for (const Mesh& m : scene.meshes) examine.mesh(m);
    return std::move(examine.found);
}

std::vector<std::string> camera_defects(const Camera& camera) {
    const Scene none;
    Examiner examine{none};
    examine.camera(camera);
    return std::move(examine.found);
}

std::vector<std::string> environment_defects(const Scene& scene) {
    Examiner examine{scene};
    for (const Texture& t : scene.textures) examine.image_of(t);
    for (const Camera& c : scene.cameras) examine.camera(c);
    if (scene.environment) examine.environment(*scene.environment);
    examine.require(scene.camera < scene.cameras.size(), "the scene has no camera");
    return std::move(examine.found);
}

bool indices_in_range(const Mesh& mesh) {
    const std::size_t count = mesh.positions.size();
    return std::ranges::all_of(mesh.triangles, [&](const auto& t) {
        return t[0] < count && t[1] < count && t[2] < count;
    });
}

bool indices_in_range(const Scene& scene) {
    return std::ranges::all_of(scene.meshes,
                               [](const Mesh& mesh) { return indices_in_range(mesh); }) &&
           std::ranges::all_of(scene.instances, [&](const Instance& instance) {
               return instance.mesh < scene.meshes.size();
           });
}

bool all_indices_in_range(const Scene& scene) {
    const auto has_material = [&](const auto& thing) {
        return thing.material < scene.materials.size();
    };
    return indices_in_range(scene) && std::ranges::all_of(scene.meshes, has_material) &&
           std::ranges::all_of(scene.spheres, has_material) &&
           std::ranges::all_of(scene.planes, has_material);
}

}  // namespace penumbra
