#include "base/process.h"
#include "support/support.h"

#include "penumbra/image.h"
#include "penumbra/povray.h"

#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <stop_token>
#include <thread>
#include <vector>

using namespace penumbra;
using test::TempDir;

namespace {

bool has_povray() { return !find_program("povray").empty(); }

// Orthographic, so that pixel (x, y) of the square wall is lit evenly: its colour is the pigment's.
const std::string wall = R"(#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { orthographic location <0,0,-5> right x*2 up y*2 direction z*5 }
background { rgb <0.1, 0.2, 1.7> }
box {
  <-1,0,0>, <1,1,1> pigment { rgb <0.3, 0.123456789, 4> }
  finish { ambient 0 emission 1 diffuse 0 }
}
)";

// Takes minutes.
const std::string slow = R"(#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0,0,-5> right x up y direction z }
plane { y, -1 pigment { rgb 1 } }
sphere { 0, 1 pigment { rgb 1 } }
light_source { <0,9,-9> rgb 1 area_light x*9, y*9, 128, 128 }
)";

test::fs::path scene(const TempDir& folder, const std::string& pov, const std::string& size = "64",
                     const std::string& ini = "s.ini") {
    test::write(folder / "s.pov", pov);
    return test::write(folder / ini, "; made by a test\nInput_File_Name=s.pov\n"
                                     "Output_File_Name=s.exr\nOutput_File_Type=E\nWidth=" +
                                         size + "\nHeight=" + size + "\nDisplay=off\n");
}

std::vector<std::string> names_in(const TempDir& folder) {
    std::vector<std::string> names;
    for (const auto& entry : test::fs::directory_iterator(folder.path))
        names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

using Names = std::vector<std::string>;

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// A program that stands in for POV-Ray.
test::fs::path script(const TempDir& folder, const std::string& text) {
    const test::fs::path file = test::write(folder / "fake", "#!/bin/sh\n" + text);
    test::fs::permissions(file, test::fs::perms::owner_all);
    return file;
}

// A process that was killed goes within moments; an orphan may stay a zombie where nobody reaps.
bool is_gone(const test::fs::path& pid_file) {
    const int id = std::atoi(test::read(pid_file).c_str());
    for (int i = 0; i < 100; ++i) {
        const std::string state = test::read("/proc/" + std::to_string(id) + "/stat");
        if (id > 0 && (kill(id, 0) != 0 || has(state, ") Z "))) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

TEST_CASE("POV-Ray's pixels come as its own float32 values") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    std::vector<double> progress;
    Watch watch;
    watch.progress = [&](double done) { progress.push_back(done); };
    PovrayOptions options;
    options.threads = 1;
    const PovrayRun run = run_povray(scene(folder, wall, "70"), 70, 70, options, watch);
    REQUIRE(run.image.width == 70);
    REQUIRE(run.image.height == 70);
    CHECK(run.image.at(0, 0) == Color(0.3F, 0.123456789F, 4));  // a half float has 0.12346
    CHECK(run.image.at(69, 34) == Color(0.3F, 0.123456789F, 4));
    CHECK(run.image.at(0, 35) == Color(0.1F, 0.2F, 1.7F));
    CHECK(run.image.at(69, 69) == Color(0.1F, 0.2F, 1.7F));

    CHECK(names_in(folder) == Names{"s.exr", "s.ini", "s.pov"});
    CHECK(run.command == Names{find_program("povray").string(), "s.ini", "+WT1"});
    CHECK(run.folder == folder.path);
    CHECK(run.seconds > 0);
    CHECK(run.cpu_seconds > 0);
    CHECK(run.cpu_seconds < 60);
    CHECK(has(run.log, "Parser Statistics"));
    CHECK_FALSE(has(run.log, "\r"));
    CHECK_FALSE(progress.empty());
    CHECK(progress.back() == 1);
    for (const double done : progress) CHECK((done >= 0 && done <= 1));
}

TEST_CASE("The user's settings of POV-Ray do not change the picture") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder, home;
    test::fs::create_directories(home / ".povray/3.7");
    // Bare pigments with all light; antialiased, so that the wall's edge is mixed.
    test::write(home / ".povray/3.7/povray.ini", "Quality=0\nAntialias=On\nStart_Row=20\n");
    test::write(home / "other.ini", "Antialias=On\n");
    const auto ini = scene(folder, wall, "65");
    const Image expected = run_povray(ini, 65, 65).image;
    const std::string before = std::getenv("HOME") ? std::getenv("HOME") : "/";
    setenv("HOME", home.path.c_str(), 1);
    const Image personal = run_povray(ini, 65, 65).image;
    setenv("POVINI", (home / "other.ini").c_str(), 1);
    const Image named = run_povray(ini, 65, 65).image;
    setenv("HOME", before.c_str(), 1);
    unsetenv("POVINI");
    CHECK(personal.pixels == expected.pixels);
    CHECK(named.pixels == expected.pixels);
}

TEST_CASE("POV-Ray's own file can be dropped, and any file name works") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    PovrayOptions options;
    options.keep_exr = false;
    const auto ini = scene(folder, wall, "8", "a [b] 'c' \"d\".ini");
    const PovrayRun run = run_povray(ini, 8, 8, options);
    CHECK(run.image.at(0, 0).z == 4);
    CHECK(names_in(folder) == Names{"a [b] 'c' \"d\".ini", "s.pov"});
}

