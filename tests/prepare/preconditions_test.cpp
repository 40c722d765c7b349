// A broken precondition of a public function is found where it is broken.
#include "base/text/utf8.h"
#include "scene/objects.h"
#include "support/aborts.h"
#include "support/small_scenes.h"
#include "tracer/accel/rays.h"
#include "tracer/media_stack.h"

#include "penumbra/light_model.h"
#include "penumbra/prepare.h"
#include "penumbra/tracer.h"

#include <functional>
#include <limits>
#include <utility>

using namespace penumbra;
using test::aborts;

#ifdef NDEBUG
#define NEEDS_ASSERTIONS PENUMBRA_SKIP("assertions are off in this build")
#else
#define NEEDS_ASSERTIONS static_cast<void>(0)
#endif

namespace {

Scene sheet() {
    Scene scene = test::empty_scene();
    test::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    return scene;
}

Scene without_a_vertex() {
    Scene scene = sheet();
    scene.meshes[0].triangles[1][2] = 4;
    return scene;
}

Scene without_a_mesh() {
    Scene scene = sheet();
    scene.instances[0].mesh = 1;
    return scene;
}

Scene without_a_material() {
    Scene scene = sheet();
    scene.meshes[0].material = no_index;
    return scene;
}

Camera along_up() {
    Camera camera;
    camera.up = camera.direction;
    return camera;
}

}  // namespace

TEST_CASE("Preconditions, that indices are in range, are asserted") {
    NEEDS_ASSERTIONS;
    const std::pair<const char*, std::function<void(Scene&)>> all[] = {
        {"bounds", [](Scene& s) { bounds(s); }},
        {"complete", [](Scene& s) { complete(s, 1); }},
        {"drop_coincident_facets", [](Scene& s) { drop_coincident_facets(s); }},
        {"lift_back_to_back_facets", [](Scene& s) { lift_back_to_back_facets(s); }},
        {"part_surfaces", [](Scene& s) { part_surfaces(s); }},
        {"shown_backs", [](Scene& s) { shown_backs(s); }}};
    for (const auto& [name, function] : all) {
        INFO(name);
        const auto on = [&, &call = function](Scene scene) { return aborts([&] { call(scene); }); };
        CHECK_FALSE(on(sheet()));
        CHECK(on(without_a_vertex()));
        CHECK(on(without_a_mesh()));
        const std::string of = name;
        CHECK(on(without_a_material()) == (of != "bounds" && of != "complete"));
    }
    CHECK(aborts([] { facet_count(without_a_mesh()); }));
    CHECK(aborts([] {
        Mesh mesh = without_a_vertex().meshes[0];
        mesh.texcoords = std::vector(4, Vec2f(0));
        compute_tangents(mesh, {});
    }));
    for (const NormalMaps choice : {NormalMaps::bake, NormalMaps::drop, NormalMaps::pixel})
        CHECK(aborts([&] {
            Scene scene = without_a_vertex();
            settle_normal_maps(scene, choice);
        }));
}

TEST_CASE("Preconditions, of cameras are asserted") {
    NEEDS_ASSERTIONS;
    for (const double aspect : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        CHECK(aborts([&] {
            Scene scene = sheet();
            scene.cameras.clear();
            scene.camera = no_index;
            complete(scene, aspect);
        }));
    CHECK(aborts([] {
        Scene scene = sheet();
        scene.camera = 7;
        complete(scene, 1);
    }));
    CHECK_FALSE(aborts([] { view_of(Camera(), 4, 3); }));
    CHECK(aborts([] { view_of(along_up(), 4, 3); }));
    CHECK(aborts([] { view_of(Camera(), 0, 3); }));
    const auto rendered_by = [](const Camera& camera) {
        const NormalisedScene scene = test::as_is(sheet());
        const RenderOptions tiny = {.width = 4, .height = 3, .threads = 1};
        return aborts([&] { Tracer(scene, 1).render(tiny, {.camera = camera}); });
    };
    CHECK_FALSE(rendered_by(Camera()));
    CHECK(rendered_by(along_up()));
}

TEST_CASE("Preconditions, of environments are asserted") {
    NEEDS_ASSERTIONS;
    const auto lit = [](auto change) {
        return aborts([&] {
            Scene scene = sheet();
            set_uniform_environment(scene, Color(1));
            change(scene);
            light_by_environment(scene);
        });
    };
    CHECK_FALSE(lit([](Scene&) {}));
    CHECK(lit([](Scene& s) { s.environment->texture = 7; }));
    CHECK(lit([](Scene& s) { s.environment->sources = -1; }));
    CHECK(lit([](Scene& s) { s.textures.back().raster = {}; }));
    CHECK(lit([](Scene& s) { s.camera = no_index; }));
}

TEST_CASE("Preconditions, within the library are asserted") {
    NEEDS_ASSERTIONS;
    CHECK_FALSE(aborts([] { place_of(sheet(), 0); }));
    CHECK(aborts([] { place_of(sheet(), 1); }));
    CHECK(aborts([] { static_cast<void>(MediumStack().last()); }));
    CHECK(aborts([] {
        std::string text;
        append_utf8(text, 0x110000);
    }));
    const double values[] = {1, 2};
    CHECK(extent_of(values, {0, 2}).high == 2);
    CHECK(aborts([&] { extent_of(values, {1, 1}); }));
}
