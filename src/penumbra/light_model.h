// The rules that the tracer and the exporters share: where virtual sources stand, where images are
// looked up, and what the camera sees.
#pragma once

#include "penumbra/math.h"
#include "penumbra/scene.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace penumbra {

/// A light as both renderers see it: one point without extent.
struct Source {
    Light::Type type = Light::Type::point;
    Vec3 position = Vec3(0);      ///< directional: a point far up the light, outside the scene
    Vec3 point_at = Vec3(0);      ///< spot and directional: a point along its axis
    Color color = Color(0);       ///< Ip x colour / number of virtual sources
    double inner = 0, outer = 0;  ///< spot half-angles, radians
    std::optional<Attenuation> attenuation = {};
};

/// An Absorption as POV-Ray's fade_color of a fade_power beyond 1000 over fade_distance: light
/// fades with exp(-(1 - fade_color) x / fade_distance). Both are float32 there.
Color fade_color(const Absorption& absorption);
/// (1 - fade_color) / fade_distance
Vec3 fade_exponent(const Absorption& absorption);

/// The virtual sources of `light`, in a fixed order. Precondition: defects() finds nothing in
/// `light`.
std::vector<Source> virtual_sources(const Light& light);

/// One of the mirrors that a rough one is made of: its normal is normalize(N + offset), N the
/// shading normal turned to the eye. POV-Ray makes the same of `normal { gradient axis, amount }`,
/// in the space in which the texture lies.
struct VirtualMirror {
    Vec3 axis = Vec3(0);  ///< unit
    float amount = 0;     ///< 0: the mirror is not displaced
    Vec3 offset = Vec3(0);
};

/// Can a rough reflection have that many mirrors?
bool is_mirror_count(int count);

/// The mirrors of a reflection, each with 1/n of it, in a fixed order: one that is not displaced
/// where it is sharp. Precondition: is_mirror_count(count).
std::vector<VirtualMirror> virtual_mirrors(float roughness, int count);

/// Of lobes that are not mixed (SpecularLobes::mixed) each is shown alone as far as this from its
/// own level, in steps from one to the next. In what is left one goes over into the other, so that
/// a lookup that differs in its last digits does not show.
inline constexpr double lobe_reach = 0.4;

/// The part of the next lobe at `between`, in [0, 1], of the way to it.
inline double lobe_share(double between) {
    return std::clamp((between - lobe_reach) / (1 - 2 * lobe_reach), 0.0, 1.0);
}

/// Does Material::conserve_energy do anything?
bool takes_reflected(const Material& material);

/// Does the coat reflect?
bool mirrors(const Coat& coat);

/// Does the sheen show?
bool covers(const Material& material);

/// The share of a surface that its sheen covers, seen along it first and head on last: linear in
/// the angle, between entries that are spaced evenly. It is the directional albedo of Charlie
/// (Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF") with Ashikhmin's
/// visibility, times the colour's largest channel (KHR_materials_sheen, albedo scaling).
std::array<float, 17> sheen_cover(const Sheen& sheen);

/// The colour of what it scatters there: its largest channel is 1.
Color sheen_tint(const Sheen& sheen);

/// Has the material a reflection of several mirrors? Light that was mirrored once sees a single one
/// in its place, so that rays grow by the mirrors' number and not by its powers.
bool blurs(const Material& material);

/// Is it glass that blurs what is seen through it (Material::roughness)? Where a ray meets it from
/// the side that its normal points to, each of the virtual mirrors reflects and bends a part. A
/// mesh whose vertices have textures of their own stays clear.
bool frosts(const Material& material);

/// Where `map` is looked up at the mesh's texture coordinates `uv`.
inline Vec2 map_texcoord(const ImageMap& map, const Vec2& uv) {
    const auto& t = map.transform;
    return {t[0] * uv.x + t[1] * uv.y + t[2], t[3] * uv.x + t[4] * uv.y + t[5]};
}

/// An alpha that is at least this counts as the cutoff: equal numbers must not be told apart by
/// their last bit.
inline double cutoff_threshold(float cutoff) { return double(cutoff) - 1e-6; }

/// Texture coordinates of a Sky in the unit direction `d`.
Vec2 sky_texcoord(const Sky& sky, const Vec3& d);

/// POV-Ray shows Scene::mirror_sky on a sphere of this radius around the middle of a normalised
/// scene: nearer than its rays' end at 10^7, and so far that it hardly matters where they start.
inline constexpr double mirror_sky_radius = 8388608;

/// The point of that sphere, divided by its radius, that a ray meets from within; both are counted
/// from the middle. Precondition: `direction` is unit and `origin` inside.
Vec3 on_mirror_sky(const Vec3& origin, const Vec3& direction);

/// Texture coordinates of a sphere at the unit vector `p` from its centre: longitude and latitude,
/// readable from outside; the left edge of the image is at +x and it runs towards -z.
Vec2 sphere_texcoord(const Vec3& p);

/// Texture coordinates of a plane: ((p - origin).u, (p - origin).v) / ImageMap::size. On a floor u
/// is +x and v is -z; on a wall v is up.
struct PlaneFrame {
    Vec3 origin = Vec3(0), normal = Vec3(0), u = Vec3(0), v = Vec3(0);  ///< unit, perpendicular
};
/// Precondition: the plane's normal is not zero.
PlaneFrame plane_frame(const Plane& plane);

/// The camera's picture plane as POV-Ray's camera vectors: the ray through the point (u, v) of the
/// picture, u right and v up in [-1/2, 1/2], starts at location with direction
/// direction + u right + v up (perspective), or at location + u right + v up with direction
/// `direction` (orthographic).
struct View {
    bool orthographic = false;
    Vec3 location = Vec3(0), right = Vec3(0), up = Vec3(0), direction = Vec3(0);
};
/// Precondition: defects() finds nothing in `camera`, and width and height are at least 1.
View view_of(const Camera& camera, int width, int height);

/// Where the light of a scene comes from: a few lamps in the dark, or all around.
enum class Illumination {
    lamps,
    environment,
    by_model,  ///< of ModelOptions: all around, unless the model brings lights of its own
};

/// Phong terms that imitate a glTF metallic-roughness surface; material.color is its base colour
/// and `f0` the dielectric reflectance at normal incidence (0.04 for ior 1.5). An approximation: a
/// least squares fit to GGX. Sets diffuse, specular, shininess, metallic, reflection, roughness,
/// conserve_energy and specular_color.
void set_metallic_roughness(Material& material, float metallic, float roughness, float f0 = 0.04F,
                            Illumination illumination = Illumination::lamps);

}  // namespace penumbra
