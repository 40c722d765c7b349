// The scene: plain values that importers make and the tracer and exporters read.
//
// Conventions, stated once. Right-handed, y up, as glTF. Angles are radians, lengths the user's
// units. Colours are linear RGB. Texture coordinates: u to the right, v up, (0, 0) is the lower
// left corner of the image (as OBJ and POV-Ray; glTF's v is flipped on import). Things refer to
// each other by Index. Planes and spheres are two-sided, facets as their Material says.
//
// The light that leaves a surface towards the eye (the light model of POV-Ray 3.7):
//   P (K_A Ia) + E + sum over virtual sources of f_a Ip (P K_D N.L + M K_S (R.V)^N) + K_R reflected
//                  + sum over virtual sources behind the surface of f_a Ip K_T |N.L|
// where P is the pigment (color x texture x vertex colour, or a pattern), N is turned toward the
// eye, R is the mirrored eye ray, and M = 1 + metallic (1 - F)(P - 1) with POV-Ray's curve F;
// beside a texture, vertex colours are left out of M. Where a surface has a specular_color, that
// takes P's place in M, and `metallic` is 1 in the M of the highlight. With opacity a < 1 the
// ambient, emitted and diffuse terms, K_T too, are scaled by a; of what lies behind, (1 - a)(1 - t
// + t P) is added, t being the transmission; highlights and reflection are not scaled.
// Material::alpha_map fades everything, as a hole does. Shadow rays are filtered by the same
// factors.
#pragma once

