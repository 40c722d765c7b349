// What a sidecar may say, key by key.
#include "support/support.h"

#include "penumbra/image.h"
#include "penumbra/importers.h"
#include "penumbra/light_model.h"

using namespace penumbra;

namespace {

// The scene of a sidecar with this text, called studio.toml.
Imported load(const std::string& text) {
    const test::TempDir folder;
    return load_scene({test::write(folder / "studio.toml", text)});
}

Material material(const std::string& keys) {
    const Imported result = load("[material.m]\n" + keys + "\n[[sphere]]\nmaterial = \"m\"\n");
    return result.scene.materials.at(result.scene.spheres.at(0).material);
}

Light light(const std::string& keys) {
    return load("[[light]]\n" + keys + "\n[[sphere]]\n").scene.lights.at(0);
}

Camera camera(const std::string& keys) {
    const Scene scene = load("[camera]\n" + keys + "\n[[sphere]]\n").scene;
    return scene.cameras.at(scene.camera);
}

bool near(const Vec3& a, const Vec3& b) { return (a - b).length() < 1e-9; }

}  // namespace

TEST_CASE("[render] and [lighting] set what a picture is made with") {
    const Imported result = load(R"(
        [render]
        size = [320, 240]
        samples = 3
        max_depth = 7
        background = [0.1, 0.2, 0.3]
        exposure = -1.5
        [lighting]
        ambient = [0.5, 0.25, 2]
    )");
    CHECK(result.render.width == 320);
    CHECK(result.render.height == 240);
    CHECK(result.render.samples == 3);
    CHECK(result.render.max_depth == 7);
    CHECK(result.render.exposure == -1.5);
    CHECK_FALSE(result.auto_exposure);
    CHECK(result.scene.background == Color(0.1F, 0.2F, 0.3F));
    CHECK(result.scene.ambient == Color(0.5F, 0.25F, 2));
    CHECK(load("[lighting]\nambient = 0.5").scene.ambient == Color(0.5F));
}

TEST_CASE("[render] says where rays go through a pixel") {
    CHECK_FALSE(load("[[sphere]]").sampled);
    const Imported fixed = load("[render]\nsamples = 1");
    CHECK(fixed.sampled);
    CHECK_FALSE(fixed.render.antialiasing);
    const Imported adaptive = load("[render]\nantialias = 0.25");
    CHECK(adaptive.sampled);
    REQUIRE(adaptive.render.antialiasing);
    CHECK(adaptive.render.antialiasing->threshold == 0.25);
    CHECK(adaptive.render.antialiasing->depth == 2);
    const Imported deep = load("[render]\nantialias_depth = 5");
    REQUIRE(deep.render.antialiasing);
    CHECK(deep.render.antialiasing->threshold == 0.2);
    CHECK(deep.render.antialiasing->depth == 5);
}

TEST_CASE("backdrop marks spheres and planes that the picture is not of") {
    const Scene scene = load("[[sphere]]\nbackdrop = true\n[[sphere]]\ncenter = [2, 0, 0]\n"
                             "[[plane]]\n[[plane]]\npoint = [0, 1, 0]\nbackdrop = true")
                            .scene;
    REQUIRE(scene.spheres.size() == 2);
    REQUIRE(scene.planes.size() == 2);
    CHECK(scene.spheres[0].backdrop);
    CHECK_FALSE(scene.spheres[1].backdrop);
    CHECK_FALSE(scene.planes[0].backdrop);
    CHECK(scene.planes[1].backdrop);
}

TEST_CASE("[camera] places a camera of its own and makes it the active one") {
    const Camera given =
        camera("position = [1, 2, 6]\nlook_at = [1, 2, 0]\nup = [1, 0, 0]\nfov = 50");
    CHECK(given.name == "sidecar");
    CHECK(given.position == Vec3(1, 2, 6));
    CHECK(near(given.direction.normalized(), {0, 0, -1}));
    CHECK(given.up == Vec3(1, 0, 0));
    CHECK(given.projection == Camera::Projection::perspective);
    CHECK(given.side == Camera::Side::horizontal);
    CHECK(given.fov == Approx(radians(50)));

    const Camera flat = camera("position = [0, 0, 9]\nlook_at = [0, 0, 0]\northographic = 4.5");
    CHECK(flat.projection == Camera::Projection::orthographic);
    CHECK(flat.extent == 4.5);
}

TEST_CASE("[camera] without look_at looks at the middle of the scene") {
    CHECK(near(camera("position = [0, 0, 7]").direction.normalized(), {0, 0, -1}));
}