TEST_CASE("A warning of POV-Ray is in the log") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    const PovrayRun run =
        run_povray(scene(folder, wall + "#warning \"mind the gap\"\n", "8"), 8, 8);
    CHECK(has(run.log, "File 's.pov' line 9: Parse Warning: mind the gap"));
}

TEST_CASE("A parse error has POV-Ray's place and words") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    test::write(folder / "s.exr", "of an earlier run");
    const auto ini = scene(folder, "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n"
                                   "sphere { 0,,1 }\n");
    CHECK(test::message_of([&] { run_povray(ini, 64, 64); }) ==
          (folder / "s.pov").string() +
              ":3: POV-Ray: Expected 'numeric expression', ,  found instead");
    CHECK(names_in(folder) == Names{"s.ini", "s.pov"});  // nothing stale, nothing partial

    // POV-Ray breaks long lines; the message does not.
    scene(folder, "#version 3.7;\n#error \"one two three four five six seven eight nine ten eleven "
                  "twelve thirteen fourteen\"\n");
    CHECK(test::message_of([&] { run_povray(ini, 64, 64); }) ==
          (folder / "s.pov").string() +
              ":2: POV-Ray: Parse halted by #error directive: one two three four five six seven "
              "eight nine ten eleven twelve thirteen fourteen");
}

TEST_CASE("A missing file is named") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    const auto ini = scene(folder, "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n"
                                   "#include \"nowhere.inc\"\n");
    const std::string message = test::message_of([&] { run_povray(ini, 64, 64); });
    CHECK(has(message, (folder / "s.pov").string() + ":3: POV-Ray: "));
    CHECK(has(message, "'nowhere.inc'"));
    test::fs::remove(folder / "s.pov");
    CHECK(has(test::message_of([&] { run_povray(ini, 64, 64); }),
              ini.string() + ": POV-Ray: Cannot find file 's.pov'"));
}

TEST_CASE("A picture of another size is refused") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    const auto ini = scene(folder, wall, "16");
    CHECK(test::message_of([&] { run_povray(ini, 8, 8); }) ==
          ini.string() + ": POV-Ray's picture has 16x16 pixels, not 8x8");
}

