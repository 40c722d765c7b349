// Models that are included in scenes of one's own.
#include "exporters/pov/plan.h"
#include "exporters/pov_stage.h"

#include "penumbra/light_model.h"

#include <set>
#include <sstream>

using namespace penumbra;

namespace {

const RenderOptions small = {.width = 240, .height = 180};

std::string include_text(const Scene& scene, const std::string& stem = "things") {
    return pov_text(normalise(scene, small), small, stem, {.pov_style = PovStyle::include});
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// What POV-Ray reads of it.
std::string without_comments(const std::string& text) {
    std::istringstream lines(text);
    std::string rest;
    for (std::string line; std::getline(lines, line);)
        rest += line.substr(0, line.find("//")) + '\n';
    return rest;
}

// The example scene in the comment.
std::string example_of(const std::string& text) {
    std::istringstream lines(text.substr(text.find("// Use it in a scene of your own")));
    std::string line, example;
    std::getline(lines, line);
    while (std::getline(lines, line) && line != "// In the model's own units it is")
        if (line.size() > 5) example += line.substr(5) + '\n';
    return example;
}

// A textured, a coloured and a plain thing under two lights, in the default ambience.
Scene things() {
    test::Stage stage;
    stage.scene.background = Color(0);
    stage.scene.ambient = Color(1);
    Material wood = test::shiny("wood");
    wood.pattern = ImageMap{.texture = stage.add(test::picture("grain"))};
    wood.color = Color(1);
    stage.mesh(test::ball(stage.add(wood)));
    stage.mesh(test::ball(stage.add(test::shiny("coloured")), true));
    Material checks = test::shiny("checks");
    checks.pattern = Checker{.colors = {Color(0.9F), Color(0.2F)}, .size = 0.4};
    stage.sphere(checks);
    return stage.scene;
}

// Every kind of declaration: noise, holes, faded and layered vertex colours, lobes, mirrors, glass.
Scene everything() {
    test::Stage stage;
    stage.scene.background = Color(0.05F);
    Material cloud = test::shiny("cloud");
    cloud.pattern = Noise{.size = 0.5, .octaves = 3};
    stage.sphere(cloud);
    std::get<Noise>(cloud.pattern).octaves = 1;
    stage.sphere(cloud);
    Material checks = test::shiny("checks");
    checks.pattern = Checker{.colors = {Color(0.9F), Color(0.2F)}, .size = 0.4};
    stage.sphere(checks);
    Material mirror = test::shiny("mirror");
    mirror.reflection = {0.5F, 0.6F, 0.4F};
    stage.sphere(mirror);
    mirror.fresnel = true;
    mirror.ior = 1.5F;
    mirror.metallic = 0.5F;
    stage.sphere(mirror);
    Material glass = test::shiny("glass");
    glass.opacity = 0.4F;
    glass.ior = 1.2F;
    stage.mesh(test::ball(stage.add(glass)));
    Material wood = test::shiny("wood");
    wood.pattern = ImageMap{.texture = stage.add(test::picture("grain"))};
    wood.opacity = 0.8F;
    stage.mesh(test::ball(stage.add(wood), true));
    stage.mesh(test::ball(stage.add(test::shiny("coloured")), true));
    Material leaf = test::shiny("leaf");
    leaf.alpha_map = AlphaMap{};
    Mesh faded = test::ball(stage.add(leaf), true);
    for (std::size_t i = 0; i < faded.positions.size(); ++i)
        faded.alphas.push_back(0.25F * float((i / 3) % 5));
    stage.mesh(faded);
    Texture grey = test::picture("rough", 1);
    grey.srgb = false;
    Material brass = wood;
    brass.name = "brass";
    brass.opacity = 1;
    brass.specular_lobes =
        SpecularLobes{.level = ImageMap{.texture = stage.add(grey)},
                      .lobes = {{.specular = 0.8F, .shininess = 30, .reflection = Color(0.4F)},
                                {.specular = 0.3F, .shininess = 5}}};
    brass.alpha_map = AlphaMap{.map = brass.specular_lobes->level, .cutoff = 0.3F};
    stage.mesh(test::ball(stage.add(brass)));
    stage.scene.planes.clear();
    return stage.scene;
}

// A caller's scene: its own defaults, then the model of that name.
std::string callers_scene(const std::string& defaults, const std::string& includes,
                          const std::string& objects) {
    return "#version 3.7;\nglobal_settings { assumed_gamma 1.0 max_trace_level 8 }\n" + defaults +
           "\n" + includes +
           "camera { location <0.3, 0.2, 11> right <-1.33, 0, 0> angle 52 look_at <0, 0, 0> }\n"
           "light_source { <4, 6, 9>, rgb 1 }\nlight_source { <-9, 2.5, 1>, rgb 0.4 }\n" +
           objects;
}

// The picture that POV-Ray makes of scene.pov in `folder`, which has this text.
Image pictured(const test::TempDir& folder, const std::string& text, bool quietly = true) {
    test::write(folder / "scene.pov", text);
    test::write(folder / "scene.ini", "Input_File_Name=scene.pov\nOutput_File_Name=scene.exr\n"
                                      "Output_File_Type=E\nWidth=240\nHeight=180\n"
                                      "Antialias=Off\nDisplay=Off\nPause_When_Done=Off\n");
    const PovrayRun run = run_povray(folder / "scene.ini", small.width, small.height);
    if (quietly) CHECK(test::warnings(run.log) == "");
    return run.image;
}

void require_same(const Image& ours, const Image& theirs) {
    const test::Agreement found = test::agreement(ours, theirs);
    CHECK(found.close >= 0.9995);
    CHECK(found.lit > 0.3);
}

}  // namespace

TEST_CASE("an include file declares the model and nothing else") {
    const std::string text = without_comments(include_text(things()));
    CHECK(has(text, "#declare Model_things = union {"));
    CHECK(has(text, "#declare Material_things__wood ="));
    CHECK(has(text, "#declare Model_things__scale ="));
    CHECK(has(text, "#declare Mesh_things__ball = mesh2 {"));
    CHECK_FALSE(has(text, "#include"));
    for (const char* word :
         {"camera", "light_source", "light_group", "global_settings", "background", "sky_sphere"})
        CHECK_FALSE(has(text, word));
}

TEST_CASE("an include file of one thing needs no union") {
    Scene scene = things();
    scene.instances.clear();
    scene.planes.clear();
    CHECK(has(without_comments(include_text(scene)), "#declare Model_things =\n  \n  sphere {"));
    CHECK_FALSE(has(include_text(scene), "union"));
}

TEST_CASE("an include file's model has a name that is not taken") {
    CHECK(has(include_text(things(), "scale"), "#declare Model_scale = union {"));
    CHECK(has(include_text(things(), "my chair"), "#declare Model_my_chair_"));
}

TEST_CASE("safe identifiers, differ for different names and have single underscores") {
    const std::vector<std::string> stems = {
        "chair", "my_chair",  "my-chair",           "my chair",
        "",      "my__chair", "_my_chair",          "\xe6\x97\xa5",
        "\xe6",  "my.chair",  std::string(60, 'x'), std::string(61, 'x')};
    std::set<std::string> made;
    for (const std::string& stem : stems) {
        const std::string name = pov::safe_identifier(stem);
        CHECK(made.insert(name).second);
        CHECK_FALSE(has(name, "__"));
    }
    CHECK(made.contains("chair"));
    CHECK(made.contains("my_chair"));
}

TEST_CASE("every name that an include file declares carries the model's") {
    const std::string text = without_comments(include_text(everything(), "chair_scale"));
    std::size_t declared = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const auto at = line.find("#");
        if (at == line.npos || line.compare(at, 8, "#version") == 0) continue;
        std::istringstream words(line.substr(at));
        std::string directive, name;
        words >> directive >> name;
        // What refuses another model of the name.
        if (directive == "#ifdef" || directive == "#if" || directive == "#error" ||
            directive == "#end")
            continue;
        INFO(line);
        CHECK((directive == "#declare" || directive == "#local"));
        const auto kind_end = name.find("_chair_scale");
        REQUIRE(kind_end != name.npos);
        const std::string rest = name.substr(kind_end + 12);
        CHECK((rest.empty() || rest.starts_with("__")));
        ++declared;
    }
    CHECK(declared > 12);
}

