#include "scene/check_options.h"
#include "scene/objects.h"
#include "scene/scene_bulk.h"
#include "scene/texture/image_maps.h"
#include "scene/transforms.h"
#include "scene/view.h"
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/light_model.h"
#include "penumbra/prepare.h"
#include "penumbra/scene.h"

#include <cmath>
#include <numeric>
#include <utility>

using namespace penumbra;

namespace {

Scene one_sphere(double radius, Vec3 center = Vec3(0)) {
    Scene scene = test::empty_scene();
    scene.spheres = {{"ball", center, radius, 0}};
    return scene;
}

}  // namespace

TEST_CASE("bounds, hold facets in world space and spheres but not planes") {
    Scene scene = one_sphere(1, {5, 0, 0});
    scene.planes = {{"floor", {0, -100, 0}, {0, 1, 0}, 0}};
    test::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    scene.instances[0].transform.setTranslation(Vec3(0, 0, -7));
    const Bounds box = bounds(scene);
    CHECK(box.min == Vec3(0, -1, -7));
    CHECK(box.max == Vec3(6, 1, 1));
    CHECK(facet_count(scene) == 2);
}

TEST_CASE("bounds, of nothing are empty") {
    CHECK(bounds(test::empty_scene()).empty());
    CHECK(bounds(test::empty_scene()).radius() == 0);
}

TEST_CASE("normalise, brings the radius to at least 128 and below 256 by a power of two") {
    const double radius = GENERATE(1e-4, 0.06, 1.0, 4.9, 77.0, 3e5);
    const NormalisedScene n = normalise(one_sphere(radius), {});
    const double scaled = bounds(n.scene).radius();
    CHECK(scaled >= 128);
    CHECK(scaled < 256);
    CHECK(std::exp2(std::round(std::log2(n.factor))) == n.factor);
    CHECK(n.scene.spheres[0].radius == radius * n.factor);
    CHECK(n.offset == Vec3(0));
}

TEST_CASE("normalise, moves what is far from the origin and scales all lengths along") {
    Scene scene = one_sphere(0.5, {1000, 0, 0});
    Light light = {.position = {1000, 3, 0}};
    light.attenuation = Attenuation{.distance = 2, .power = 2};
    light.penumbra.delta = 0.1;
    scene.lights = {light};
    scene.materials[0].pattern = Checker{.size = 0.25, .origin = {0, 0, 0}};
    const NormalisedScene n = normalise(scene, {});
    CHECK(n.offset == Vec3(1000, 0, 0));
    CHECK(n.scene.spheres[0].center == Vec3(0));
    CHECK(n.scene.lights[0].position == Vec3(0, 3 * n.factor, 0));
    CHECK(n.scene.lights[0].attenuation->distance == 2 * n.factor);
    CHECK(n.scene.lights[0].penumbra.delta == 0.1 * n.factor);
    CHECK(std::get<Checker>(n.scene.materials[0].pattern).size == 0.25 * n.factor);
    CHECK(std::get<Checker>(n.scene.materials[0].pattern).origin.x == -1000 * n.factor);
}

TEST_CASE("normalise, gives an instanced mesh vertices near world scale and moves no point") {
    Scene scene = test::empty_scene();
    test::add_quad(scene, {0, 0, 0}, {1000, 0, 0}, {1000, 1000, 0}, {0, 1000, 0});
    scene.instances[0].transform.setScale(0.001);
    const Bounds before = bounds(scene);
    const NormalisedScene n = normalise(scene, {});
    const Bounds after = bounds(n.scene);
    CHECK((after.max / n.factor - before.max).length() < 1e-12);
    const double scale = std::cbrt(std::abs(n.scene.instances[0].transform.determinant()));
    CHECK(scale > 0.6);
    CHECK(scale < 1.5);
}

TEST_CASE("normalise, folds exposure into everything that shines") {
    Scene scene = one_sphere(1);
    scene.lights = {{.intensity = 3}};
    scene.background = Color(0.25F);
    scene.materials[0].emission = Color(0.5F);
    const NormalisedScene n = normalise(scene, {.exposure = 1});
    CHECK(n.scene.lights[0].intensity == 6);
    CHECK(n.scene.background == Color(0.5F));
    CHECK(n.scene.materials[0].emission == Color(1));
    CHECK(n.scene.ambient == Color(2));
}

