#include "prepare/subdivide.h"
#include "scene/normal_map.h"
#include "support/mapped_square.h"
#include "support/support.h"

#include "penumbra/tracer.h"

#include <cmath>
#include <map>
#include <set>

using namespace penumbra;
using test::angle, test::bumps, test::map_of, test::mapped_square;

namespace {

// The points where a vertex lies within another facet's edge.
std::size_t hanging_vertices(const Mesh& mesh) {
    using Point = std::array<float, 3>;
    const auto point = [&](Index i) {
        const Vec3f& p = mesh.positions[i];
        return Point{p.x, p.y, p.z};
    };
    std::map<std::pair<Point, Point>, int> sides;
    for (const auto& t : mesh.triangles)
        for (unsigned k = 0; k < 3; ++k) ++sides[std::minmax({point(t[k]), point(t[(k + 1) % 3])})];
    std::set<Point> corners;
    for (const auto& t : mesh.triangles)
        for (const Index i : t) corners.insert(point(i));
    std::size_t hanging = 0;
    for (const auto& [side, count] : sides) {
        Point middle;
        for (unsigned k = 0; k < 3; ++k) middle[k] = (side.first[k] + side.second[k]) * 0.5F;
        hanging += corners.count(middle);
    }
    return hanging;
}

double area_of(const Mesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += (Vec3(mesh.positions[b]) - Vec3(mesh.positions[a]))
                   .cross(Vec3(mesh.positions[c]) - Vec3(mesh.positions[a]))
                   .length() /
               2;
    return sum;
}

}  // namespace

// glTF 2.0, section 3.9.3: x is to the right and y up in the image.
TEST_CASE("normal map, bends the normal to the right and up in the image") {
    const Scene scene = mapped_square(map_of(2, [](const Vec2&) { return Vec3(0.6, 0.48, 0.64); }));
    const NormalMap& map = *scene.materials[0].normal_map;
    const TextureLookup lookup(scene.textures[0]);
    const Vec3 straight = perturbed_normal(map, lookup, {}, {0.5, 0.5});
    CHECK(angle(straight, {0.6, 0.48, 0.64}) < radians(0.3));
    const Vec3 mirrored = perturbed_normal(map, lookup, {.handedness = -1}, {0.5, 0.5});
    CHECK(angle(mirrored, {0.6, -0.48, 0.64}) < radians(0.3));
    const Vec3 scaled = perturbed_normal({.map = map.map, .scale = 0.5F}, lookup, {}, {0.5, 0.5});
    CHECK(angle(scaled, {0.3, 0.24, 0.64}) < radians(0.3));
}

TEST_CASE("subdivision, leaves no vertex on another facet's edge") {
    // Two squares that meet at a seam with other texture coordinates, and a third upright on it.
    Mesh mesh = {.positions = {{0, 0, 0},
                               {1, 0, 0},
                               {1, 1, 0},
                               {0, 1, 0},
                               {1, 0, 0},
                               {2.5F, 0, 0},
                               {2.5F, 1, 0},
                               {1, 1, 0},
                               {1, 0, 1},
                               {1, 1, 1}},
                 .texcoords = std::vector<Vec2f>(10, Vec2f(0)),
                 .triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {7, 4, 6}, {1, 2, 8}, {8, 2, 9}}};
    mesh.texcoords[4] = {7, 7};
    Subdivision subdivision(mesh);
    std::vector<Index> changed;
    for (Index i = 0; i < 300; ++i) {
        const auto count = subdivision.mesh().triangles.size();
        subdivision.divide(Index((i * 7919) % count), changed);
        REQUIRE(subdivision.mesh().triangles.size() > count);
    }
    CHECK(hanging_vertices(subdivision.mesh()) == 0);
    CHECK(area_of(subdivision.mesh()) == Approx(area_of(mesh)));
    CHECK(subdivision.mesh().texcoords.size() == subdivision.mesh().positions.size());
}

TEST_CASE("subdivision, keeps the vertices of a seam apart") {
    Scene scene = mapped_square(map_of(4, bumps));
    Mesh mesh = {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                 .texcoords = {{0, 0}, {0, 0}, {0, 0}, {1, 1}, {1, 1}, {1, 1}},
                 .triangles = {{0, 1, 2}, {3, 5, 4}}};
    Subdivision subdivision(mesh);
    std::vector<Index> changed;
    subdivision.divide(0, changed);  // the diagonal, which both share
    CHECK(changed.size() == 4);
    REQUIRE(subdivision.mesh().positions.size() == 8);
    CHECK(subdivision.mesh().positions[6] == subdivision.mesh().positions[7]);
    CHECK(subdivision.mesh().texcoords[6] == Vec2f(0));
    CHECK(subdivision.mesh().texcoords[7] == Vec2f(1));
}

