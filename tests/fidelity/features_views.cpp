// Features: cameras, what fills a picture's background, and how a pixel is sampled.
#include "fidelity/features_stage.h"

#include <fmt/format.h>

#include <cmath>

namespace test {
namespace {

const std::string small_ball = "[[sphere]]\ncenter = [1.2, 0.35, 0.6]\nradius = 0.35\n";

Feature seen_by(const std::string& name, const std::string& camera) {
    return staged(name, showing(rock()),
                  {.camera = "[camera]\n" + camera, .floor = tiles(), .rest = small_ball});
}

// By a glTF camera in `nodes`, the first of which stands in the scene.
Feature seen_by(const std::string& name, const json& camera, const std::vector<json>& nodes) {
    Gltf gltf = showing(rock());
    gltf.root["cameras"] = {camera};
    gltf.root["scenes"][0]["nodes"].push_back(1);
    for (const json& node : nodes) gltf.add("nodes", node);
    return staged(name, gltf, {.camera = "", .floor = tiles(), .rest = small_ball});
}

json perspective(double yfov) {
    return {{"type", "perspective"}, {"perspective", {{"yfov", yfov}, {"znear", 0.1}}}};
}

// A unit quaternion about an axis of the space.
json turn(int axis, double angle) {
    json q = {0, 0, 0, std::cos(angle / 2)};
    q[std::size_t(axis)] = std::sin(angle / 2);
    return q;
}

}  // namespace

std::vector<Feature> camera_features() {
    const json front = {
        {"camera", 0}, {"translation", {0.4, 1.1, 4.6}}, {"rotation", turn(0, -0.08)}};
    return {
        seen_by("perspective", "position = [1.6, 1.4, 3.4]\nlook_at = [0, 0.7, 0]\nfov = 55\n"),
        seen_by("wide angle", "position = [0.7, 0.8, 1.7]\nlook_at = [0.1, 0.7, 0]\nfov = 125\n"),
        seen_by("rolled",
                "position = [-1.6, 1.9, 3.9]\nlook_at = [0, 0.7, 0]\nup = [0.5, 1, 0.2]\n"),
        seen_by("orthographic",
                "position = [2.6, 2.2, 4]\nlook_at = [0.2, 0.7, 0]\northographic = 4.1\n"),
        seen_by("vertical field of view (glTF)", perspective(0.6), {front}),
        seen_by("orthographic (glTF)",
                {{"type", "orthographic"},
                 {"orthographic", {{"xmag", 2}, {"ymag", 1.3}, {"znear", 0.1}, {"zfar", 50}}}},
                {front}),
        seen_by("in a turned and scaled node", perspective(0.8),
                {{{"rotation", turn(1, 0.7)}, {"scale", {1.4, 1.2, 0.9}}, {"children", {2}}},
                 {{"camera", 0}, {"translation", {0.1, 1.1, 4.4}}, {"rotation", turn(2, 0.3)}}})};
}

std::vector<Feature> picture_features() {
    const std::string mirror = ball_of("reflection = [0.8, 0.7, 0.6]\ndiffuse = 0.2\n");
    std::vector<Feature> all;
    const auto sky = [&](const std::string& name, const std::string& file,
                         const std::string& content, const std::string& render) {
        all.push_back(staged(name, {.background = '"' + file + '"',
                                    .render = render,
                                    .camera = "[camera]\nposition = [0.9, 1.1, 3.5]\n"
                                              "look_at = [-0.5, 1.3, 0]\nfov = 95\n",
                                    .floor = "",
                                    .rest = mirror}));
        all.back().files[file] = content;
    };
    sky("sky image, PNG", "sky.png", png(), "");
    sky("sky image, EXR, with exposure", "sky.exr", picture_file(".exr"), "exposure = 0.75\n");
    all.push_back(staged("ambient light", {.lights = "[lighting]\nambient = [0.9, 1.6, 2.4]\n"
                                                     "[[light]]\nposition = [3, 5, 4]\n",
                                           .rest = ball_of("ambient = [0.4, 0.2, 0.1]\n")}));
    for (const int n : {2, 3, 4})
        all.push_back(staged(
            fmt::format("anti-aliasing, samples = {}", n), showing(rock()),
            {.render = fmt::format("samples = {}\n", n), .floor = tiles(), .rest = small_ball}));
    for (const auto& [threshold, depth] : {std::pair{0.1, 3}, std::pair{0.02, 5}})
        all.push_back(staged(
            fmt::format("anti-aliasing, antialias = {}, depth {}", threshold, depth),
            showing(rock()),
            {.render = fmt::format("antialias = {}\nantialias_depth = {}\n", threshold, depth),
             .floor = tiles(),
             .rest = small_ball}));
    return all;
}

}  // namespace test
