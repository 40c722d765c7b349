// What becomes of a scene in a file of Tachyon, and what Tachyon makes of that.
#include "base/process.h"
#include "support/golden.h"
#include "support/small_scenes.h"

#include "penumbra/exporters.h"
#include "penumbra/light_model.h"
#include "penumbra/tracer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

using namespace penumbra;

namespace {

const RenderOptions small = {.width = 160, .height = 120};

struct Written {
    test::TempDir folder = {};
    Exported exported = {};
    std::string text = {};

    explicit Written(const Scene& scene, const RenderOptions& options = small)
        : exported(write_tachyon(test::as_is(scene), options, folder / "scene.dat")),
          text(test::read(folder / "scene.dat")) {}
};

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

Texture two_texels() {
    return {.name = "oak",
            .raster = {.width = 2,
                       .height = 1,
                       .channels = 3,
                       .data = {std::byte(255), std::byte(128), std::byte(0), std::byte(0),
                                std::byte(255), std::byte(64)}}};
}

// An orthographic camera, whose vectors need no trigonometry.
Scene stage() {
    Scene scene = test::empty_scene();
    scene.cameras[0].projection = Camera::Projection::orthographic;
    scene.cameras[0].extent = 8;
    scene.lights = {{.name = "lamp", .position = {3, 5, 4}, .intensity = 0.8}};
    return scene;
}

Scene golden() {
    Scene scene = stage();
    scene.background = {0.1F, 0.2F, 0.3F};
    scene.lights[0].attenuation = Attenuation{.distance = 10, .power = 2};
    scene.lights.push_back({.name = "sun", .type = Light::Type::directional});
    scene.lights.push_back(
        {.name = "cone", .type = Light::Type::spot, .position = {0, 8, 0}, .color = {1, 0.5F, 0}});
    scene.lights[2].attenuation = Attenuation{.distance = 4, .power = 1};
    scene.textures = {two_texels()};
    scene.materials = {
        {.name = "clay", .color = {0.8F, 0.4F, 0.2F}},
        {.name = "gold", .metallic = 1, .reflection = Color(0.6F)},
        {.name = "glass", .opacity = 0.25F},
        {.name = "matte", .specular = 0, .smooth = false},
        {.name = "wood", .color = Color(1), .pattern = ImageMap{.texture = 0, .size = 4}}};
    scene.spheres = {{"ball", {2, 0, 1}, 0.5, 1}, {"bubble", {-2, 0, 1}, 0.75, 2}};
    scene.planes = {{"table", {0, -1, 0}, {0, 1, 0}, 4}};
    test::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 0);
    scene.meshes[0].normals = {{0, 0, 1}, {0, 0, 1}, {0, 0.6F, 0.8F}, {0, 0, 1}};
    Instance mirrored = scene.instances[0];
    mirrored.transform = Matrix(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1);
    scene.instances.push_back(mirrored);
    test::add_quad(scene, {0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}, 3);
    return scene;
}

// What Tachyon cannot show as it is.
Scene beyond_tachyon() {
    Scene scene = stage();
    scene.background = Color(0.5F);
    scene.textures = {two_texels()};
    scene.sky = Sky{.texture = 0};
    scene.lights = {{.name = "cone",
                     .type = Light::Type::spot,
                     .attenuation = Attenuation{.distance = 1, .power = 3}}};
    scene.materials = {
        {.name = "gold", .ambient = {0.1F, 0, 0}, .metallic = 0.6F, .reflection = {0.6F, 0.5F, 0}},
        {.name = "glass",
         .emission = Color(1),
         .opacity = 0.5F,
         .transmission = 1,
         .ior = 1.5F,
         .fresnel = true,
         .absorption = Absorption{}},
        {.name = "leaf",
         .pattern = ImageMap{.texture = 0},
         .alpha_map = AlphaMap{.map = {.texture = 0}}},
        {.pattern = ImageMap{.texture = 0}}};
    scene.materials[1].reflection = Color(1);
    scene.materials[2].specular_lobes = SpecularLobes{.lobes = {{}, {}}};
    scene.textures[0].wrap_u = Wrap::clamp;
    for (Index i = 0; i < 3; ++i) scene.spheres.push_back({"", Vec3(i, 0, 0), 1, i});
    scene.planes = {{"floor", {}, {0, 1, 0}, 3}};
    test::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 0);
    scene.meshes[0].colors = std::vector(4, Color(0.5F));
    return scene;
}

