// What the program is asked to write to, and what it must not.
#include "support/program.h"

#include "penumbra/image.h"

using namespace test;

namespace {

// A room that shows room.png, its own image.
void make_room(const fs::path& folder) {
    penumbra::save_image(folder / "room.png", [] {
        penumbra::Image image(4, 4);
        for (penumbra::Color& pixel : image.pixels) pixel = penumbra::Color(0.5F, 0.2F, 0.1F);
        return image;
    }());
    write(folder / "room.mtl", "newmtl wall\nKd 1 1 1\nmap_Kd room.png\nnewmtl other\nmap_Kd "
                               "unused.png\n");
    write(folder / "unused.png", "an image that no facet shows");
    write(folder / "room.obj", "mtllib room.mtl\nusemtl wall\nvt 0 0\nvt 1 0\nvt 0 1\nv 0 0 0\nv "
                               "2 0 0\nv 0 3 0\nf 1/1 2/2 3/3\n");
}

constexpr const char* never = ": is one of the inputs, which are never overwritten; give what is "
                              "written another name\n";

}  // namespace

TEST_CASE("render and export overwrite no file that a model is made of") {
    const TempDir folder;
    make_room(folder.path);
    fs::create_symlink("room.png", folder / "link.png");
    fs::create_hard_link(folder / "room.png", folder / "hard.png");
    write(folder / "sky.toml", "[render]\nbackground = \"sky.png\"\n");
    fs::copy_file(folder / "room.png", folder / "sky.png");
    write(folder / "room.pov", "my own scene");
    const auto content = [&] {
        std::map<std::string, std::string> all;
        for (const auto& entry : fs::directory_iterator(folder.path))
            all[entry.path().filename().string()] = read(entry.path());
        return all;
    };
    const auto before = content();
    const auto refused = [&](const Words& words, const std::string& message) {
        const Ended ended = run(folder.path, words);
        INFO(ended.err);
        CHECK(ended.status == 4);
        CHECK(ended.err.ends_with("penumbra: error: " + message));
        CHECK(content() == before);
    };
    const Words size = {"--size", "8x6"};
    const auto render = [&](Words words) {
        words.insert(words.begin(), "render");
        words.insert(words.end(), size.begin(), size.end());
        return words;
    };
    refused(render({"room.obj"}), std::string("room.png") + never);
    refused(render({"room.obj", "-o", "./room.png"}), std::string("./room.png") + never);
    refused(render({"room.obj", "-o", "link.png"}), std::string("link.png") + never);
    refused(render({"room.obj", "-o", "hard.png"}), std::string("hard.png") + never);
    refused(render({"room.obj", "-o", "unused.png"}), std::string("unused.png") + never);
    refused(render({"room.obj", "sky.toml", "-o", "sky.png"}), std::string("sky.png") + never);
    refused(render({"room.obj", "--background", "sky.png", "-o", "sky.png"}),
            std::string("sky.png") + never);
    refused({"export", "room.obj"}, "room.pov: is there already, and not from an export; give the "
                                    "scene another name (or replace it with --force)\n");
    const Ended done = run(folder.path, render({"room.obj", "-o", "picture.png"}));
    CHECK(done.status == 0);
    CHECK(run(folder.path, render({"room.obj", "-o", "picture.png"})).status == 0);
    CHECK(run(folder.path, {"export", "room.obj", "--force"}).status == 0);
    CHECK(read(folder / "room.png") == before.at("room.png"));
}

TEST_CASE("export overwrites no texture of the model, even with --force") {
    const TempDir folder;
    make_room(folder.path);
    fs::create_directory(folder / "room_textures");
    fs::rename(folder / "room.png", folder / "room_textures/room.png");
    write(folder / "room.mtl", "newmtl wall\nKd 1 1 1\nmap_Kd room_textures/room.png\n");
    const std::string before = read(folder / "room_textures/room.png");
    for (const Words& words :
         {Words{"export", "room.obj"}, Words{"export", "room.obj", "--force"}}) {
        const Ended ended = run(folder.path, words);
        CHECK(ended.status == 4);
        CHECK(ended.err.ends_with(std::string("room_textures/room.png") + never));
        CHECK(read(folder / "room_textures/room.png") == before);
        CHECK_FALSE(fs::exists(folder / "room.pov"));
    }
    CHECK(run(folder.path, {"export", "room.obj", "-o", "scene.pov"}).status == 0);
    CHECK(run(folder.path, {"export", "room.obj", "-o", "scene.pov"}).status == 0);
}

