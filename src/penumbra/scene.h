// The scene: plain values that importers make and the tracer and exporters read.
//
// Conventions, stated once. Right-handed, y up, as glTF. Angles are radians, lengths the user's
// units. Colours are linear RGB. Texture coordinates: u to the right, v up, (0, 0) is the lower
// left corner of the image (as OBJ and POV-Ray; glTF's v is flipped on import). Things refer to
// each other by Index. Facets, planes and spheres are two-sided; winding has no meaning.
//
// The light that leaves a surface towards the eye (the light model of POV-Ray 3.7):
//   P (K_A Ia) + E + sum over virtual sources of f_a Ip (P K_D N.L + M K_S (R.V)^N) + K_R reflected
// where P is the pigment (color x texture x vertex colour, or a pattern), N is turned toward the
// eye, R is the mirrored eye ray, and M = 1 + metallic (1 - F)(P - 1) with POV-Ray's curve F;
// beside a texture, vertex colours are left out of M. With opacity a < 1 the ambient, emitted and
// diffuse terms are scaled by a; of what lies behind, (1 - a)(1 - t + t P) is added, t being the
// transmission; highlights and reflection are not scaled. Material::coverage fades everything, as a
// hole does. Shadow rays are filtered by the same factors.
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
struct Coverage {
    ImageMap map = {};  ///< no texture: 1 everywhere
    std::optional<float> cutoff = {};
};

/// Highlight and mirror of one polish.
struct Lobe {
    float specular = 0, shininess = 40;
    Color reflection = Color(0);
};

/// Images that vary highlight and mirror over an opaque mesh, in place of Material's specular,
/// shininess and reflection: `color` takes the place of P in the tint M of both; `level`'s first
/// channel, in [0, 1], chooses between `lobes`, which are spaced evenly over it and mixed linearly.
struct Gloss {
    ImageMap color = {};           ///< no texture: P stays
    ImageMap level = {};           ///< no texture: lobes[0] alone; the texture is linear
    std::vector<Lobe> lobes = {};  ///< 1 to 16
};

/// A tangent-space normal map (glTF 2.0, section 3.9.3) over a mesh with tangents; `scale` is that
/// of its x and y. The texture is linear. See bake_normal_maps().
struct NormalMap {
    ImageMap map = {};
    float scale = 1;
};

/// Light along a path of length x inside of the surface is multiplied by color^(x / distance).
struct Absorption {
    Color color = Color(1);  ///< in (0, 1]
    double distance = 1;
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
    Color reflection = Color(0);  ///< mirror coefficient per channel
    Color emission = Color(0);    ///< radiance, not multiplied by P
    float opacity = 1;            ///< [0, 1]
    float transmission = 0;       ///< [0, 1]: how much P tints what is seen through the surface
    float ior = 1;                ///< index of refraction; 1 lets rays pass straight
    bool fresnel = false;         ///< reflection is multiplied by Fresnel's term of `ior`
    bool smooth = true;           ///< interpolate normals if the mesh has them
    std::optional<Absorption> absorption = {};
    // Of meshes only:
    std::optional<ImageMap> emission_map = {};  ///< times `emission`; the surface must be opaque
    std::optional<Coverage> coverage = {};
    std::optional<Gloss> gloss = {};  ///< the surface must be opaque
    std::optional<NormalMap> normal_map = {};
};

/// Does no light pass through it?
inline bool opaque(const Material& m) { return m.opacity >= 1 && !m.coverage; }

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
    std::vector<float> alphas = {};                    ///< [0, 1], of Material::coverage
    std::vector<Tangent> tangents = {};                ///< needed by normal maps
    std::vector<std::array<Index, 3>> triangles = {};  ///< into positions
    Index material = no_index;                         ///< into Scene::materials
};

/// A mesh placed in the world. Several instances may share one mesh.
struct Instance {
    std::string name = {};
    Index mesh = 0;         ///< into Scene::meshes
    Matrix transform = {};  ///< mesh to world; affine, invertible, any handedness
};

struct Sphere {
    std::string name = {};
    Vec3 center = Vec3(0);
    double radius = 1;
    Index material = no_index;
};

/// Infinite, two-sided.
struct Plane {
    std::string name = {};
    Vec3 point = Vec3(0);
    Vec3 normal = {0, 1, 0};  ///< need not be unit
    Index material = no_index;
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
};

/// An image of the whole sky in place of Scene::background: longitude runs to the right and
/// latitude up, the middle of the image lies in -z, its top in +y (equirectangular).
struct Sky {
    Index texture = no_index;
    double gain = 1;
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
    std::optional<Sky> sky = {};
    Color ambient = Color(1);  ///< Ia, the global lighting constant
};

/// How a scene is turned into a picture; the same for the tracer and for POV-Ray.
struct RenderOptions {
    int width = 800, height = 600;  ///< pixels
    int samples = 1;      ///< 1: the pixel's centre; n > 1: n x n grid and the centre once more
    int max_depth = 5;    ///< ray segments along a path, the primary one included
    double exposure = 0;  ///< EV: light, ambience, emission and background are scaled by 2^EV
    int threads = 0;      ///< 0: as many as the machine has
};

/// An axis-aligned box; empty while min > max.
struct Bounds {
    Vec3 min = Vec3(1e300), max = Vec3(-1e300);
    bool empty() const { return !(min.x <= max.x); }
    void extend(const Vec3& p);
    Vec3 center() const { return (min + max) * 0.5; }
    double radius() const { return empty() ? 0 : (max - min).length() * 0.5; }
};

/// World-space bounds of all facets and spheres (not planes).
Bounds bounds(const Scene& scene);