TEST_CASE("A missing POV-Ray is said") {
    const TempDir folder;
    const auto ini = scene(folder, wall);
    const std::string missing = ": not found";
    PovrayOptions options;
    options.binary = "no-such-povray";
    CHECK(test::message_of([&] { run_povray(ini, 64, 64, options); }) ==
          "no-such-povray" + missing);
    options.binary = ini.string();  // there, but not executable
    CHECK(test::message_of([&] { run_povray(ini, 64, 64, options); }) == ini.string() + missing);
    CHECK(test::message_of([&] { povray_version(options); }) == ini.string() + missing);
    CHECK(test::remedy_of([&] { povray_version(options); }) == Remedy::program);

    const std::string path = std::getenv("PATH");
    setenv("PATH", folder.path.c_str(), 1);
    CHECK(test::message_of([&] { run_povray(ini, 64, 64); }) == "povray" + missing);
    setenv("PATH", path.c_str(), 1);
    setenv("PENUMBRA_POVRAY", "/nowhere/povray", 1);
    CHECK(test::message_of([&] { run_povray(ini, 64, 64); }) == "/nowhere/povray" + missing);
    unsetenv("PENUMBRA_POVRAY");
}

TEST_CASE("A missing or strange ini file is said") {
    const TempDir folder;
    PovrayOptions options;
    options.binary = script(folder, "exit 0\n").string();
    const auto ini = folder / "x.ini";
    CHECK(test::message_of([&] { run_povray(ini, 4, 4, options); }) ==
          ini.string() + ": no such file");
    test::write(ini, "Width=4\n");
    CHECK(test::message_of([&] { run_povray(ini, 4, 4, options); }) ==
          ini.string() + ": has no Output_File_Name that says where the picture is");
}

TEST_CASE("A slow scene is stopped by the time limit") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    const auto ini = scene(folder, slow, "2048");
    PovrayOptions options;
    options.timeout = std::chrono::seconds(1);
    const auto begin = std::chrono::steady_clock::now();
    CHECK(test::message_of([&] { run_povray(ini, 2048, 2048, options); }) ==
          ini.string() + ": POV-Ray did not finish within 1 s and was stopped");
    CHECK(seconds_since(begin) < 5);
    CHECK(names_in(folder) == Names{"s.ini", "s.pov"});
}

TEST_CASE("A running POV-Ray ends on request") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    const auto ini = scene(folder, slow, "2048");
    std::stop_source source;
    Watch watch;
    watch.stop = source.get_token();
    std::chrono::steady_clock::time_point asked;
    std::jthread user([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        asked = std::chrono::steady_clock::now();
        source.request_stop();
    });
    try {
        run_povray(ini, 2048, 2048, {}, watch);
        FAIL("was not stopped");
    } catch (const Error& error) {
        CHECK(error.failure == Failure::interrupted);
    }
    CHECK(seconds_since(asked) < 3);  // 0.4 s on an idle machine
    CHECK(names_in(folder) == Names{"s.ini", "s.pov"});
}

TEST_CASE("The children of a stopped program end with it, however deaf") {
    const TempDir folder;
    const auto ini = scene(folder, wall);
    PovrayOptions options;
    options.timeout = std::chrono::seconds(1);
    options.binary = script(folder, "trap '' TERM\nsh -c 'echo $$ > child; exec sleep 30' &\n"
                                    "sleep 30\nsleep 30\n")
                         .string();
    CHECK(has(test::message_of([&] { run_povray(ini, 64, 64, options); }),
              "POV-Ray did not finish within 1 s"));
    CHECK(is_gone(folder / "child"));

    // One that ends well leaves none behind either.
    options.binary =
        script(folder, "sh -c 'echo $$ > child; exec sleep 30' &\nsleep 0.3\nexit 0\n").string();
    CHECK(has(test::message_of([&] { run_povray(ini, 64, 64, options); }),
              "POV-Ray left no picture"));
    CHECK(is_gone(folder / "child"));
}

