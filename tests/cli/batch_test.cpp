// Many cases at once: folders of pictures, manifests, other renderers, and what is kept of an
// earlier run.
#include "support/program.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>

using namespace test;
using nlohmann::json;

namespace {

json cases_in(const fs::path& report) {
    return json::parse(test::read(report / "report.json"))["cases"];
}

const json& named(const json& cases, const std::string& name) {
    for (const json& one : cases)
        if (one["name"] == name) return one;
    FAIL("no case " << name);
    throw std::logic_error("unreachable");
}

// A folder of pictures: the first two are the same in both, the third differs.
void write_pictures(const fs::path& folder, int level) {
    test::write(folder / "a.ppm", ppm(40, 30, 100));
    test::write(folder / "deep/b.ppm", ppm(32, 20, 90));
    test::write(folder / "c.ppm", ppm(40, 30, level));
}

constexpr const char* two_cameras = R"([camera]
position = [0, 1, 6]
look_at = [0, 1, 0]
)";

}  // namespace

TEST_CASE("compare pairs the pictures of two folders by name") {
    const TempDir folder;
    write_pictures(folder / "out", 100);
    write_pictures(folder / "golden", 60);
    test::write(folder / "out/only.ppm", ppm(8, 8, 50));
    const Ended ended =
        run(folder.path, {"compare", "out", "golden", "--report", "all", "--jobs", "2"});
    CHECK(ended.status == 3);
    CHECK(ended.err == "penumbra: error: out/only.ppm: has no counterpart in golden\n");
    // The worst first.
    CHECK(ended.out.find("only.ppm") < ended.out.find("fail "));
    CHECK(ended.out.find("fail ") < ended.out.find("pass "));
    CHECK(ended.out.find("4 scenes: 1 error 1 fail 2 pass\nreport: all/index.html\n") !=
          std::string::npos);
    const json cases = cases_in(folder / "all");
    REQUIRE(cases.size() == 4);
    CHECK(named(cases, "a.ppm")["verdict"] == "pass");
    CHECK(named(cases, "c.ppm")["verdict"] == "fail");
    CHECK(named(cases, "deep/b.ppm")["verdict"] == "pass");
    CHECK(named(cases, "deep/b.ppm")["folder"] == "deep_b.ppm");
    CHECK(named(cases, "c.ppm")["commands"][0] == "penumbra compare out/c.ppm golden/c.ppm");
    CHECK(named(cases, "c.ppm")["severity"] > named(cases, "a.ppm")["severity"]);
    for (const json& one : cases)
        if (one["verdict"] != "error")
            CHECK(fs::exists(folder / "all" / one["folder"].get<std::string>() / "index.html"));
}

TEST_CASE("compare pairs pictures of other extensions where that is not ambiguous") {
    const TempDir folder;
    test::write(folder / "out/a.ppm", ppm(40, 30, 100));
    fs::create_directories(folder / "golden");
    test::write(folder / "golden/a.pgm", "P2 40 30 255\n");
    const Ended ended = run(folder.path, {"compare", "out", "golden", "--json"});
    CHECK(json::parse(ended.out)["cases"].size() == 1);
    CHECK(json::parse(ended.out)["cases"][0]["name"] == "a");
}

TEST_CASE("a folder cannot be compared with a file") {
    const TempDir folder;
    test::write(folder / "out/a.ppm", ppm(8, 8, 50));
    const Ended ended = run(folder.path, {"compare", "out", "out/a.ppm"});
    CHECK(ended.status == 3);
    CHECK(ended.err == "penumbra: error: out/a.ppm: is no folder, but the other one is: give two "
                       "pictures or two folders\n");
}