// Tachyon's picture of a .dat, linear; nothing where it is not installed.
Image drawn(const test::TempDir& folder, const std::string& file) {
    const auto tachyon = find_program("tachyon");
    const Finished ran =
        run({.argv = {tachyon.string(), file, "-shade_phong", "-format", "PPM48", "-o", "out.ppm"},
             .folder = folder.path});
    INFO(ran.output);
    REQUIRE((ran.how == Finished::How::exited && ran.code == 0));
    std::istringstream in(test::read(folder / "out.ppm"));
    std::string magic;
    int width = 0, height = 0, largest = 0;
    in >> magic >> width >> height >> largest;
    in.get();
    REQUIRE(largest == 65535);
    Image image(width, height);
    for (Color& pixel : image.pixels)
        for (int k = 0; k < 3; ++k) {
            const int high = in.get();
            pixel[k] = float(high * 256 + in.get()) / 65535.0F;
        }
    REQUIRE(in.good());
    return image;
}

Vec3 mean(const Image& image) {
    Vec3 sum(0);
    for (const Color& pixel : image.pixels)
        for (int k = 0; k < 3; ++k) sum[k] += double(std::clamp(pixel[k], 0.0F, 1.0F));
    return sum / double(image.pixels.size());
}

// The share of pixels that are background in one picture and not in the other.
double silhouettes_apart(const Image& a, const Image& b, const Color& background) {
    double count = 0;
    const auto behind = [&](const Color& c) { return (c - background).length() < 1e-4F; };
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        count += behind(a.pixels[i]) != behind(b.pixels[i]) ? 1 : 0;
    return count / double(a.pixels.size());
}

}  // namespace

TEST_CASE("a Tachyon scene, equals the reviewed file") {
    const Written written(golden());
    test::check_golden("scene.dat", written.text);
    CHECK(written.exported.files ==
          std::vector{written.folder / "scene.dat", written.folder / "scene-0.ppm"});
    // sRGB 128 is 0.2159 in linear light, 64 is 0.0513.
    CHECK(test::read(written.folder / "scene-0.ppm") ==
          std::string("P6\n# penumbra\n2 1\n255\n\xff\x37\x00\x00\xff\x0d", 28));
}

