// A Tracer that is used again gives what a new one would give, and builds no more than it must.
#include "support/random.h"
#include "support/small_scenes.h"
#include "support/support.h"
#include "tracer/prepared/prepared_scene.h"

#include "penumbra/tracer.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <numbers>
#include <thread>

using namespace penumbra;

namespace {

Raster random_raster(test::Random& random) {
    Raster raster = {.width = 4, .height = 4, .channels = 3};
    for (int i = 0; i < 4 * 4 * 3; ++i) raster.data.push_back(std::byte(int(random(0, 255))));
    return raster;
}

void add_blob(Scene& scene, test::Random& random, Index material) {
    std::vector<Vec3f> positions;
    std::vector<std::array<Index, 3>> triangles;
    for (Index i = 0; i < 40; ++i) {
        const Vec3 center = random.vector(1);
        for (int corner = 0; corner < 3; ++corner)
            positions.emplace_back(center + random.vector(0.7));
        triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    test::add_mesh(scene, std::move(positions), std::move(triangles), material);
    for (const Vec3f& p : scene.meshes.back().positions)
        scene.meshes.back().texcoords.emplace_back(p.x, p.y);
}

// Two meshes shown once and one shown twice; a mirror, glass and an image among the materials.
Scene stage() {
    test::Random random;
    Scene scene = test::empty_scene();
    scene.textures = {{.name = "noise", .raster = random_raster(random)}};
    scene.materials = {test::matte(0.8F), test::matte(0.6F), test::matte(0.7F), test::matte()};
    scene.materials[1].reflection = Color(0.4F);
    scene.materials[2].opacity = 0.4F;
    scene.materials[3].pattern = ImageMap{.texture = 0};
    for (const Index material : {0U, 2U, 3U}) add_blob(scene, random, material);
    scene.instances[0].transform.translate(Vec3(-2, 0, 0));
    scene.instances[1].transform.translate(Vec3(0, 1, 1));
    scene.instances[2].transform.translate(Vec3(2, -1, 0));
    scene.instances.push_back({.name = "again", .mesh = 2});
    scene.instances[3].transform.translate(Vec3(1, 2, -1));
    scene.spheres = {{"ball", {-1, -1.5, 1}, 0.6, 1}, {"drop", {1, 1, 2}, 0.4, 2}};
    scene.planes = {{"floor", {0, -3, 0}, {0, 1, 0}, 0}};
    scene.lights = {{.name = "lamp", .position = {3, 5, 6}, .penumbra = {.delta = 0.2}}};
    return scene;
}

const RenderOptions small = {.width = 48, .height = 36};

using Change = std::function<void(Scene&)>;

struct Step {
    const char* name = "";
    std::size_t trees = 0;  // that are built anew
    Change change = {};
};

// What each step changes and how many trees that costs: the top tree, and those of shared meshes.
const std::vector<Step> steps = {
    {"nothing", 0, [](Scene&) {}},
    {"camera", 0, [](Scene& s) { s.cameras[0].position = {2, 1, 9}; }},
    {"light", 0, [](Scene& s) { s.lights[0].position = {-3, 4, 5}; }},
    {"new light", 0, [](Scene& s) { s.lights.push_back({.position = {0, 0, 8}}); }},
    {"colour", 0, [](Scene& s) { s.materials[0].color = Color(0.9F, 0.2F, 0.1F); }},
    {"texture", 0, [](Scene& s) { s.textures[0].raster.data[0] = std::byte(77); }},
    {"background", 0, [](Scene& s) { s.background = Color(0.1F, 0.2F, 0.3F); }},
    {"sphere", 0, [](Scene& s) { s.spheres[0].center.x += 0.5; }},
    {"plane", 0, [](Scene& s) { s.planes[0].point.y -= 0.5; }},
    {"no more opaque", 1, [](Scene& s) { s.materials[0].opacity = 0.5F; }},
    {"moved instance", 1, [](Scene& s) { s.instances[0].transform.translate(Vec3(0, 0.5, 0)); }},
    {"moved shared mesh", 1, [](Scene& s) { s.instances[3].transform.translate(Vec3(0.5, 0, 0)); }},
    {"moved vertex", 1, [](Scene& s) { s.meshes[1].positions[4].x += 0.3F; }},
    {"moved vertex of a shared mesh", 2, [](Scene& s) { s.meshes[2].positions[7].y -= 0.4F; }},
    {"fewer facets", 1, [](Scene& s) { s.meshes[0].triangles.resize(20); }},
    {"removed instance", 1, [](Scene& s) { s.instances.erase(s.instances.begin()); }},
    {"new instance", 2,
     [](Scene& s) { s.instances.push_back({.mesh = 0}), s.instances.push_back({.mesh = 0}); }},
    {"another mesh", 1, [](Scene& s) { s.instances[0].mesh = 0; }},
};

}  // namespace

TEST_CASE("Tracer, gives after an update what a new one gives") {
    NormalisedScene scene = test::as_is(stage());
    Tracer tracer(scene);
    Image before = tracer.render(small);
    for (const Step& step : steps) {
        INFO(step.name);
        step.change(scene.scene);
        REQUIRE(defects(scene.scene).empty());
        tracer.update(scene);
        const Image again = tracer.render(small);
        CHECK(again.pixels == render(scene, small).pixels);
        CHECK(tracer.objects_seen(small) == objects_seen(scene, small));
        if (std::string(step.name) != "nothing") CHECK(again.pixels != before.pixels);
        before = again;
    }
    // Nothing is left of the scene before but what is the same.
    const NormalisedScene other = test::as_is(stage());
    tracer.update(other);
    CHECK(tracer.render(small).pixels == render(other, small).pixels);
}

// 64 x 64 squares that rise and fall.
Scene rough_sheet() {
    Scene scene = test::empty_scene();
    std::vector<Vec3f> positions;
    std::vector<std::array<Index, 3>> triangles;
    for (int row = 0; row <= 64; ++row)
        for (int column = 0; column <= 64; ++column)
            positions.emplace_back(float(column - 32) / 10, float(row - 32) / 10,
                                   float((3 * row + 5 * column) % 7) / 20);
    for (Index row = 0; row < 64; ++row)
        for (Index column = 0; column < 64; ++column) {
            const Index a = row * 65 + column;
            triangles.push_back({a, a + 1, a + 66});
            triangles.push_back({a, a + 66, a + 65});
        }
    test::add_mesh(scene, positions, triangles);
    scene.lights = {{.position = {5, 5, 9}}};
    scene.cameras[0].position = {0.371, -0.233, 10};  // so that no ray meets an edge exactly
    return scene;
}

TEST_CASE("Tracer, where instances move, moves one without building its mesh's tree again") {
    Scene scene = rough_sheet();
    auto still = std::make_unique<PreparedScene>(scene);
    auto moving = std::make_unique<PreparedScene>(scene, nullptr, true);
    CHECK(still->facets->trees_built() == 1);
    CHECK(moving->facets->trees_built() == 2);
    const auto built = [&](const PreparedScene& from, bool instances_move) {
        return PreparedScene(scene, &from, instances_move).facets->trees_built();
    };
    CHECK(built(*moving, true) == 0);
    scene.instances[0].transform.setTranslation(Vec3(1, 0.5, 0));
    CHECK(built(*still, false) == 1);  // all facets
    CHECK(built(*moving, true) == 1);  // one instance

    NormalisedScene normalised = test::as_is(rough_sheet());
    Tracer tracer(normalised, 1, true);
    normalised.scene.instances[0].transform = scene.instances[0].transform;
    tracer.update(normalised);
    const Image image = tracer.render(small), other = render(normalised, small);
    std::size_t off = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        off += (image.pixels[i] - other.pixels[i]).length() > 1e-4F ? 1 : 0;
    CHECK(off <= image.pixels.size() / 500);
}

TEST_CASE("Tracer, builds only the trees whose facets were changed") {
    Scene scene = stage();
    auto prepared = std::make_unique<PreparedScene>(scene);
    CHECK(prepared->facets->trees_built() == 2);
    for (const Step& step : steps) {
        INFO(step.name);
        step.change(scene);
        prepared = std::make_unique<PreparedScene>(scene, prepared.get());
        CHECK(prepared->facets->trees_built() == step.trees);
    }
}

TEST_CASE("Tracer, renders with other cameras, sizes, samples and rows") {
    const NormalisedScene scene = test::as_is(stage());
    const Tracer tracer(scene);
    NormalisedScene other = scene;
    other.scene.cameras[0].position = {4, 2, 8};
    other.scene.cameras[0].direction = {-0.4, -0.2, -0.8};
    const RenderOptions large = {.width = 70, .height = 50, .samples = 2, .max_depth = 3};
    CHECK(tracer.render(large, {.camera = other.scene.cameras[0]}).pixels ==
          render(other, large).pixels);
    CHECK(tracer.render(small).pixels == render(scene, small).pixels);

    const Image whole = tracer.render(large);
    tracer.render_rows(large, {32, 50}, [&](int first, const Image& rows) {
        CHECK(std::equal(rows.pixels.begin(), rows.pixels.end(), &whole.at(0, first)));
    });
}

TEST_CASE("Tracer, tells the subject of a picture from its backdrop") {
    Scene scene = test::empty_scene();
    scene.spheres = {{"ball", {0, 0, 0}, 1, 0}};
    scene.planes = {{"wall", {0, 0, -5}, {0, 0, 1}, 0}};
    scene.cameras[0].projection = Camera::Projection::orthographic;
    const auto count = [&] {
        const NormalisedScene normalised = test::as_is(scene);
        const std::vector<bool> seen =
            Tracer(normalised).subject_seen({.width = 40, .height = 40, .samples = 2});
        REQUIRE(seen.size() == 40 * 40);
        CHECK(seen[20 * 40 + 20]);
        return double(std::count(seen.begin(), seen.end(), true)) / (40 * 40);
    };
    CHECK(count() == 1);
    scene.planes[0].backdrop = true;
    CHECK(count() == Approx(std::numbers::pi / 16).epsilon(0.02));
}

TEST_CASE("Tracer, can leave out shadows and the copies of sources") {
    NormalisedScene scene = test::as_is(stage());
    const Tracer tracer(scene);
    const Image plain = tracer.render(small), bright = tracer.render(small, {.shadows = false});
    double more = 0;
    for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
        CHECK(bright.pixels[i].x >= plain.pixels[i].x - 1e-6F);
        more += double(bright.pixels[i].x - plain.pixels[i].x);
    }
    CHECK(more > 1);
    const Image hard = tracer.render(small, {.penumbrae = false});
    CHECK(tracer.render(small).pixels == plain.pixels);
    scene.scene.lights[0].penumbra.delta = 0;
    CHECK(hard.pixels == render(scene, small).pixels);
}