TEST_CASE("ignored pixels do not count") {
    const TempDir folder;
    std::string left = "P3\n64 48\n255\n", right = left, mask = left;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const int value = (x * 7 + y * 13) % 200;
            const bool spot = x >= 20 && x < 30 && y >= 10 && y < 18;
            for (int c = 0; c < 3; ++c) {
                left += std::to_string(value) + "\n";
                right += std::to_string(spot ? 255 - value : value) + "\n";
                mask += spot ? "0\n" : "255\n";
            }
        }
    test::write(folder / "left.ppm", left);
    test::write(folder / "right.ppm", right);
    test::write(folder / "mask.ppm", mask);
    const Words words = {"compare", "left.ppm", "right.ppm"};
    const auto status = [&](const Words& more) {
        Words all = words;
        all.insert(all.end(), more.begin(), more.end());
        return run(folder.path, all).status;
    };
    CHECK(status({}) == 1);
    CHECK(status({"--mask", "mask.ppm"}) == 0);
    CHECK(status({"--ignore", "20,10,30,18"}) == 0);
    CHECK(status({"--ignore", "20,10,29,18"}) == 1);
    CHECK(status({"--ignore", "20,10,25,18", "--ignore", "25,10,30,18"}) == 0);
    CHECK(status({"--mask", "none.ppm"}) == 3);
    const Ended wrong = run(folder.path, {"compare", "left.ppm", "right.ppm", "--ignore", "1,2,3"});
    CHECK(wrong.status == 2);
    CHECK(wrong.err == "penumbra: error: --ignore: '1,2,3' is not X0,Y0,X1,Y1 in whole pixels with "
                       "X0 < X1 and Y0 < Y1\n");
}

TEST_CASE("limits of every metric can be set, and the warn band") {
    const TempDir folder;
    test::write(folder / "a.ppm", ppm(40, 30, 100));
    test::write(folder / "b.ppm", ppm(40, 30, 98));
    const auto verdict = [&](const Words& more) {
        Words words = {"compare", "a.ppm",   "b.ppm",    "--json",  "--profile",
                       "similar", "--limit", "flip=0.2", "--limit", "bias=0.1"};
        words.insert(words.end(), more.begin(), more.end());
        const Ended ended = run(folder.path, words);
        INFO(ended.err);
        return json::parse(ended.out)["cases"][0]["verdict"].get<std::string>();
    };
    const std::string usual = verdict({});
    CHECK((usual == "pass" || usual == "warn"));
    CHECK(verdict({"--limit", "rmse=0.000001"}) == "fail");
    CHECK(verdict({"--warn-band", "1"}) == "warn");
    CHECK(verdict({"--warn-band", "0"}) == "pass");
    const Ended unknown = run(folder.path, {"compare", "a.ppm", "b.ppm", "--limit", "sharpness=1"});
    CHECK(unknown.status == 2);
    CHECK(unknown.err.starts_with("penumbra: error: unknown metric 'sharpness' (known: parity"));
}

TEST_CASE("calibrate proposes limits that its own pairs meet") {
    const TempDir folder;
    write_pictures(folder / "one", 100);
    write_pictures(folder / "two", 97);
    const Ended ended = run(folder.path, {"calibrate", "one", "two", "--json"});
    REQUIRE(ended.status == 0);
    const json document = json::parse(ended.out);
    CHECK(document["pairs"] == 3);
    REQUIRE(document["limits"].contains("flip"));
    Words words = {"compare", "one", "two"};
    for (const auto& [metric, limit] : document["limits"].items())
        words.insert(words.end(), {"--limit", metric + "=" + limit.dump()});
    CHECK(run(folder.path, words).status == 0);
    CHECK(run(folder.path, {"calibrate", "one", "two"}).out.find("as options: --limit ") !=
          std::string::npos);
    const Ended odd = run(folder.path, {"calibrate", "one"});
    CHECK(odd.status == 2);
    CHECK(odd.err.find("pairs of pictures or of folders, not 1") != std::string::npos);
}

TEST_CASE("a summary in Markdown has a row for every case and no markup of others") {
    const TempDir folder;
    test::write(folder / "out/a|b<i>.ppm", ppm(40, 30, 100));
    test::write(folder / "golden/a|b<i>.ppm", ppm(40, 30, 100));
    const Ended ended = run(folder.path, {"compare", "out", "golden", "--summary", "markdown"});
    CHECK(ended.status == 0);
    CHECK(ended.out.starts_with("### penumbra\n"));
    CHECK(ended.out.find("| a&#124;b&#60;i&#62;.ppm |") != std::string::npos);
    CHECK(ended.out.find("<i>") == std::string::npos);
}