TEST_CASE("[camera] without a position is framed with the field of view that it names") {
    const Camera narrow = camera("fov = 10"), wide = camera("fov = 90");
    CHECK(narrow.fov == Approx(radians(10)));
    CHECK(narrow.position.length() > 5 * wide.position.length());
    CHECK(camera("orthographic = 3").extent == 3);
    const Camera aimed = camera("look_at = [0, 1, 0]");
    CHECK(near((aimed.position + aimed.direction), {0, 1, 0}));
}

TEST_CASE("[[light]] says everything about a point light") {
    const Light given = light(R"(
        name = "lamp"
        type = "point"
        position = [3, 5, 4]
        color = [1, 0.5, 0.25]
        intensity = 2.5
        attenuation = { distance = 8, power = 1.5 }
        penumbra = { delta = 0.1, pattern = "sphere", count = 20 }
    )");
    CHECK(given.name == "lamp");
    CHECK(given.type == Light::Type::point);
    CHECK(given.position == Vec3(3, 5, 4));
    CHECK(given.color == Color(1, 0.5F, 0.25F));
    CHECK(given.intensity == 2.5);
    REQUIRE(given.attenuation);
    CHECK(given.attenuation->distance == 8);
    CHECK(given.attenuation->power == 1.5);
    CHECK(given.penumbra.delta == 0.1);
    CHECK(given.penumbra.layout == Penumbra::Layout::sphere);
    CHECK(given.penumbra.count[0] == 20);
    CHECK(virtual_sources(given).size() == 20);
}

TEST_CASE("[[light]] without attenuation and penumbra has none") {
    const Light plain = light("position = [1, 2, 3]");
    CHECK(!plain.attenuation);
    CHECK(plain.penumbra.delta == 0);
    CHECK(virtual_sources(plain).size() == 1);
    CHECK(!light("position = [1, 2, 3]\nattenuation = false\npenumbra = false").attenuation);
}

TEST_CASE("A penumbra of seven axes sources is what a bare delta gives") {
    const Light given = light("position = [1, 2, 3]\npenumbra = { delta = 0.25 }");
    const auto sources = virtual_sources(given);
    REQUIRE(sources.size() == 7);
    CHECK(sources[1].position == Vec3(1.25, 2, 3));
    CHECK(sources[0].color.x == Approx(1.0 / 7));
}

TEST_CASE("A grid penumbra faces the target of its light or its own") {
    const Light own = light("position = [0, 4, 0]\npenumbra = { delta = 1, pattern = \"grid\", "
                            "count = [3, 2], target = [1, 0, 0] }");
    CHECK(own.penumbra.count == std::array<int, 2>{3, 2});
    CHECK(own.penumbra.target == Vec3(1, 0, 0));
    const Light shared = light("position = [0, 4, 0]\ntarget = [0, 1, 0]\npenumbra = { delta = 1, "
                               "pattern = \"grid\", count = 3 }");
    CHECK(shared.penumbra.target == Vec3(0, 1, 0));
    CHECK(shared.penumbra.count == std::array<int, 2>{3, 3});
}

TEST_CASE("A spot light is aimed by a target or a direction") {
    const Light aimed =
        light("type = \"spot\"\nposition = [0, 4, 3]\ntarget = [0, 0, 0]\ninner = 15\nouter = 25");
    CHECK(near(aimed.direction, {0, -0.8, -0.6}));
    CHECK(aimed.inner == Approx(radians(15)));
    CHECK(aimed.outer == Approx(radians(25)));
    const Light turned =
        light("type = \"spot\"\nposition = [0, 4, 0]\ndirection = [0, -9, 0]\nouter = 15");
    CHECK(near(turned.direction, {0, -1, 0}));
    CHECK(turned.inner == Approx(radians(10)));
    CHECK(
        light("type = \"spot\"\nposition = [0, 4, 0]\ndirection = [0, -9, 0]\ninner = 40").outer ==
        Approx(radians(60)));
}

TEST_CASE("A directional light has a direction of length one") {
    const Light sun =
        light("type = \"directional\"\ndirection = [0, -3, -4]\npenumbra.delta = 0.01");
    CHECK(sun.type == Light::Type::directional);
    CHECK(near(sun.direction, {0, -0.6, -0.8}));
    CHECK(sun.penumbra.delta == 0.01);
}

TEST_CASE("[[sphere]] and [[plane]] are placed and named") {
    const Scene scene = load(R"(
        [[sphere]]
        name = "ball"
        center = [1, 2, 3]
        radius = 0.5
        material = "red"
        [[plane]]
        name = "floor"
        point = [0, -1, 0]
        normal = [0, 2, 0]
        material = "red"
        [material.red]
        color = "#ff0000"
    )")
                            .scene;
    CHECK(scene.spheres.at(0).name == "ball");
    CHECK(scene.spheres[0].center == Vec3(1, 2, 3));
    CHECK(scene.spheres[0].radius == 0.5);
    CHECK(scene.materials.at(scene.spheres[0].material).color == Color(1, 0, 0));
    CHECK(scene.planes.at(0).name == "floor");
    CHECK(scene.planes[0].point == Vec3(0, -1, 0));
    CHECK(scene.planes[0].normal == Vec3(0, 2, 0));
    CHECK(scene.planes[0].material == scene.spheres[0].material);
}

