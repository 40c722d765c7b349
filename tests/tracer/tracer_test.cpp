#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/tracer.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

using namespace penumbra;

namespace {

constexpr int side = 200;

// Looks straight down on the floor y = 0: the pixel at column x shows the floor at
// floor_x(x).
Scene seen_from_above(double width) {
    Scene scene = test::empty_scene();
    scene.planes = {{"floor", {0, 0, 0}, {0, 1, 0}, 0}};
    Camera& camera = scene.cameras[0];
    camera.position = {0, 30, 0};
    camera.direction = {0, -1, 0};
    camera.up = {0, 0, -1};
    camera.projection = Camera::Projection::orthographic;
    camera.extent = width;
    return scene;
}

double floor_x(int column, double width) { return ((column + 0.5) / side - 0.5) * width; }

Image picture(const Scene& scene, RenderOptions options = {}) {
    options.width = options.height = side;
    return render(test::as_is(scene), options);
}

float brightness_in_middle_row(const Image& image, int column) {
    return image.at(column, image.height / 2).x;
}

// A wide wall of the half plane x < 0 at height 1, below a light at height 2.
Scene edge_shadow(double delta) {
    Scene scene = seen_from_above(4);
    test::add_quad(scene, {-40, 1, -40}, {0, 1, -40}, {0, 1, 40}, {-40, 1, 40});
    scene.cameras[0].position.y = 0.5;  // below the wall
    Light light = {.position = {0, 2, 0}};
    light.penumbra.delta = delta;
    scene.lights = {light};
    return scene;
}

}  // namespace

// The light of height 2 is displaced by +-delta along x; by similar triangles the shadow of the
// edge at height 1 moves by -+delta on the floor: umbra for x < -delta, full light for x > delta.
TEST_CASE("penumbra, reaches from -delta to +delta around the shadow of an edge") {
    const double delta = GENERATE(0.0, 0.1, 0.2, 0.5);
    const Image image = picture(edge_shadow(delta));
    Scene open = edge_shadow(delta);
    open.instances.clear();
    const Image lit = picture(open);
    for (int column = 0; column < side; ++column) {
        const double x = floor_x(column, 4);
        const float seen = brightness_in_middle_row(image, column);
        const float full = brightness_in_middle_row(lit, column);
        INFO("x = " << x << ", " << seen << " of " << full);
        if (x < -delta - 0.02) CHECK(seen == 0);
        if (x > delta + 0.02) CHECK(seen == full);
        if (delta > 0 && std::abs(x) < delta - 0.02) {
            CHECK(seen > 0.05F * full);
            CHECK(seen < 0.95F * full);
        }
    }
}

// In the umbra's middle six of the seven virtual sources straddle the edge: those at the source,
// along y and along z are cut at x = 0, and only the one at -delta shines on x > 0 later.
TEST_CASE("penumbra, averages the seven virtual sources") {
    const double delta = 0.5;
    const Image image = picture(edge_shadow(delta));
    Scene open = edge_shadow(delta);
    open.instances.clear();
    const Image lit = picture(open);
    const int left = side / 2 - 12, right = side / 2 + 12;  // x = -+0.24
    // Left of the edge only the source at -x is hidden from no wall: it stands over the wall, so
    // light passes the edge to the left from the source at +x.
    CHECK(brightness_in_middle_row(image, left) / brightness_in_middle_row(lit, left) ==
          Approx(1.0 / 7).epsilon(0.05));
    CHECK(brightness_in_middle_row(image, right) / brightness_in_middle_row(lit, right) ==
          Approx(6.0 / 7).epsilon(0.05));
}

TEST_CASE("diffuse light, is intensity x K_D x cosine x f_a of each source") {
    Scene scene = seen_from_above(8);
    scene.materials[0].diffuse = 0.5F;
    scene.materials[0].ambient = Color(0.25F);
    scene.ambient = Color(0.5F);
    Light light = {.position = {0, 3, 0}, .intensity = 2};
    light.attenuation = Attenuation{.distance = 4, .power = 2};
    scene.lights = {light, light};
    const Image image = picture(scene);
    for (const int column : {0, 50, 100, 199}) {
        const double x = floor_x(column, 8), z = floor_x(side / 2, 8);
        const double d2 = x * x + z * z + 9;
        const double expected = 0.25 * 0.5 + 2 * 2 * 0.5 * (3 / std::sqrt(d2)) * 2 / (1 + d2 / 16);
        CHECK(brightness_in_middle_row(image, column) == Approx(expected).epsilon(1e-6));
    }
}