TEST_CASE("virtual sources, of the axes pattern stand at the source and at +-delta") {
    Light light = {.position = {1, 2, 3}, .intensity = 14};
    light.penumbra.delta = 0.5;
    const auto sources = virtual_sources(light);
    REQUIRE(sources.size() == 7);
    CHECK(sources[0].position == Vec3(1, 2, 3));
    CHECK(sources[1].position == Vec3(1.5, 2, 3));
    CHECK(sources[2].position == Vec3(0.5, 2, 3));
    CHECK(sources[5].position == Vec3(1, 2, 3.5));
    CHECK(sources[6].position == Vec3(1, 2, 2.5));
    for (const Source& s : sources) CHECK(s.color == Color(2));
}

TEST_CASE("virtual sources, of a sharp light are the light itself") {
    const auto sources = virtual_sources({.position = {1, 2, 3}, .intensity = 5});
    REQUIRE(sources.size() == 1);
    CHECK(sources[0].color == Color(5));
}

TEST_CASE("virtual sources, of the sphere pattern fill the ball evenly") {
    Light light;
    light.penumbra = {.delta = 2, .layout = Penumbra::Layout::sphere, .count = {500, 1}};
    Vec3 mean(0);
    int inner = 0;
    for (const Source& s : virtual_sources(light)) {
        CHECK(s.position.length() <= 2 + 1e-12);
        mean += s.position / 500.0;
        inner += s.position.length() < 2 * std::cbrt(0.5);
    }
    CHECK(mean.length() < 0.05);
    CHECK(inner == Approx(250).margin(15));  // half of the ball's volume holds half of the points
}

TEST_CASE("virtual sources, of the grid pattern span a square that faces its target") {
    Light light = {.position = {0, 4, 0}};
    light.penumbra = {.delta = 1, .layout = Penumbra::Layout::grid, .count = {4, 2}};
    const auto sources = virtual_sources(light);
    REQUIRE(sources.size() == 8);
    Vec3 sum(0);
    for (const Source& s : sources) {
        CHECK(s.position.y == Approx(4));
        CHECK(std::abs(s.position.x) <= 1);
        CHECK(std::abs(s.position.z) <= 1);
        sum += s.position - light.position;
    }
    CHECK(sum.length() < 1e-12);
}

TEST_CASE("view, measures the horizontal field of view and keeps pixels square") {
    Camera camera;
    camera.fov = radians(90);
    const View view = view_of(camera, 200, 100);
    CHECK(view.right.length() == Approx(2));
    CHECK(view.up.length() == Approx(1));
    CHECK(view.right.x > 0);
    CHECK(view.up.y > 0);
    camera.side = Camera::Side::vertical;
    CHECK(view_of(camera, 200, 100).up.length() == Approx(2));
    CHECK(view_of(camera, 200, 100).right.length() == Approx(4));
}

TEST_CASE("camera ray, goes through its point of the picture in unit steps") {
    Camera camera = {.position = {1, 2, 3}};
    camera.fov = radians(90);
    const CameraRay middle = camera_ray(view_of(camera, 200, 100), 0, 0);
    CHECK(middle.origin == camera.position);
    CHECK(middle.direction == Vec3(0, 0, -1));
    const CameraRay right = camera_ray(view_of(camera, 200, 100), 0.5, 0);
    CHECK((right.direction - Vec3(std::sqrt(0.5), 0, -std::sqrt(0.5))).length() < 1e-15);
    const CameraRay corner = camera_ray(view_of(camera, 200, 100), -0.5, 0.5);
    CHECK((corner.direction - Vec3(-1, 0.5, -1).normalized()).length() < 1e-15);

    camera.projection = Camera::Projection::orthographic;
    camera.extent = 4;
    const CameraRay parallel = camera_ray(view_of(camera, 200, 100), -0.5, 0.5);
    CHECK(parallel.origin == Vec3(-1, 3, 3));
    CHECK(parallel.direction == Vec3(0, 0, -1));
}

TEST_CASE("plane frame, lays images upright on walls and away from the viewer on floors") {
    const PlaneFrame floor = plane_frame({"floor", {0, 0, 0}, {0, 2, 0}, 0});
    CHECK(floor.u == Vec3(1, 0, 0));
    CHECK(floor.v == Vec3(0, 0, -1));
    const PlaneFrame wall = plane_frame({"wall", {0, 0, 0}, {0, 0, 1}, 0});
    CHECK(wall.u == Vec3(1, 0, 0));
    CHECK(wall.v == Vec3(0, 1, 0));
}

TEST_CASE("defects, are named one by one") {
    Scene scene = one_sphere(-1);
    scene.spheres[0].material = 4;
    scene.lights = {{.name = "lamp", .type = Light::Type::spot, .direction = {0, 0, 0}}};
    scene.cameras[0].up = scene.cameras[0].direction;
    const auto found = defects(scene);
    REQUIRE(found.size() == 4);
    CHECK(found[0] == "sphere 'ball' has a radius that is not positive");
    CHECK(found[1] == "sphere 'ball' refers to material 4 of 1");
    CHECK(found[2] == "light 'lamp' has a direction of length zero");
    CHECK(found[3] == "camera 'eye' looks along its up vector or nowhere");
    CHECK(defects(one_sphere(1)).empty());
}

