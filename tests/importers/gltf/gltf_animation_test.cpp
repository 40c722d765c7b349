// Animations of glTF, and which of a file's scenes is shown.
#include "importers/gltf/gltf_builder.h"

#include <cmath>
#include <functional>
#include <limits>

using namespace penumbra;
using test::Gltf;
using test::json;
using test::read;

namespace {

// A triangle with one animated property.
struct Animated {
    Gltf gltf = test::triangle();
    int samplers = 0;

    Animated() { gltf.root["animations"] = {{{"name", "walk"}}}; }
    json& animation() { return gltf.root["animations"][0]; }

    template <class T>
    void animate(const std::string& path, const std::string& interpolation,
                 const std::vector<float>& times, const std::vector<T>& values) {
        const std::string type = path == "weights"    ? "SCALAR"
                                 : path == "rotation" ? "VEC4"
                                                      : "VEC3";
        const int output = gltf.accessor(type, values, {{"normalized", !std::is_same_v<T, float>}});
        animation()["samplers"].push_back({{"input", gltf.accessor("SCALAR", times)},
                                           {"output", output},
                                           {"interpolation", interpolation}});
        animation()["channels"].push_back(
            {{"sampler", samplers++}, {"target", {{"node", 0}, {"path", path}}}});
    }
    Matrix at(double time) const {
        return read(gltf, {.time = time}).scene.instances.at(0).transform;
    }
    Vec3 origin_at(double time) const { return at(time).translation(); }
};

void check_near(const Vec3& a, const Vec3& b, double tolerance = 1e-6) {
    INFO(a << " is not " << b);
    CHECK((a - b).length() <= tolerance);
}

std::string usage(const Gltf& gltf, const ModelOptions& options) {
    try {
        read(gltf, options);
    } catch (const Error& error) {
        CHECK(error.failure == Failure::usage);
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("glTF animations, leave the nodes where they stand unless asked") {
    Animated animated;
    animated.animate<float>("translation", "LINEAR", {1, 3}, {0, 0, 5, 4, 0, 5});
    const Imported imported = read(animated.gltf);
    CHECK(imported.scene.instances.at(0).transform == Matrix());
    CHECK(imported.losses.empty());
    CHECK(imported.models.at(0).animations == 1);
}

TEST_CASE("glTF animations, go in lines and keep to their ends") {
    Animated animated;
    animated.animate<float>("translation", "LINEAR", {1, 3, 4}, {0, 0, 5, 4, 0, 5, 4, 8, 5});
    check_near(animated.origin_at(0), {0, 0, 5});
    check_near(animated.origin_at(1), {0, 0, 5});
    check_near(animated.origin_at(1.5), {1, 0, 5});
    check_near(animated.origin_at(3.25), {4, 2, 5});
    check_near(animated.origin_at(99), {4, 8, 5});
}

TEST_CASE("glTF animations, go in steps") {
    Animated animated;
    animated.animate<float>("scale", "STEP", {0, 1, 2}, {1, 1, 1, 2, 2, 2, 3, 3, 3});
    const auto scale_at = [&](double time) { return (Vec3(1, 0, 0) * animated.at(time)).x; };
    CHECK(scale_at(0.999) == 1);
    CHECK(scale_at(1) == 2);
    CHECK(scale_at(1.5) == 2);
    CHECK(scale_at(2) == 3);
}

TEST_CASE("glTF animations, go in cubic splines") {
    Animated animated;
    // Each key has the tangent in, the value and the tangent out. x: from 1 to 5 in two seconds,
    // with the slopes 2 and -3. By Hermite's formula at the middle:
    // (p0 + p1) / 2 + t (m0 - m1) / 8.
    animated.animate<float>("translation", "CUBICSPLINE", {1, 3},
                            {9, 9, 9, 1, 0, 0, 2, 0, 0, -3, 0, 0, 5, 0, 0, 9, 9, 9});
    check_near(animated.origin_at(0), {1, 0, 0});
    check_near(animated.origin_at(2), {3 + 2 * (2 + 3) / 8.0, 0, 0});
    check_near(animated.origin_at(4), {5, 0, 0});
}

TEST_CASE("glTF animations, turn at an even rate by the shorter way") {
    Animated animated;
    const float a = std::sin(0.15F), b = std::cos(0.15F), c = std::sin(0.75F), d = std::cos(0.75F);
    // From 0.3 to 1.5 radians about z; the second quaternion is the negative of the usual one.
    animated.animate<float>("rotation", "LINEAR", {0, 4}, {0, 0, a, b, 0, 0, -c, -d});
    for (const double t : {0.0, 1.0, 2.5, 4.0}) {
        const double angle = 0.3 + 1.2 * t / 4;
        check_near(Vec3(1, 0, 0) * animated.at(t), {std::cos(angle), std::sin(angle), 0});
    }
}

TEST_CASE("glTF animations, read integers as fractions") {
    Animated animated;
    animated.animate<std::int16_t>("rotation", "STEP", {0}, {0, 0, 23170, 23170});
    check_near(Vec3(1, 0, 0) * animated.at(0), {0, 1, 0});
}

TEST_CASE("glTF animations, morph") {
    Animated animated;
    Gltf& gltf = animated.gltf;
    json& mesh = gltf.root["meshes"][0];
    for (int i = 0; i < 2; ++i)
        mesh["primitives"][0]["targets"].push_back(
            {{"POSITION", gltf.accessor("VEC3", std::vector<float>(9, i == 0 ? 1.0F : 10.0F))}});
    mesh["weights"] = {5, 5};
    animated.animate<std::uint8_t>("weights", "LINEAR", {0, 1}, {0, 0, 255, 51});
    const Scene scene = read(gltf, {.time = 0.5}).scene;
    const Vec3f first = scene.meshes.at(0).positions.at(0);
    check_near(Vec3(first), Vec3(0.5 + 0.1 * 10));
}

TEST_CASE("glTF animations, are chosen by name or number") {
    Animated animated;
    animated.animate<float>("translation", "STEP", {0}, {1, 0, 0});
    json second = animated.animation();
    second["name"] = "0";  // a name goes before a number
    second["channels"][0]["target"]["path"] = "scale";
    animated.gltf.root["animations"].push_back(second);
    const auto x = [&](const std::string& name) {
        return read(animated.gltf, {.animation = name}).scene.instances.at(0).transform[3][0];
    };
    CHECK(x("walk") == 1);
    animated.gltf.root["scenes"][0]["nodes"] = {0};
    CHECK(usage(animated.gltf, {.animation = "wlak"}) ==
          "box.gltf: there is no animation 'wlak' (did you mean 'walk'?)");
    CHECK(usage(animated.gltf, {.animation = "2"}) ==
          "box.gltf: there is no animation '2' (the file has 2 animations)");
    CHECK(usage(animated.gltf, {.animation = "running"}) ==
          "box.gltf: there is no animation 'running' (animations: walk, 0)");
    CHECK(usage(test::triangle(), {.animation = "walk"}) ==
          "box.gltf: there is no animation 'walk' (the file has no animations)");
}

TEST_CASE("glTF animations, are not there when only a time is given") {
    const Imported imported = read(test::triangle(), {.time = 1});
    CHECK(imported.losses ==
          Losses{{Loss::approximated, "box.gltf", "it has no animation for the time asked for"}});
}

TEST_CASE("glTF animations, name what they cannot move") {
    Animated animated;
    animated.animate<float>("translation", "STEP", {0}, {1, 0, 0});
    animated.animate<float>("glow", "STEP", {0}, {1, 0, 0});
    json& channels = animated.animation()["channels"];
    channels.push_back(
        {{"sampler", 0}, {"target", {{"path", "translation"}}}});  // no node: nothing
    animated.gltf.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 2, 1};
    const Imported imported = read(animated.gltf, {.time = 0});
    check_near(imported.scene.instances.at(0).transform.translation(), {0, 0, 2});
    CHECK(imported.losses == Losses{{Loss::dropped, "box.gltf#/animations/0",
                                     "node 0 has a matrix and is not animated"},
                                    {Loss::dropped, "box.gltf#/animations/0",
                                     "node 0 has a matrix and is not animated"}});
    animated.gltf.root["nodes"][0].erase("matrix");
    CHECK(read(animated.gltf, {.time = 0}).losses.at(0) ==
          Loss{Loss::dropped, "box.gltf#/animations/0", "its animation of a 'glow' is ignored"});
}

TEST_CASE("glTF animations, must be whole") {
    const auto broken = [](const std::function<void(Animated&)>& spoil) {
        Animated animated;
        animated.animate<float>("translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
        spoil(animated);
        return test::message_of([&] { read(animated.gltf, {.time = 0.5}); });
    };
    CHECK(broken([](Animated&) {}) == "");
    CHECK(broken([](Animated& a) { a.animation()["channels"][0]["sampler"] = 1; }) ==
          "box.gltf#/animations/0/channels/0/sampler: is 1, but the animation has 1 samplers");
    CHECK(
        broken([](Animated& a) { a.animation()["samplers"][0]["interpolation"] = "EASE"; }) ==
        "box.gltf#/animations/0/samplers/0/interpolation: is 'EASE', which is none of LINEAR STEP "
        "CUBICSPLINE");
    CHECK(broken([](Animated& a) {
              a.animation()["samplers"][0]["interpolation"] = "CUBICSPLINE";
          }) == "box.gltf#/animations/0/samplers/0/output: accessor 1 has 2 elements for 6 values");
    CHECK(broken([](Animated& a) { a.animation()["samplers"][0]["output"] = 2; }) ==
          "box.gltf#/animations/0/samplers/0/output: accessor 2 has the wrong type for what it "
          "moves");
    CHECK(broken([](Animated& a) { a.animation()["samplers"][0]["input"] = 0; }) ==
          "box.gltf#/animations/0/samplers/0/input: accessor 0 must hold single floats");
}

TEST_CASE("glTF animations, survive times that do not increase") {
    Animated animated;
    animated.animate<float>("translation", "LINEAR", {2, 2, 1, 3},
                            {1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0});
    for (const double time : {0.0, 1.0, 1.5, 2.0, 2.5, 3.0}) {
        const double x = animated.origin_at(time).x;
        CHECK((x >= 1 && x <= 4));
    }
}

TEST_CASE("glTF scenes, are chosen by name or number") {
    Gltf gltf = test::triangle();
    gltf.add("nodes", {{"mesh", 0}, {"name", "second"}});
    gltf.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}, {"name", "garden"}}};
    const auto shown = [&](const std::string& scene) {
        return read(gltf, {.scene = scene}).scene.instances.at(0).name;
    };
    CHECK(shown("") == "node0");
    CHECK(shown("garden") == "second");
    CHECK(shown("1") == "second");
    CHECK(shown("0") == "node0");
    CHECK(usage(gltf, {.scene = "attic"}) ==
          "box.gltf: there is no scene 'attic' (scenes: 0, garden)");
    gltf.root.erase("scenes");
    gltf.root.erase("scene");
    CHECK(usage(gltf, {.scene = "garden"}) ==
          "box.gltf: there is no scene 'garden' (the file has no scenes)");
}

TEST_CASE("glTF animations, have no pose at a time that is no number") {
    for (const double time :
         {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
        CHECK_THAT(test::message_of([&] { test::read(test::triangle(), {.time = time}); }),
                   Catch::Matchers::StartsWith("box.gltf: the time must be a finite number, not "));
}