TEST_CASE("[material] holds every Phong term") {
    const Material m = material(R"(
        color = [0.9, 0.8, 0.7]
        ambient = [0.1, 0.2, 0.3]
        diffuse = 0.2
        specular = 0.5
        shininess = 60
        metallic = 0.75
        reflection = [0.6, 0.5, 0.4]
        emission = [1, 2, 3]
        opacity = 0.5
        ior = 1.5
        smooth = false
    )");
    CHECK(m.name == "m");
    CHECK(m.color == Color(0.9F, 0.8F, 0.7F));
    CHECK(m.ambient == Color(0.1F, 0.2F, 0.3F));
    CHECK(m.diffuse == 0.2F);
    CHECK(m.specular == 0.5F);
    CHECK(m.shininess == 60);
    CHECK(m.metallic == 0.75F);
    CHECK(m.reflection == Color(0.6F, 0.5F, 0.4F));
    CHECK(m.emission == Color(1, 2, 3));
    CHECK(m.opacity == 0.5F);
    CHECK(m.ior == 1.5F);
    CHECK(!m.smooth);
    CHECK(material("ambient = 0.25\nreflection = 0.5").ambient == Color(0.25F));
    CHECK(material("ambient = 0.25\nreflection = 0.5").reflection == Color(0.5F));
}

TEST_CASE("A material that says nothing is Material's default") {
    const Material m = material("");
    CHECK(m.color == Material{}.color);
    CHECK(m.diffuse == Material{}.diffuse);
    CHECK(m.smooth);
}

TEST_CASE("Colours are linear numbers or sRGB in hexadecimal") {
    CHECK(material("color = [0, 0.5, 12]").color == Color(0, 0.5F, 12));
    CHECK(material("color = \"#FF8000\"").color == Color(1, srgb_to_linear(128 / 255.0F), 0));
    const Color grey = material("color = \"#808080\"").color;
    CHECK(grey.x == Approx(0.21586).epsilon(1e-4));
}

TEST_CASE("A checker and a noise have two colours and a size") {
    const auto checker = std::get<Checker>(
        material("checker = { colors = [\"#ffffff\", [0.1, 0.1, 0.1]], size = 0.5 }").pattern);
    CHECK(checker.colors[0] == Color(1));
    CHECK(checker.colors[1] == Color(0.1F));
    CHECK(checker.size == 0.5);
    const auto noise = std::get<Noise>(
        material("noise = { colors = [[1, 0, 0], [0, 0, 1]], size = 2, octaves = 4 }").pattern);
    CHECK(noise.colors[1] == Color(0, 0, 1));
    CHECK(noise.size == 2);
    CHECK(noise.octaves == 4);
}

TEST_CASE("A texture is read once, with the colour as its factor") {
    const test::TempDir folder;
    Image image(2, 1);
    image.at(0, 0) = Color(1, 0, 0);
    save_image(folder / "wood.png", image);
    const auto file = test::write(folder / "a.toml", R"(
        [material.plain]
        texture = "wood.png"
        [material.tinted]
        color = [0.5, 0.5, 0.5]
        texture = { file = "./wood.png", size = 2 }
        [[plane]]
        material = "tinted"
    )");
    const Scene scene = load_scene({file}).scene;
    REQUIRE(scene.textures.size() == 1);
    CHECK(scene.textures[0].name == "wood");
    CHECK(scene.textures[0].raster.width == 2);
    CHECK(scene.textures[0].srgb);
    const Material& plain = scene.materials.at(0);
    const Material& tinted = scene.materials.at(1);
    CHECK(plain.color == Color(1));
    CHECK(std::get<ImageMap>(plain.pattern).size == 1);
    CHECK(tinted.color == Color(0.5F));
    CHECK(std::get<ImageMap>(tinted.pattern).size == 2);
    CHECK(std::get<ImageMap>(tinted.pattern).texture == 0);
}

TEST_CASE("[material] says which sides of facets are shown") {
    CHECK(material("").sides == Sides::both);
    CHECK(material("sides = \"front\"").sides == Sides::front);
    CHECK(material("sides = \"both\"").sides == Sides::both);
    CHECK(test::message_of([] { material("sides = \"back\""); }).find("\"front\"") !=
          std::string::npos);
}
