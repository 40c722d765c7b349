// Pictures with a defect, and whether the scene tells what it is. The whole study is
// bench/defects.cpp.
#include "support/pictures.h"
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/compare.h"
#include "penumbra/tracer.h"

#include <algorithm>
#include <functional>

using namespace penumbra;
using test::as_is;
using test::has;
using test::joined;

namespace {

Material material(const std::string& name, const Color& color) {
    return {.name = name, .color = color, .specular = 0.4F, .shininess = 30};
}

// A floor, a mirror ball, a matte ball and a textured wall under two lights.
Scene stage() {
    Scene scene;
    scene.materials = {material("floor", {0.5F, 0.45F, 0.4F}), material("clay", {0.7F, 0.3F, 0.2F}),
                       material("steel", {0.3F, 0.3F, 0.35F}), material("wall", Color(1))};
    scene.materials[2].reflection = Color(0.6F);
    scene.materials[3].pattern = ImageMap{.texture = 0};
    Texture texture = {.name = "marks"};
    texture.raster = {.width = 4, .height = 4, .channels = 3};
    for (int i = 0; i < 48; ++i)
        texture.raster.data.push_back(std::byte(40 + (i * 37 + i / 9 * 61) % 200));
    scene.textures = {texture};
    scene.planes = {{.name = "ground", .point = {0, -2, 0}, .material = 0}};
    scene.spheres = {
        {.name = "clay ball", .center = {-3, 0, 0}, .radius = 2, .material = 1},
        {.name = "steel ball", .center = {2.5, -0.8, 1}, .radius = 1.2, .material = 2}};
    test::add_quad(scene, {-1, -2, -4}, {6, -2, -3}, {6, 4, -3}, {-1, 4, -4}, 3);
    scene.meshes[0].texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    scene.instances[0].name = "board";
    scene.lights = {
        {.name = "key", .position = {-6, 9, 8}, .intensity = 0.8},
        {.name = "fill", .position = {9, 6, 6}, .color = {0.6F, 0.7F, 1}, .intensity = 0.4}};
    scene.lights[0].penumbra.delta = 0.8;
    scene.background = {0.05F, 0.08F, 0.15F};
    scene.cameras = {{.name = "eye", .position = {1, 3, 14}, .direction = {-0.05, -0.2, -1}}};
    scene.camera = 0;
    return scene;
}

const RenderOptions options = {.width = 96, .height = 72};

// What the diagnosis says of a reference that was rendered with `change`.
Comparison explained(const std::function<void(Scene&)>& change,
                     const RenderOptions& shot = options) {
    Scene other = stage();
    change(other);
    const Image picture = render(as_is(stage()), shot);
    const Image reference = render(as_is(other), shot);
    Comparison result = compare(picture, reference, {.limits = profile_limits("equivalent")});
    CHECK(result.verdict == Verdict::fail);
    explain(as_is(stage()), shot, picture, reference, result);
    INFO(joined(result.diagnosis));
    CHECK(has(joined(result.diagnosis), "of the mean square error"));
    return result;
}

void each_material(Scene& scene, void (*change)(Material&)) {
    for (Material& m : scene.materials) change(m);
}

}  // namespace

TEST_CASE("objects_seen tells what each pixel shows") {
    Scene scene = test::empty_scene();
    test::add_quad(scene, {-4, -4, -1}, {0, -4, -1}, {0, 4, -1}, {-4, 4, -1});
    scene.spheres = {{.center = {-1.5, 0, 0}, .radius = 0.5, .material = 0},
                     {.center = {1.5, 0, 0}, .radius = 0.5, .material = 0}};
    scene.planes = {{.point = {0, -3, 0}, .material = 0}};
    const RenderOptions size = {.width = 40, .height = 30};
    const std::vector<Index> objects = objects_seen(as_is(scene), size);
    REQUIRE(objects.size() == 1200);
    // The picture is 7.3 units wide at the spheres: 5.5 pixels a unit.
    const auto at = [&](int x, int y) { return objects[std::size_t(y * 40 + x)]; };
    CHECK(at(11, 15) == 1);
    CHECK(at(28, 15) == 2);
    CHECK(at(15, 10) == 0);
    CHECK(at(28, 5) == no_index);
    CHECK(at(35, 29) == 3);
}

TEST_CASE("What is missing is named") {
    CHECK(explained([](Scene& s) { s.lights.pop_back(); }).cause == "light_missing");
    const Comparison ball = explained([](Scene& s) { s.spheres.pop_back(); });
    CHECK(ball.cause == "object");
    CHECK(has(joined(ball.diagnosis), "as if the sphere 'steel ball' were missing"));
    CHECK(explained([](Scene& s) {
              each_material(s, [](Material& m) { m.specular = 0; });
          }).cause == "highlights");
    CHECK(explained([](Scene& s) { s.materials[2].reflection = Color(0); }).cause == "reflection");
    CHECK(explained([](Scene& s) { s.lights[0].penumbra.delta = 0; }).cause == "penumbra");
    CHECK(explained([](Scene& s) { s.ambient = Color(0); }).cause == "ambient");
}

