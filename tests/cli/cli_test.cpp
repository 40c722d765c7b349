// What goes wrong: exit statuses, messages, and nothing left behind.
#include "support/program.h"

#include <algorithm>

using namespace test;

TEST_CASE("the version is told without loading OpenImageIO") {
    const TempDir folder;
    const Ended ended = run(folder.path, {"--version"}, {{"LD_DEBUG", "files"}});
    CHECK(ended.status == 0);
    CHECK(ended.out.starts_with("penumbra "));
    CHECK(ended.err.find("libc.so") != std::string::npos);
    CHECK(ended.err.find("OpenImageIO") == std::string::npos);
}

TEST_CASE("every command has a help with an example") {
    const TempDir folder;
    for (const std::string command : {"render", "export", "validate", "compare", "info"}) {
        const Ended ended = run(folder.path, {command, "--help"});
        INFO(command);
        CHECK(ended.status == 0);
        CHECK(ended.err.empty());
        CHECK(ended.out.find("Example:\n  penumbra " + command + " ") != std::string::npos);
    }
    CHECK(run(folder.path, {"--help"}).out.find("validate") != std::string::npos);
}

TEST_CASE("errors of the library name the option that helps") {
    const TempDir folder;
    write(folder / "scene.toml", small_scene);
    write(folder / "a.obj", std::string("mtllib ../a.mtl\n") + cube_corner);
    const auto sleeper =
        write(folder / "sleeper", "#!/bin/sh\n[ \"$1\" = --version ] && echo POV-Ray 3.7 && exit\n"
                                  "exec sleep 60\n");
    fs::permissions(sleeper, fs::perms::owner_all);
    const auto error_of = [&](int status, const Words& words) {
        const Ended ended = run(folder.path, words);
        INFO(ended.err);
        CHECK(ended.status == status);
        return ended.err;
    };
    CHECK(error_of(5, {"validate", "scene.toml", "--povray", "none"})
              .ends_with("none: not found (install the package povray, or name it with --povray or "
                         "PENUMBRA_POVRAY)\n"));
    CHECK(error_of(5, {"validate", "scene.toml", "--povray", sleeper.string(), "--timeout", "1"})
              .ends_with("POV-Ray did not finish within 1 s and was stopped (allow it more with "
                         "--timeout)\n"));
    CHECK(error_of(3, {"info", "a.obj", "--strict"})
              .ends_with("'../a.mtl' lies outside the model's folder (--allow-path DIR lets models "
                         "read files below DIR)\n"));
    CHECK(error_of(2, {"info", "a.obj", "--allow-path", "none"}) ==
          "penumbra: error: --allow-path: 'none' is not a folder\n");
    CHECK(error_of(2, {"info", "scene.toml", "--set", "render.samples=0"}) ==
          "penumbra: error: --set render.samples=0: 'samples' in [render] must be from 1 to 9, not "
          "0\n");
    CHECK(error_of(2, {"info", "scene.toml", "--set", ""}) ==
          "penumbra: error: --set : must be KEY=VALUE, such as lighting.ambient=0.1\n");
}

TEST_CASE("a wrong command line exits with 2 and one sentence") {
    const TempDir folder;
    const auto error_of = [&](const Words& words) {
        const Ended ended = run(folder.path, words);
        CHECK(ended.status == 2);
        CHECK(ended.out.empty());
        return ended.err;
    };
    CHECK(error_of({}) == "penumbra: error: no command is given (see 'penumbra --help')\n");
    CHECK(error_of({"rendr"}) ==
          "penumbra: error: unknown command 'rendr' (did you mean 'render'?) (see 'penumbra "
          "--help')\n");
    CHECK(error_of({"rendre"}).find("'rendre' (did you mean 'render'?)") != std::string::npos);
    CHECK(error_of({"render", "a.obj", "--sizee", "3x2"}) ==
          "penumbra: error: unknown option '--sizee' (did you mean '--size'?) (see 'penumbra "
          "render --help')\n");
    CHECK(error_of({"render"}) ==
          "penumbra: error: no input is given (see 'penumbra render --help')\n");
    CHECK(error_of({"render", "a.obj", "--size", "800"}) ==
          "penumbra: error: --size: '800' is not WIDTHxHEIGHT in pixels from 1 to 32767, such as "
          "800x600\n");
    CHECK(error_of({"render", "a.obj", "--samples", "0"}) ==
          "penumbra: error: --samples: '0' is not a whole number from 1 to 9\n");
    CHECK(error_of({"render", "a.obj", "--antialias", "fine"}) ==
          "penumbra: error: --antialias: 'fine' is not a number from 0 to 1000\n");
    CHECK(error_of({"render", "a.obj", "--antialias-depth", "10"}) ==
          "penumbra: error: --antialias-depth: '10' is not a whole number from 1 to 9\n");
    CHECK(error_of({"render", "a.obj", "--exposure", "bright"}) ==
          "penumbra: error: --exposure: 'bright' is not a number from -32 to 32\n");
    CHECK(error_of({"render", "a.obj", "--normal-maps", "bump"}) ==
          "penumbra: error: --normal-maps: 'bump' is not bake, drop or pixel\n");
    CHECK(error_of({"export", "a.obj", "--pov-style", "inc"}) ==
          "penumbra: error: --pov-style: 'inc' is not standalone or include\n");
    CHECK(error_of({"render", "a.obj", "--environment", "1,2"}) ==
          "penumbra: error: --environment: '1,2' is not R,G,B in linear numbers of 0 or more, such "
          "as 0.1,0.1,0.2\n");
    CHECK(error_of({"render", "a.obj", "--background", "1,nan,0"}) ==
          "penumbra: error: --background: '1,nan,0' is not R,G,B in linear numbers of 0 or more, "
          "such as 0.1,0.1,0.2\n");
    CHECK(error_of({"render", "a.obj", "--depth", "16", "-o", "a.exr"}) ==
          "penumbra: error: --depth: 16 bits are for .png and .tif, not .exr\n");
    CHECK(error_of({"render", "a.obj", "--depth", "16", "-o", "a.JPG"}) ==
          "penumbra: error: --depth: 16 bits are for .png and .tif, not .jpg\n");
    CHECK(error_of({"compare", "a.png"}) == "penumbra: error: compare takes two pictures or two "
                                            "folders, not 1 (see 'penumbra compare --help')\n");
    CHECK(error_of({"compare", "a.png", "b.png", "--profile", "lax"}).find("lax") !=
          std::string::npos);
    CHECK(error_of({"validate", "a.obj", "--jobs", "2"}) ==
          "penumbra: error: --jobs: needs --each or --manifest\n");
    CHECK(entries(folder.path) == 0);
}