TEST_CASE("a Tachyon scene, says what Tachyon lacks") {
    CHECK(Written(stage()).exported.losses.empty());
    RenderOptions options = small;
    options.samples = 3;
    const Losses expected = {
        {Loss::dropped, "background", "the image is left out"},
        {Loss::approximated, "samples", "rays lie at random in the pixel"},
        {Loss::approximated, "max_depth", "where a path ends, the background is added"},
        {Loss::approximated, "cone", "the edge of its cone fades linearly with the angle"},
        {Loss::approximated, "cone", "it fades with the square of the distance"},
        {Loss::approximated, "cone", "its highlights do not fade with its light"},
        {Loss::approximated, "a material", "the image is not tinted"},
        {Loss::approximated, "a material", "the image repeats"},
        {Loss::approximated, "a material",
         "the image has 8 bits of linear light, and blurs with the distance"},
        {Loss::approximated, "gold", "ambient light becomes grey"},
        {Loss::approximated, "gold", "the mirror becomes grey"},
        {Loss::approximated, "gold", "the mirror is not tinted by the metal"},
        {Loss::approximated, "gold", "highlights are those of a metal or of plastic"},
        {Loss::approximated, "gold", "a metal's highlight is the same for every light"},
        {Loss::dropped, "glass", "emission is left out"},
        {Loss::approximated, "glass", "the mirror is no stronger in grazing light"},
        {Loss::approximated, "glass", "what is seen through it is not tinted"},
        {Loss::approximated, "glass", "light passes straight through it"},
        {Loss::dropped, "glass", "absorption is left out"},
        {Loss::dropped, "leaf", "the alpha map is left out: the surface is whole"},
        {Loss::approximated, "leaf", "highlight and mirror become the same all over it"},
        {Loss::approximated, "leaf", "the pattern becomes its mean colour"},
        {Loss::dropped, "mesh", "vertex colours are left out"},
    };
    const Written written(beyond_tachyon(), options);
    for (const Loss& loss : expected) {
        INFO(loss.place << ": " << loss.what);
        CHECK(std::find(written.exported.losses.begin(), written.exported.losses.end(), loss) !=
              written.exported.losses.end());
    }
    CHECK(written.exported.losses.size() == expected.size());
    CHECK(has(written.text, "ANTIALIASING 9 "));

    options.antialiasing = Antialiasing{.depth = 2};
    const Written adaptive(beyond_tachyon(), options);
    const Loss loss = {Loss::approximated, "antialias",
                       "every pixel has as many rays, at random in it"};
    CHECK(std::ranges::count(adaptive.exported.losses, loss) == 1);
    CHECK(adaptive.exported.losses.size() == expected.size());
    CHECK(has(adaptive.text, "ANTIALIASING 4 "));
}

TEST_CASE("a Tachyon scene, says that a studio's floor is one like any other") {
    Scene scene = stage();
    scene.planes = {{.name = "floor", .material = 0, .casts_shadow = false, .in_mirrors = false}};
    CHECK(Written(scene).exported.losses ==
          Losses{{Loss::approximated, "floor", "it casts shadows"},
                 {Loss::approximated, "floor", "mirrors show it"}});
}

TEST_CASE("a Tachyon light, is 1 in the middle of the scene and fades as ours") {
    Scene scene = stage();
    scene.spheres = {{"ball", {0, 0, 0}, 1, 0}};
    scene.lights = {{.position = {0, 0, 6}, .intensity = 5e6}};
    for (const double power : {1.0, 2.0}) {
        scene.lights[0].attenuation = Attenuation{.distance = 0.01, .power = power};
        const std::string text = Written(scene).text;
        double constant = 0, linear = 0, quadratic = 0, colour = 0;
        REQUIRE(std::sscanf(text.c_str() + text.find("ATTENUATION"),
                            "ATTENUATION CONSTANT %lf LINEAR %lf QUADRATIC %lf COLOR %lf",
                            &constant, &linear, &quadratic, &colour) == 4);
        for (const double d : {2.0, 6.0, 20.0}) {
            const double factor = 1 / (constant + linear * d + quadratic * d * d);
            const double ours = 2 / (1 + std::pow(d / 0.01, power));
            CHECK(factor * colour / (ours * 5e6) == Approx(1).margin(1e-4));
            if (d == 6) CHECK(factor == Approx(1).margin(1e-4));
        }
    }
}

TEST_CASE("a Tachyon scene, has names of images that Tachyon reads") {
    const test::TempDir folder;
    const NormalisedScene scene = test::as_is(golden());
    const Exported exported = write_tachyon(scene, small, folder / "my ch\xc3\xa4ir.dat");
    CHECK(exported.files[1] == folder / "my=20ch=c3=a4ir-0.ppm");
    CHECK(has(test::read(exported.files[0]), "TEXFUNC 9 my=20ch=c3=a4ir-0.ppm CENTER"));
    const test::fs::path longest = folder / (std::string(74, 'x') + "-0.ppm");
    write_tachyon(scene, small, folder / (std::string(74, 'x') + ".dat"));
    CHECK(test::fs::exists(longest));
    const test::fs::path longer = folder / (std::string(75, 'x') + ".dat");
    CHECK(test::message_of([&] { write_tachyon(scene, small, longer); }) ==
          (folder / (std::string(75, 'x') + "-0.ppm")).string() +
              ": Tachyon reads names of images of at most 80 bytes; give the scene a shorter name");
    CHECK_FALSE(test::fs::exists(longer));
}

