// What goes right: results on standard output and in files.
#include "support/program.h"

#include <nlohmann/json.hpp>

#include <array>
#include <sstream>

using namespace test;
using nlohmann::json;

TEST_CASE("render writes the picture that it is asked for") {
    const TempDir folder;
    test::write(folder / "scene.toml", small_scene);
    const Ended ended = run(folder.path, {"render", "scene.toml"});
    CHECK(ended.status == 0);
    CHECK(ended.err.empty());
    CHECK(ended.out.starts_with("scene.png: 32 x 24 pixels in "));
    CHECK(test::read(folder / "scene.png").substr(1, 3) == "PNG");

    CHECK(run(folder.path, {"render", "scene.toml", "-q", "-o", "a.exr"}).out.empty());
    CHECK(run(folder.path, {"render", "scene.toml", "-o", "16.png", "--depth", "16"}).status == 0);
    CHECK(test::read(folder / "16.png")[24] == 16);  // bit depth in IHDR
    CHECK(run(folder.path, {"render", "--sidecar", "scene.toml", "-o", "b.exr"}).status == 0);
    CHECK(test::read(folder / "a.exr") == test::read(folder / "b.exr"));
}

TEST_CASE("the same command writes the same bytes for any number of threads") {
    const TempDir folder;
    test::write(folder / "scene.toml", small_scene);
    CHECK(run(folder.path, {"render", "scene.toml", "-o", "1.exr", "--threads", "1"}).status == 0);
    CHECK(run(folder.path, {"render", "scene.toml", "-o", "4.exr"}, {{"PENUMBRA_THREADS", "4"}})
              .status == 0);
    CHECK(test::read(folder / "1.exr") == test::read(folder / "4.exr"));
}

TEST_CASE("options override the sidecar, and later ones earlier ones") {
    const TempDir folder;
    test::write(folder / "scene.toml", small_scene);
    const auto size = [&](const Words& more) {
        Words words = {"render", "scene.toml", "--json"};
        words.insert(words.end(), more.begin(), more.end());
        const json result = json::parse(run(folder.path, words).out);
        return std::array<int, 2>{result["width"], result["height"]};
    };
    using Size = std::array<int, 2>;
    CHECK(size({}) == Size{32, 24});
    CHECK(size({"--size", "20x10"}) == Size{20, 10});
    CHECK(size({"--size", "20x10", "--set", "render.size=[8,9]"}) == Size{8, 9});
    CHECK(size({"--set", "render.size=[8,9]", "--size", "20x10"}) == Size{20, 10});
    CHECK(size({"--size=20x10", "--size=21x11"}) == Size{21, 11});
}

TEST_CASE("render and export anti-alias unless they are told where rays go") {
    const TempDir folder;
    test::write(folder / "scene.toml", small_scene);
    const auto picture = [&](const Words& more) {
        Words words = {"render", "scene.toml", "-q", "-o", "a.exr"};
        words.insert(words.end(), more.begin(), more.end());
        REQUIRE(run(folder.path, words).status == 0);
        return test::read(folder / "a.exr");
    };
    const std::string plain = picture({});
    CHECK(plain == picture({"--antialias", "0.2", "--antialias-depth", "2"}));
    CHECK(plain == picture({"--samples", "3", "--antialias-depth", "2"}));
    CHECK(plain != picture({"--samples", "1"}));
    CHECK(plain != picture({"--antialias-depth", "1"}));
    CHECK(picture({"--samples", "1"}) ==
          picture({"--antialias", "0", "--set", "render.samples=1"}));

    const auto ini = [&](const Words& more) {
        Words words = {"export", "scene.toml", "-q"};
        words.insert(words.end(), more.begin(), more.end());
        REQUIRE(run(folder.path, words).status == 0);
        return test::read(folder / "scene.ini");
    };
    CHECK(ini({}).find("Sampling_Method=2\nAntialias_Threshold=0.2\nAntialias_Depth=2\n") !=
          std::string::npos);
    CHECK(ini({"--samples", "1"}).find("Antialias=Off\n") != std::string::npos);
    CHECK(ini({"--samples", "2"}).find("Sampling_Method=1\n") != std::string::npos);
}

TEST_CASE("a setting that does not fit is named as the user typed it") {
    const TempDir folder;
    test::write(folder / "scene.toml", small_scene);
    const Ended camera = run(folder.path, {"info", "scene.toml", "--camera", "Top \"1\""});
    CHECK(camera.status == 2);
    CHECK(camera.err.starts_with("penumbra: error: --camera 'Top \"1\"': no camera"));
    const Ended set = run(folder.path, {"info", "scene.toml", "--set", "lighting.ambiant=0.1"});
    CHECK(set.status == 2);
    CHECK(set.err.find("did you mean 'ambient'") != std::string::npos);
}

