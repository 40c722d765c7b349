// Models that are included in scenes of one's own.
#include "pov_stage.h"

#include <sstream>

using namespace penumbra;

namespace {

const RenderOptions small = {.width = 240, .height = 180};

std::string include_text(const Scene& scene, const std::string& stem = "things") {
    return pov_text(normalise(scene, small), small, stem, {.style = PovStyle::include});
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

// The picture that POV-Ray makes of scene.pov in `folder`, which has this text.
Image pictured(const test::TempDir& folder, const std::string& text) {
    test::write(folder / "scene.pov", text);
    test::write(folder / "scene.ini", "Input_File_Name=scene.pov\nOutput_File_Name=scene.exr\n"
                                      "Output_File_Type=E\nWidth=240\nHeight=180\n"
                                      "Antialias=Off\nDisplay=Off\nPause_When_Done=Off\n");
    const PovrayRun run = run_povray(folder / "scene.ini", small.width, small.height);
    CHECK(test::warnings(run.log) == "");
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
    CHECK(has(text, "#declare Material_wood ="));
    CHECK(has(text, "#declare Model_scale ="));
    CHECK(has(text, "#include \"things_geometry.inc\""));
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
    CHECK(has(include_text(things(), "scale"), "#declare Model_scale_2 = union {"));
    CHECK(has(include_text(things(), "my chair"), "#declare Model_my_chair"));
}

TEST_CASE("an include file comes without an .ini, and ends in .inc or .pov") {
    const test::TempDir folder;
    const NormalisedScene scene = normalise(things(), small);
    const PovOptions options = {.style = PovStyle::include};
    const Exported exported = write_pov(scene, small, folder / "things.inc", options);
    CHECK(exported.files == std::vector<test::fs::path>{folder / "things.inc",
                                                        folder / "things_geometry.inc",
                                                        folder / "things_textures/grain.png"});
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
    write_pov(scene, small, folder / "things.inc", {.style = PovStyle::include});
    require_same(render(scene, small),
                 pictured(folder, example_of(test::read(folder / "things.inc"))));
}

TEST_CASE("an included model can be placed in its own units") {
    NEEDS_POVRAY();
    // Far away and large: both Model_scale and Model_offset count.
    Scene scene = things();
    scene.planes.clear();
    Matrix place;
    place.setScale(64.0);
    place[3][0] = 65536;
    for (Instance& instance : scene.instances) instance.transform *= place;
    scene.spheres[0].center = scene.spheres[0].center * place;
    scene.spheres[0].radius *= 64;
    scene.materials.back().pattern = {};
    for (Light& light : scene.lights) light.position = light.position * place;
    scene.cameras[0].position = scene.cameras[0].position * place;

    const test::TempDir folder;
    const NormalisedScene normalised = normalise(scene, small);
    REQUIRE(normalised.offset != Vec3(0));
    REQUIRE(normalised.factor != 1);
    write_pov(normalised, small, folder / "things.inc", {.style = PovStyle::include});
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
    own << "object { Model_things scale 1/Model_scale translate Model_offset }\n";
    const Image theirs = pictured(folder, own.str()), ours = render(normalised, small);
    const test::Agreement found = test::agreement(ours, theirs);
    CHECK(found.close >= 0.997);  // camera and lights have six decimals
    CHECK(found.lit > 0.05);
}
