// The options that choose one of the pictures that a glTF file can give.
#include "importers/gltf/gltf_builder.h"
#include "support/program.h"

using test::json;

namespace {

// Two scenes; the first one's triangle moves from x = 0 to x = 10 in two seconds by its second
// animation.
std::string moving() {
    test::Gltf gltf = test::triangle();
    gltf.add("nodes", {{"mesh", 0}, {"translation", {0, 100, 0}}});
    gltf.root["scenes"].push_back({{"name", "attic"}, {"nodes", {1}}});
    const int times = gltf.accessor("SCALAR", std::vector<float>{0, 2});
    for (const float end : {1.0F, 10.0F}) {
        const int moves = gltf.accessor("VEC3", std::vector<float>{0, 0, 0, end, 0, 0});
        gltf.add(
            "animations",
            {{"name", end > 1 ? "run" : "walk"},
             {"samplers", {{{"input", times}, {"output", moves}}}},
             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
    }
    return gltf.text();
}

}  // namespace

TEST_CASE("a scene, an animation and an instant can be chosen") {
    const test::TempDir folder;
    test::write(folder / "a.gltf", moving());
    const auto corner = [&](const test::Words& options) {
        test::Words words = {"info", "a.gltf", "--json"};
        words.insert(words.end(), options.begin(), options.end());
        const test::Ended ended = test::run(folder.path, words);
        CHECK(ended.status == 0);
        return json::parse(ended.out)["bounds"]["min"];
    };
    CHECK(corner({}) == json{0, 0, 0});
    CHECK(corner({"--time", "1"}) == json{0.5, 0, 0});
    CHECK(corner({"--time", "1", "--animation", "run"}) == json{5, 0, 0});
    CHECK(corner({"--time=9", "--animation=1"}) == json{10, 0, 0});
    CHECK(corner({"--animation", "run"}) == json{0, 0, 0});
    CHECK(corner({"--scene", "attic"}) == json{0, 100, 0});
    CHECK(corner({"--scene", "1"}) == json{0, 100, 0});

    const auto problem = [&](const test::Words& options) {
        test::Words words = {"info", "a.gltf"};
        words.insert(words.end(), options.begin(), options.end());
        const test::Ended ended = test::run(folder.path, words);
        CHECK(ended.status == 2);
        return ended.err;
    };
    CHECK(problem({"--animation", "rnu"}) ==
          "penumbra: error: a.gltf: there is no animation 'rnu' (did you mean 'run'?)\n");
    CHECK(problem({"--scene", "7"}) ==
          "penumbra: error: a.gltf: there is no scene '7' (the file has 2 scenes)\n");
    CHECK(problem({"--time", "soon"}).find("--time") != std::string::npos);
    CHECK(problem({"--time", "-1"}).find("--time") != std::string::npos);
}