TEST_CASE("baked normals, are the map's within the tolerance") {
    Scene scene = mapped_square(map_of(64, bumps));
    NormalMapBudget budget;
    budget.tolerance = GENERATE(0.02, 0.005);
    const Losses losses = bake_normal_maps(scene, budget);
    const Mesh& mesh = scene.meshes[0];
    CHECK(hanging_vertices(mesh) == 0);
    REQUIRE(mesh.normals.size() == mesh.positions.size());
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 center =
            (Vec3(mesh.positions[a]) + Vec3(mesh.positions[b]) + Vec3(mesh.positions[c])) / 3;
        const Vec3 normal(mesh.normals[a] + mesh.normals[b] + mesh.normals[c]);
        const double error = angle(normal, bumps({center.x, center.y}));
        CHECK(error < 3 * budget.tolerance + radians(0.3));  // 8 bits are good for 0.3 degrees
        sum += error;
    }
    CHECK(sum / double(mesh.triangles.size()) < budget.tolerance + radians(0.15));
    CHECK_FALSE(scene.materials[0].normal_map.has_value());
    REQUIRE(losses.size() == 1);
    CHECK(losses[0].place == "matte");
    CHECK(losses[0].what.starts_with(
        "its normal map is baked into vertex normals: 2 facets became "));
}

TEST_CASE("baked normals, keep to the budget") {
    Scene scene = mapped_square(map_of(64, bumps));
    bake_normal_maps(scene, {.facets = 101, .tolerance = 0});
    CHECK(scene.meshes[0].triangles.size() >= 100);
    CHECK(scene.meshes[0].triangles.size() <= 102);
}

TEST_CASE("baked normals, cost nothing where the map is smooth") {
    // Bumps in the left half only.
    Scene scene = mapped_square(
        map_of(64, [](const Vec2& t) { return t.x < 0.5 ? bumps(t * 4.0) : Vec3(0, 0, 1); }));
    scene.textures[0].wrap_u = Wrap::clamp;
    bake_normal_maps(scene, {.facets = 4000});
    std::size_t left = 0, right = 0;
    for (const auto& t : scene.meshes[0].triangles) {
        const Vec3f center = (scene.meshes[0].positions[t[0]] + scene.meshes[0].positions[t[1]] +
                              scene.meshes[0].positions[t[2]]) /
                             3.0F;
        if (center.x < 0.45F) ++left;
        if (center.x > 0.55F) ++right;
    }
    CHECK(left > 20 * right);
}

TEST_CASE("baked normals, share the budget by the area and error of the meshes") {
    Scene scene = mapped_square(map_of(64, bumps));
    scene.meshes.push_back(scene.meshes[0]);
    scene.instances.push_back({.name = "large", .mesh = 1});
    scene.instances[1].transform.makeIdentity();
    scene.instances[1].transform.setScale(3.0);
    bake_normal_maps(scene, {.facets = 5000, .tolerance = 0});
    CHECK(scene.meshes[0].triangles.size() + scene.meshes[1].triangles.size() >= 5000);
    CHECK(scene.meshes[1].triangles.size() > 2 * scene.meshes[0].triangles.size());
    CHECK(scene.meshes[0].triangles.size() > 500);
}

TEST_CASE("baked normals, bake a shared mesh once") {
    Scene scene = mapped_square(map_of(16, bumps));
    scene.instances.push_back({.name = "again", .mesh = 0});
    bake_normal_maps(scene);
    CHECK(scene.meshes.size() == 1);
    CHECK(scene.instances[1].mesh == 0);
}

// POV-Ray draws a facet flat, with its own normal, when its normals are nearly equal.
TEST_CASE("baked normals, are told apart where the map is constant but not straight") {
    Scene scene = mapped_square(map_of(16, [](const Vec2&) { return Vec3(0.3, 0.2, 1); }));
    bake_normal_maps(scene);
    const Mesh& mesh = scene.meshes[0];
    for (const auto& [a, b, c] : mesh.triangles) {
        const double ab = (Vec3(mesh.normals[a]) - Vec3(mesh.normals[b])).length();
        const double ac = (Vec3(mesh.normals[a]) - Vec3(mesh.normals[c])).length();
        CHECK(std::max(ab, ac) > 1.01e-5);
        CHECK(std::max(ab, ac) < 2e-4);
    }
}

