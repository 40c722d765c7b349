// What the exporter writes means to POV-Ray what the Scene means to the tracer: each test renders
// a scene with both and compares raw pixels.
#include "exporters/pov_stage.h"

using namespace penumbra;
using namespace test;

TEST_CASE("export, shows surfaces of every kind as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    stage.sphere(shiny("plain"));
    Material m = shiny("metal");
    m.metallic = 0.8F;
    m.reflection = Color(0.5F);
    stage.sphere(m);
    m = shiny("mirror");
    m.reflection = {0.6F, 0.7F, 0.8F};
    stage.sphere(m);
    m = shiny("glowing");
    m.emission = {0.3F, 0.1F, 0.2F};
    stage.sphere(m);
    m.name = "glowing, no blue";
    m.color.z = 0;
    m.metallic = 0.5F;
    stage.sphere(m);
    m.name = "lamp";
    m.metallic = 0;
    m.color = Color(0);
    stage.sphere(m);
    m = shiny("thin");
    m.opacity = 0.4F;
    stage.sphere(m);
    m.name = "thin, glowing";
    m.color = {0, 0.5F, 1};
    m.emission = {0.3F, 0.1F, 0.2F};
    stage.sphere(m);
    m.name = "clear";
    m.opacity = 0;
    stage.sphere(m);
    m = shiny("glass");
    m.opacity = 0.1F;
    m.ior = 1.5F;
    m.reflection = Color(0.1F);
    stage.sphere(m);
    m = shiny("sharp");
    m.shininess = 200;
    m.smooth = false;
    stage.mesh(ball(stage.add(m)));
    m.name = "smooth";
    m.smooth = true;
    stage.mesh(ball(stage.add(m)));
    require_exact(agreement(stage.scene));
}

TEST_CASE("export, shows patterns in world space as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    const Checker checker{
        .colors = {Color(0.9F, 0.1F, 0.2F), Color(0.1F)}, .size = 0.7, .origin = {0.1, 0.2, 0.3}};
    const Noise noise{
        .colors = {Color(0.1F), Color(1, 0.8F, 0.3F)}, .size = 0.3, .origin = {1, 2, 3}};
    for (int octaves = 0; octaves < 4; ++octaves) {
        Material m = shiny("pattern");
        Noise octave = noise;
        octave.octaves = octaves;
        if (octaves == 0)
            m.pattern = checker;
        else
            m.pattern = octave;
        stage.sphere(m);
        m.emission = {0, 0.2F, 0.4F};
        m.metallic = 0.5F;
        stage.sphere(m);
        m.opacity = 0.5F;
        m.emission = Color(0);
        stage.mesh(ball(stage.add(m), octaves == 1));
    }
    Material floor = test::matte();
    floor.pattern = Checker{.colors = {Color(0.3F), Color(0.6F)}, .size = 1.1};
    stage.scene.planes[0].material = stage.add(floor);
    require_exact(agreement(stage.scene));
}

TEST_CASE("export, shows every wrapping, filter and depth of textures as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    const auto wraps = {Wrap::repeat, Wrap::mirror, Wrap::clamp};
    int i = 0;
    for (const Wrap u : wraps) {
        for (const Wrap v : wraps) {
            const Depth depth = i % 3 == 0 ? Depth::u8 : i % 3 == 1 ? Depth::u16 : Depth::f32;
            Texture texture = picture("dir/picture.png", 1 + i % 4, depth);
            texture.wrap_u = u;
            texture.wrap_v = v;
            texture.bilinear = i % 2 == 0;
            texture.srgb = i % 4 < 2;
            Material m = shiny("picture");
            m.color = Color(1);
            m.pattern = ImageMap{.texture = stage.add(texture)};
            if (i == 4)
                stage.sphere(m);
            else
                stage.mesh(ball(stage.add(m)));
            ++i;
        }
    }
    for (const Wrap u : wraps) {
        Texture texture = picture("round");
        texture.wrap_u = texture.wrap_v = u;
        Material m = shiny("round");
        m.pattern = ImageMap{.texture = stage.add(texture)};
        stage.sphere(m);
    }
    require_exact(agreement(stage.scene));
}