TEST_CASE("highlight, is K_S cos^N of the mirrored eye ray in the light's colour") {
    Scene scene = seen_from_above(8);
    Material& m = scene.materials[0];
    m.diffuse = 0;
    m.specular = 0.75F;
    m.shininess = 12;
    scene.lights = {{.position = {0, 3, 0}, .color = Color(1, 0.5F, 0.25F)}};
    const Image image = picture(scene);
    for (const int column : {100, 120, 150}) {
        const double x = floor_x(column, 8), z = floor_x(side / 2, 8);
        const double cosine = 3 / std::sqrt(x * x + z * z + 9);  // mirrored ray points up
        const double expected = 0.75 * std::pow(cosine, 12);
        CHECK(image.at(column, side / 2).x == Approx(expected).epsilon(1e-5));
        CHECK(image.at(column, side / 2).z == Approx(expected / 4).epsilon(1e-5));
    }
}

// Sources cast no shadow rays for points that neither scatter nor mirror them to the eye.
TEST_CASE("highlight, is the same on a surface that scatters nothing and one that scatters next to "
          "nothing") {
    Scene scene = seen_from_above(8);
    scene.spheres = {{"ball", {1, 1.5, 0}, 0.7, 0}, {"glass", {-1, 1.5, 0.5}, 0.7, 1}};
    Material glass = test::matte();
    glass.opacity = 0.3F;
    glass.transmission = 1;
    scene.materials.push_back(glass);
    test::add_quad(scene, {-2, 2, -2}, {0, 2, -2}, {0, 2, 0}, {-2, 2, 0}, 1);
    Material& m = scene.materials[0];
    m.specular = 0.75F;
    m.shininess = 25;
    m.coat = Coat{.specular = 0.3F, .shininess = 90, .reflection = 0.04F};
    for (int i = 0; i < 12; ++i)
        scene.lights.push_back(
            {.position = {6 * std::sin(i * 0.9), 3 + 0.4 * i, 6 * std::cos(i * 1.3)}});
    m.diffuse = 0;
    const Image without = picture(scene);
    m.diffuse = 1e-9F;
    const Image with = picture(scene);
    double most = 0, sum = 0;
    for (std::size_t i = 0; i < with.pixels.size(); ++i) {
        most = std::max(most, double(std::abs(with.pixels[i].x - without.pixels[i].x)));
        sum += with.pixels[i].x;
    }
    CHECK(most < 1e-6);
    CHECK(sum > 100);
}

TEST_CASE("spot, falls off by a smoothstep in the cosine between its half-angles") {
    Scene scene = seen_from_above(8);
    scene.lights = {{.type = Light::Type::spot,
                     .position = {0, 3, 0},
                     .direction = {0, -1, 0},
                     .inner = radians(20),
                     .outer = radians(40)}};
    const Image image = picture(scene);
    const double inner = std::cos(radians(20)), outer = std::cos(radians(40));
    for (int column = 100; column < side; column += 7) {
        const double x = floor_x(column, 8), z = floor_x(side / 2, 8);
        const double cosine = 3 / std::sqrt(x * x + z * z + 9);
        const double s = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
        CHECK(brightness_in_middle_row(image, column) ==
              Approx(cosine * s * s * (3 - 2 * s)).margin(1e-6));
    }
}

TEST_CASE("directional light, is the same everywhere") {
    Scene scene = seen_from_above(8);
    scene.lights = {{.type = Light::Type::directional, .direction = {0.6, -0.8, 0}}};
    const Image image = picture(scene);
    for (const Color& pixel : image.pixels) REQUIRE(pixel.x == Approx(0.8).epsilon(1e-6));
}

