#include "vertices.h"

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
bool finite_matrix(const Matrix& m) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            if (!finite(m[row][column])) return false;
    return true;
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
        require(finite_vector(m.color) && finite_vector(m.ambient) && finite_vector(m.emission) &&
                    finite_vector(m.reflection) && finite(m.diffuse) && finite(m.specular) &&
                    finite(m.shininess) && finite(m.metallic),
                who + " has a number that is not finite");
        require(m.opacity >= 0 && m.opacity <= 1, who + " has an opacity outside [0, 1]");
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
        if (m.emission_map) map(*m.emission_map, who, "emission");
        if (m.coverage && m.coverage->map.texture != no_index)
            map(m.coverage->map, who, "coverage");
        if (m.normal_map) map(m.normal_map->map, who, "normal map");
        if (m.gloss) {
            require(!m.gloss->lobes.empty() && m.gloss->lobes.size() <= 16,
                    who + " has a gloss of no lobes or of more than 16");
            if (m.gloss->color.texture != no_index) map(m.gloss->color, who, "gloss");
            if (m.gloss->level.texture != no_index) map(m.gloss->level, who, "gloss level");
        }
        require(m.opacity == 1 || (!m.emission_map && !m.gloss),
                who + " is translucent and has an emission map or a gloss, which need it opaque");
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
        require(std::all_of(
                    m.triangles.begin(), m.triangles.end(),
                    [&](const auto& t) { return t[0] < count && t[1] < count && t[2] < count; }),
                who + " has a facet that refers to a missing vertex");
        material_of(m.material, who);
    }

    void instance(const Instance& i) {
        const std::string who = fmt::format("instance '{}'", i.name);
        require(i.mesh < scene.meshes.size(), who + " refers to a missing mesh");
        require(finite_matrix(i.transform) && std::isnormal(i.transform.determinant()),
                who + " has a transform that cannot be inverted");
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

std::vector<std::string> defects(const Scene& scene) {
    Examiner examine{scene};
    for (const Material& m : scene.materials) examine.material(m);
    for (const Mesh& m : scene.meshes) examine.mesh(m);
    for (const Instance& i : scene.instances) examine.instance(i);
    examine.require(scene.instances.size() < no_index,
                    "there are more instances than can be numbered");
    for (const Sphere& s : scene.spheres) {
        const std::string who = fmt::format("sphere '{}'", s.name);
        examine.require(finite_vector(s.center) && s.radius > 0 && finite(s.radius),
                        who + " has a radius that is not positive");
        examine.material_of(s.material, who);
    }
    for (const Plane& p : scene.planes) {
        const std::string who = fmt::format("plane '{}'", p.name);
        examine.require(finite_vector(p.point) && finite_vector(p.normal) && p.normal.length() > 0,
                        who + " has no usable normal");
        examine.material_of(p.material, who);
    }
    for (const Light& l : scene.lights) examine.light(l);
    for (const Camera& c : scene.cameras) examine.camera(c);
    examine.require(!scene.sky || scene.sky->texture < scene.textures.size(),
                    "the sky refers to a missing texture");
    examine.require(scene.camera < scene.cameras.size(), "the scene has no camera");
    return std::move(examine.found);
}

}  // namespace penumbra
