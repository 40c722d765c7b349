// An environment becomes lights and a sky: what they add up to, and where they come from.
#include "prepare/environment/cut.h"
#include "scene/texture/texture_lookup.h"
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/light_model.h"
#include "penumbra/prepare.h"
#include "penumbra/tracer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

using namespace penumbra;

namespace {

constexpr Surroundings all[] = {Surroundings::studio, Surroundings::overcast, Surroundings::sunset,
                                Surroundings::night};

Texture image_of(Surroundings which) {
    Scene scene;
    set_surroundings(scene, which);
    return scene.textures.at(0);
}

// Linear floats, top row first.
Texture image(int width, int height, const std::vector<Color>& pixels) {
    Texture texture = {.name = "image"};
    texture.raster = {.width = width, .height = height, .channels = 3, .depth = Depth::f32};
    texture.raster.data.resize(pixels.size() * sizeof(Color));
    std::memcpy(texture.raster.data.data(), &pixels[0].x, texture.raster.data.size());
    return texture;
}

// Evenly over the sphere.
std::vector<Vec3> directions(int count) {
    std::vector<Vec3> result;
    for (int i = 0; i < count; ++i) {
        const double y = 1 - (2.0 * i + 1) / count, r = std::sqrt(1 - y * y);
        const double a = i * std::numbers::pi * (3 - std::sqrt(5.0));
        result.emplace_back(r * std::cos(a), y, r * std::sin(a));
    }
    return result;
}

double luminance(const Vec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

// Irradiance of a surface that faces `normal`, from every cell.
double irradiance(const SkyCells& cells, const Vec3& normal) {
    double sum = 0;
    for (const LightMoments& m : cells.moments) sum += std::max(0.0, m.vector.dot(normal));
    return sum;
}

double irradiance(const SkySources& sources, const Vec3& normal) {
    double sum = 0;
    for (const auto& [toward, flux] : sources.sources)
        sum += luminance(flux) * std::max(0.0, toward.dot(normal));
    return sum;
}

// Root of the mean square, in parts of the mean.
double error_of(const SkyCells& cells, const SkySources& sources) {
    double square = 0, mean = 0;
    const auto normals = directions(300);
    for (const Vec3& normal : normals) {
        const double truth = irradiance(cells, normal);
        const double error = irradiance(sources, normal) - truth;
        square += error * error;
        mean += truth;
    }
    return std::sqrt(square / double(normals.size())) / (mean / double(normals.size()));
}

Vec3 flux_of(const SkyCells& cells) {
    Vec3 sum(0);
    for (const Vec3& flux : cells.flux) sum += flux;
    return sum;
}

Vec3 flux_of(const SkySources& sources) {
    Vec3 sum(0);
    for (const SkySource& source : sources.sources) sum += source.flux;
    return sum;
}

Scene lit_by(Surroundings which) {
    Scene scene = test::empty_scene();
    scene.spheres.push_back({.material = 0});
    set_surroundings(scene, which);
    return scene;
}

}  // namespace

TEST_CASE("An environment is cut into as many sources as wanted, with all of its light") {
    for (const Surroundings which : all) {
        const SkyCells cells = sky_cells(image_of(which));
        CHECK(cells.width == 512);
        CHECK(cells.height == 256);
        const Vec3 whole = flux_of(cells);
        for (const int count : {1, 2, 16, 64, 1000, 4096}) {
            const SkySources cut = sky_sources(cells, count);
            CHECK(cut.sources.size() == std::size_t(count));
            CHECK((flux_of(cut) - whole).length() <= 1e-12 * whole.length());
            for (const SkySource& source : cut.sources)
                CHECK(std::abs(source.toward.length() - 1) < 1e-5);
        }
        CHECK(sky_sources(cells, 0).sources.empty());
    }
}

TEST_CASE("An environment's sources light surfaces as the whole of it does") {
    for (const Surroundings which : all) {
        const SkyCells cells = sky_cells(image_of(which));
        const double at_16 = error_of(cells, sky_sources(cells, 16));
        const double at_64 = error_of(cells, sky_sources(cells, 64));
        const double at_256 = error_of(cells, sky_sources(cells, 256));
        CAPTURE(int(which), at_16, at_64, at_256);
        CHECK(at_16 < 0.06);
        CHECK(at_64 < 0.006);
        CHECK(at_256 < 0.0025);
        CHECK(at_64 < at_16);
        CHECK(at_256 < at_64);
    }
}

TEST_CASE("An environment's spread becomes smaller with more sources") {
    const SkyCells cells = sky_cells(image_of(Surroundings::overcast));
    double before = 10;
    for (const int count : {1, 4, 16, 64, 256, 1024}) {
        const double spread = sky_sources(cells, count).spread;
        CHECK(spread < before);
        CHECK(spread > 0);
        before = spread;
    }
    // 1024 parts of the sphere, nearly round: a disc of 4 pi / 1024 has the square radius 4 / 1024.
    // The ground is darker and gets fewer of them.
    CHECK(before < 4.8 / 1024);
    CHECK(before > 3.2 / 1024);
}

TEST_CASE("An environment of little light has no sources without any") {
    std::vector<Color> pixels(32 * 16, Color(0));
    CHECK(sky_sources(sky_cells(image(32, 16, pixels)), 64).sources.empty());
    pixels[5 * 32 + 7] = Color(1, 2, 3);
    pixels[9] = Color(-5, std::nanf(""), -1);
    const SkySources cut = sky_sources(sky_cells(image(32, 16, pixels)), 8);
    CHECK(cut.sources.size() == 8);
    const double longitude = (7.5 / 32 - 0.5) * 2 * std::numbers::pi,
                 latitude = (0.5 - 5.5 / 16) * std::numbers::pi;
    const Vec3 there(std::sin(longitude) * std::cos(latitude), std::sin(latitude),
                     -std::cos(longitude) * std::cos(latitude));
    for (const SkySource& source : cut.sources) CHECK(source.toward.dot(there) > 0.97);
}

TEST_CASE("An environment of one colour lights all sides alike") {
    Scene scene;
    set_uniform_environment(scene, {0.5F, 0.25F, 1});
    const SkyCells cells = sky_cells(scene.textures.at(0));
    const Vec3 whole = flux_of(cells);
    CHECK(std::abs(whole.x - 2 * std::numbers::pi) < 1e-6);
    CHECK(std::abs(whole.z - 4 * std::numbers::pi) < 1e-6);
    CHECK(error_of(cells, sky_sources(cells, 64)) < 0.01);
}

TEST_CASE("An image's pixels are counted once whatever its size") {
    std::vector<Color> pixels;
    for (int i = 0; i < 1100 * 530; ++i) pixels.emplace_back(0.1F * float(i % 7));
    const Texture large = image(1100, 530, pixels);
    const SkyCells cells = sky_cells(large);
    CHECK(cells.width <= 512);
    CHECK(cells.height <= 256);
    double sum = 0;
    for (int y = 0; y < 530; ++y)
        for (int x = 0; x < 1100; ++x)
            sum += double(pixels[std::size_t(y) * 1100 + std::size_t(x)].x) *
                   (std::cos(std::numbers::pi * y / 530) -
                    std::cos(std::numbers::pi * (y + 1) / 530)) *
                   2 * std::numbers::pi / 1100;
    CHECK(std::abs(flux_of(cells).x - sum) < 1e-6 * sum);
}

TEST_CASE("The largest cut takes no more than a moment") {
    const SkyCells cells = sky_cells(image_of(Surroundings::studio));
    const auto start = std::chrono::steady_clock::now();
    CHECK(sky_sources(cells, most_sources).sources.size() == most_sources);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    CHECK(time.count() < 5);  // a loaded machine; 0.3 s on an idle one
}

TEST_CASE("White in surroundings of our own is not overexposed") {
    for (const Surroundings which : all) {
        const SkyCells cells = sky_cells(image_of(which));
        double most = 0;
        for (const Vec3& normal : directions(400))
            most = std::max(most, irradiance(cells, normal) / std::numbers::pi);
        CAPTURE(int(which));
        CHECK(most > 0.89);
        CHECK(most < 0.95);
    }
}

TEST_CASE("normalise() makes an environment lights and a sky") {
    Scene scene = lit_by(Surroundings::night);
    REQUIRE(defects(scene).empty());
    scene.environment->sources = 5;
    scene.environment->intensity = 3;
    const Scene made = normalise(scene, {.exposure = 1}).scene;
    CHECK_FALSE(made.environment);
    CHECK_FALSE(made.mirror_sky);
    REQUIRE(made.sky);
    REQUIRE(made.lights.size() == 5);
    CHECK(made.lights[1].name == "source 2 of 5 of environment night");
    Vec3 flux(0);
    for (const Light& light : made.lights) {
        CHECK(light.type == Light::Type::directional);
        flux += Vec3(light.color) * (light.intensity * std::numbers::pi);
    }
    const Vec3 whole = flux_of(sky_cells(image_of(Surroundings::night))) * 6;
    CHECK((flux - whole).length() < 1e-6 * whole.length());

    scene.environment->visible = false;
    scene.environment->sources = 0;
    scene.background = Color(0.5F);
    const Scene hidden = normalise(scene, {}).scene;
    CHECK(hidden.lights.empty());
    CHECK_FALSE(hidden.sky);
    CHECK(hidden.mirror_sky);
    CHECK(hidden.background == Color(0.5F));
}

TEST_CASE("An environment widens highlights by what its sources stand for") {
    Scene scene = lit_by(Surroundings::studio);
    Material& m = scene.materials[0];
    m.specular = 0.5F;
    m.shininess = 200;
    m.specular_lobes = SpecularLobes{.lobes = {{.specular = 0.25F, .shininess = 1000}}};
    m.blend = Blend{.map = {.texture = 0}, .other = {{.specular = 1, .shininess = 10}}};
    scene.environment->sources = 16;
    const double spread = sky_sources(sky_cells(scene.textures[0], 16), 16).spread;
    const Material made = normalise(scene, {}).scene.materials[0];
    const auto check = [&](float specular, float shininess, double k, double n) {
        const double wider = 1 / (1 / n + spread);
        CHECK(shininess == Approx(wider));
        CHECK(specular == Approx(k * (wider + 1) / (n + 1)));
    };
    check(made.specular, made.shininess, 0.5, 200);
    check(made.specular_lobes->lobes[0].specular, made.specular_lobes->lobes[0].shininess, 0.25,
          1000);
    check(made.blend->other[0].specular, made.blend->other[0].shininess, 1, 10);
    scene.environment->sources = 0;
    CHECK(normalise(scene, {}).scene.materials[0].shininess == 200);
}

TEST_CASE("A studio's floor sends back what falls on it, to mirrors as well") {
    Scene scene = test::empty_scene();
    scene.spheres.push_back({.radius = 1, .material = 0});
    Environment& environment = set_uniform_environment(scene, Color(1));
    environment.stage = Environment::Stage::floor;
    environment.visible = false;
    scene.cameras[0].position = {0, 3, 10};
    const Scene made = normalise(scene, {}).scene;
    REQUIRE(made.planes.size() == 1);
    REQUIRE(made.mirror_sky);
    const TextureLookup around(made.textures[made.mirror_sky->texture]);
    const float albedo = made.materials[made.planes[0].material].color.x;
    CHECK(sample(around, 0.3, 0.9).x == Approx(1));
    CHECK(sample(around, 0.3, 0.1).x == Approx(albedo).epsilon(0.01));
    CHECK(made.background.x == Approx(albedo).epsilon(0.02));
    double up = 0, down = 0;
    for (const Light& l : made.lights)
        (l.direction.y < 0 ? down : up) += l.intensity * std::abs(double(l.direction.y));
    CHECK(up / down == Approx(double(albedo)).epsilon(0.05));
}

TEST_CASE("A studio turns with the camera, level with it") {
    Scene scene = lit_by(Surroundings::studio);
    scene.environment->sources = 12;
    scene.cameras[0].direction = {0, 0, -1};
    const std::vector<Light> before = normalise(scene, {}).scene.lights;
    // To where -z is turned about y by 90 degrees, and down.
    scene.cameras[0].direction = {-1, -0.7, 0};
    const Scene turned = normalise(scene, {}).scene;
    REQUIRE(turned.lights.size() == before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 d = before[i].direction;
        CHECK((turned.lights[i].direction - Vec3(d.z, d.y, -d.x)).length() < 1e-9);
    }
    Scene night = lit_by(Surroundings::night);
    CHECK_FALSE(night.environment->before_camera);
    // Straight down: what is at the top of the picture counts as ahead.
    scene.cameras[0].direction = {0, -1, 0};
    scene.cameras[0].up = {0, 0, -1};
    const std::vector<Light> above = normalise(scene, {}).scene.lights;
    for (std::size_t i = 0; i < before.size(); ++i)
        CHECK((above[i].direction - before[i].direction).length() < 1e-9);
}

TEST_CASE("A turned environment is seen where its lights come from") {
    // Only the middle of the image, in -z, is lit.
    std::vector<Color> pixels(32 * 16, Color(0));
    for (const int x : {15, 16})
        for (const int y : {7, 8}) pixels[std::size_t(y) * 32 + std::size_t(x)] = Color(1, 0.5F, 0);
    Scene scene = test::empty_scene();
    scene.textures.push_back(image(32, 16, pixels));
    Environment& environment = set_environment(scene, 0, "spot");
    environment.sources = 1;
    // About y by 90 degrees: -z goes to -x.
    environment.rotation = Matrix(0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1);
    scene.cameras[0].direction = {-1, 0, 0};
    REQUIRE(defects(scene).empty());
    const NormalisedScene made = normalise(scene, {});
    REQUIRE(made.scene.lights.size() == 1);
    CHECK((made.scene.lights[0].direction - Vec3(1, 0, 0)).length() < 1e-5);
    const Image seen = render(made, {.width = 9, .height = 9});
    CHECK(seen.at(4, 4) == Color(1, 0.5F, 0));
    scene.cameras[0].direction = {0, 0, -1};
    CHECK(render(normalise(scene, {}), {.width = 9, .height = 9}).at(4, 4) == Color(0));
}

TEST_CASE("What an environment cannot be is a defect") {
    Scene scene = lit_by(Surroundings::night);
    const auto defect = [&](const auto& change) {
        Scene changed = scene;
        change(*changed.environment);
        const auto found = defects(changed);
        return found.empty() ? std::string() : found[0];
    };
    CHECK(defect([](Environment& e) { e.texture = 7; }) ==
          "the environment refers to a missing texture");
    CHECK(defect([](Environment& e) { e.rotation.setScale(Vec3(2)); }) ==
          "the environment is turned by what is no rotation");
    CHECK(defect([](Environment& e) { e.rotation[0][0] = -1; }) ==
          "the environment is turned by what is no rotation");
    CHECK(defect([](Environment& e) { e.sources = 5000; }) ==
          "the environment has sources that are not 0 to 4096");
    CHECK(defect([](Environment& e) { e.intensity = -1; }) ==
          "the environment has an intensity that is not 0 or more");
    scene.mirror_sky = Sky{.texture = 9};
    CHECK(defects(scene).at(0) == "the sky in mirrors refers to a missing texture");
}