// A mirror at z = 0 shows the sphere at z = 5 as if it stood at z = -5.
TEST_CASE("mirror, shows an object where its image stands") {
    Scene scene = test::empty_scene();
    scene.materials.push_back({.name = "mirror",
                               .ambient = Color(0),
                               .diffuse = 0,
                               .specular = 0,
                               .reflection = Color(0.5F)});
    scene.materials.push_back(
        {.name = "glow", .ambient = Color(0), .diffuse = 0, .specular = 0, .emission = Color(1)});
    scene.planes = {{"mirror", {0, 0, 0}, {0, 0, 1}, 1}};
    scene.spheres = {{"ball", {3, 0, 5}, 1, 2}};
    Scene unfolded = scene;
    unfolded.planes.clear();
    unfolded.spheres[0].center.z = -5;
    const Image reflected = picture(scene), direct = picture(unfolded);
    int seen = 0;
    for (int column = 0; column < side * 2 / 3; ++column) {
        const float image = brightness_in_middle_row(reflected, column);
        CHECK(image == 0.5F * brightness_in_middle_row(direct, column));
        seen += image > 0;
    }
    for (int column = side * 2 / 3; column < side; ++column)
        seen += brightness_in_middle_row(reflected, column) == 0.5F;
    CHECK(seen > 0);
}

// Between facing mirrors of coefficient 1/2 that glow with 1 a path of n segments sums the
// geometric series 1 + 1/2 + ... + 1/2^(n-1).
TEST_CASE("recursion, ends after max_depth segments") {
    Scene scene = test::empty_scene();
    scene.materials[0] = {.name = "mirror",
                          .ambient = Color(0),
                          .diffuse = 0,
                          .specular = 0,
                          .reflection = Color(0.5F),
                          .emission = Color(1)};
    scene.planes = {{"front", {0, 0, 0}, {0, 0, 1}, 0}, {"back", {0, 0, 11}, {0, 0, 1}, 0}};
    const int depth = GENERATE(1, 2, 3, 5, 10);
    const Image image = picture(scene, {.max_depth = depth});
    CHECK(image.at(side / 2, side / 2).x == Approx(2 - std::exp2(1 - depth)));
}

TEST_CASE("facets and planes, look the same from both sides") {
    Scene scene = test::empty_scene();
    test::add_quad(scene, {-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0});
    scene.lights = {{.position = {1, 2, 10}}};
    const Image front = picture(scene);
    for (auto& t : scene.meshes[0].triangles) std::swap(t[0], t[1]);
    CHECK(picture(scene).pixels == front.pixels);

    Scene plane = test::empty_scene();
    plane.planes = {{"wall", {0, 0, 0}, {0, 0, 1}, 0}};
    plane.lights = scene.lights;
    const Image wall = picture(plane);
    plane.planes[0].normal = {0, 0, -1};
    CHECK(picture(plane).pixels == wall.pixels);
    CHECK(front.at(side / 2, side / 2).x == Approx(wall.at(side / 2, side / 2).x));
}

TEST_CASE("opacity, lets light and sight through and needs no more depth") {
    Scene scene = seen_from_above(8);
    scene.lights = {{.position = {0, 20, 0}}};
    const float full = picture(scene).at(side / 2, side / 2).x;
    scene.materials.push_back({.name = "film",
                               .color = Color(0),
                               .ambient = Color(0),
                               .diffuse = 0,
                               .specular = 0,
                               .opacity = 0.25F});
    for (int sheet = 0; sheet < 3; ++sheet)
        test::add_quad(scene, {-9, 1.0F + float(sheet), -9}, {9, 1.0F + float(sheet), -9},
                       {9, 1.0F + float(sheet), 9}, {-9, 1.0F + float(sheet), 9}, 1);
    // Sight passes 3 sheets, light 3 more times: (3/4)^6.
    CHECK(picture(scene, {.max_depth = 2}).at(side / 2, side / 2).x ==
          Approx(full * std::pow(0.75, 6)).epsilon(1e-5));
}

