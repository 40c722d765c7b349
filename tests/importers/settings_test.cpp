// --set KEY=VALUE and the other options of load_scene().
#include "support/inputs.h"

#include "penumbra/light_model.h"

#include <cmath>

using namespace penumbra;
using test::Inputs, test::StudioFiles, test::material_of, test::near;

TEST_CASE("A setting changes any key and comes last") {
    const StudioFiles inputs;
    const Imported result = inputs.set(
        {"studio.toml"},
        {"lighting.ambient=0.1", "render.size=[320,240]", "render.samples = 3",
         "material.floor.diffuse=.5", "material.floor.color=#ff0000", "light.0.intensity=2",
         "light.0.penumbra.delta=.3", "sphere.0.radius=2.5", "plane.0.point=[0,-2.5,0]",
         "render.background=[.5,-.0,.25]", "light.0.attenuation.distance=4"});
    const Scene& scene = result.scene;
    CHECK(scene.ambient == Color(0.1F));
    CHECK(result.render.width == 320);
    CHECK(result.render.height == 240);
    CHECK(result.render.samples == 3);
    CHECK(scene.background == Color(0.5F, 0, 0.25F));
    CHECK(material_of(scene, "floor").diffuse == 0.5F);
    CHECK(material_of(scene, "floor").color == Color(1, 0, 0));
    REQUIRE(scene.lights.size() == 1);
    CHECK(scene.lights[0].intensity == 2);
    CHECK(scene.lights[0].position == Vec3(3, 5, 4));
    CHECK(scene.lights[0].penumbra.delta == 0.3);
    CHECK(scene.lights[0].penumbra.count[0] == 9);
    REQUIRE(scene.lights[0].attenuation);
    CHECK(scene.lights[0].attenuation->distance == 4);
    CHECK(scene.spheres.at(0).radius == 2.5);
    CHECK(scene.planes.at(0).point == Vec3(0, -2.5, 0));
    CHECK(inputs.set({"studio.toml"}, {"lighting.ambient=3", "lighting.ambient=4"}).scene.ambient ==
          Color(4));
}

TEST_CASE("A setting may add things as a sidecar does") {
    const Scene scene =
        StudioFiles().set({"studio.toml"}, {"light=[{position=[0,1,0], intensity=.5}]"}).scene;
    REQUIRE(scene.lights.size() == 2);
    CHECK(scene.lights[1].intensity == 0.5);
}

TEST_CASE("A setting's bare words are strings") {
    const StudioFiles inputs;
    CHECK(inputs.set({"studio.toml"}, {"light.0.name=Left door"}).scene.lights[0].name ==
          "Left door");
    CHECK(inputs.set({"studio.toml"}, {"light.0.name=7"}).scene.lights[0].name == "7");
    CHECK(inputs.set({"studio.toml"}, {"light.0.name='a=b'"}).scene.lights[0].name == "a=b");
    CHECK(inputs.set({"studio.toml"}, {"light.0.penumbra.pattern=axes"})
              .scene.lights[0]
              .penumbra.layout == Penumbra::Layout::axes);
}

TEST_CASE("A setting quotes a name that has dots") {
    Inputs inputs;
    inputs.file("a.toml", "[material.'a.b c']\n[[sphere]]\nmaterial = 'a.b c'");
    const Scene scene = inputs.set({"a.toml"}, {"material.\"a.b c\".diffuse=0.25"}).scene;
    CHECK(material_of(scene, "a.b c").diffuse == 0.25F);
}

TEST_CASE("A setting defines a material that something uses") {
    const StudioFiles inputs;
    const Scene scene =
        inputs.set({"studio.toml"}, {"sphere.0.material=glass", "material.glass.opacity=0.25"})
            .scene;
    CHECK(scene.materials.at(scene.spheres.at(0).material).opacity == 0.25F);
    Inputs bare;
    bare.file("ball.toml", "[[sphere]]");
    const Scene plain = bare.set({"ball.toml"}, {"material.default.diffuse=0.25"}).scene;
    CHECK(plain.materials.at(plain.spheres.at(0).material).diffuse == 0.25F);
}