/// Number of facets after instancing.
std::size_t facet_count(const Scene& scene);

/// Every broken rule in `scene`, one sentence each; empty when it may be rendered: indices in
/// range, numbers finite, per-vertex vectors of equal length, invertible transforms, sane cameras.
[[nodiscard]] std::vector<std::string> defects(const Scene& scene);

/// Gives a scene what a picture needs and its author left out: a material for everything without
/// one, a camera framed on the bounds from front-right-above, and, when it has no light, a rig of
/// three sources sized to the bounds. `aspect` is width / height.
void complete(Scene& scene, double aspect);

/// Gives `mesh` the tangents that a normal map at `map` needs: per vertex, in the direction in
/// which u' of the map grows. The bitangent points to where v' grows, that is up in the image, as
/// green does in glTF's normal maps, whose v runs down but whose y is up (glTF 2.0, section 3.9.3).
/// Weighs facets by their angle at the vertex, as MikkTSpace does; vertices where facets of both
/// handednesses meet are split. A mesh without normals gets those of its facets first, each facet
/// then having vertices of its own. Does nothing to a mesh without texture coordinates.
void compute_tangents(Mesh& mesh, const ImageMap& map);

/// How far bake_normal_maps() goes.
struct NormalMapBudget {
    std::size_t facets = 500000;  ///< that all meshes with normal maps may have together
    /// Radians. Facets whose interpolated normals are this near to the map's, in the quadratic mean
    /// over the facet, are not divided further.
    double tolerance = 0.01;
};

/// Turns normal maps into vertex normals, which POV-Ray knows: divides the facets of every mesh
/// whose material has one, those with the largest error first, until the budget is reached. Facets
/// are halved on both sides of an edge, so that no cracks open. Normals become the perturbed ones,
/// normalize(scale x T + scale y B + z N), and the other vertex data are interpolated; tangents are
/// not kept. Computes missing tangents and, for flat facets, normals. No material has a normal map
/// afterwards. The losses say, for each material, what was reached.
/// Precondition: defects(scene) finds nothing in meshes, materials and textures.
Losses bake_normal_maps(Scene& scene, const NormalMapBudget& budget = {});

/// Removes all normal maps; a loss for each material.
Losses drop_normal_maps(Scene& scene);

/// Of opaque facets that lie exactly on one another leaves the first: which of them a ray hits
/// would be a matter of rounding. Meshes that several instances share stay whole. Returns how many
/// went.
std::size_t drop_coincident_facets(Scene& scene);

// ---- what the tracer and the exporters share --------------------------------------------------

/// A scene in the units that both renderers work in. POV-Ray's tolerances are absolute, so all
/// lengths are multiplied by one power of two that brings the radius of the bounded geometry into
/// [8, 16); a scene far from the origin (more than 64 radii) is moved there first.
/// Meshes are rescaled by powers of two so that their instances have a scale near 1. Exposure
/// is folded into lights, ambience, emission and background. Material::color is multiplied into
/// the texture (16 bit linear) where POV-Ray cannot layer it: metallic, emissive and translucent
/// surfaces.
struct NormalisedScene {
    Scene scene = {};
    double factor = 1;        ///< user's length * factor = length here
    Vec3 offset = {0, 0, 0};  ///< subtracted, in the user's units, before scaling
};

/// Precondition: defects(scene).empty().
NormalisedScene normalise(Scene scene, const RenderOptions& options);

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

/// The virtual sources of `light`, in a fixed order.
std::vector<Source> virtual_sources(const Light& light);

/// Where `map` is looked up at the mesh's texture coordinates `uv`.
inline Vec2 map_texcoord(const ImageMap& map, const Vec2& uv) {
    const auto& t = map.transform;
    return {t[0] * uv.x + t[1] * uv.y + t[2], t[3] * uv.x + t[4] * uv.y + t[5]};
}

/// A coverage that is at least this counts as the cutoff: equal numbers must not be told apart by
/// their last bit.
inline double cutoff_threshold(float cutoff) { return double(cutoff) - 1e-6; }

/// Texture coordinates of a Sky in the unit direction `d`.
Vec2 sky_texcoord(const Vec3& d);

/// Texture coordinates of a sphere at the unit vector `p` from its centre: longitude and latitude,
/// readable from outside; the left edge of the image is at +x and it runs towards -z.
Vec2 sphere_texcoord(const Vec3& p);

/// Texture coordinates of a plane: ((p - origin).u, (p - origin).v) / ImageMap::size. On a floor u
/// is +x and v is -z; on a wall v is up.
struct PlaneFrame {
    Vec3 origin = Vec3(0), normal = Vec3(0), u = Vec3(0), v = Vec3(0);  ///< unit, perpendicular
};
PlaneFrame plane_frame(const Plane& plane);

/// The camera's picture plane as POV-Ray's camera vectors: the ray through the point (u, v) of the
/// picture, u right and v up in [-1/2, 1/2], starts at location with direction
/// direction + u right + v up (perspective), or at location + u right + v up with direction
/// `direction` (orthographic).
struct View {
    bool orthographic = false;
    Vec3 location = Vec3(0), right = Vec3(0), up = Vec3(0), direction = Vec3(0);
};
View view_of(const Camera& camera, int width, int height);

/// Phong terms that imitate a glTF metallic-roughness surface; `base` is its base colour and `f0`
/// the dielectric reflectance at normal incidence (0.04 for ior 1.5). An approximation: a least
/// squares fit of the Phong lobe to GGX. Sets diffuse, specular, shininess, metallic, reflection.
void set_metallic_roughness(Material& material, float metallic, float roughness, float f0 = 0.04F);

}  // namespace penumbra