TEST_CASE("How much something differs is found") {
    const Comparison light = explained([](Scene& s) {
        for (Light& l : s.lights) l.intensity *= 1.05;
    });
    CHECK(light.cause == "light");
    CHECK(has(joined(light.diagnosis), "as if all light sources were 5 % brighter"));

    const Comparison fov = explained([](Scene& s) { s.cameras[0].fov += radians(1); });
    CHECK(fov.cause == "fov");
    INFO(joined(fov.diagnosis));
    CHECK(has(joined(fov.diagnosis), "a field of view 1.0 degrees wider"));

    const Comparison albedo = explained([](Scene& s) { s.materials[1].color *= 0.8F; });
    CHECK(albedo.cause == "albedo");
    CHECK(has(joined(albedo.diagnosis), "material 'clay' were 0.8 times as bright"));

    const Comparison shininess =
        explained([](Scene& s) { each_material(s, [](Material& m) { m.shininess *= 1.5F; }); });
    CHECK(shininess.cause == "shininess");
    CHECK(has(joined(shininess.diagnosis), "the shininess were 1.5 times as high"));

    const Comparison background = explained([](Scene& s) { s.background = {0.2F, 0.1F, 0}; });
    CHECK(background.cause == "background");
    CHECK(has(joined(background.diagnosis), "the background (0.2, 0.1, 0)"));
}

TEST_CASE("Textures that lie wrong are named") {
    const auto mapped = [](std::array<double, 6> transform) {
        return explained(
            [&](Scene& s) { std::get<ImageMap>(s.materials[3].pattern).transform = transform; });
    };
    const Comparison mirrored = mapped({-1, 0, 1, 0, 1, 0});
    CHECK(mirrored.cause == "texture");
    CHECK(has(joined(mirrored.diagnosis), "material 'wall' were mirrored left to right"));
    CHECK(has(joined(mapped({1, 0, 0, 0, -1, 1}).diagnosis), "were upside down"));
    const Comparison half = mapped({1, 0, 0.5 / 4, 0, 1, 0.5 / 4});
    CHECK(half.cause == "texture");
    CHECK(has(joined(half.diagnosis), "moved by (-0.5, -0.5) texels"));
}

TEST_CASE("A comparison that passed is left alone") {
    const Image picture = render(as_is(stage()), options);
    Comparison result = compare(picture, picture);
    explain(as_is(stage()), options, picture, picture, result);
    CHECK(result.cause.empty());
    CHECK(result.diagnosis.empty());
}

TEST_CASE("A large picture is explained by a part of its pixels") {
    Scene other = stage();
    other.lights[0].intensity *= 1.1;
    const RenderOptions large = {.width = 331, .height = 250};  // 82,750 pixels
    const Image picture = render(as_is(stage()), large), reference = render(as_is(other), large);
    Comparison result = compare(picture, reference);
    explain(as_is(stage()), large, picture, reference, result);
    CHECK(result.cause == "light");
    CHECK(has(joined(result.diagnosis),
              "light source 'key' were 10 % brighter: that explains 100 %"));
}

TEST_CASE("Anti-aliased pictures, large ones too, are explained by anti-aliased ones") {
    RenderOptions smooth = options;
    smooth.antialiasing = Antialiasing();
    const auto brighter = [](Scene& s) {
        for (Light& l : s.lights) l.intensity *= 1.05;
    };
    CHECK(explained(brighter, smooth).cause == "light");
    smooth.width = 480;
    smooth.height = 360;
    CHECK(explained(brighter, smooth).cause == "light");
}

TEST_CASE("A failed comparison of pictures of other sizes is not explained but refused") {
    const Image picture = render(as_is(stage()), options);
    Comparison result;
    result.verdict = Verdict::fail;
    CHECK(test::message_of([&] {
              explain(as_is(stage()), options, picture, Image(8, 8), result);
          }).starts_with("the pictures differ in size: "));
}

TEST_CASE("An explanation can be interrupted") {
    Scene other = stage();
    other.ambient = Color(0);
    const Image picture = render(as_is(stage()), options);
    const Image reference = render(as_is(other), options);
    Comparison result = compare(picture, reference);
    REQUIRE(result.verdict == Verdict::fail);
    std::stop_source stop;
    stop.request_stop();
    CHECK(test::message_of([&] {
              explain(as_is(stage()), options, picture, reference, result,
                      {.stop = stop.get_token()});
          }) == "interrupted");
}

TEST_CASE("explain, finds that backs of facets are shown or not") {
    Scene turned = stage();
    for (auto& [a, b, c] : turned.meshes[0].triangles) std::swap(b, c);
    Scene hidden = turned;
    for (Material& m : hidden.materials) m.sides = Sides::front;
    const Image whole = render(as_is(turned), options), lacking = render(as_is(hidden), options);
    Comparison result = compare(whole, lacking, {.limits = profile_limits("equivalent")});
    explain(as_is(turned), options, whole, lacking, result);
    CHECK(has(joined(result.diagnosis), "facets were shown from the front alone"));
    result = compare(lacking, whole, {.limits = profile_limits("equivalent")});
    explain(as_is(hidden), options, lacking, whole, result);
    CHECK(has(joined(result.diagnosis), "facets were shown from both sides"));
}
