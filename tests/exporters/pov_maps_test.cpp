// The parts of a Material that images vary, and what shines through: both renderers compared.
#include "exporters/pov_stage.h"

using namespace penumbra;
using namespace test;

namespace {

Texture grey(const std::string& name) {
    Texture texture = picture(name, 1);
    texture.srgb = false;
    return texture;
}

// A map of which no axis, scale or shift can be mistaken for another.
ImageMap askew(Index texture) {
    return {.texture = texture, .transform = {0.7, 0.3, 0.1, -0.2, 1.1, 0.4}};
}

Material textured(Stage& stage, const std::string& name) {
    Material m = shiny(name);
    m.color = Color(1);
    m.pattern = ImageMap{.texture = stage.add(picture(name))};
    return m;
}

}  // namespace

TEST_CASE("export, lays maps over a mesh as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    Material m = textured(stage, "wood");
    m.pattern = askew(std::get<ImageMap>(m.pattern).texture);
    stage.mesh(ball(stage.add(m)));
    m.emission = {0.5F, 1, 0.3F};
    m.emission_map = askew(stage.add(picture("lamps")));
    stage.mesh(ball(stage.add(m)));
    m.color = {0.4F, 0.9F, 0.6F};
    stage.mesh(ball(stage.add(m)));
    stage.mesh(ball(stage.add(m), true));
    Material plain = shiny("plain");
    plain.emission = Color(1);
    plain.emission_map = ImageMap{.texture = stage.add(picture("glow", 4))};
    stage.mesh(ball(stage.add(plain)));
    for (const Wrap wrap : {Wrap::clamp, Wrap::mirror}) {
        Texture texture = picture("clamped");
        texture.wrap_u = texture.wrap_v = wrap;
        plain.emission_map = askew(stage.add(texture));
        stage.mesh(ball(stage.add(plain)));
    }
    require_exact(agreement(stage.scene));
}

TEST_CASE("export, shows surfaces with gaps as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    Material m = textured(stage, "leaf");
    m.reflection = Color(0.3F);
    m.alpha_map = AlphaMap{.map = askew(stage.add(grey("holes")))};
    stage.mesh(ball(stage.add(m)));
    stage.mesh(ball(stage.add(m), true));
    m.alpha_map->cutoff = 0.5F;
    stage.mesh(ball(stage.add(m)));
    m.color = {0.9F, 0.5F, 0.7F};
    stage.mesh(ball(stage.add(m)));
    m.emission = Color(0.5F);
    m.emission_map = ImageMap{.texture = stage.add(picture("lamps"))};
    stage.mesh(ball(stage.add(m)));
    Material thin = shiny("thin");
    thin.alpha_map = AlphaMap{.map = askew(stage.add(grey("gauze")))};
    thin.opacity = 0.5F;
    stage.mesh(ball(stage.add(thin)));
    thin.ior = 1.3F;
    thin.reflection = Color(0.2F);
    stage.mesh(ball(stage.add(thin)));
    // Light from the side casts the shadow of each on the next and on the wall.
    stage.scene.lights[1].position = {-9, 2.5, 1};
    require_exact(agreement(stage.scene));
}

TEST_CASE("export, fades by the alpha of vertices as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    const auto faded = [](Mesh mesh) {
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            mesh.alphas.push_back(0.25F * float((i / 3) % 5));
        return mesh;
    };
    Material plain = shiny("veil");
    plain.alpha_map = AlphaMap{};
    stage.mesh(faded(ball(stage.add(plain))));
    stage.mesh(faded(ball(stage.add(plain), true)));
    stage.mesh(ball(stage.add(plain)));
    Material m = textured(stage, "leaf");
    m.reflection = Color(0.3F);
    m.alpha_map = AlphaMap{.map = askew(stage.add(grey("holes")))};
    stage.mesh(faded(ball(stage.add(m))));
    stage.mesh(faded(ball(stage.add(m), true)));
    m.alpha_map->cutoff = 0.5F;  // which takes no notice of vertices
    stage.mesh(faded(ball(stage.add(m))));
    plain.opacity = 0.4F;
    stage.mesh(faded(ball(stage.add(plain), true)));
    stage.scene.lights[1].position = {-9, 2.5, 1};
    require_exact(agreement(stage.scene));
}