TEST_CASE("what is lost is a warning, and with --strict an error") {
    const TempDir folder;
    test::write(folder / "a.mtl", "newmtl m\nKd 1 0 0\nmap_Bump bump.png\n");
    test::write(folder / "a.obj", std::string("mtllib a.mtl\nusemtl m\n") + cube_corner);
    const Words words = {"render", "a.obj", "--size", "8x8"};
    const Ended ended = run(folder.path, words);
    CHECK(ended.status == 0);
    CHECK(ended.err.starts_with("penumbra: warning: a.mtl:3: "));

    Words quiet = words, strict = words;
    quiet.emplace_back("--quiet");
    strict.emplace_back("--strict");
    CHECK(run(folder.path, quiet).err.empty());
    fs::remove(folder / "a.png");
    const Ended refused = run(folder.path, strict);
    CHECK(refused.status == 3);
    CHECK(refused.err.find("penumbra: error: 1 thing cannot be carried over and --strict is "
                           "given; the first is a.mtl:3: ") != std::string::npos);
    CHECK_FALSE(fs::exists(folder / "a.png"));
    // It ends while the image module is still being loaded for the .exr.
    strict.insert(strict.end(), {"-o", "a.exr"});
    for (int i = 0; i < 5; ++i) CHECK(run(folder.path, strict).status == 3);
}

TEST_CASE("messages are coloured on request only, as nobody's terminal is there") {
    const TempDir folder;
    CHECK(run(folder.path, {"info", "a.obj"}).err == "penumbra: error: a.obj: no such file\n");
    CHECK(run(folder.path, {"info", "a.obj", "--color"}).err ==
          "\033[1;31mpenumbra: error: \033[0ma.obj: no such file\n");
    CHECK(run(folder.path, {"info", "a.obj", "--color", "--no-color"}).err ==
          "penumbra: error: a.obj: no such file\n");
}

TEST_CASE("export writes a scene and says which files") {
    const TempDir folder;
    test::write(folder / "a.obj", cube_corner);
    const Ended ended = run(folder.path, {"export", "a.obj", "-o", "b.pov"});
    CHECK(ended.status == 0);
    CHECK(ended.out.starts_with("b.pov\n"));
    CHECK(test::read(folder / "b.pov").find("penumbra export a.obj -o b.pov") != std::string::npos);
    std::istringstream lines(ended.out);
    for (std::string line; std::getline(lines, line);) CHECK(fs::exists(folder / line));
    CHECK(fs::exists(folder / "b.ini"));

    const json result = json::parse(run(folder.path, {"export", "a.obj", "--json"}).out);
    CHECK(result["version"] == 1);
    CHECK(result["files"][0] == "a.pov");
}

TEST_CASE("info tells what is approximate from what is dropped, whatever the sentences say") {
    const TempDir folder;
    test::write(folder / "a.obj", std::string("mtllib a.mtl\nusemtl left out\n") + cube_corner +
                                      "call b.obj\np 1\np 2\n");
    test::write(folder / "a.mtl", "newmtl left out\nillum 10\n");
    const Ended text = run(folder.path, {"info", "a.obj"});
    CHECK(text.out.find("approximate:\n"
                        "  a.mtl:1: material 'left out': illum 10 is taken as 2\n"
                        "dropped:\n") != std::string::npos);
    CHECK(text.out.find(": 'call' is not followed\n") > text.out.find("dropped:\n"));

    const json losses = json::parse(run(folder.path, {"info", "a.obj", "--json"}).out)["losses"];
    REQUIRE(losses.size() == 3);
    CHECK(losses[0] == json{{"place", "a.mtl:1"},
                            {"what", "material 'left out': illum 10 is taken as 2"},
                            {"kind", "approximated"},
                            {"count", 1}});
    CHECK(losses[2]["what"] == "points (p) are ignored (2 times)");
    CHECK(losses[2]["kind"] == "dropped");
    CHECK(losses[2]["count"] == 2);
}

TEST_CASE("export writes what the extension asks for") {
    const TempDir folder;
    test::write(folder / "a.obj", cube_corner);
    const Ended ended = run(folder.path, {"export", "a.obj", "-o", "b.dat"});
    CHECK(ended.status == 0);
    CHECK(ended.out == "b.dat\n");
    CHECK(test::read(folder / "b.dat").find("\nBEGIN_SCENE\nRESOLUTION 800 600\n") !=
          std::string::npos);
    CHECK_FALSE(fs::exists(folder / "b.ini"));
}