TEST_CASE("a Tachyon scene, replaces no image that is not an export's") {
    const test::TempDir folder;
    const NormalisedScene scene = test::as_is(golden());
    const test::fs::path image = folder / "wood-0.ppm";
    write_tachyon(scene, small, folder / "wood.dat");
    write_tachyon(scene, small, folder / "wood.dat");
    const std::string before = test::read(folder / "wood.dat");
    for (const std::string theirs : {"P6\n1 1\n255\nabc", "", "P6\n# penumbr"}) {
        test::write(image, theirs);
        CHECK(test::message_of([&] { write_tachyon(scene, {}, folder / "wood.dat"); }) ==
              image.string() +
                  ": is there already, and not from an export; give the scene another name");
        CHECK(test::read(image) == theirs);
        CHECK(test::read(folder / "wood.dat") == before);
    }
    CHECK(std::distance(test::fs::directory_iterator(folder.path), {}) == 2);
}

TEST_CASE("a Tachyon scene, has no more images than Tachyon holds") {
    Scene scene = stage();
    for (Index i = 0; i < 45; ++i) {
        scene.textures.push_back(two_texels());
        scene.materials.push_back({.name = "m", .pattern = ImageMap{.texture = i}});
        scene.planes.push_back({"wall", Vec3(i), {0, 0, 1}, i + 1});
    }
    const Written written(scene);
    CHECK(written.exported.files.size() == 1 + 39);
    const Loss loss = {Loss::approximated, "m", "the pattern becomes its mean colour"};
    const Losses& losses = written.exported.losses;
    CHECK(std::find(losses.begin(), losses.end(), loss) != losses.end());
}

TEST_CASE("the formats of scenes, are chosen by the extension") {
    const test::TempDir folder;
    const NormalisedScene scene = test::as_is(stage());
    std::vector<std::string> extensions;
    for (const ExportFormat& format : export_formats())
        for (const std::string& extension : format.extensions) {
            extensions.push_back(extension);
            const test::fs::path file = folder / ("a" + extension);
            const ExportOptions options = {.pov_style = extension == ".inc" ? PovStyle::include
                                                                            : PovStyle::standalone};
            CHECK(export_scene(scene, small, file, options).files[0] == file);
            CHECK(test::fs::exists(file));
        }
    CHECK(extensions == std::vector<std::string>{".pov", ".inc", ".dat"});
}

TEST_CASE("the formats of scenes, are told in upper case too") {
    const test::TempDir folder;
    const NormalisedScene scene = test::as_is(stage());
    for (const char* name : {"a.POV", "b.Dat", "c.INC"}) {
        const auto file = folder / name;
        const ExportOptions options = {.pov_style =
                                           *name == 'c' ? PovStyle::include : PovStyle::standalone};
        check_export_file(file, options);
        CHECK(export_scene(scene, small, file, options).files[0] == file);
        CHECK(test::fs::exists(file));
    }
    CHECK(has(test::read(folder / "a.ini"), "Input_File_Name=\"a.POV\""));
    CHECK(test::message_of([&] { check_export_file("a.INC"); }) ==
          "a.INC: a POV-Ray scene must end in .pov");
}