TEST_CASE("a manifest is models times sidecars times cameras") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    test::write(folder / "models/a.toml", small_scene);
    test::write(folder / "models/b.toml", small_scene);
    test::write(folder / "near.toml", two_cameras);
    test::write(folder / "far.toml", "[camera]\nposition = [0, 1, 9]\nlook_at = [0, 1, 0]\n");
    test::write(folder / "cases.toml", R"(settings = ["render.size=[24,16]"]
[[case]]
models = ["models/*.toml"]
sidecars = ["near.toml", "far.toml"]
[[case]]
name = "strict"
models = ["models/a.toml"]
profile = "strict"
limits = { flip = 0.5 }
)");
    const Ended ended = run(folder.path, {"validate", "--manifest", "cases.toml", "--jobs", "2"});
    INFO(ended.err);
    CHECK(ended.status == 0);
    const json cases = cases_in(folder / "cases-report");
    REQUIRE(cases.size() == 5);
    for (const char* name : {"a-near", "a-far", "b-near", "b-far", "strict"})
        CHECK(named(cases, name)["verdict"] == "pass");
    CHECK(named(cases, "strict")["metrics"]["flip"]["limit"] == 0.5);
    CHECK(named(cases, "strict")["metrics"]["psnr_db"]["limit"] == 48);
    CHECK(named(cases, "a-far")["commands"][0].get<std::string>().starts_with(
        "penumbra validate models/a.toml --sidecar far.toml --set "));
}

TEST_CASE("what is wrong in a manifest is named with its place") {
    const TempDir folder;
    const auto problem = [&](const std::string& text) {
        test::write(folder / "cases.toml", text);
        const Ended ended = run(folder.path, {"validate", "--manifest", "cases.toml"});
        CHECK(ended.status == 3);
        return ended.err;
    };
    CHECK(problem("") == "penumbra: error: cases.toml: has no [[case]]\n");
    CHECK(problem("[[case]]\nmodels = []\n") ==
          "penumbra: error: cases.toml:2:10: 'models' in [[case]] must name at least one file\n");
    CHECK(problem("[[case]]\nmodels = ['x/*.glb']\n") ==
          "penumbra: error: cases.toml:2:10: no file matches 'x/*.glb'\n");
    CHECK(problem("[[case]]\nmodels = ['a.glb']\nlimits = { flop = 1 }\n")
              .starts_with("penumbra: error: cases.toml:3:19: unknown metric 'flop' (did you mean "
                           "'flip'?) (known: "));
    CHECK(problem("[[case]]\nmodel = ['a.glb']\n").find("needs 'models'") != std::string::npos);
}

TEST_CASE("an unchanged scene is not rendered again") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    test::write(folder / "a.toml", small_scene);
    test::write(folder / "b.toml", small_scene);
    const Words words = {"validate", "--each", "a.toml", "b.toml", "--report", "all"};
    const auto cached = [&](const Words& more) {
        Words all = words;
        all.insert(all.end(), more.begin(), more.end());
        const Ended ended = run(folder.path, all);
        INFO(ended.err);
        CHECK(ended.status == 0);
        const json cases = cases_in(folder / "all");
        REQUIRE(cases.size() == 2);
        for (const json& one : cases)
            for (const json& file : one["files"])
                CHECK(fs::exists(folder / "all" / file.get<std::string>()));
        return std::array{cases[0]["cached"].get<bool>(), cases[1]["cached"].get<bool>()};
    };
    using Both = std::array<bool, 2>;
    CHECK(cached({}) == Both{false, false});
    CHECK(cached({}) == Both{true, true});
    CHECK(cached({"--fresh"}) == Both{false, false});
    // Other limits judge the same pictures anew.
    CHECK(cached({"--profile", "strict"}) == Both{true, true});
    CHECK(cases_in(folder / "all")[0]["metrics"]["psnr_db"]["limit"] == 48);
    CHECK(cached({"--profile", "strict"}) == Both{true, true});
    std::string changed = small_scene;
    changed.replace(changed.find("0.8, 0.1"), 3, "0.7");
    test::write(folder / "b.toml", changed);
    CHECK(cached({}) == Both{true, false});
    fs::remove(folder / "all/a/ours.exr");
    CHECK(cached({}) == Both{false, true});
    test::write(folder / "all/a/cache.json", "{");
    CHECK(cached({}) == Both{false, true});
}

