// The text that the exporter writes.
#include "base/file.h"
#include "exporters/pov/files.h"
#include "exporters/pov/geometry.h"
#include "exporters/pov/plan.h"
#include "exporters/pov/sdl.h"
#include "support/golden.h"
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/exporters.h"

#include <cstring>
#include <limits>
#include <sstream>

using namespace penumbra;

namespace {

const RenderOptions small = {.width = 160, .height = 120};

std::string text_of(const Scene& scene, const std::string& stem = "scene") {
    return pov_text(test::as_is(scene), small, stem);
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

Texture two_texels(const std::string& name) {
    return {.name = name,
            .raster = {.width = 2,
                       .height = 1,
                       .channels = 3,
                       .data = {std::byte(1), std::byte(2), std::byte(3), std::byte(4),
                                std::byte(5), std::byte(6)}}};
}

// An orthographic camera along -z: its vectors need no trigonometry, whose last digit may differ
// from one C library to the next.
Scene golden_scene() {
    Scene scene = test::empty_scene();
    scene.cameras[0].projection = Camera::Projection::orthographic;
    scene.lights = {{.name = "lamp", .position = {3, 5, 4}, .intensity = 0.8}};
    return scene;
}

Scene golden_shapes() {
    Scene scene = golden_scene();
    scene.background = {0.1F, 0.2F, 0.3F};
    scene.lights[0].attenuation = Attenuation{.distance = 10, .power = 2};
    scene.lights[0].penumbra.delta = 0.25;
    scene.lights.push_back({.name = "sun", .type = Light::Type::directional});
    scene.lights.push_back(
        {.type = Light::Type::spot, .position = {0, 8, 0}, .color = {1, 0.5F, 0.25F}});
    scene.materials = {{.name = "clay", .color = {0.8F, 0.4F, 0.2F}},
                       {.name = "mirror", .metallic = 0.5F, .reflection = Color(0.6F)},
                       {.name = "lamp shade", .color = {1, 0, 0.5F}, .emission = {0.5F, 0.25F, 0}},
                       {.name = "glass", .opacity = 0.25F, .ior = 1.5F},
                       {.name = "floor", .pattern = Checker{.size = 0.5, .origin = {0, 1, 0}}},
                       {.name = "cloud", .pattern = Noise{.size = 2, .octaves = 3}},
                       {.name = "wood", .pattern = ImageMap{.texture = 0, .size = 4}}};
    scene.textures = {two_texels("boards/oak.jpg")};
    for (Index i = 0; i < scene.materials.size(); ++i)
        scene.spheres.push_back({.name = "ball", .center = {2.0 * i, 0, 0}, .material = i});
    scene.planes = {{"ground", {0, -1, 0}, {0, 2, 0}, 4}, {"table", {0, 1, 0}, {0, 1, 0}, 6}};
    return scene;
}

Scene golden_meshes() {
    Scene scene = golden_scene();
    scene.materials = {{.name = "clay"},
                       {.name = "painted", .color = {1, 0.5F, 0.25F}},
                       {.name = "wood", .pattern = ImageMap{.texture = 0}}};
    scene.textures = {two_texels("oak")};
    scene.textures[0].wrap_u = Wrap::mirror;
    test::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 0);
    scene.meshes[0].name = "panel";
    scene.meshes[0].normals = {{0, 0, 1}, {0, 0, 1}, {0, 0.6F, 0.8F}, {0, 0, 0}};
    Instance second = scene.instances[0];
    second.name = "left panel";
    second.transform.translate(Vec3(-2, 0, 0));
    scene.instances.push_back(second);
    second.name = "slanted panel";
    second.transform = Matrix(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0.5, 0, 1, 2, 3, 1);
    scene.instances.push_back(second);
    for (const Index material : {1U, 2U}) {
        Mesh mesh = scene.meshes[0];
        mesh.normals.clear();
        mesh.material = material;
        mesh.texcoords = {{0, 0}, {0.1F, 0}, {2, 1}, {-0.5F, 1}};
        mesh.colors = {Color(1), Color(1, 0.5F, 0), Color(1), Color(1)};
        scene.meshes.push_back(mesh);
        scene.instances.push_back({.name = "panel", .mesh = material});
    }
    return scene;
}

}  // namespace

TEST_CASE("pov, of no samples is an error of usage") {
    const NormalisedScene scene = test::as_is(test::empty_scene());
    const std::string wrong = "a picture must have at least 1 sample a pixel, not 0";
    const test::TempDir folder;
    CHECK(test::message_of([&] { write_pov(scene, {.samples = 0}, folder / "a.pov"); }) == wrong);
    CHECK(test::message_of([&] { pov_text(scene, {.samples = 0}, "a"); }) == wrong);
    CHECK(test::message_of([&] { pov_losses(scene, {.samples = 0}); }) == wrong);
    CHECK(test::fs::is_empty(folder.path));
}