#include "penumbra/error.h"
#include "penumbra/image.h"
#include "penumbra/math.h"

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace penumbra {

enum class Wrap { repeat, clamp, mirror };

/// An image laid over a surface by its texture coordinates.
struct Texture {
    std::string name = {};  ///< for messages and for the exported file's name
    Raster raster = {};     ///< decoded; 1 to 4 channels
    bool srgb = true;       ///< integer samples are sRGB-encoded (else linear); floats are linear
    bool bilinear = true;   ///< else the nearest texel
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
};

/// The texture at the mesh's texture coordinates, times Material::color.
/// Spheres and planes have texture coordinates of their own: see sphere_texcoord() and
/// plane_frame().
struct ImageMap {
    Index texture = no_index;  ///< into Scene::textures
    double size = 1;           ///< planes: scene units that one copy of the image covers
    /// Meshes: the image is looked up at u' = t0 u + t1 v + t2, v' = t3 u + t4 v + t5, where (u, v)
    /// are the mesh's texture coordinates. Invertible.
    std::array<double, 6> transform = {1, 0, 0, 0, 1, 0};
    bool operator==(const ImageMap&) const = default;
};

/// Cubes of side `size` in world space, alternately colours[0] and colours[1]; colours[0] fills
/// [0, size)^3 (moved to origin). Replaces Material::color and vertex colours.
struct Checker {
    std::array<Color, 2> colors = {Color(1), Color(0)};
    double size = 1;  ///< scene units
    Vec3 origin = {0, 0, 0};
};

/// Perlin noise in world space, POV-Ray's generator 3 (pov `noise_generator 3`), value in [0, 1],
/// mixed linearly from colors[0] to colors[1]. Replaces Material::color and vertex colours.
/// With n octaves: sum of noise(2^i p) / 2^i over i < n, divided by the sum of the weights.
struct Noise {
    std::array<Color, 2> colors = {Color(0), Color(1)};
    double size = 1;  ///< scene units per lattice cell
    int octaves = 1;  ///< 1 to 10
    Vec3 origin = {0, 0, 0};
};

/// monostate: Material::color alone.
using Pattern = std::variant<std::monostate, ImageMap, Checker, Noise>;

/// An image whose first channel says how much of a mesh is there: with c in [0, 1] the surface is
/// mixed from its own look (c) and from nothing at all (1 - c), highlights and mirror included.
/// With a cutoff it is there where c >= cutoff, and nowhere else. The texture is linear. Without a
/// cutoff c is multiplied by Mesh::alphas, and vertex colours are interpolated with these as
/// weights (premultiplied), as POV-Ray mixes the textures of vertices.
struct AlphaMap {
    ImageMap map = {};  ///< no texture: 1 everywhere
    std::optional<float> cutoff = {};
};

/// Highlight and mirror of one roughness.
struct SpecularLobe {
    float specular = 0, shininess = 40;
    Color reflection = Color(0);
    float roughness = 0;  ///< of the reflection
};

/// Images that vary highlight and mirror over an opaque mesh, in place of Material's specular,
/// shininess and reflection: `color` takes the place of P, or of specular_color, in the tint M of
/// both; `level`'s first channel, in [0, 1], chooses between `lobes`, which are spaced evenly over
/// it and mixed linearly; or else, which takes half the rays, the nearest is shown but for
/// a narrow transition: see lobe_share().
struct SpecularLobes {
    ImageMap color = {};                   ///< no texture: P stays
    ImageMap level = {};                   ///< no texture: lobes[0] alone; the texture is linear
    std::vector<SpecularLobe> lobes = {};  ///< 1 to 32
    bool mixed = true;
};

/// A tangent-space normal map (glTF 2.0, section 3.9.3) over a mesh with tangents; `scale` is that
/// of its x and y. The texture is linear. See bake_normal_maps().
struct NormalMap {
    ImageMap map = {};
    float scale = 1;
};

struct Material;

/// A second look of a mesh: where the image's first channel is c in [0, 1], the surface is mixed
/// linearly from its own look (c) and from the other (1 - c), each lit by itself. The texture is
/// linear. What a ray has entered is that of the first: the other's ior and absorption are not used
/// but for Fresnel's term.
struct Blend {
    ImageMap map = {};
    // Without an initializer, as Material is incomplete here.
    std::vector<Material> other;  ///< one, without a Blend and an AlphaMap
};

/// Light along a path of length x inside of the surface is multiplied by color^(x / distance).
struct Absorption {
    Color color = Color(1);  ///< in (0, 1]
    double distance = 1;
};

/// Which sides of its facets a surface shows. The front of a facet is where its corners run
/// counter-clockwise, in the space of its mesh, so that an instance which mirrors turns nothing
/// over. From behind such a facet is not there for rays that look; it casts its shadow from both
/// sides.
enum class Sides { both, front };

/// A clear layer over a surface, with mirror and highlight of its own, both colourless. The mirror
/// reflects r + (g - r)(1 - N.V)^5 (Schlick 1994, "An Inexpensive BRDF Model for Physically-based
/// Rendering") and is blurred as Material::roughness blurs; what it reflects is taken from the
/// terms of the surface below but reflection and what lies behind.
struct Coat {
    float specular = 0, shininess = 40;
    float reflection = 0;  ///< r, at normal incidence
    float grazing = 0;     ///< g, along the surface
    float roughness = 0;
    int mirrors = 7;
    bool operator==(const Coat&) const = default;
};

/// Fibres that stand out of a surface, as of cloth. What they scatter, as a matte surface does,
/// lies over all terms but reflection and what lies behind, and covers them by a share that rises
/// in grazing light: see sheen_cover(). Of opaque surfaces.
struct Sheen {
    Color color = Color(0);  ///< linear, in [0, 1]
    float roughness = 0;     ///< [0, 1]
    bool operator==(const Sheen&) const = default;
};

/// A Phong surface. Every number is kept in float32, as POV-Ray keeps it.
struct Material {
    std::string name = {};
    Color color = Color(0.8F);  ///< base colour; factor of a texture and of vertex colours
    Pattern pattern = {};
    Color ambient = Color(0.1F);  ///< K_A per channel; times P and Scene::ambient
    float diffuse = 0.7F;         ///< K_D
    float specular = 0.3F;        ///< K_S, highlight in the light's colour
    float shininess = 40;         ///< N, the Phong exponent of the mirrored eye ray, >= 0
    float metallic = 0;           ///< [0, 1]: tints highlight and reflection by P
    /// The highlight's own colour, in place of P in M; a metal's reflection takes it too.
    std::optional<Color> specular_color = {};
    Color reflection = Color(0);  ///< mirror coefficient per channel
    /// [0, 1], of the reflection: it is the mean of `mirrors` mirror images by displaced normals,
    /// see virtual_mirrors(). Of opaque surfaces, and of those that bend light (`ior`), which then
    /// bend it by the same normals where it goes in: see frosts(). Of others it is sharp.
    float roughness = 0;
    int mirrors = 7;  ///< 1 (sharp), 7, 13, 19 or 32
    /// What the mirrors reflect is taken from the other terms but what lies behind: they are
    /// multiplied by 1 - reflectance for each mirror. Of opaque surfaces without `fresnel`.
    bool conserve_energy = false;
    Color emission = Color(0);  ///< radiance, multiplied neither by P nor by the opacity
    /// K_T per channel, not multiplied by P: light from behind that is scattered to the eye.
    Color diffuse_transmission = Color(0);
    float opacity = 1;       ///< [0, 1]
    float transmission = 0;  ///< [0, 1]: how much P tints what is seen through the surface
    float ior = 1;           ///< index of refraction; 1 lets rays pass straight
    bool fresnel = false;    ///< reflection is multiplied by Fresnel's term of `ior`
    bool smooth = true;      ///< interpolate normals if the mesh has them
    std::optional<Absorption> absorption = {};
    std::optional<Coat> coat = {};
    std::optional<Sheen> sheen = {};
    // Of meshes only:
    Sides sides = Sides::both;
    std::optional<ImageMap> emission_map = {};  ///< times `emission`
    /// Times `diffuse_transmission`; the surface must be opaque.
    std::optional<ImageMap> diffuse_transmission_map = {};
    std::optional<AlphaMap> alpha_map = {};
    std::optional<SpecularLobes> specular_lobes = {};  ///< the surface must be opaque
    std::optional<NormalMap> normal_map = {};
    std::optional<Blend> blend = {};
};

/// Does no light pass through it?
inline bool opaque(const Material& m) {
    return m.opacity >= 1 && !m.alpha_map && !(m.blend && !opaque(m.blend->other.front()));
}

/// Direction of u on the surface, unit, and the handedness (+1 or -1) of the bitangent, which is
/// handedness * cross(normal, direction) (glTF 2.0, section 3.7.2.1).
struct Tangent {
    Vec3f direction = Vec3f(1, 0, 0);
    float handedness = 1;
};

/// Facets with one material. All per-vertex vectors are empty or as long as positions.
struct Mesh {
    std::string name = {};
    std::vector<Vec3f> positions = {};
    std::vector<Vec3f> normals = {};  ///< unit; empty: flat facets
    std::vector<Vec2f> texcoords = {};
    std::vector<Color> colors = {};                    ///< vertex colours, times Material::color
    std::vector<float> alphas = {};                    ///< [0, 1], of Material::alpha_map
    std::vector<Tangent> tangents = {};                ///< needed by normal maps
    std::vector<std::array<Index, 3>> triangles = {};  ///< into positions
    Index material = no_index;                         ///< into Scene::materials
};

/// A mesh placed in the world. Several instances may share one mesh.
struct Instance {
    std::string name = {};
    Index mesh = 0;         ///< into Scene::meshes
    Matrix transform = {};  ///< mesh to world; affine, invertible, any handedness
    /// Surroundings, not what the picture is of: see Tracer::subject_seen().
    bool backdrop = false;
};

struct Sphere {
    std::string name = {};
    Vec3 center = Vec3(0);
    double radius = 1;
    Index material = no_index;
    bool backdrop = false;  ///< see Instance
};

/// Infinite, two-sided.
struct Plane {
    std::string name = {};
    Vec3 point = Vec3(0);
    Vec3 normal = {0, 1, 0};  ///< need not be unit
    Index material = no_index;
    bool backdrop = false;  ///< see Instance
    bool casts_shadow = true;
    bool in_mirrors = true;  ///< rays that were mirrored see it
};

/// f_a = 2 / (1 + (d / distance)^power), d the distance to the source: POV-Ray's
/// fade_distance and fade_power. 1 at d = distance, 2 at the source.
struct Attenuation {
    double distance = 10;
    double power = 2;
};

/// Where the virtual sources of a light stand; each has 1/n of its intensity.
/// axes: the source itself and its copies displaced by +-delta along x, y and z: 7.
/// sphere: `count[0]` points spread evenly in the ball of radius delta.
/// grid: count[0] x count[1] points over a square of side 2 delta that faces `target`.
struct Penumbra {
    enum class Layout { axes, sphere, grid };
    double delta =
        0;  ///< scene units; for a directional light the tangent of its half-angle; 0: none
    Layout layout = Layout::axes;
    std::array<int, 2> count = {7, 1};
    Vec3 target = {0, 0, 0};
};

struct Light {
    enum class Type { point, spot, directional };
    std::string name = {};
    Type type = Type::point;
    Vec3 position = Vec3(0);      ///< of point and spot
    Vec3 direction = {0, -1, 0};  ///< of spot and directional: where the light goes; unit
    Color color = Color(1);
    double intensity = 1;        ///< Ip
    double inner = radians(20);  ///< spot: half-angle of full light
    double outer = radians(30);  ///< spot: half-angle where it ends; smoothstep between in cosine
    std::optional<Attenuation> attenuation = {};
    Penumbra penumbra = {};
};

struct Camera {
    enum class Projection { perspective, orthographic };
    enum class Side { horizontal, vertical };  ///< of the picture
    std::string name = {};
    Vec3 position = {0, 0, 5};
    Vec3 direction = {0, 0, -1};  ///< of view; need not be unit
    Vec3 up = {0, 1, 0};          ///< need not be unit or perpendicular
    Projection projection = Projection::perspective;
    Side side = Side::horizontal;  ///< the side that `fov` or `extent` measures
    double fov = radians(40);      ///< perspective: full angle, in (0, pi)
    double extent = 4;             ///< orthographic: full length, scene units
    double aspect = 0;  ///< width / height of the picture that its author had in mind; 0: any
};

/// An image of all directions (equirectangular): longitude runs to the right and latitude up, the
/// middle of the image lies in -z and its top in +y, both then turned by `rotation`.
struct Sky {
    Index texture = no_index;
    double gain = 1;
    Matrix rotation = {};  ///< from the image's directions to the world's: a rotation about 0
};

/// Of an Environment.
inline constexpr int most_sources = 4096;

/// What surrounds the scene and lights it: an image as that of a Sky. Both renderers see it as a
/// Sky and as `sources` directional lights: see normalise().
struct Environment {
    std::string name = {};  ///< for messages and for what a scene's lights are called
    Index texture = no_index;
    /// From the image's directions to the world's: a rotation about 0.
    Matrix rotation = {};
    /// The image's middle lies where the active camera looks, but level with it, before `rotation`
    /// is applied.
    bool before_camera = false;
    double intensity = 1;  ///< times the image, which is a radiance
    int sources = 64;      ///< 0 to most_sources; 0: it is seen and gives no light
    bool visible = true;   ///< replaces background and sky; else only what mirrors show of them
    /// What stands around the things. plain: where the environment is not visible the background
    /// has the colour that a floor has in the open. floor: there is one as well, level and endless,
    /// just below the lowest of the things. It casts no shadow, so that light comes from below, and
    /// is a backdrop. Without a floor: scenes with planes, or whose camera stands within the things
    /// or below them.
    enum class Stage { none, plain, floor } stage = Stage::none;
};

/// Everything in one picture but its size and quality.
struct Scene {
    std::vector<Material> materials = {};
    std::vector<Texture> textures = {};
    std::vector<Mesh> meshes = {};
    std::vector<Instance> instances = {};
    std::vector<Sphere> spheres = {};
    std::vector<Plane> planes = {};
    std::vector<Light> lights = {};
    std::vector<Camera> cameras = {};
    Index camera = no_index;  ///< the active one of `cameras`
    Color background = Color(0);
    std::optional<Sky> sky = {};         ///< in place of `background`
    std::optional<Sky> mirror_sky = {};  ///< in place of both, for rays that were mirrored
    std::optional<Environment> environment = {};
    Color ambient = Color(1);  ///< Ia, the global lighting constant
};

/// An axis-aligned box; empty while min > max.
struct Bounds {
    Vec3 min = Vec3(1e300), max = Vec3(-1e300);
    bool empty() const { return !(min.x <= max.x); }
    void extend(const Vec3& p);
    Vec3 center() const { return (min + max) * 0.5; }
    double radius() const { return empty() ? 0 : (max - min).length() * 0.5; }
};

/// World-space bounds of all facets and spheres (not planes). Precondition: the indices of
/// instances and facets are in range.
Bounds bounds(const Scene& scene);

/// Number of facets after instancing. Precondition: the instances' meshes are in range.
std::size_t facet_count(const Scene& scene);

/// Every broken rule in `scene`, one sentence each; empty when it may be rendered: indices in
/// range, numbers finite, per-vertex vectors of equal length, invertible transforms, sane cameras.
[[nodiscard]] std::vector<std::string> defects(const Scene& scene);

}  // namespace penumbra