TEST_CASE("info says what a scene holds, as text and as JSON") {
    const TempDir folder;
    test::write(folder / "a.obj", cube_corner);
    const json result = json::parse(run(folder.path, {"info", "a.obj", "--json"}).out);
    CHECK(result["version"] == 1);
    CHECK(result["inputs"] == json::array({"a.obj"}));
    CHECK(result["bounds"]["min"] == json::array({0, 0, 0}));
    CHECK(result["bounds"]["max"] == json::array({2, 3, 4}));
    CHECK(result["facets"] == 2);
    CHECK(result["meshes"] == 1);
    CHECK(result["instances"] == 1);
    CHECK(result["lights"] == 0);
    CHECK(result["cameras"] == 1);
    for (const char* const key : {"spheres", "planes", "materials", "textures", "animations"})
        CHECK(result[key].is_number_unsigned());
    CHECK(result["extensions"] == json::array());
    CHECK(result["environment"]["name"] == "studio");
    CHECK(result["losses"] == json::array());

    const Ended text = run(folder.path, {"info", "a.obj"});
    CHECK(text.out.find("bounds     (0, 0, 0) to (2, 3, 4)\nfacets     2\n") != std::string::npos);
    CHECK(text.out.find("Everything is rendered and exported exactly.\n") != std::string::npos);
    CHECK(entries(folder.path) == 1);
}

TEST_CASE("info says what surrounds a scene, and does not count it among the lights") {
    const TempDir folder;
    test::write(folder / "a.obj", cube_corner);
    const json result = json::parse(run(folder.path, {"info", "a.obj", "--json", "--environment",
                                                      "night", "--set", "environment.sources=16"})
                                        .out);
    CHECK(result["lights"] == 0);
    CHECK(result["environment"] ==
          json{{"name", "night"}, {"sources", 16}, {"intensity", 1}, {"visible", true}});
    const Ended text = run(folder.path, {"info", "a.obj", "--environment", "studio", "--set",
                                         "environment.visible=false"});
    CHECK(text.out.find("\nenvironment studio: 64 sources, seen in mirrors only\n") !=
          std::string::npos);
    CHECK(text.out.find("Everything is rendered and exported exactly.\n") != std::string::npos);
    CHECK(json::parse(run(folder.path, {"info", "a.obj", "--json", "--environment", "0.5,1,2"})
                          .out)["environment"]["name"] == "uniform");
    CHECK(json::parse(run(folder.path, {"info", "a.obj", "--json", "--environment", "night",
                                        "--environment", "none"})
                          .out)["environment"] == nullptr);
}

TEST_CASE("compare exits with 0, 1 or 6") {
    const TempDir folder;
    test::write(folder / "a.ppm", ppm(40, 30, 100));
    test::write(folder / "b.ppm", ppm(40, 30, 60));
    test::write(folder / "c.ppm", ppm(41, 30, 100));
    const Ended same = run(folder.path, {"compare", "a.ppm", "a.ppm"});
    CHECK(same.status == 0);
    CHECK(same.out.starts_with("a.ppm vs a.ppm: pass\n"));

    const Ended other = run(folder.path, {"compare", "a.ppm", "b.ppm", "--report", "difference"});
    CHECK(other.status == 1);
    CHECK(other.out.starts_with("a.ppm vs b.ppm: fail\n"));
    CHECK(other.out.find("NOT MET") != std::string::npos);
    for (const char* const name : {"index.html", "report.json", "junit.xml", "difference.png"})
        CHECK(fs::exists(folder / "difference" / name));

    const Ended sizes = run(folder.path, {"compare", "a.ppm", "c.ppm", "--json"});
    CHECK(sizes.status == 6);
    CHECK(json::parse(sizes.out)["cases"][0]["verdict"] == "not_comparable");
}

TEST_CASE("a limit on the command line decides the verdict") {
    const TempDir folder;
    test::write(folder / "a.ppm", ppm(40, 30, 100));
    test::write(folder / "b.ppm", ppm(40, 30, 99));
    const auto ok = [&](const std::string& option, const std::string& limit,
                        const std::string& metric) {
        const Ended ended =
            run(folder.path, {"compare", "a.ppm", "b.ppm", "--json", option, limit});
        return bool(json::parse(ended.out)["cases"][0]["metrics"][metric]["ok"]);
    };
    CHECK(ok("--min-ssim", "0.5", "ssim"));
    CHECK_FALSE(ok("--min-ssim", "1", "ssim"));
    CHECK(ok("--max-flip", "1", "flip"));
    CHECK_FALSE(ok("--max-flip", "0", "flip"));
    CHECK_FALSE(ok("--max-flip-tile", "0", "flip_tile"));
    CHECK_FALSE(ok("--min-parity", "1", "parity"));
}