TEST_CASE("a report replaces and removes no input") {
    const TempDir folder;
    fs::create_directory(folder / "report");
    write(folder / "report/flip.png", ppm(40, 30, 90));
    fs::rename(folder / "report/flip.png", folder / "report/flip.ppm");
    write(folder / "a.ppm", ppm(40, 30, 100));
    fs::create_hard_link(folder / "report/flip.ppm", folder / "report/flip.png");
    const std::string before = read(folder / "report/flip.ppm");
    const Ended ended =
        run(folder.path, {"compare", "a.ppm", "report/flip.ppm", "--report", "report"});
    CHECK(ended.status == 4);
    CHECK(ended.err == std::string("penumbra: error: report/flip.png") + never);
    CHECK(read(folder / "report/flip.ppm") == before);
    CHECK(entries(folder / "report") == 2);
    CHECK(run(folder.path, {"compare", "a.ppm", "report/flip.ppm", "--report", "other"}).status <
          2);
}

TEST_CASE("a report replaces no files of others unless it is told to") {
    const TempDir folder;
    write(folder / "a.ppm", ppm(40, 30, 100));
    write(folder / "b.ppm", ppm(40, 30, 101));
    const char* const theirs = GENERATE("index.html", "flip.png");
    write(folder / theirs, "mine");
    const Words words = {"compare", "a.ppm", "b.ppm", "--report", "."};
    const Ended ended = run(folder.path, words);
    CHECK(ended.status == 4);
    CHECK(ended.err == std::string("penumbra: error: ./") + theirs +
                           ": is there already, and not from a report; give the report another "
                           "folder (or replace it with --force)\n");
    CHECK(read(folder / theirs) == "mine");
    CHECK(entries(folder.path) == 3);
    Words forced = words;
    forced.push_back("--force");
    CHECK(run(folder.path, forced).status < 2);
    CHECK(read(folder / theirs) != "mine");
    CHECK(run(folder.path, words).status < 2);  // over an earlier report
}

TEST_CASE("a report of several scenes removes no folder that holds an input") {
    if (!has_povray()) PENUMBRA_SKIP("POV-Ray is not installed");
    const TempDir folder;
    make_room(folder.path);
    fs::create_directory(folder / "room");
    fs::rename(folder / "room.png", folder / "room/room.png");
    write(folder / "room.mtl", "newmtl wall\nKd 1 1 1\nmap_Kd room/room.png\n");
    const std::string before = read(folder / "room/room.png");
    const Ended ended = run(folder.path, {"validate", "--each", "room.obj", "--report", ".",
                                          "--size", "16x12", "--force"});
    CHECK(ended.status == 4);
    CHECK(ended.err.find(std::string("room/room.png") + never) != std::string::npos);
    CHECK(read(folder / "room/room.png") == before);
    CHECK_FALSE(fs::exists(folder / "index.html"));
}

TEST_CASE(
    "render with --resume and other settings says what is different and leaves all as it was") {
    const TempDir folder;
    write(folder / "scene.toml", small_scene);
    const Words words = {"render",       "scene.toml", "-o",        "a.png",
                         "--size",       "1200x900",   "--samples", "9",
                         "--checkpoint", "0.05",       "--threads", "1"};
    Running running(folder.path, words);
    while (!fs::exists(folder / "a.png.checkpoint") ||
           fs::file_size(folder / "a.png.checkpoint") < 100000)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    kill(running.pid, SIGKILL);
    running.wait();
    const std::string before = read(folder / "a.png.checkpoint");
    Words other = words;
    other[7] = "8";
    other.emplace_back("--resume");
    const Ended ended = run(folder.path, other);
    CHECK(ended.status == 3);
    CHECK(ended.err ==
          "penumbra: error: a.png.checkpoint: is of another picture (samples 9, now 8); repeat it "
          "as it was, start anew without --resume, or remove the checkpoint\n");
    CHECK(read(folder / "a.png.checkpoint") == before);
    CHECK_FALSE(fs::exists(folder / "a.png"));
}

TEST_CASE("render shows the grey behind a file's own lights as grey, whatever the exposure is") {
    const TempDir folder;
    // A facet under a lamp of 5000 candela: metered far from exposure 0.
    write(folder / "lamp.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"translation": [0, 0, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual":
            {"lights": [{"type": "point", "intensity": 5000}]}}})");
    write(folder / "facet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (const char* const exposure : {"auto", "-3"}) {
        const Ended ended = run(folder.path, {"render", "lamp.gltf", "facet.obj", "--exposure",
                                              exposure, "--size", "32x24", "-o", "p.png"});
        REQUIRE(ended.status == 0);
        const penumbra::Image picture = penumbra::load_image(folder / "p.png");
        CHECK(double(picture.at(0, 0).x) == Approx(0.18).margin(0.002));
        fs::remove(folder / "p.png");
    }
}