TEST_CASE("defects, name images that are not whole") {
    Scene scene = one_sphere(1);
    scene.textures = {{.name = "none"}, {.name = "cut"}, {.name = "whole"}};
    for (const std::size_t i : {1U, 2U})
        scene.textures[i].raster = {.width = 2, .height = 1, .channels = 3, .depth = Depth::u16};
    scene.textures[1].raster.data.resize(11);
    scene.textures[2].raster.data.resize(12);
    CHECK(defects(scene) ==
          std::vector<std::string>{"texture 'none' has no image, or not all of it",
                                   "texture 'cut' has no image, or not all of it"});
}

TEST_CASE("defects, call the parts of a material as the documents do") {
    Scene scene = one_sphere(1);
    Material& m = scene.materials[0];
    m.name = "leaf";
    m.opacity = 0.5F;
    m.alpha_map = AlphaMap{.map = {.texture = 7}};
    m.specular_lobes = SpecularLobes{.color = {.texture = 8}, .level = {.texture = 9}, .lobes = {}};
    CHECK(defects(scene) ==
          std::vector<std::string>{
              "material 'leaf' refers to a missing texture for its alpha map",
              "material 'leaf' refers to a missing texture for its specular lobes' colour",
              "material 'leaf' refers to a missing texture for its specular lobes' level",
              "material 'leaf' has 0 specular lobes, not 1 to 32",
              "material 'leaf' is translucent and has specular lobes, which need it opaque"});
}

TEST_CASE("objects, are instances, then spheres, then planes") {
    Scene scene = one_sphere(1);
    scene.materials.resize(4);
    test::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 2);
    scene.instances = {{.name = "own", .mesh = 0}, {.name = "", .mesh = 0}};
    scene.spheres[0].material = 3;
    scene.planes = {{"floor", {0, 0, 0}, {0, 1, 0}, 1}};
    REQUIRE(object_count(scene) == 4);
    std::vector<Index> materials;
    std::vector<std::string> names;
    for (Index object = 0; object < 4; ++object) {
        materials.push_back(material_index(scene, object));
        names.push_back(name_of(scene, object));
    }
    CHECK(materials == std::vector<Index>{2, 2, 3, 1});
    CHECK(names == std::vector<std::string>{"own", "mesh", "ball", "floor"});
    CHECK(place_of(scene, 3).kind == ObjectKind::plane);
    CHECK(place_of(scene, 3).index == 0);
}

TEST_CASE("image maps, of a material are all visited and can be changed") {
    Material material;
    std::vector<MapUse> uses;
    const auto note = [&](const ImageMap&, MapUse use) { uses.push_back(use); };
    each_image_map(std::as_const(material), note);
    CHECK(uses.empty());
    material.pattern = ImageMap{.texture = 1};
    material.emission_map = ImageMap{.texture = 2};
    material.alpha_map = AlphaMap{.map = {.texture = 3}};
    material.specular_lobes = SpecularLobes{.color = {.texture = 4}, .level = {.texture = 5}};
    material.normal_map = NormalMap{.map = {.texture = 6}};
    each_image_map(std::as_const(material), note);
    CHECK(uses == std::vector{MapUse::pattern, MapUse::emission, MapUse::alpha, MapUse::lobe_color,
                              MapUse::lobe_level, MapUse::normal});
    each_image_map(material, [](ImageMap& map, MapUse) { map.texture += 10; });
    CHECK(std::get<ImageMap>(material.pattern).texture == 11);
    CHECK(material.emission_map->texture == 12);
    CHECK(material.alpha_map->map.texture == 13);
    CHECK(material.specular_lobes->color.texture == 14);
    CHECK(material.specular_lobes->level.texture == 15);
    CHECK(material.normal_map->map.texture == 16);
}