TEST_CASE("the formats of scenes, are listed for another extension") {
    const auto message = [&](const std::string& file, PovStyle style = PovStyle::standalone) {
        return test::message_of([&] { check_export_file(file, {.pov_style = style}); });
    };
    const std::string list = " (use one of: .pov, .inc, .dat)";
    CHECK(message("a.txt") == "a.txt: unknown scene format" + list);
    CHECK(message("a.gltf") == "a.gltf: unknown scene format" + list);
    CHECK(message("a") == "a: its name has no extension" + list);
    CHECK(message("a.povv") == "a.povv: unknown scene format (did you mean '.pov'?)");
    CHECK(message("a.POVV") == "a.POVV: unknown scene format (did you mean '.pov'?)");
    CHECK(message("a.inc") == "a.inc: a POV-Ray scene must end in .pov");
    CHECK(message("a.dat", PovStyle::include) ==
          "a.dat: an include file of POV-Ray must end in .inc or .pov");
    CHECK(message("a.dat").empty());
    const test::TempDir folder;
    const NormalisedScene scene = test::as_is(stage());
    CHECK(test::message_of([&] { export_scene(scene, small, folder / "a.txt"); }) ==
          (folder / "a.txt").string() + ": unknown scene format" + list);
    CHECK(test::message_of([&] { write_tachyon(scene, small, folder / "a.txt"); }) ==
          (folder / "a.txt").string() + ": a Tachyon scene must end in .dat");
    CHECK(test::message_of([&] { write_tachyon(scene, small, folder / "no/a.dat"); }) ==
          (folder / "no/a.dat").string() + ": its folder does not exist");
    CHECK(test::fs::is_empty(folder.path));
}

TEST_CASE("Tachyon draws what the tracer draws, nearly") {
    if (find_program("tachyon").empty()) PENUMBRA_SKIP("Tachyon is not installed");
    Scene scene = golden();
    scene.background = {0, 0, 0.25F};
    scene.cameras[0] = {.position = {2, 3, 9}, .direction = {-0.2, -0.3, -0.9}};
    scene.planes = {};
    scene.materials[1].metallic = 0;
    scene.spheres.push_back({"far ball", {-1, 1.5, -2}, 1, 3});
    const Written written(scene);
    const Image theirs = drawn(written.folder, "scene.dat");
    const Image ours = render(test::as_is(scene), small);
    REQUIRE((theirs.width == ours.width && theirs.height == ours.height));
    const Vec3 us = mean(ours), them = mean(theirs);
    INFO("means " << us.x << ' ' << us.y << ' ' << us.z << " and " << them.x << ' ' << them.y << ' '
                  << them.z);
    for (int k = 0; k < 3; ++k) CHECK(them[k] == Approx(us[k]).epsilon(0.02));
    CHECK(silhouettes_apart(ours, theirs, scene.background) == 0);
}

TEST_CASE("Tachyon lays images on planes where the tracer does") {
    if (find_program("tachyon").empty()) PENUMBRA_SKIP("Tachyon is not installed");
    // Four fields of different colours, large, so that Tachyon does not blur them.
    Raster fields = {.width = 64, .height = 64, .channels = 3};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (const int value : {x < 32 ? 255 : 0, y < 32 ? 255 : 0, 128})
                fields.data.push_back(std::byte(value));
    Scene scene = stage();
    scene.cameras[0].extent = 50;
    scene.textures = {{.name = "fields", .raster = fields}};
    scene.materials = {{.name = "wall",
                        .color = Color(1),
                        .pattern = ImageMap{.texture = 0, .size = 40},
                        .ambient = Color(1),
                        .diffuse = 0,
                        .specular = 0}};
    scene.planes = {{"wall", {3, 2, 0}, {0, 0, 1}, 0}};
    const Written written(scene);
    const Image theirs = drawn(written.folder, "scene.dat");
    const Image ours = render(test::as_is(scene), small);
    double apart = 0;
    for (std::size_t i = 0; i < ours.pixels.size(); ++i)
        apart += double((ours.pixels[i] - theirs.pixels[i]).length());
    CHECK(apart / double(ours.pixels.size()) < 0.02);
}