TEST_CASE("sdl numbers, are the shortest that read back") {
    CHECK(sdl::number(0.1F) == "0.1");
    CHECK(sdl::number(0.1) == "0.1");
    CHECK(sdl::number(double(0.1F)) == "0.10000000149011612");
    CHECK(sdl::number(-0.0) == "0");
    CHECK(sdl::number(-0.0F) == "0");
    CHECK(sdl::number(1e30F) == "1e+30");
    CHECK(sdl::number(-2.5e-7) == "-2.5e-07");
    CHECK(sdl::number(std::size_t(12)) == "12");
}

TEST_CASE("sdl texture coordinates, keep ten decimals") {
    const auto text = [](float value) {
        std::string out = "<";
        sdl::append_fixed(out, value);
        return out;
    };
    CHECK(text(0.1F) == "<0.1000000015");
    CHECK(text(0.5F) == "<0.5");
    CHECK(text(-3) == "<-3");
    CHECK(text(10) == "<10");
    CHECK(text(-1e-20F) == "<0");
    CHECK(text(-0.0F) == "<0");
    CHECK(text(std::numeric_limits<float>::max()) == "<340282346638528859811704183484516925440");
}

TEST_CASE("sdl colours, are short when grey and opaque") {
    CHECK(sdl::color(Color(0.5F)) == "rgb 0.5");
    CHECK(sdl::color(Color(1, 0.5F, 0)) == "rgb <1, 0.5, 0>");
    CHECK(sdl::color(Color(1), 0.25F) == "rgbt <1, 1, 1, 0.25>");
}

TEST_CASE("sdl words, are safe in identifiers and file names") {
    CHECK(sdl::word("Cube.001") == "Cube_001");
    CHECK(sdl::word("../../etc/passwd") == "etc_passwd");
    CHECK(sdl::word("St\xc3\xbchle") == "St_hle");
    CHECK(sdl::word("\xe6\x97\xa5\xe6\x9c\xac").empty());
    CHECK(sdl::word(std::string(500, 'x')).size() == 48);
}

TEST_CASE("sdl comments, cannot end") {
    CHECK(sdl::comment("a\nb\r\tc") == "a b  c");
    CHECK(sdl::comment("*/ evil /*") == "* / evil / *");
    CHECK(sdl::comment("\x1b[31m\x7f") == "?[31m?");
    CHECK(sdl::comment("caf\xc3\xa9") == "caf?");
    CHECK(sdl::comment(std::string(500, 'x'), 10) == "xxxxxxx...");
}

TEST_CASE("sdl names, are unique whatever their case") {
    sdl::Names names;
    CHECK(names.unique("box", "?") == "box");
    CHECK(names.unique("box_2", "?") == "box_2");
    CHECK(names.unique("Box", "?") == "Box_3");
    CHECK(names.unique("box", "?") == "box_4");
    CHECK(names.unique("", "7") == "7");
}

TEST_CASE("export, equals the reviewed files") {
    const ExportOptions options = {.source = "shapes.toml",
                                   .command = "penumbra export shapes.toml -o shapes.pov",
                                   .losses = {{Loss::dropped, "shapes.toml", "sheen is ignored"}}};
    test::check_golden("shapes.pov",
                       pov_text(test::as_is(golden_shapes()), small, "shapes", options));
    test::check_golden("meshes.pov", pov_text(test::as_is(golden_meshes()), small, "meshes"));
    const Scene meshes = golden_meshes();
    test::check_golden("meshes_geometry.inc",
                       pov::geometry_text(pov::make_plan(meshes, small, "meshes")));
}

TEST_CASE("export, makes POV-Ray anti-alias by the same rule") {
    const test::TempDir folder;
    RenderOptions options = small;
    options.samples = 12;  // does not count
    options.antialiasing = Antialiasing{.threshold = 0.25, .depth = 4};
    const Exported exported = write_pov(test::as_is(golden_meshes()), options, folder / "a.pov");
    CHECK(exported.losses.empty());
    CHECK(test::read(folder / "a.ini")
              .find("; adaptive anti-aliasing, threshold 0.25, depth 4\n"
                    "Antialias=On\n"
                    "Sampling_Method=2\n"
                    "Antialias_Threshold=0.25\n"
                    "Antialias_Depth=4\n"
                    "Antialias_Gamma=2.5\n"
                    "Jitter=Off\n") != std::string::npos);
    CHECK(test::read(folder / "a.pov")
              .find("160 x 120 pixels, adaptive anti-aliasing, threshold 0.25, depth 4, 5 ") !=
          std::string::npos);
}