TEST_CASE("refraction, bends by Snell's law and counts as a segment") {
    Scene scene = test::empty_scene();
    scene.materials[0].opacity = 0;
    scene.materials[0].diffuse = 0;
    scene.materials[0].ior = 1.5F;
    scene.materials.push_back(
        {.name = "glow", .ambient = Color(0), .diffuse = 0, .specular = 0, .emission = Color(1)});
    // A ray enters water below z = 0 at x = 4 with tangent 4/10 and falls on z = -5.
    const double sine = 0.4 / std::sqrt(1.16) / 1.5;
    const double landing = 4 + 5 * sine / std::sqrt(1 - sine * sine);
    scene.planes = {{"water", {0, 0, 0}, {0, 0, 1}, 0}};
    const auto x = float(landing);
    test::add_quad(scene, {x, -9, -5}, {x + 9, -9, -5}, {x + 9, 9, -5}, {x, 9, -5}, 1);
    scene.cameras[0].direction = {4, 0, -10};
    scene.cameras[0].fov = radians(0.5);
    const Image image = picture(scene);
    CHECK(brightness_in_middle_row(image, side / 2 - 4) == 0);
    CHECK(brightness_in_middle_row(image, side / 2 + 4) == 1);
    const Image shallow = picture(scene, {.max_depth = 1});
    CHECK(brightness_in_middle_row(shallow, side / 2 + 4) == 0);
}

TEST_CASE("checker, alternates in cubes of its size from its origin") {
    Scene scene = seen_from_above(8);
    scene.materials[0].pattern =
        Checker{.colors = {Color(1), Color(0.25F)}, .size = 2, .origin = {0.5, 0, 0}};
    scene.materials[0].ambient = Color(1);
    const Image image = picture(scene);
    const auto at = [&](double x, double z) {
        return image.at(int((x / 8 + 0.5) * side), int((z / 8 + 0.5) * side)).x;
    };
    CHECK(at(1, 1) == 1);
    CHECK(at(3, 1) == 0.25F);
    CHECK(at(3, -1) == 1);
    CHECK(at(0.3, 1) == 0.25F);
    CHECK(at(-0.3, -1) == 1);
}

TEST_CASE("samples, are POV-Ray's grid with the centre once more") {
    Scene scene = seen_from_above(8);
    test::add_quad(scene, {0.013F, 1, -9}, {9, 1, -9}, {9, 1, 9}, {0.013F, 1, 9});
    scene.materials[0].ambient = Color(1);
    scene.materials.push_back(test::matte(0));
    scene.meshes[0].material = 1;
    // Column 100 spans x from 0 to 0.04; the wall begins at a third of it. Of the samples at
    // 1/4 and 3/4 (two each) the left ones see the floor; the centre sees the wall.
    const Image image = picture(scene, {.samples = 2});
    CHECK(brightness_in_middle_row(image, side / 2) == Approx(2.0 / 5));
    CHECK(brightness_in_middle_row(image, side / 2 - 1) == Approx(1));
}

TEST_CASE("render, gives the same bytes on one and on two threads") {
    Scene scene = edge_shadow(0.2);
    scene.materials[0].reflection = Color(0.3F);
    scene.spheres = {{"ball", {0.4, 0.2, 0.3}, 0.2, 0}};
    const Image one = picture(scene, {.threads = 1});
    const Image two = picture(scene, {.threads = 2});
    CHECK(std::memcmp(one.pixels.data(), two.pixels.data(), one.pixels.size() * sizeof(Color)) ==
          0);
}

TEST_CASE("render, reports progress and stops on request") {
    std::stop_source source;
    double last = 0;
    Watch watch = {.progress = [&](double done) { last = done; }, .stop = source.get_token()};
    (void)render(test::as_is(edge_shadow(0)), {.width = 64, .height = 64}, watch);
    CHECK(last == 1);
    source.request_stop();
    CHECK(test::message_of([&] {
              (void)render(test::as_is(edge_shadow(0)), {.width = 64, .height = 64}, watch);
          }) == "interrupted");
}

TEST_CASE("render, stops in the middle of a tile that takes long") {
    std::stop_source source;
    const RenderOptions endless = {
        .width = 32, .height = 32, .antialiasing = Antialiasing{.threshold = 0, .depth = 9}};
    std::jthread user([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        source.request_stop();
    });
    const auto start = std::chrono::steady_clock::now();
    CHECK(test::message_of([&] {
              (void)render(test::as_is(edge_shadow(0.2)), endless, {.stop = source.get_token()});
          }) == "interrupted");
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}