TEST_CASE("PENUMBRA_THREADS is checked like an option") {
    const TempDir folder;
    const Ended ended = run(folder.path, {"info", "a.obj"}, {{"PENUMBRA_THREADS", "many"}});
    CHECK(ended.status == 2);
    CHECK(ended.err ==
          "penumbra: error: PENUMBRA_THREADS: 'many' is not a whole number from 0 to 1024\n");
}

TEST_CASE("an input that cannot be read exits with 3, whatever the command") {
    const TempDir folder;
    test::write(folder / "empty.glb", "");
    test::write(folder / "cut.glb", std::string("glTF\2\0\0\0\377\0\0\0", 12));
    test::write(folder / "range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    test::write(folder / "typo.toml", "[[sphere]]\nraduis = 2\n");
    test::write(folder / "model.stl", "solid\n");
    for (const std::string command : {"render", "export", "validate", "info"}) {
        for (const std::string name :
             {"missing.gltf", "empty.glb", "cut.glb", "range.obj", "typo.toml", "model.stl"}) {
            const Ended ended = run(folder.path, {command, name});
            INFO(command << ' ' << name << ": " << ended.err);
            CHECK(ended.status == (command == "validate" && !has_povray() ? 5 : 3));
            CHECK(ended.out.empty());
            CHECK(ended.err.starts_with("penumbra: error: "));
            CHECK(std::count(ended.err.begin(), ended.err.end(), '\n') == 1);
        }
    }
    CHECK(entries(folder.path) == 5);
    CHECK(run(folder.path, {"info", "missing.gltf"}).err ==
          "penumbra: error: missing.gltf: no such file\n");
    CHECK(
        run(folder.path, {"info", "range.obj"}).err.starts_with("penumbra: error: range.obj:4: "));
    CHECK(run(folder.path, {"info", "typo.toml"}).err ==
          "penumbra: error: typo.toml:2:1: unknown key 'raduis' in [[sphere]] (did you mean "
          "'radius'?)\n");
    CHECK(run(folder.path, {"compare", "missing.png", "b.png"}).status == 3);
}

TEST_CASE("an output that cannot be written exits with 4 before any work") {
    const TempDir folder;
    test::write(folder / "scene.toml", small_scene);
    test::write(folder / "file", "");
    const auto error_of = [&](const Words& words) {
        const Ended ended = run(folder.path, words);
        CHECK(ended.status == 4);
        CHECK(ended.out.empty());
        return ended.err;
    };
    CHECK(error_of({"render", "scene.toml", "-o", "no/a.png"}) ==
          "penumbra: error: no/a.png: its folder does not exist\n");
    CHECK(error_of({"render", "scene.toml", "-o", "file/a.png"}) ==
          "penumbra: error: file/a.png: 'file' is not a folder\n");
    CHECK(error_of({"render", "scene.toml", "-o", "/proc/a.png"})
              .starts_with("penumbra: error: /proc/a.png: cannot write"));
    CHECK(error_of({"render", "scene.toml", "-o", "a.webp"}) ==
          "penumbra: error: a.webp: unknown picture format (use .png, .exr, .tif, .jpg or .hdr)\n");
    CHECK(error_of({"export", "scene.toml", "-o", "a.txt"}) ==
          "penumbra: error: a.txt: unknown scene format (use one of: .pov, .inc, .dat)\n");
    CHECK(error_of({"export", "scene.toml", "-o", "a.inc"}) ==
          "penumbra: error: a.inc: a POV-Ray scene must end in .pov\n");
    CHECK(error_of({"export", "scene.toml", "-o", "a.dat", "--pov-style", "include"}) ==
          "penumbra: error: a.dat: an include file of POV-Ray must end in .inc or .pov\n");
    CHECK(error_of({"export", "scene.toml", "-o", "no/a.pov"}) ==
          "penumbra: error: no/a.pov: its folder does not exist\n");
    CHECK(error_of({"validate", "scene.toml", "--report", "file"}) ==
          "penumbra: error: file: is not a folder\n");
    CHECK(error_of({"validate", "scene.toml", "--report", "no/report"}) ==
          "penumbra: error: no/report: its folder does not exist\n");
    CHECK(entries(folder.path) == 2);
}

TEST_CASE("a missing or failing POV-Ray exits with 5") {
    const TempDir folder;
    test::write(folder / "scene.toml", small_scene);
    const Ended named = run(folder.path, {"validate", "scene.toml", "--povray", "/none/povray"});
    CHECK(named.status == 5);
    CHECK(named.err.find("/none/povray") != std::string::npos);
    CHECK(run(folder.path, {"validate", "scene.toml"}, {{"PENUMBRA_POVRAY", "/none/povray"}})
              .status == 5);
    CHECK(run(folder.path, {"validate", "scene.toml", "--povray", "/bin/false"}).status == 5);
    CHECK(entries(folder.path) == 1);
}

TEST_CASE("a failing POV-Ray is told of with the names that the report has in the end") {
    const TempDir folder;
    test::write(folder / "scene.toml", small_scene);
    const auto failing =
        test::write(folder / "povray",
                    "#!/bin/sh\ntest \"$1\" = --version && echo POV-Ray 3.7.0.10.unofficial\n");
    fs::permissions(failing, fs::perms::owner_all);
    const auto error_of = [&](const std::vector<std::string>& words) {
        std::vector<std::string> all = {"validate", "scene.toml", "--povray", failing.string(),
                                        "--report"};
        all.insert(all.end(), words.begin(), words.end());
        const Ended ended = run(folder.path, all);
        CHECK(ended.status == 5);
        return ended.err;
    };
    const std::string why = ": POV-Ray failed with status 1 and did not say why\n";
    CHECK(error_of({"new"}).ends_with("penumbra: error: new/scene.ini" + why));
    CHECK(error_of({"new"}).ends_with("penumbra: error: new/scene.ini" + why));
    CHECK(fs::exists(folder / "new/scene.ini"));
    CHECK(test::read(folder / "new/report.json").find(".tmp") == std::string::npos);
    CHECK(error_of({"all", "--each"}).ends_with("penumbra: error: all/scene/scene.ini" + why));
    CHECK(fs::exists(folder / "all/scene/scene.ini"));
    CHECK(test::read(folder / "all/scene/index.html").find(".tmp") == std::string::npos);
}

TEST_CASE("a full standard output is an output failure") {
    const TempDir folder;
    test::write(folder / "a.obj", cube_corner);
    const std::string command = std::string(PENUMBRA_PROGRAM) + " info " +
                                (folder / "a.obj").string() + " >/dev/full 2>/dev/null";
    const int status = std::system(command.c_str());
    CHECK(WEXITSTATUS(status) == 4);
}

namespace {

// Hours of work.
constexpr const char* endless = "[render]\nsize = [8000, 8000]\nsamples = 9\n"
                                "[[sphere]]\nmaterial = \"m\"\n[material.m]\ncolor = [1, 1, 1]\n"
                                "[[light]]\ntype = \"point\"\nposition = [3, 5, 4]\n"
                                "penumbra = { delta = 1, pattern = \"sphere\", count = 200 }\n";

void check_interrupted(const fs::path& folder, const Words& words, int signal) {
    Running running(folder, words);
    running.wait_until_it_handles(signal);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    const auto start = std::chrono::steady_clock::now();
    kill(running.pid, signal);
    const Ended ended = running.wait();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    CHECK(ended.status == 130);
    CHECK(ended.out.empty());
    CHECK(ended.err == "penumbra: error: interrupted\n");
    CHECK(seconds.count() < 3);  // one on an idle machine
}

}  // namespace

TEST_CASE("an interrupted run exits with 130 soon and leaves what was there") {
    const TempDir folder;
    test::write(folder / "scene.toml", endless);
    test::write(folder / "scene.png", "old");
    check_interrupted(folder.path, {"render", "scene.toml"}, SIGINT);
    check_interrupted(folder.path, {"render", "scene.toml"}, SIGTERM);
    CHECK(test::read(folder / "scene.png") == "old");
    if (has_povray()) check_interrupted(folder.path, {"validate", "scene.toml"}, SIGINT);
    CHECK(entries(folder.path) == 2);
}