TEST_CASE("export, shows highlights and mirrors that images vary as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    Material m = textured(stage, "brass");
    m.metallic = 1;
    m.specular_lobes =
        SpecularLobes{.color = askew(stage.add(picture("tint"))),
                      .lobes = {{.specular = 0.8F, .shininess = 30, .reflection = Color(0.5F)}}};
    stage.mesh(ball(stage.add(m)));
    m.specular_lobes->level = ImageMap{.texture = stage.add(grey("rough"))};
    m.specular_lobes->lobes.push_back(
        {.specular = 0.4F, .shininess = 8, .reflection = Color(0.1F)});
    stage.mesh(ball(stage.add(m)));
    m.specular_lobes->lobes.push_back({.specular = 0, .shininess = 3});
    m.color = {0.9F, 0.6F, 0.5F};
    stage.mesh(ball(stage.add(m)));
    stage.mesh(ball(stage.add(m), true));
    m.alpha_map = AlphaMap{.map = ImageMap{.texture = stage.add(grey("holes"))}};
    stage.mesh(ball(stage.add(m)));
    m.emission = {0.5F, 1, 0.3F};
    m.emission_map = askew(stage.add(picture("lamps")));
    stage.mesh(ball(stage.add(m)));
    Material clay = shiny("clay");
    clay.specular_lobes = m.specular_lobes;
    clay.specular_lobes->color = {};
    stage.mesh(ball(stage.add(clay)));
    stage.mesh(ball(stage.add(clay), true));
    require_exact(agreement(stage.scene));
}

TEST_CASE("export, filters, absorbs and reflects in glass as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    Material m = shiny("stained");
    m.opacity = 0.3F;
    m.transmission = 1;
    stage.sphere(m);
    stage.mesh(ball(stage.add(m)));
    m.transmission = 0.4F;
    m.emission = {0.2F, 0.1F, 0.3F};
    stage.sphere(m);
    Material wood = textured(stage, "window");
    wood.opacity = 0.2F;
    wood.transmission = 1;
    stage.mesh(ball(stage.add(wood)));
    m = shiny("glass");
    m.opacity = 0;
    m.diffuse = 0;
    m.color = Color(1);
    m.ior = 1.5F;
    m.reflection = Color(1);
    m.fresnel = true;
    stage.sphere(m);
    Material lacquer = shiny("lacquer");
    lacquer.ior = 1.6F;
    lacquer.reflection = Color(1);
    lacquer.fresnel = true;
    stage.sphere(lacquer);
    m.absorption = Absorption{.color = {0.9F, 0.3F, 0.1F}, .distance = 1.5};
    stage.sphere(m);
    stage.mesh(ball(stage.add(m)));
    m.ior = 1;
    m.fresnel = false;
    m.reflection = Color(0);
    stage.sphere(m);
    m.ior = 0.8F;
    stage.sphere(m);
    Material inner = shiny("inner");
    stage.scene.spheres.push_back(
        {"inner", stage.scene.spheres.back().center, 0.4, stage.add(inner)});
    stage.scene.lights[1].position = {-9, 2.5, 1};
    RenderOptions options;
    options.max_depth = 8;
    require_exact(agreement(stage.scene, options));
}

TEST_CASE("export, shows a sky as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    stage.scene.planes.clear();
    const Depth depth = GENERATE(Depth::u8, Depth::f32);
    stage.scene.sky = Sky{.texture = stage.add(picture("sky", 3, depth))};
    Material m = shiny("mirror");
    m.reflection = Color(0.8F);
    for (int i = 0; i < 4; ++i) stage.sphere(m);
    stage.scene.cameras[0].fov = radians(100);
    stage.scene.cameras[0].direction = {0.4, 0.5, -1};
    RenderOptions options;
    options.exposure = depth == Depth::u8 ? 0 : -1.5;
    require_exact(agreement(stage.scene, options));
}

TEST_CASE("export, looks out of glass as the tracer does") {
    NEEDS_POVRAY();
    Stage stage;
    Material m = shiny("glass");
    m.color = Color(1);
    m.opacity = 0.1F;
    m.ior = 1.4F;
    m.absorption = Absorption{.color = {0.5F, 0.8F, 0.9F}, .distance = 1};
    for (int i = 0; i < 6; ++i) stage.sphere(shiny("ball"));
    Mesh bowl = ball(stage.add(m));
    stage.mesh(bowl);
    stage.scene.instances[0].transform =
        Matrix(1.5, 0, 0, 0, 0, 1.2, 0, 0, 0, 0, 1.3, 0, 0.4, 0.3, 10.8, 1);
    require_exact(agreement(stage.scene));
}