TEST_CASE("export, shows textured planes as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    Texture mirrored = picture("wall");
    mirrored.wrap_u = Wrap::mirror;
    Material m = shiny("wall");
    m.pattern = ImageMap{.texture = stage.add(mirrored), .size = 2.5};
    stage.scene.planes[0].material = stage.add(m);
    stage.scene.planes.push_back({"floor", {0, -3, 0}, {0.1, 2, 0}, stage.add(m)});
    stage.scene.planes.push_back({"side", {-5, 0, 0}, {1, 0.2, 0.3}, stage.add(m)});
    stage.sphere(shiny("ball"));
    require_exact(agreement(stage.scene));
}

TEST_CASE("export, multiplies textures by colours as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    Material m = shiny("colored");
    m.pattern = ImageMap{.texture = stage.add(picture("wood"))};
    m.reflection = Color(0.2F);
    stage.sphere(m);
    stage.mesh(ball(stage.add(m)));
    Material metal = m;
    metal.metallic = 0.7F;
    stage.mesh(ball(stage.add(metal)));
    Material glowing = m;
    glowing.emission = {0.1F, 0.5F, 0.9F};
    stage.mesh(ball(stage.add(glowing)));
    Material thin = glowing;
    thin.opacity = 0.5F;
    stage.mesh(ball(stage.add(thin)));
    require_exact(agreement(stage.scene));
}

TEST_CASE("export, shows vertex colours as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    Material m = shiny("clay");
    stage.mesh(ball(stage.add(m), true));
    m.metallic = 0.6F;
    m.specular = 0.8F;
    stage.mesh(ball(stage.add(m), true));
    m.metallic = 0;
    m.emission = {0.1F, 0.3F, 0.2F};
    stage.mesh(ball(stage.add(m), true));
    m.opacity = 0.6F;
    stage.mesh(ball(stage.add(m), true));
    m = shiny("wood");
    m.pattern = ImageMap{.texture = stage.add(picture("wood"))};
    stage.mesh(ball(stage.add(m), true));
    m.emission = {0.1F, 0.3F, 0.2F};
    m.color = Color(1);
    stage.mesh(ball(stage.add(m), true));
    Mesh white = ball(stage.add(shiny("white")), true);
    std::fill(white.colors.begin(), white.colors.end(), Color(1));
    stage.mesh(white);
    require_exact(agreement(stage.scene));
}

TEST_CASE("export, says what it approximates and stays close") {
    NEEDS_POVRAY();
    Stage stage;
    Material m = shiny("brass");
    m.color = Color(1);
    m.pattern = ImageMap{.texture = stage.add(picture("wood"))};
    m.metallic = 0.7F;
    stage.mesh(ball(stage.add(m), true));
    m.emission = {0.1F, 0.3F, 0.2F};
    stage.mesh(ball(stage.add(m), true));
    const Agreement found = agreement(stage.scene);
    CHECK(found.exact >= 0.999);
    REQUIRE(found.losses.size() == 1);
    CHECK(found.losses[0].place == "brass");
    CHECK(found.losses[0].what == "highlights and reflections of the textured metal take no "
                                  "vertex colours: approximate");
}

TEST_CASE("export, shows lights of every kind as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    for (int i = 0; i < 12; ++i) stage.sphere(shiny("ball"));
    using Layout = Penumbra::Layout;
    stage.scene.lights = {{.name = "spot",
                           .type = Light::Type::spot,
                           .position = {2, 3, 8},
                           .direction = Vec3(-0.3, -0.4, -1).normalized(),
                           .intensity = 0.7,
                           .inner = radians(10),
                           .outer = radians(25),
                           .penumbra = {.delta = 0.3, .layout = Layout::sphere, .count = {5, 1}}},
                          {.name = "sun",
                           .type = Light::Type::directional,
                           .direction = Vec3(0.5, -1, -1).normalized(),
                           .intensity = 0.3,
                           .penumbra = {.delta = 0.02, .layout = Layout::axes}},
                          {.name = "lamp",
                           .position = {-4, 4, 5},
                           .color = {1, 0.5F, 0.2F},
                           .attenuation = Attenuation{.distance = 4, .power = 2},
                           .penumbra = {.delta = 0.5, .layout = Layout::grid, .count = {2, 2}}}};
    RenderOptions options;
    options.exposure = 0.5;
    require_exact(agreement(stage.scene, options));
}