TEST_CASE("an include file comes without an .ini, and ends in .inc or .pov") {
    const test::TempDir folder;
    const NormalisedScene scene = normalise(things(), small);
    const ExportOptions options = {.pov_style = PovStyle::include};
    const Exported exported = write_pov(scene, small, folder / "things.inc", options);
    CHECK(exported.files ==
          std::vector<test::fs::path>{folder / "things.inc", folder / "things_textures/grain.png"});
    CHECK(exported.losses.empty());
    CHECK(write_pov(scene, small, folder / "b.pov", options).files[0] == folder / "b.pov");
    CHECK_FALSE(test::fs::exists(folder / "b.ini"));
    CHECK(has(example_of(test::read(folder / "b.pov")), "#include \"b.pov\""));
    CHECK(test::message_of([&] { write_pov(scene, small, folder / "things.txt", options); }) ==
          (folder / "things.txt").string() +
              ": an include file of POV-Ray must end in .inc or .pov");
    CHECK(test::message_of([&] { write_pov(scene, small, folder / "things.inc"); }) ==
          (folder / "things.inc").string() + ": a POV-Ray scene must end in .pov");
}

TEST_CASE("the example in an include file shows what the tracer shows") {
    NEEDS_POVRAY();
    const test::TempDir folder;
    const NormalisedScene scene = normalise(things(), small);
    write_pov(scene, small, folder / "things.inc", {.pov_style = PovStyle::include});
    require_same(render(scene, small),
                 pictured(folder, example_of(test::read(folder / "things.inc"))));
}

TEST_CASE("an include file refuses to stand beside another model of its name") {
    const auto guard = [](const Scene& scene) {
        const std::string text = include_text(scene);
        const auto at = text.find("#ifdef (Content_things)\n  #if (Content_things != ");
        REQUIRE(at != std::string::npos);
        CHECK(has(text, "#error \"Another model named things is included already"));
        return text.substr(at, text.find("#end", at) - at);
    };
    Scene other = things();
    other.materials[1].color = Color(0.1F);
    CHECK(guard(things()) == guard(things()));
    CHECK(guard(things()) != guard(other));
}

