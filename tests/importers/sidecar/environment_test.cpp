// [environment]: what a sidecar, a setting and the command line may say of what surrounds a scene.
#include "support/inputs.h"

#include "penumbra/image.h"
#include "penumbra/light_model.h"

using namespace penumbra;
using test::Inputs, test::StudioFiles;

namespace {

// Of a sidecar studio.toml with this text and a sphere.
Imported with(const std::string& text, const std::vector<std::string>& settings = {}) {
    Inputs inputs;
    Image sky(8, 4);
    for (Color& pixel : sky.pixels) pixel = Color(2, 1, 0.5F);
    save_image(inputs.folder / "hall.exr", sky);
    inputs.file("studio.toml", text + "\n[[sphere]]\n");
    return inputs.set({"studio.toml"}, settings);
}

std::string problem(const std::string& text) {
    return Inputs().file("studio.toml", text + "\n[[sphere]]\n").problem({"studio.toml"});
}

}  // namespace

TEST_CASE("[environment] names one of our own, and needs no other light") {
    const Scene scene = with("[environment]\nname = \"studio\"").scene;
    REQUIRE(scene.environment);
    CHECK(scene.environment->name == "studio");
    CHECK(scene.environment->before_camera);
    CHECK(scene.environment->sources == 64);
    CHECK(scene.environment->intensity == 1);
    CHECK(scene.environment->visible);
    CHECK(scene.textures.at(scene.environment->texture).name == "studio");
    CHECK(scene.lights.empty());
    for (const char* name : {"overcast", "sunset", "night"})
        CHECK_FALSE(with(std::string("[environment]\nname = \"") + name + '"')
                        .scene.environment->before_camera);
}

TEST_CASE("[environment] takes an image, turned, dimmed, and in mirrors only") {
    const Imported result = with("[environment]\nimage = \"hall.exr\"\nrotate = 90\n"
                                 "intensity = 0.5\nsources = 16\nvisible = false");
    REQUIRE(result.scene.environment);
    const Environment& environment = *result.scene.environment;
    CHECK(environment.name == "hall");
    CHECK(environment.intensity == 0.5);
    CHECK(environment.sources == 16);
    CHECK_FALSE(environment.visible);
    Vec3 ahead(0);
    environment.rotation.multDirMatrix(Vec3(0, 0, -1), ahead);
    CHECK(ahead == Vec3(-1, 0, 0));
    CHECK(result.scene.textures.at(environment.texture).raster.width == 8);
    CHECK(std::ranges::any_of(result.files,
                              [](const auto& f) { return f.filename() == "hall.exr"; }));
}

TEST_CASE("[environment] takes a colour") {
    const Scene scene = with("[environment]\ncolor = [0.5, 1, 2]\nsources = 0").scene;
    REQUIRE(scene.environment);
    const NormalisedScene made = normalise(scene, {});
    CHECK(made.scene.lights.empty());
    REQUIRE(made.scene.sky);
    CHECK(made.scene.textures.at(made.scene.sky->texture).raster.texels() == 1);
}

TEST_CASE("A setting changes an environment, or takes it away") {
    const std::string text = "[environment]\nname = \"sunset\"\nrotate = 30\nsources = 256";
    const Scene scene = with(text, {"environment.sources=16", "environment.visible=false"}).scene;
    REQUIRE(scene.environment);
    CHECK(scene.environment->name == "sunset");
    CHECK(scene.environment->sources == 16);
    CHECK_FALSE(scene.environment->visible);
    const Scene other = with(text, {"environment.color=[1,1,1]"}).scene;
    CHECK(other.environment->name == "uniform");
    CHECK(other.environment->sources == 256);
    const Scene none = with(text, {"environment.name=none"}).scene;
    CHECK_FALSE(none.environment);
    CHECK(none.lights.size() == 3);  // the rig
    CHECK(with("", {"environment.name=night"}).scene.environment->name == "night");
}

TEST_CASE("An environment stands beside lights") {
    StudioFiles inputs;
    inputs.file("more.toml", "[environment]\nname = \"overcast\"");
    const Scene scene = inputs.load({"studio.toml", "more.toml"}).scene;
    CHECK(scene.lights.size() == 1);
    CHECK(scene.environment);
}

TEST_CASE("What is wrong with an environment is named with its place") {
    CHECK(problem("[environment]\nname = \"studoi\"") ==
          "studio.toml:2:8: 'name' in [environment] must be one of \"studio\", \"overcast\", "
          "\"sunset\", \"night\", \"none\", not \"studoi\"");
    CHECK(problem("[environment]\nname = \"studio\"\nrotat = 3") ==
          "studio.toml:3:1: unknown key 'rotat' in [environment] (did you mean 'rotate'?)");
    CHECK(problem("[enviroment]\nname = \"studio\"") ==
          "studio.toml:1:2: unknown key 'enviroment' at the top level (did you mean "
          "'environment'?)");
    CHECK(problem("[environment]\nname = \"studio\"\nimage = \"a.hdr\"") ==
          "studio.toml:3:9: 'image' in [environment] cannot stand beside 'name'");
    CHECK(problem("[environment]\nimage = \"gone.hdr\"") ==
          "studio.toml:2:9: 'image' in [environment] is 'gone.hdr': no such file");
    CHECK(problem("[environment]\nname = \"night\"\nsources = 4097") ==
          "studio.toml:3:11: 'sources' in [environment] must be from 0 to 4096, not 4097");
    CHECK(problem("[environment]\nname = \"night\"\nintensity = -1") ==
          "studio.toml:3:13: 'intensity' in [environment] must be 0 or more, not -1");
    CHECK(problem("[environment]\nname = \"night\"\nvisible = 1") ==
          "studio.toml:3:11: 'visible' in [environment] must be true or false, not a number");
    CHECK(problem("[environment]\nrotate = 3") ==
          "studio.toml:1:1: there is no environment to change: give it a 'name', an 'image' or a "
          "'color'");
    CHECK(problem("environment = \"studio\"") == "studio.toml:1:15: [environment] must be a table");
    CHECK(StudioFiles().set_problem({"studio.toml"}, "environment.sources=3") ==
          "setting 'environment.sources=3': there is no environment to change: give it a 'name', "
          "an 'image' or a 'color'");
}