TEST_CASE("scene, is put back without a copy of its meshes and images") {
    Scene scene = one_sphere(1);
    test::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    scene.textures = {{.name = "wood", .raster = {1, 1, 1, Depth::u8, {std::byte{7}}}}};
    scene.lights = {{.name = "lamp"}};
    scene.sky = Sky{.texture = 0};
    const Mesh* const meshes = scene.meshes.data();
    const std::byte* const samples = scene.textures[0].raster.data.data();
    const Scene kept = without_bulk(scene);
    CHECK(kept.meshes.empty());
    CHECK(kept.textures[0].raster.data.empty());

    scene.textures[0].bilinear = false;
    scene.textures.push_back(scene.textures[0]);
    scene.materials[0].diffuse = 0;
    scene.spheres.clear();
    scene.lights.clear();
    scene.sky.reset();
    scene.camera = no_index;
    restore_all_but_bulk(scene, kept);
    CHECK(scene.meshes.data() == meshes);
    REQUIRE(scene.textures.size() == 1);
    CHECK(scene.textures[0].bilinear);
    CHECK(scene.textures[0].name == "wood");
    CHECK(scene.textures[0].raster.data.data() == samples);
    CHECK(scene.materials[0].diffuse == 1);
    CHECK(scene.spheres.size() == 1);
    CHECK(scene.lights.size() == 1);
    CHECK(scene.sky.has_value());
    CHECK(scene.camera == 0);
}

TEST_CASE("transforms, scale lengths by the mean of their axes") {
    Matrix transform;
    transform.setScale(Vec3(2, -4, 1));
    CHECK(mean_scale(transform) == Approx(2));
    CHECK(finite(transform));
    transform[3][1] = std::nan("");
    CHECK_FALSE(finite(transform));
}

TEST_CASE("render options, without a picture are an error of usage") {
    const auto message = [](const RenderOptions& options) {
        return test::message_of([&] { normalise(one_sphere(1), options); });
    };
    CHECK(message({}).empty());
    CHECK(message({.width = 1, .height = 1, .samples = 1, .max_depth = 1}).empty());
    CHECK(message({.width = 0, .height = 600}) ==
          "a picture must have at least 1 x 1 pixels, not 0 x 600");
    CHECK(message({.width = 800, .height = -1}) ==
          "a picture must have at least 1 x 1 pixels, not 800 x -1");
    CHECK(message({.samples = 0}) == "a picture must have at least 1 sample a pixel, not 0");
    CHECK(message({.samples = 256}).empty());
    CHECK(message({.samples = 2'000'000'000}) ==
          "a picture must have at most 256 x 256 samples a pixel, not 2000000000 x 2000000000");
    CHECK(message({.antialiasing = Antialiasing{.threshold = -1}}) ==
          "the threshold of anti-aliasing must be at least 0, not -1");
    CHECK(message({.antialiasing = Antialiasing{.depth = 10}}) ==
          "the depth of anti-aliasing must be from 1 to 9, not 10");
    CHECK(message({.max_depth = 0}) == "a path must have at least 1 ray segment, not 0");
    try {
        check({.width = 0});
        FAIL("nothing was thrown");
    } catch (const Error& error) {
        CHECK(error.failure == Failure::usage);
    }
}

TEST_CASE("drop_coincident_facets, leaves the last of facets that lie on one another") {
    Scene scene = test::empty_scene();
    Mesh mesh{.name = "sheet", .material = 0};
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {2, 0, 1}};
    scene.meshes = {mesh, mesh};
    scene.instances = {{.name = "a", .mesh = 0}, {.name = "b", .mesh = 1}};
    scene.instances[1].transform[3][0] = 1e-3;
    CHECK(drop_coincident_facets(scene) == 2);  // each mesh's own third facet
    CHECK(scene.meshes[0].triangles.size() == 2);
    scene.instances[1].transform[3][0] = 0;
    CHECK(drop_coincident_facets(scene) == 2);
    CHECK(scene.meshes[0].triangles.empty());
    CHECK(scene.meshes[1].triangles.size() == 2);

    SECTION("where another instance wants the mesh whole, from a copy") {
        scene.meshes[0] = scene.meshes[1];
        scene.instances.push_back({.name = "c", .mesh = 0});
        scene.instances[2].transform[3][1] = 5;
        CHECK(drop_coincident_facets(scene) == 2);
        REQUIRE(scene.meshes.size() == 3);
        CHECK(scene.meshes[0].triangles.size() == 2);
        CHECK(scene.meshes[1].triangles.size() == 2);
        CHECK(scene.meshes[2].triangles.empty());
        CHECK(scene.instances[0].mesh == 2);
        CHECK(scene.instances[1].mesh == 1);
        CHECK(scene.instances[2].mesh == 0);
    }
    SECTION("of a mesh that is shown twice in one place, from one copy") {
        scene.instances[0].mesh = 1;
        CHECK(drop_coincident_facets(scene) == 2);
        CHECK(scene.meshes[scene.instances[0].mesh].triangles.empty());
        CHECK(scene.meshes[scene.instances[1].mesh].triangles.size() == 2);
    }
    SECTION("or light passes through them") {
        scene.meshes[0] = scene.meshes[1];
        scene.materials[0].opacity = 0.5F;
        CHECK(drop_coincident_facets(scene) == 0);
    }
}