TEST_CASE("an included model can be placed in its own units") {
    NEEDS_POVRAY();
    // Far away and large: both scale and offset count.
    Scene scene = things();
    scene.planes.clear();
    Matrix place;
    place.setScale(1024.0);
    place[3][0] = 65536;
    for (Instance& instance : scene.instances) instance.transform *= place;
    scene.spheres[0].center = scene.spheres[0].center * place;
    scene.spheres[0].radius *= 1024;
    scene.materials.back().pattern = {};
    for (Light& light : scene.lights) light.position = light.position * place;
    scene.cameras[0].position = scene.cameras[0].position * place;

    const test::TempDir folder;
    const NormalisedScene normalised = normalise(scene, small);
    REQUIRE(normalised.offset != Vec3(0));
    REQUIRE(normalised.factor != 1);
    write_pov(normalised, small, folder / "things.inc", {.pov_style = PovStyle::include});
    const View view = view_of(scene.cameras[0], small.width, small.height);
    std::ostringstream own;
    const auto vector = [](const Vec3& v) {
        return "<" + std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z) +
               ">";
    };
    own << "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n#include \"things.inc\"\n"
        << "camera { location " << vector(view.location) << " right " << vector(view.right)
        << " up " << vector(view.up) << " direction " << vector(view.direction) << " }\n";
    for (const Light& light : scene.lights)
        own << "light_source { " << vector(light.position) << ", rgb "
            << vector(Vec3(light.color) * light.intensity) << " }\n";
    own << "object { Model_things scale 1/Model_things__scale translate Model_things__offset }\n";
    const Image theirs = pictured(folder, own.str()), ours = render(normalised, small);
    const test::Agreement found = test::agreement(ours, theirs);
    CHECK(found.close >= 0.997);  // camera and lights have six decimals
    CHECK(found.lit > 0.05);
}

TEST_CASE("two included models do not clash, whatever their scales and whereabouts") {
    NEEDS_POVRAY();
    const test::TempDir folder;
    const ExportOptions options = {.pov_style = PovStyle::include};
    write_pov(normalise(everything(), small), small, folder / "first.inc", options);
    Scene other = everything();
    Matrix place;
    place.setScale(64.0);
    place[3][0] = 65536;
    for (Instance& instance : other.instances) instance.transform *= place;
    for (Sphere& sphere : other.spheres) {
        sphere.center = sphere.center * place;
        sphere.radius *= 64;
    }
    for (Material& material : other.materials) material.color = {0.1F, 0.2F, 0.9F};
    write_pov(normalise(other, small), small, folder / "second.inc", options);
    const std::string shown =
        "object { Model_first scale 1/Model_first__scale translate Model_first__offset }\n";
    const std::string first = "#include \"first.inc\"\n", second = "#include \"second.inc\"\n";
    const Image alone = pictured(folder, callers_scene("", first, shown));
    const Image both = pictured(folder, callers_scene("", first + second, shown));
    CHECK(test::agreement(alone, both).lit > 0.1);
    CHECK((alone.pixels == both.pixels));
}

TEST_CASE("nothing of a caller's #default shows in an included model") {
    NEEDS_POVRAY();
    const test::TempDir folder;
    const ExportOptions options = {.pov_style = PovStyle::include};
    write_pov(normalise(everything(), small), small, folder / "first.inc", options);
    write_pov(normalise(things(), small), small, folder / "second.inc", options);
    const auto picture = [&](const std::string& defaults) {
        return pictured(folder,
                        callers_scene(defaults, "#include \"first.inc\"\n#include \"second.inc\"\n",
                                      "object { Model_first }\n"
                                      "object { Model_second translate -z * 4 }\n"),
                        defaults.find("diffuse .1, .9") == defaults.npos);  // is experimental
    };
    const Image plain = picture("");
    CHECK(test::agreement(plain, plain).lit > 0.3);
    for (const char* defaults :
         {"#default { finish { ambient 1 diffuse 0 phong 1 reflection .5 } pigment { rgb x } }",
          "#default { finish { ambient 1 emission .3 diffuse .1, .9 brilliance 3 phong 1 "
          "phong_size 5 specular 1 roughness .3 metallic 1 crand .5 "
          "irid { .9 thickness .5 turbulence .5 } "
          "reflection { rgb .2, rgb .9 fresnel on falloff 3 exponent .5 metallic .5 } } }",
          "#default { pigment { marble frequency 5 phase .3 turbulence .8 "
          "color_map { [0 rgb x] [1 rgbt 1] } } }",
          "#default { normal { granite 2 scale .2 } }",
          "#default { pigment { rgbt 1 } normal { bumps 1 slope_map { [0 <0, 1>] [1 <1, 0>] } } "
          "}"}) {
        INFO(defaults);
        CHECK((picture(defaults).pixels == plain.pixels));
    }
}