TEST_CASE("export, writes every file that the scene needs") {
    const test::TempDir folder;
    RenderOptions options = small;
    options.samples = 3;
    const Exported exported =
        write_pov(test::as_is(golden_meshes()), options, folder / "meshes.pov");
    CHECK(exported.files == std::vector{folder / "meshes.pov", folder / "meshes.ini",
                                        folder / "meshes_geometry.inc",
                                        folder / "meshes_textures/oak.png"});
    CHECK(exported.losses.empty());
    CHECK(test::read(folder / "meshes.ini") == R"(; Run in this folder: povray meshes.ini
Input_File_Name="meshes.pov"
Output_File_Name="meshes.exr"
Output_File_Type=E
Width=160
Height=120
; every pixel on a fixed grid of 3 x 3 rays
Antialias=On
Sampling_Method=1
Antialias_Threshold=0.0
Antialias_Depth=3
Jitter=Off
Display=Off
Pause_When_Done=Off
)");
    for (const auto& entry : test::fs::directory_iterator(folder.path))
        CHECK(entry.path().extension() != ".tmp");
    const Raster mirrored = decode_image(read_bytes(exported.files[3]), "oak.png");
    CHECK(mirrored.width == 4);
    CHECK(mirrored.data == std::vector{std::byte(1), std::byte(2), std::byte(3), std::byte(4),
                                       std::byte(5), std::byte(6), std::byte(4), std::byte(5),
                                       std::byte(6), std::byte(1), std::byte(2), std::byte(3)});
}

TEST_CASE("export, gives the same bytes every time") {
    CHECK(text_of(golden_shapes()) == text_of(golden_shapes()));
}

TEST_CASE("export, keeps files of a name that POV-Ray cannot open beside copies that it can") {
    const test::TempDir folder;
    const Exported exported =
        write_pov(test::as_is(golden_meshes()), small, folder / "my ch\xc3\xa4ir.pov");
    REQUIRE(exported.files.size() == 6);
    const std::string stem = exported.files[1].stem().string();
    CHECK(stem.starts_with("my_ch_ir_"));
    CHECK(exported.files[0] == folder / "my ch\xc3\xa4ir.pov");
    CHECK(exported.files[4] == folder / "my ch\xc3\xa4ir.ini");
    CHECK(exported.files[5] == folder / (stem + ".pov"));
    for (const test::fs::path& file : exported.files) CHECK(test::fs::exists(file));
    CHECK(test::read(exported.files[0]) == test::read(exported.files[5]));
    CHECK(has(test::read(exported.files[4]), "Input_File_Name=\"" + stem + ".pov\""));
    CHECK(has(test::read(exported.files[0]), "#include \"" + stem + "_geometry.inc\""));
}

TEST_CASE("safe stems, differ for different names") {
    CHECK(pov::safe_stem("chair-2.v1") == "chair-2.v1");
    CHECK(pov::safe_stem("my chair") != pov::safe_stem("my_chair"));
    CHECK(pov::safe_stem("my chair") != pov::safe_stem("my+chair"));
    CHECK(pov::safe_stem("-x") != "-x");
    CHECK(pov::safe_stem("\xe6\x97\xa5").starts_with("scene_"));
}

TEST_CASE("export, says why it cannot write") {
    const test::TempDir folder;
    const auto message = [&](const test::fs::path& file) {
        return test::message_of([&] { write_pov(test::as_is(golden_meshes()), small, file); });
    };
    CHECK(message(folder / "scene.txt") ==
          (folder / "scene.txt").string() + ": a POV-Ray scene must end in .pov");
    CHECK(message(folder / "none/scene.pov") ==
          (folder / "none/scene.ini").string() + ": its folder does not exist");
    test::write(folder / "taken_textures", "a file");
    CHECK(message(folder / "taken.pov") == (folder / "taken_textures").string() +
                                               ": cannot make the folder: a file of that name "
                                               "is in the way");
    CHECK(!test::fs::exists(folder / "taken.pov"));
}

TEST_CASE("export, leaves out what cannot be seen") {
    Scene scene = golden_scene();
    test::add_mesh(scene, {{0, 0, 0}}, {});
    test::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    scene.instances.pop_back();
    const std::string text = text_of(scene);
    CHECK(!has(text, "Mesh_"));
    CHECK(!has(text, "#include"));
    CHECK(pov::geometry_text(pov::make_plan(scene, small, "scene")).empty());
}