TEST_CASE("export, shows instances, sub-pixels and orthographic views as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    stage.mesh(ball(stage.add(shiny("first"))));
    for (int i = 0; i < 5; ++i) {
        Instance instance = stage.scene.instances[0];
        instance.transform = Matrix(0.5, 0.1 * i, 0.2, 0, -0.1, 1.1, 0.1 * i, 0, 0, -0.3, -0.8, 0,
                                    2.2 * i - 4, 0.7 * i - 2, 0.1, 1);
        stage.scene.instances.push_back(instance);
    }
    Camera& camera = stage.scene.cameras[0];
    camera.projection = Camera::Projection::orthographic;
    camera.extent = 11;
    camera.direction = {-0.1, -0.1, -1};
    RenderOptions options;
    options.samples = GENERATE(2, 3, 4);
    require_exact(agreement(stage.scene, options));
}

TEST_CASE("export, makes POV-Ray anti-alias as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    Material mirror = shiny("mirror");
    mirror.reflection = Color(0.5F);
    stage.mesh(ball(stage.add(mirror)));
    Material glass = shiny("glass");
    glass.opacity = 0.2F;
    glass.ior = 1.4F;
    stage.sphere(glass);
    Material checkers = shiny("checkers");
    checkers.pattern = Checker{.colors = {Color(2), Color(0.1F)}, .size = 0.3};
    stage.mesh(ball(stage.add(checkers)));
    RenderOptions options = {.width = 120, .height = 90};
    options.antialiasing = GENERATE(Antialiasing{0.1, 3}, Antialiasing{0, 2}, Antialiasing{0.03, 4},
                                    Antialiasing{0.5, 9}, Antialiasing{0.3, 1});
    require_exact(agreement(stage.scene, options));
}

TEST_CASE("export, is scaled so that small and far scenes keep their shadows") {
    NEEDS_POVRAY();
    Stage stage;
    for (int i = 0; i < 5; ++i) stage.mesh(ball(stage.add(shiny("ball"))));
    const double size = GENERATE(1e-3, 1e3);
    const Vec3 far(2000 * size, 0, 0);
    Scene& scene = stage.scene;
    for (Instance& i : scene.instances) {
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 3; ++column) i.transform[row][column] *= size;
        i.transform[3][0] += far.x;
    }
    for (Light& l : scene.lights) l.position = l.position * size + far;
    for (Plane& p : scene.planes) p.point = p.point * size + far;
    scene.cameras[0].position = scene.cameras[0].position * size + far;
    require_exact(agreement(scene));
}

TEST_CASE("export, works in POV-Ray under any file name and with any names in the model") {
    NEEDS_POVRAY();
    Stage stage;
    Material m = shiny("wood");
    m.pattern = ImageMap{.texture = stage.add(picture("wood"))};
    stage.mesh(ball(stage.add(m), true));
    stage.sphere(m);
    Scene& scene = stage.scene;
    const test::TempDir folder;
    const RenderOptions options = {.width = 60, .height = 45};
    const auto povray = [&](const std::string& stem) {
        const Exported exported =
            write_pov(normalise(scene, options), options, folder / (stem + ".pov"));
        return run_povray(exported.files[1], 60, 45).image.pixels;
    };
    const std::vector<Color> plain = povray("scene");
    const std::string evil = "x */ #error \"a\"\n#include \"evil.inc\" } // \xc3\xa9 \\ \"";
    for (Material& material : scene.materials) material.name = evil;
    for (Texture& t : scene.textures) t.name = evil;
    for (Mesh& mesh : scene.meshes) mesh.name = "sphere";
    for (Instance& i : scene.instances) i.name = evil;
    for (Light& l : scene.lights) l.name = evil;
    for (Sphere& s : scene.spheres) s.name = evil;
    scene.cameras[0].name = evil;
    CHECK(povray("it's \"caf\xc3\xa9\"; +O -x [1]") == plain);
}