TEST_CASE("Tracer, shows no facets to a camera that is out of their reach") {
    NormalisedScene scene = test::as_is(stage());
    scene.scene.background = Color(0.25F);
    scene.scene.planes.clear();
    Tracer tracer(scene);
    Camera far = scene.scene.cameras[0];
    far.position = {0, 0, 1e17};
    const Image image = tracer.render(small, {.camera = far});
    CHECK(image.at(24, 18) == Color(0.25F));
    CHECK(tracer.render(small).pixels == render(scene, small).pixels);
}

// A thread that waits in a callback for tasks of its own would take a tile meanwhile, finish it,
// and wait for the lock that it holds itself: where it may, this test never ends.
TEST_CASE("Tracer, lets callbacks use oneTBB") {
    const tbb::global_control many(tbb::global_control::max_allowed_parallelism, 16);
    const NormalisedScene scene = test::as_is(stage());
    const Tracer tracer(scene);
    const RenderOptions options = {.width = 128, .height = 128, .threads = 16};
    constexpr int inner = 16, rounds = 20, tiles = 4 * 4, bands = 4;
    std::atomic<int> tasks = 0, rows = 0;
    const auto work = [&] {
        tbb::parallel_for(0, inner, [&](int) {
            std::this_thread::sleep_for(std::chrono::microseconds(50));
            ++tasks;
        });
    };
    const Watch watch = {.progress = [&](double) { work(); }};
    const auto take = [&](int, const Image& band) {
        work();
        rows += band.height;
    };
    for (int round = 0; round < rounds; ++round)
        tracer.render_rows(options, {0, options.height}, take, {}, watch);
    CHECK(rows == rounds * options.height);
    CHECK(tasks == rounds * inner * (1 + tiles + bands));
}
