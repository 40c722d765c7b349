// EXT_lights_image_based becomes an Environment.
#include "gltf_builder.h"
#include "importers/gltf/nodes/light_cube.h"

#include "penumbra/light_model.h"
#include "penumbra/tracer.h"

#include <cmath>

using namespace penumbra;
using penumbra::gltf::LightCube;
using test::Gltf, test::json;

namespace {

constexpr int size = 8;

// A smooth light that differs in all directions.
Color light(const Vec3& direction) {
    const Vec3 d = direction.normalized();
    return {float(0.5 + 0.3 * d.x), float(0.5 + 0.3 * d.y), float(0.5 + 0.3 * d.z)};
}

// The middle of a texel, for OpenGL's faces turned upside down (rows from the bottom).
Vec3 middle(std::size_t face, int column, int row) {
    const double s = (2 * column + 1.0) / size - 1, t = 1 - (2 * row + 1.0) / size;
    switch (face) {
    case 0: return {1, -t, -s};
    case 1: return {-1, -t, s};
    case 2: return {s, 1, t};
    case 3: return {s, -1, -t};
    case 4: return {s, -t, 1};
    default: return {-s, -t, -1};
    }
}

LightCube cube(LightCube::Flip flip) {
    LightCube result{.size = size};
    for (std::size_t face = 0; face < 6; ++face)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
                result.faces[face].push_back(light(
                    middle(face, flip.columns ? size - 1 - x : x, flip.rows ? y : size - 1 - y)));
    return result;
}

// A PNG of one face, RGB or RGBD with the divisor 1/2.
std::vector<std::uint8_t> face_file(std::size_t face, bool rgbd) {
    Raster raster{.width = size, .height = size, .channels = rgbd ? 4 : 3};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const Color color = light(middle(face, x, y)) * (rgbd ? 0.502F : 1.0F);
            for (int c = 0; c < 3; ++c)
                raster.data.push_back(std::byte(std::lround(255 * linear_to_srgb(color[c]))));
            if (rgbd) raster.data.push_back(std::byte(128));
        }
    const test::TempDir folder;
    save_raster(folder / "face.png", raster);
    const std::string bytes = test::read(folder / "face.png");
    return {bytes.begin(), bytes.end()};
}

Gltf lit(const json& members = {}) {
    Gltf gltf = test::triangle();
    json faces = json::array();
    for (std::size_t i = 0; i < 6; ++i) {
        const int view = gltf.view(face_file(i, i % 2 == 0));
        faces.push_back(gltf.add("images", {{"bufferView", view}, {"mimeType", "image/png"}}));
    }
    json light = {{"specularImages", {faces}}, {"specularImageSize", size}};
    if (members.is_object()) light.update(members);
    gltf.root["extensionsUsed"] = {"EXT_lights_image_based"};
    gltf.root["extensions"]["EXT_lights_image_based"]["lights"] = {light};
    gltf.root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
    return gltf;
}

// The mean difference of an equirectangular image from light().
double error_of(const Texture& texture) {
    const Raster& raster = texture.raster;
    double sum = 0;
    for (int y = 0; y < raster.height; ++y)
        for (int x = 0; x < raster.width; ++x) {
            Color color;
            std::memcpy(&color.x,
                        raster.data.data() +
                            (std::size_t(y) * std::size_t(raster.width) + std::size_t(x)) *
                                sizeof color,
                        sizeof color);
            const double turn = ((x + 0.5) / raster.width - 0.5) * 2 * std::numbers::pi;
            const double height = (0.5 - (y + 0.5) / raster.height) * std::numbers::pi;
            sum += double((color - light({std::sin(turn) * std::cos(height), std::sin(height),
                                          -std::cos(turn) * std::cos(height)}))
                              .length());
        }
    return sum / double(raster.texels());
}

}  // namespace

TEST_CASE("A cube of light is unrolled, whichever way its faces stand") {
    for (const bool columns : {false, true})
        for (const bool rows : {false, true}) {
            LightCube made = cube({.columns = columns, .rows = rows});
            set_flip(made);
            CAPTURE(columns, rows);
            CHECK(made.flip.columns == columns);
            CHECK(made.flip.rows == rows);
            const Texture unrolled = equirectangular(made, "hall");
            CHECK(unrolled.raster.width == 4 * size);
            CHECK(unrolled.raster.height == 2 * size);
            CHECK(error_of(unrolled) < 0.03);
        }
}

TEST_CASE("EXT_lights_image_based gives an environment") {
    const Imported result =
        test::read_content(lit({{"name", "hall"},
                                {"intensity", 3},
                                {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}}})
                               .text());
    CHECK(result.losses.empty());
    REQUIRE(result.scene.environment);
    const Environment& environment = *result.scene.environment;
    CHECK(environment.name == "hall");
    CHECK(environment.intensity == 3);
    CHECK(environment.visible);
    Vec3 ahead(0);
    environment.rotation.multDirMatrix(Vec3(0, 0, -1), ahead);
    CHECK((ahead - Vec3(-1, 0, 0)).length() < 1e-12);
    CHECK(error_of(result.scene.textures.at(environment.texture)) < 0.03);
}

TEST_CASE("An environment of a model is turned with it, and comes before none of a sidecar") {
    const test::TempDir folder;
    test::write(folder / "box.gltf", lit().text());
    const auto sidecar = test::write(
        folder / "a.toml", "[[model]]\nfile = \"box.gltf\"\nrotate = [0, 90, 0]\nscale = 3\n");
    const Scene scene = load_scene({sidecar}).scene;
    REQUIRE(scene.environment);
    Vec3 ahead(0);
    scene.environment->rotation.multDirMatrix(Vec3(0, 0, -1), ahead);
    CHECK((ahead - Vec3(-1, 0, 0)).length() < 1e-12);
    CHECK(load_scene({sidecar}, {.settings = {"environment.name=none"}}).scene.lights.size() == 3);
    CHECK(
        load_scene({sidecar}, {.settings = {"environment.sources=5"}}).scene.environment->sources ==
        5);
}

TEST_CASE("An image-based light that cannot be read is left out with a loss") {
    Gltf gltf = lit();
    json& light = gltf.root["extensions"]["EXT_lights_image_based"]["lights"][0];
    light["specularImages"][0].erase(0);
    Imported result = test::read_content(gltf.text());
    CHECK_FALSE(result.scene.environment);
    REQUIRE(result.losses.size() == 1);
    CHECK(result.losses[0].place == "box.gltf#/extensions/EXT_lights_image_based/lights/0");
    CHECK(result.losses[0].what == "the light is left out: its first cube map must have 6 faces");
    light["specularImages"] = json::array();
    CHECK(test::read_content(gltf.text()).losses.at(0).what ==
          "the light is left out: it has no cube map");
    light["specularImages"] = {{99}};
    CHECK(test::message_of([&] { test::read_content(gltf.text()); }).find("specularImages") !=
          std::string::npos);
}