TEST_CASE("A program that dies or fails without a word is said") {
    const TempDir folder;
    const auto ini = scene(folder, wall);
    PovrayOptions options;
    options.binary = script(folder, "kill -SEGV $$\n").string();
    CHECK(test::message_of([&] { run_povray(ini, 64, 64, options); }) ==
          ini.string() + ": POV-Ray was ended by signal 11 (Segmentation fault)");
    options.binary = script(folder, "echo run >> runs; exit 3\n").string();
    CHECK(test::message_of([&] { run_povray(ini, 64, 64, options); }) ==
          ini.string() + ": POV-Ray failed with status 3 and did not say why");
    CHECK(test::read(ini.parent_path() / "runs") == "run\n");
    options.binary = script(folder, "echo 'Possible Parse Error: assumed_gamma'\n"
                                    "echo 'Cannot create render state output file.'; exit 1\n")
                         .string();
    CHECK(test::message_of([&] { run_povray(ini, 64, 64, options); }) ==
          ini.string() + ": POV-Ray: Cannot create render state output file");
    options.binary = test::write(folder / "fake", "no program").string();
    CHECK(has(test::message_of([&] { run_povray(ini, 64, 64, options); }),
              (folder / "fake").string() + ": cannot be started: "));
}

TEST_CASE("A POV-Ray whose thread does not start in time is started again") {
    const TempDir folder;
    const auto ini = scene(folder, wall);
    PovrayOptions options;
    const std::string late =
        "echo run >> runs; echo 'Timed out waiting for worker thread startup' >&2; exit 1\n";
    options.binary = script(folder, late).string();
    CHECK(test::message_of([&] { run_povray(ini, 64, 64, options); }) ==
          ini.string() + ": POV-Ray: Timed out waiting for worker thread startup");
    CHECK(test::read(folder / "runs") == "run\nrun\nrun\nrun\nrun\n");

    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const std::string once = "test -e late && exec povray \"$@\"; touch late\n" + late;
    options.binary = script(folder, once).string();
    CHECK(run_povray(ini, 64, 64, options).image.at(32, 16).x == Approx(0.3));
}

TEST_CASE("A talkative program neither blocks nor fills the memory") {
    const TempDir folder;
    const auto ini = scene(folder, wall);
    Command command;
    command.argv = {script(folder, "head -c 20000000 /dev/zero | tr '\\0' x; echo end\n").string()};
    const Finished finished = run(command);
    CHECK(finished.how == Finished::How::exited);
    CHECK(finished.code == 0);
    CHECK(finished.output.size() < 4'000'000);
    CHECK(finished.output.ends_with("xend\n"));
}

TEST_CASE("A program reads nothing, runs in its folder and gets its arguments as they are") {
    const TempDir folder;
    Command command;
    command.argv = {script(folder, "pwd; cat; printf '%s|' \"$@\"; exit 7\n").string(), "a b",
                    "$HOME", "'\"*"};
    command.folder = test::fs::canonical(folder.path);
    const Finished finished = run(command);
    CHECK(finished.output == command.folder.string() + "\na b|$HOME|'\"*|");
    CHECK(finished.code == 7);
}

TEST_CASE("A program gets its own variables") {
    const TempDir folder;
    setenv("PENUMBRA_TEST_GONE", "1", 1);
    setenv("PENUMBRA_TEST_KEPT", "2", 1);
    Command command;
    command.argv = {
        script(folder, "echo $PENUMBRA_TEST_GONE,$PENUMBRA_TEST_KEPT,$HOME\n").string()};
    command.environment = {{"PENUMBRA_TEST_GONE", ""}, {"HOME", "/a b"}};
    CHECK(run(command).output == ",2,/a b\n");
    unsetenv("PENUMBRA_TEST_GONE");
    unsetenv("PENUMBRA_TEST_KEPT");
}

TEST_CASE("The picture file serves when there is no render-state file") {
    const TempDir folder;
    Image picture(3, 2);
    picture.at(2, 1) = {0.5F, 0.25F, 8};
    save_image(folder / "made.exr", picture);
    const auto ini = scene(folder, wall);
    PovrayOptions options;
    options.binary = script(folder, "cp made.exr s.exr\n").string();
    CHECK(run_povray(ini, 3, 2, options).image.at(2, 1) == Color(0.5F, 0.25F, 8));
    CHECK(names_in(folder) == Names{"fake", "made.exr", "s.exr", "s.ini", "s.pov"});
}

TEST_CASE("The version is told") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    CHECK(povray_version().starts_with("POV-Ray 3."));
}