TEST_CASE("baked normals, leave a straight map's mesh as it is") {
    Texture map = map_of(4, [](const Vec2&) { return Vec3(0, 0, 1); });
    map.raster.depth = Depth::f32;
    map.raster.data.clear();
    const std::array<float, 3> straight = {0.5F, 0.5F, 1};
    for (int i = 0; i < 16; ++i) {
        const auto* bytes = reinterpret_cast<const std::byte*>(straight.data());
        map.raster.data.insert(map.raster.data.end(), bytes, bytes + sizeof straight);
    }
    Scene scene = mapped_square(map);
    bake_normal_maps(scene);
    CHECK(scene.meshes[0].positions.size() == 4);
    for (const Vec3f& n : scene.meshes[0].normals) CHECK(n == Vec3f(0, 0, 1));
}

TEST_CASE("baked normals, of flat facets start from the facets' own") {
    Scene scene = mapped_square(map_of(16, bumps));
    Mesh& mesh = scene.meshes[0];
    SECTION("of a mesh without normals") { mesh.normals.clear(); }
    SECTION("of a material that does not use them") {
        scene.materials[0].smooth = false;
        mesh.normals.assign(4, Vec3f(0.6F, 0, 0.8F));
    }
    bake_normal_maps(scene);
    CHECK(scene.materials[0].smooth);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3f& p = mesh.positions[i];
        CHECK(angle(Vec3(mesh.normals[i]), bumps({p.x, p.y})) < radians(4));
    }
}

TEST_CASE("baked normals, interpolate colours and texture coordinates") {
    Scene scene = mapped_square(map_of(16, bumps));
    scene.meshes[0].colors = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    bake_normal_maps(scene);
    const Mesh& mesh = scene.meshes[0];
    REQUIRE(mesh.positions.size() > 100);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        CHECK(mesh.texcoords[i].x == mesh.positions[i].x);
        CHECK(mesh.colors[i].y == mesh.positions[i].y);
    }
    CHECK(mesh.tangents.empty());
}

TEST_CASE("baked normals, say of which mesh the map is left out") {
    Scene scene = mapped_square(map_of(16, bumps));
    test::add_quad(scene, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1});
    scene.meshes[1].name = "plain";
    const Losses losses = bake_normal_maps(scene);
    REQUIRE(losses.size() == 2);
    CHECK(losses[0] == Loss{Loss::dropped, "plain",
                            "has no texture coordinates for the normal map of material "
                            "'matte'; it is left out"});
    CHECK(scene.meshes[1].normals.empty());
}

TEST_CASE("dropped normal maps, are a loss of each material") {
    Scene scene = mapped_square(map_of(4, bumps));
    scene.materials.push_back({.name = "other"});
    CHECK(drop_normal_maps(scene) ==
          Losses{{Loss::dropped, "matte", "its normal map is left out"}});
    CHECK_FALSE(scene.materials[0].normal_map.has_value());
    CHECK(scene.meshes[0].triangles.size() == 2);
}

TEST_CASE("the tracer, bends the normal of every pixel as the baked mesh does") {
    Scene scene = mapped_square(map_of(64, bumps));
    scene.materials[0].specular = 0.5F;
    scene.lights = {{.position = {3, 4, 5}}};
    scene.cameras[0].position = {0.5, 0.5, 10};
    scene.cameras[0].projection = Camera::Projection::orthographic;
    scene.cameras[0].extent = 0.9;
    Scene baked = scene;
    bake_normal_maps(baked);
    complete_tangents(scene);
    const RenderOptions options = {.width = 60, .height = 60};
    const Image pixel = render(test::as_is(scene), options);
    const Image vertex = render(test::as_is(baked), options);
    float least = 1, most = 0;
    double sum = 0;
    for (std::size_t i = 0; i < pixel.pixels.size(); ++i) {
        const float error = std::abs(pixel.pixels[i].x - vertex.pixels[i].x);
        CHECK(error < 0.05F);  // in the highlight, which is some degrees wide
        sum += double(error);
        least = std::min(least, pixel.pixels[i].x);
        most = std::max(most, pixel.pixels[i].x);
    }
    CHECK(sum / double(pixel.pixels.size()) < 0.006);
    CHECK(most - least > 0.3F);
}

TEST_CASE("the tracer, draws a mesh without tangents as if it had no normal map") {
    Scene scene = mapped_square(map_of(8, bumps));
    scene.lights = {{.position = {3, 4, 5}}};
    scene.cameras[0].position = {0.5, 0.5, 3};
    SECTION("nor normals") {
        compute_tangents(scene.meshes[0], {.texture = 0});
        scene.meshes[0].normals.clear();
    }
    SECTION("at all") {}
    Scene plain = scene;
    plain.materials[0].normal_map.reset();
    const RenderOptions options = {.width = 20, .height = 15};
    CHECK(render(test::as_is(scene), options).pixels == render(test::as_is(plain), options).pixels);
}