TEST_CASE("an interrupted batch goes on where it was") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    Words words = {"validate", "--each", "--report", "all"};
    for (int i = 0; i < 12; ++i) {
        const std::string name = "s" + std::to_string(i) + ".toml";
        test::write(folder / name, small_scene);
        words.push_back(name);
    }
    {
        Running running(folder.path, words);
        for (int i = 0; i < 3000 && !fs::exists(folder / "all/s1/cache.json"); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        kill(running.pid, SIGINT);
        CHECK(running.wait().status == 130);
    }
    CHECK_FALSE(fs::exists(folder / "all/index.html"));
    CHECK(run(folder.path, words).status == 0);
    const json cases = cases_in(folder / "all");
    REQUIRE(cases.size() == 12);
    CHECK(cases[0]["cached"] == true);
    CHECK(cases[1]["cached"] == true);
    CHECK(cases[11]["cached"] == false);
    for (const auto& entry : fs::directory_iterator(folder / "all"))
        CHECK(entry.path().extension() != ".tmp");
}

// Renderers may take as much memory as penumbra. Where one of them is penumbra itself, built with
// AddressSanitizer, that is the whole of what a process can address.
const std::string any_memory = "256T";

TEST_CASE("other renderers get cases of their own") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    test::write(folder / "scene.toml", small_scene);
    // Stand-ins: programs that everybody has. One copies the picture that penumbra makes.
    const std::string copy = std::string("Same=") + PENUMBRA_PROGRAM +
                             " render {scene} --size {width}x{height} --samples 1 -q -o {out:exr}";
    const Ended ended =
        run(folder.path, {"validate", "scene.toml", "--renderer", copy, "--renderer",
                          "Broken=sh -c 'echo no licence; exit 7' {out}", "--renderer",
                          "Lazy=true {out}", "--report", "all", "--max-memory", any_memory});
    CHECK(ended.status == 5);
    CHECK(ended.err.find("penumbra: error: Broken: ended with status 7: no licence\n") !=
          std::string::npos);
    const json cases = cases_in(folder / "all");
    REQUIRE(cases.size() == 4);
    CHECK(named(cases, "scene")["verdict"] == "pass");
    const json same = named(cases, "scene [Same]");
    CHECK(same["verdict"] == "pass");
    CHECK(same["reference"] == "Same");
    CHECK(same["metrics"]["exactness"]["value"] == 1.0);
    CHECK(named(cases, "scene [Broken]")["verdict"] == "error");
    CHECK(named(cases, "scene [Lazy]")["message"].get<std::string>().starts_with(
        "Lazy: left no picture ("));
    CHECK(fs::exists(folder / "all/scene@Same/index.html"));
    const Ended without = run(folder.path, {"validate", "scene.toml", "--renderer", "A=b"});
    CHECK(without.status == 2);
    CHECK(without.err.find("{out}") != std::string::npos);
}

TEST_CASE("a scene that penumbra crashes on does not stop the others") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    for (const char* name : {"a.toml", "bad.toml", "c.toml", "d.toml"})
        test::write(folder / name, small_scene);
    // A renderer that ends the program that started it as a fault of its own would.
    const std::string renderer =
        std::string("Killer=sh -c 'case $1 in *bad*) kill -ABRT $PPID; sleep 5;; *) exec ") +
        PENUMBRA_PROGRAM + " render $1 --samples 1 -q -o $2;; esac' sh {scene} {out:exr}";
    for (const char* jobs : {"1", "2"}) {
        const Ended ended =
            run(folder.path, {"validate", "--each", "a.toml", "bad.toml", "c.toml", "d.toml",
                              "--fresh", "--jobs", jobs, "--renderer", renderer, "--report", "all",
                              "--max-memory", any_memory});
        INFO(ended.err);
        CHECK(ended.status == 70);
        CHECK(ended.err.find("bad: penumbra crashed on it") != std::string::npos);
        const json cases = cases_in(folder / "all");
        REQUIRE(cases.size() == 7);
        CHECK(named(cases, "bad")["verdict"] == "error");
        for (const char* name : {"a", "c", "d", "a [Killer]", "c [Killer]", "d [Killer]"})
            CHECK(named(cases, name)["verdict"] == "pass");
        CHECK(fs::exists(folder / "all/bad/index.html"));
        for (const auto& entry : fs::recursive_directory_iterator(folder.path))
            CHECK(entry.path().extension() != ".tmp");
    }
}
