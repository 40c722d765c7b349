// Light from all around: POV-Ray shows it as the tracer does, seen by the camera or in mirrors
// only.
#include "exporters/pov_stage.h"

#include "penumbra/prepare.h"

using namespace penumbra;
using namespace test;

namespace {

const RenderOptions small = {.width = 96, .height = 72};

// Things of every kind on a floor: rough white, glossy, mirrors, glass, holes, a mirror in glass.
Stage in(Surroundings which, int sources, bool visible) {
    Stage stage;
    Scene& scene = stage.scene;
    scene.lights.clear();
    scene.ambient = Color(0);
    scene.planes = {{"floor", {0, -1.2, 0}, {0, 1, 0}, 0}};
    scene.materials[0].diffuse = 0.9F;
    Environment& environment = set_surroundings(scene, which);
    environment.sources = sources;
    environment.visible = visible;
    environment.intensity = 0.8;
    environment.rotation = Matrix().rotate(Vec3(0.2, 0.7, -0.4));
    stage.things = 4;
    Material white = {
        .name = "white", .color = Color(1), .ambient = Color(0), .diffuse = 0.9F, .specular = 0};
    stage.sphere(white);
    stage.mesh(ball(stage.add(shiny("glossy"))));
    Material mirror = shiny("mirror");
    mirror.reflection = {0.8F, 0.7F, 0.6F};
    mirror.diffuse = 0.1F;
    stage.sphere(mirror);
    Material glass = shiny("glass");
    glass.opacity = 0.05F;
    glass.ior = 1.5F;
    glass.fresnel = true;
    glass.reflection = Color(1);
    stage.sphere(glass);
    Material thin = shiny("thin");
    thin.opacity = 0.3F;
    thin.reflection = Color(0.3F);
    stage.things = 1;
    stage.mesh(ball(stage.add(thin)));
    stage.sphere(glass);
    scene.spheres.push_back({"inner", scene.spheres.back().center, 0.5, stage.add(mirror)});
    return stage;
}

}  // namespace

TEST_CASE("export, shows an environment as the tracer does") {
    NEEDS_POVRAY();
    const auto which = GENERATE(Surroundings::studio, Surroundings::sunset);
    const auto sources = GENERATE(16, 64);
    const bool visible = sources == 64;
    Stage stage = in(which, sources, visible);
    RenderOptions options = small;
    options.max_depth = 8;
    options.exposure = -0.5;
    CAPTURE(int(which), sources, visible);
    require_exact(agreement(stage.scene, options));
}

TEST_CASE("export, shows an environment in mirrors only as the tracer does at any depth") {
    NEEDS_POVRAY();
    Stage stage = in(Surroundings::night, 4, false);
    RenderOptions options = small;
    for (const int depth : {1, 2, 3, 5}) {
        options.max_depth = depth;
        CAPTURE(depth);
        require_exact(agreement(stage.scene, options));
    }
}

// What is reflected totally within glass counts as mirrored, what it refracts does not.
TEST_CASE("export, shows what glass reflects totally as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    Scene& scene = stage.scene;
    scene.lights.clear();
    scene.planes.clear();
    scene.background = {0.6F, 0.1F, 0.1F};
    set_surroundings(scene, Surroundings::overcast).visible = false;
    scene.environment->sources = 3;
    Material glass = shiny("glass");
    glass.opacity = 0;
    glass.specular = 0;
    glass.ior = 1.6F;
    stage.things = 4;
    stage.sphere(glass);
    for (int i = 0; i < 2; ++i) {
        Mesh prism{.name = "prism", .material = stage.add(glass)};
        prism.positions = {{-1, -1, 1},  {1, -1, 1},  {0.1F, 0.9F, 1},
                           {-1, -1, -1}, {1, -1, -1}, {0.1F, 0.9F, -1}};
        prism.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1},
                           {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}};
        stage.mesh(prism);
        scene.instances.back().transform =
            Matrix().rotate(Vec3(0.3 + i, 0.5, 0.2 * i)) * scene.instances.back().transform;
    }
    RenderOptions options{.width = 160, .height = 120, .max_depth = 10};
    require_exact(agreement(scene, options));
    // The camera inside of glass.
    stage.things = 1;
    stage.sphere(glass);
    scene.spheres.back().center = scene.cameras[0].position + Vec3(0.2, 0.1, 0);
    require_exact(agreement(scene, options));
}

TEST_CASE("export, shows a small environment as the tracer does at its seam and poles") {
    NEEDS_POVRAY();
    Stage stage;
    Scene& scene = stage.scene;
    scene.planes.clear();
    scene.lights.clear();
    set_environment(scene, stage.add(picture("sky", 3, Depth::f32)), "sky").visible =
        GENERATE(true, false);
    scene.environment->sources = 7;
    // The seam lies in +z, the poles in +-y.
    Material mirror = shiny("mirror");
    mirror.reflection = Color(0.9F);
    for (int i = 0; i < 12; ++i) stage.sphere(mirror);
    scene.cameras[0].direction = {0.1, 0.2, -1};
    require_exact(agreement(scene, {.width = 160, .height = 120}));
}

TEST_CASE("export, says which of an environment's sources a light is") {
    Stage stage = in(Surroundings::studio, 3, false);
    const std::string text = pov_text(normalise(stage.scene, small), small, "scene",
                                      {.pov_style = PovStyle::standalone});
    CHECK(text.find("// source 2 of 3 of environment studio: directional light\n") != text.npos);
    CHECK(text.find("inverse hollow no_image no_shadow") != text.npos);
    CHECK(text.find("sky_sphere") == text.npos);
}