// Nothing that a model calls itself may become a statement.
TEST_CASE("export, keeps the names of a model out of the code") {
    const std::string evil = "x */ #error \"a\"\n#include \"evil.inc\" } // \xc3\xa9 \\ \"";
    Scene scene = golden_meshes();
    for (Material& m : scene.materials) m.name = evil;
    for (Texture& t : scene.textures) t.name = evil;
    for (Mesh& m : scene.meshes) m.name = evil;
    for (Instance& i : scene.instances) i.name = evil;
    for (Light& l : scene.lights) l.name = evil;
    for (Camera& c : scene.cameras) c.name = evil;
    scene.spheres = {{.name = evil, .material = 0}};
    scene.planes = {{evil, {}, {0, 1, 0}, 0}};
    const ExportOptions options = {
        .source = evil, .command = evil, .losses = {{Loss::approximated, evil, evil}}};
    const std::string text = pov_text(test::as_is(scene), small, "scene", options) +
                             pov::geometry_text(pov::make_plan(scene, small, "scene"));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::string code = line.substr(0, line.find("//"));
        CHECK(!has(code, "#error"));
        CHECK(!has(code, "evil.inc"));
        for (const char c : line) REQUIRE((c >= ' ' && c <= '~'));
    }
}

TEST_CASE("export, names what POV-Ray cannot do") {
    Scene scene = golden_meshes();
    scene.materials[2].color = Color(1);
    scene.materials[2].metallic = 1;
    scene.materials[2].opacity = 0.5F;
    scene.textures[0].wrap_v = Wrap::clamp;
    scene.planes = {{"floor", {}, {0, 1, 0}, 2}};
    const RenderOptions render = {.samples = 12, .max_depth = 300};
    const Losses losses = pov::make_plan(scene, render, "scene").losses;
    const Losses expected = {
        {Loss::approximated, "oak",
         "the clamped image is used so far outside of its edges that it is repeated there"},
        {Loss::approximated, "wood",
         "highlights and reflections of the textured metal take no vertex colours: "
         "approximate"},
        {Loss::approximated, "wood",
         "vertex colours over a translucent texture also tint what lies behind"},
        {Loss::approximated, "max_depth", "POV-Ray follows at most 256 ray segments"},
        {Loss::approximated, "samples", "POV-Ray's grid has at most 9 x 9 samples"}};
    CHECK(losses == expected);
    CHECK(has(text_of(scene), "//   wood: vertex colours over a translucent texture also tint "
                              "what lies behind\n"));
}

TEST_CASE("export, names float textures that POV-Ray cannot read exactly") {
    Scene scene = golden_meshes();
    const auto losses_of = [&](float texel) {
        Raster& raster = scene.textures[0].raster;
        raster = {.width = 1, .height = 1, .channels = 1, .depth = Depth::f32};
        raster.data.resize(sizeof texel);
        std::memcpy(raster.data.data(), &texel, sizeof texel);
        return pov::make_plan(scene, small, "scene").losses;
    };
    CHECK(losses_of(0.25F).empty());
    CHECK(losses_of(0.1F) == Losses{{Loss::approximated, "oak",
                                     "POV-Ray reads float images with 11 significant bits"}});
}

TEST_CASE("textures, of one image and wrapping share a file") {
    Scene scene = golden_meshes();
    scene.textures.push_back(scene.textures[0]);
    scene.textures.push_back(scene.textures[0]);
    scene.textures[1].bilinear = false;
    scene.textures[2].wrap_u = Wrap::repeat;
    for (Index i = 0; i < 3; ++i) {
        scene.materials.push_back({.name = "wood", .pattern = ImageMap{.texture = i}});
        scene.spheres.push_back({.material = 3 + i});
    }
    const auto textures = pov::make_plan(scene, small, "scene").textures;
    CHECK(textures[0].file == "scene_textures/oak.png");
    CHECK(textures[1].file == "scene_textures/oak.png");
    CHECK(textures[2].file == "scene_textures/oak_2.png");
}

TEST_CASE("clamped textures, are padded as far as they are used") {
    Scene scene = golden_meshes();
    Texture& texture = scene.textures[0];
    texture.wrap_u = texture.wrap_v = Wrap::clamp;
    const pov::TextureFile file = pov::make_plan(scene, small, "scene").textures[0];
    // u is used from -0.5 to 2, which is from texel -1 to texel 4, and one more for the filter
    CHECK(file.u.first == -2);
    CHECK(file.u.first + file.u.count - 1 == 4);
    const Raster raster = pov::baked(texture, file);
    REQUIRE(raster.width == 7);
    const auto red = [&](int column) {
        return std::to_integer<int>(raster.data[std::size_t(column) * 3]);
    };
    CHECK(red(0) == 1);
    CHECK(red(2) == 1);
    CHECK(red(3) == 4);
    CHECK(red(6) == 4);
}
