// What exports write to, and what they leave alone.
#include "exporters/pov_stage.h"
#include "exporters/shared/targets.h"

using namespace penumbra;
using test::fs::path;

namespace {

const RenderOptions small = {.width = 32, .height = 24};

// A ball that shows an image of that name; its mesh gives the export a geometry file.
NormalisedScene ball_with(const std::string& image, Depth depth = Depth::u8) {
    test::Stage stage;
    Material m = test::shiny("wood");
    m.color = Color(1);
    m.pattern = ImageMap{.texture = stage.add(test::picture(image, 3, depth))};
    stage.mesh(test::ball(stage.add(m)));
    return normalise(stage.scene, small);
}

// A floor with an image, which Tachyon shows.
NormalisedScene floor_with_image(bool image) {
    test::Stage stage;
    if (image)
        stage.scene.materials[0].pattern =
            ImageMap{.texture = stage.add(test::picture("tiles")), .size = 2};
    return normalise(stage.scene, small);
}

std::vector<path> files_in(const path& folder) {
    std::vector<path> files;
    for (const auto& entry : test::fs::recursive_directory_iterator(folder))
        if (!entry.is_directory()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

TEST_CASE("an export, overwrites no input by any name") {
    const NormalisedScene scene = ball_with("oak");
    const std::string problem =
        ": is one of the inputs, which are never overwritten; give what is written another name";
    for (const char* name :
         {"chair.pov", "chair.ini", "chair_geometry.inc", "chair_textures/oak.png"}) {
        for (const std::string way : {"itself", "symbolic link", "hard link"}) {
            INFO(name << " by " << way);
            const test::TempDir folder;
            const path target = folder / name;
            test::fs::create_directories(target.parent_path());
            const path input = way == "itself" ? target : folder / "model/image.png";
            test::write(input, "; Run in this folder: povray x.ini, written by penumbra");
            if (way == "symbolic link") test::fs::create_symlink(input, target);
            if (way == "hard link") test::fs::create_hard_link(input, target);
            const std::vector<path> before = files_in(folder.path);
            for (const bool replace : {false, true}) {
                const ExportOptions options = {.inputs = {folder / "none", input},
                                               .replace = replace};
                CHECK(test::message_of([&] {
                          write_pov(scene, small, folder / "chair.pov", options);
                      }) == target.string() + problem);
            }
            CHECK(files_in(folder.path) == before);
            CHECK(test::read(input).ends_with("x.ini, written by penumbra"));
        }
    }
}

TEST_CASE("an export, replaces what an export has written and nothing else") {
    const NormalisedScene scene = ball_with("oak"), floats = ball_with("sun", Depth::f32);
    const test::TempDir folder;
    const path file = folder / "chair.pov";
    for (const NormalisedScene* each : {&scene, &floats, &scene}) write_pov(*each, small, file);
    write_pov(scene, small, folder / "chair.inc", {.pov_style = PovStyle::include});
    write_tachyon(floor_with_image(true), small, folder / "chair.dat");
    const std::vector<path> written = files_in(folder.path);
    for (const path& each : written) {
        INFO(each);
        CHECK(is_own_file(each));
        const std::string whole = test::read(each);
        test::write(each, "somebody's work");
        const auto again = [&](bool replace) {
            const path target =
                folder / ("chair" + (each.extension() == ".dat" || each.extension() == ".ppm"
                                         ? std::string(".dat")
                                     : each == folder / "chair.inc" ? ".inc"
                                                                    : ".pov"));
            ExportOptions options = {.replace = replace};
            if (target.extension() == ".inc") options.pov_style = PovStyle::include;
            export_scene(target.extension() == ".dat" ? floor_with_image(true) : scene, small,
                         target, options);
        };
        CHECK(test::message_of([&] { again(false); }) ==
              each.string() + ": is there already, and not from an export; give the scene another "
                              "name");
        CHECK(test::remedy_of([&] { again(false); }) == Remedy::replace);
        CHECK(test::read(each) == "somebody's work");
        again(true);
        CHECK(test::read(each) == whole);
    }
    CHECK(files_in(folder.path) == written);
}

TEST_CASE("an export's name is refused early when somebody's file has it") {
    const test::TempDir folder;
    test::write(folder / "a.pov", "sphere { 0, 1 }");
    CHECK(test::message_of([&] { check_export_file(folder / "a.pov"); }) ==
          (folder / "a.pov").string() +
              ": is there already, and not from an export; give the scene another name");
    CHECK(test::message_of([&] { check_export_file(folder / "a.pov", {.replace = true}); }) == "");
}

TEST_CASE("an export, removes the textures of an earlier one that it does not need") {
    const test::TempDir folder;
    const path file = folder / "chair.pov", textures = folder / "chair_textures";
    write_pov(ball_with("oak"), small, file);
    write_pov(ball_with("sun", Depth::f32), small, folder / "other.pov");
    test::write(textures / "mine.png", "somebody's");
    test::write(textures / "notes.txt", "written by penumbra's user");
    test::fs::copy_file(textures / "oak.png", textures / "kept.png");

    const ExportOptions options = {.inputs = {textures / "kept.png"}};
    const Exported exported = write_pov(ball_with("ash"), small, file, options);
    CHECK(exported.removed == std::vector{textures / "oak.png"});
    CHECK(files_in(textures) == std::vector{textures / "ash.png", textures / "kept.png",
                                            textures / "mine.png", textures / "notes.txt"});
    CHECK(test::fs::exists(folder / "other_textures/sun.exr"));
    CHECK(write_pov(ball_with("sun"), small, folder / "other.pov").removed ==
          std::vector{folder / "other_textures/sun.exr"});
}

TEST_CASE("an export, keeps the textures that another export of its name may need") {
    const test::TempDir folder;
    const ExportOptions include = {.pov_style = PovStyle::include};
    write_pov(ball_with("oak"), small, folder / "chair.pov");
    CHECK(write_pov(ball_with("ash"), small, folder / "chair.inc", include).removed.empty());
    CHECK(test::fs::exists(folder / "chair_textures/oak.png"));
    test::fs::remove(folder / "chair.pov");
    CHECK(write_pov(ball_with("elm"), small, folder / "chair.inc", include).removed.size() == 2);
}

TEST_CASE("a Tachyon scene, removes the images of an earlier one that it does not need") {
    const test::TempDir folder;
    for (const char* name : {"a.dat", "a-1.dat"})
        write_tachyon(floor_with_image(true), small, folder / name);
    test::write(folder / "a-7.ppm", "P6\n1 1\n255\nabc");
    CHECK(write_tachyon(floor_with_image(false), small, folder / "a.dat").removed ==
          std::vector{folder / "a-0.ppm"});
    CHECK(test::fs::exists(folder / "a-1-0.ppm"));
    CHECK(test::fs::exists(folder / "a-7.ppm"));
}