TEST_CASE("validate proves both pictures equal and writes a report") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    test::write(folder / "scene.toml", small_scene);
    const Ended ended = run(folder.path, {"validate", "scene.toml", "--json"});
    CHECK(ended.status == 0);
    CHECK(ended.err.empty());
    const json report = json::parse(ended.out);
    const json& result = report["cases"][0];
    CHECK(report["version"] == 1);
    CHECK(result["name"] == "scene");
    CHECK(result["verdict"] == "pass");
    CHECK(result["metrics"]["parity"]["value"] >= 0.999);
    CHECK(result["sampling"] == json{{"samples", 1}});
    for (const char* const step : {"import", "render", "export", "povray", "compare"})
        CHECK(result["seconds"][step].is_number());
    for (const json& file : result["files"])
        CHECK(fs::exists(folder / "scene-report" / file.get<std::string>()));
    for (const char* const name : {"index.html", "report.json", "junit.xml", "ours.exr",
                                   "povray.exr", "scene.pov", "scene.ini"})
        CHECK(fs::exists(folder / "scene-report" / name));
    CHECK(json::parse(test::read(folder / "scene-report/report.json")) == report);
    CHECK(entries(folder.path) == 2);

    // The commands of the report repeat it; a second one replaces the first.
    CHECK(result["commands"][0] == "penumbra validate scene.toml --json");
    const Ended failing = run(folder.path, {"validate", "scene.toml", "--max-flip", "0", "--set",
                                            "material.red.shininess=41"});
    CHECK(failing.out.starts_with("scene: "));
    CHECK(failing.out.find("report: scene-report/index.html\n") != std::string::npos);
    CHECK(entries(folder.path) == 2);
}

TEST_CASE("validate says how it sampled, in both pictures alike") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    test::write(folder / "scene.toml", small_scene);
    const Ended ended = run(folder.path, {"validate", "scene.toml", "--antialias", "0.2"});
    CHECK(ended.status == 0);
    const std::string used = "adaptive anti-aliasing, threshold 0.2, depth 2";
    CHECK(ended.out.find("  both with " + used + "\n") != std::string::npos);
    CHECK(test::read(folder / "scene-report/index.html").find(used) != std::string::npos);
    const json report = json::parse(test::read(folder / "scene-report/report.json"));
    const json& result = report["cases"][0];
    CHECK(result["sampling"] == json{{"antialias", 0.2}, {"antialias_depth", 2}});
    CHECK(result["metrics"]["exactness"]["value"] >= 0.999);
}

TEST_CASE("validate compares black things on black, and no backdrop alone") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    const auto verdict_of = [&](const std::string& plane) {
        test::write(folder / "scene.toml", "[render]\nsize = [32, 24]\n[[plane]]\n" + plane +
                                               "material = \"coal\"\n[material.coal]\n"
                                               "color = [0, 0, 0]\nspecular = 0\n");
        const Ended ended = run(folder.path, {"validate", "scene.toml", "--json"});
        return json::parse(ended.out)["cases"][0]["verdict"].get<std::string>();
    };
    CHECK(verdict_of("") == "pass");
    CHECK(verdict_of("backdrop = true\n") == "not_comparable");
}

TEST_CASE("with --each one failing scene never stops the others") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    test::write(folder / "a/scene.toml", small_scene);
    test::write(folder / "b/scene.toml", small_scene);
    const Ended ended = run(folder.path, {"validate", "--each", "a/scene.toml", "none.glb",
                                          "b/scene.toml", "--jobs", "2", "--report", "all"});
    CHECK(ended.status == 3);
    CHECK(ended.err == "penumbra: error: none.glb: no such file\n");
    CHECK(ended.out.find("3 scenes: 1 error 2 pass\n") != std::string::npos);
    const json report = json::parse(test::read(folder / "all/report.json"));
    REQUIRE(report["cases"].size() == 3);
    CHECK(report["cases"][0]["verdict"] == "pass");
    CHECK(report["cases"][1]["verdict"] == "error");
    CHECK(report["cases"][1]["message"] == "none.glb: no such file");
    CHECK(report["cases"][2]["name"] == "scene-2");
    CHECK(report["cases"][2]["commands"][0] == "penumbra validate b/scene.toml");
    CHECK(fs::exists(folder / "all/scene-2/ours.exr"));
}