TEST_CASE("What is wrong with a setting is a wrong use of the program") {
    const StudioFiles inputs;
    const std::vector<std::string> in = {"studio.toml"};
    CHECK(inputs.set_problem(in, "lighting.ambiet=0.1") ==
          "setting 'lighting.ambiet=0.1': unknown key 'ambiet' in [lighting] (did you mean "
          "'ambient'?)");
    CHECK(inputs.set_problem(in, "lihgting.ambient=0.1") ==
          "setting 'lihgting.ambient=0.1': unknown key 'lihgting' at the top level (did you mean "
          "'lighting'?)");
    CHECK(inputs.set_problem(in, "lighting.ambient=much") ==
          "setting 'lighting.ambient=much': 'ambient' in [lighting] must be [r, g, b] or "
          "\"#rrggbb\", "
          "not \"much\"");
    CHECK(inputs.set_problem(in, "render.samples=0") ==
          "setting 'render.samples=0': 'samples' in [render] must be from 1 to 9, not 0");
    CHECK(inputs.set_problem(in, "light.1.intensity=2") ==
          "setting 'light.1.intensity=2': no light.1 (the scene has only light.0)");
    CHECK(inputs.set_problem(in, "light.x.intensity=2") ==
          "setting 'light.x.intensity=2': 'light' must be followed by a number: light.0");
    CHECK(inputs.set_problem(in, "light.0=2") ==
          "setting 'light.0=2': 'light.0' must be followed by a key: light.0.KEY");
    CHECK(inputs.set_problem(in, "model.0.scale=2") ==
          "setting 'model.0.scale=2': no model.0 (the scene has no models)");
    CHECK(inputs.set_problem(in, "material.flor.diffuse=.5") ==
          "setting 'material.flor.diffuse=.5': no material 'flor' (did you mean 'floor'?)");
    CHECK(inputs.set_problem(in, "camera.name=Front") ==
          "setting 'camera.name=Front': no camera 'Front' (the scene has no cameras)");
    CHECK(inputs.set_problem(in, "sphere.0.material=flor") ==
          "setting 'sphere.0.material=flor': no material 'flor' (did you mean 'floor'?)");
    for (const char* text : {"render", "=3", ".a=3", "a..b=3", "\"a=3"})
        CHECK(inputs.set_problem(in, text) == std::string("setting '") + text +
                                                  "': must be KEY=VALUE, such as "
                                                  "lighting.ambient=0.1");
    CHECK(inputs.set_problem(in, "render.size=[1,")
              .rfind("setting 'render.size=[1,': not a TOML value: ", 0) == 0);
    try {
        inputs.set({"studio.toml"}, {"lighting.ambiet=0.1"});
        FAIL("no error");
    } catch (const Error& error) {
        CHECK(error.failure == Failure::usage);
    }
    try {
        inputs.load({"nothing.obj"});
        FAIL("no error");
    } catch (const Error& error) {
        CHECK(error.failure == Failure::input);
    }
}

TEST_CASE("The lights of the rig can be set, too") {
    Inputs inputs;
    inputs.file("ball.toml", "[[sphere]]");
    const Scene scene = inputs.set({"ball.toml"}, {"light.2.intensity=9"}).scene;
    REQUIRE(scene.lights.size() == 3);
    CHECK(scene.lights[2].name == "rim");
    CHECK(scene.lights[2].intensity == 9);
}

TEST_CASE("The penumbra option sets every delta and keeps the patterns") {
    const StudioFiles inputs;
    const Light lamp = inputs.load({"studio.toml"}, {.penumbra = 0.7}).scene.lights.at(0);
    CHECK(lamp.penumbra.delta == 0.7);
    CHECK(lamp.penumbra.layout == Penumbra::Layout::sphere);
    CHECK(lamp.penumbra.count[0] == 9);
    const Light sharp = inputs.load({"studio.toml"}, {.penumbra = 0.0}).scene.lights.at(0);
    CHECK(virtual_sources(sharp).size() == 1);

    Inputs rig;
    rig.file("ball.toml", "[[sphere]]");
    for (const Light& light : rig.load({"ball.toml"}, {.penumbra = 0.2}).scene.lights)
        CHECK(virtual_sources(light).size() == 7);
    CHECK(inputs.problem({"studio.toml"}, {.penumbra = -1.0}) ==
          "penumbra: must be a finite number of 0 or more, not -1");
    CHECK(inputs.problem({"studio.toml"}, {.penumbra = std::nan("")}) ==
          "penumbra: must be a finite number of 0 or more, not nan");
}

TEST_CASE("The sides option is for all models, and sidecars lie over it") {
    Inputs inputs;
    inputs.file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nusemtl paint\nf 1 2 3\n");
    inputs.file("a.toml", "[material.paint]\nsides = \"both\"\n[[sphere]]\n");
    const auto sides = [&](const std::vector<std::string>& files, const LoadOptions& options) {
        const Scene scene = inputs.load(files, options).scene;
        return scene.materials.at(scene.meshes.at(0).material).sides;
    };
    CHECK(sides({"a.obj"}, {}) == Sides::both);
    CHECK(sides({"a.obj"}, {.sides = Sides::front}) == Sides::front);
    CHECK(sides({"a.obj", "a.toml"}, {.sides = Sides::front}) == Sides::both);
    CHECK(sides({"a.obj"}, {.settings = {"material.paint.sides=front"}}) == Sides::front);
}

TEST_CASE("A camera setting changes the active camera") {
    Inputs inputs;
    inputs.file("a.toml", "[[sphere]]\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]");
    const Scene scene =
        inputs.set({"a.toml"}, {"camera.fov=25", "camera.position=[5, 0, 0]"}).scene;
    REQUIRE(scene.cameras.size() == 1);
    CHECK(scene.cameras[0].fov == Approx(radians(25)));
    CHECK(scene.cameras[0].position == Vec3(5, 0, 0));
    // It still looks at the point that the sidecar names.
    CHECK(near(scene.cameras[0].direction.normalized(), {-1, 0, 0}));
}

TEST_CASE("A camera setting without a camera changes the framed one") {
    Inputs inputs;
    inputs.file("ball.toml", "[[sphere]]");
    const auto camera = [&](const std::vector<std::string>& settings) {
        const Scene scene = inputs.set({"ball.toml"}, settings).scene;
        REQUIRE(scene.cameras.size() == 1);
        return scene.cameras[0];
    };
    CHECK(camera({"camera.fov=10"}).position.length() > 3 * camera({}).position.length());
    // The order of settings does not matter to what is framed.
    const Camera one = camera({"camera.up=[1,0,0]", "camera.fov=10"});
    const Camera two = camera({"camera.fov=10", "camera.up=[1,0,0]"});
    CHECK(near(one.position, two.position));
    CHECK(camera({"camera.orthographic=3"}).extent == 3);
    CHECK(camera({"camera.orthographic=3", "camera.up=[1,0,0]"}).extent == 3);
}
