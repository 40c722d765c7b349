// What is asked of groups of rays at once agrees with each ray by itself.
#include "support/random.h"
#include "support/small_scenes.h"
#include "support/support.h"
#include "tracer/accel/shaft.h"
#include "tracer/blockers.h"
#include "tracer/prepared/shapes.h"

#include "penumbra/tracer.h"

#include <cmath>
#include <numeric>

using namespace penumbra;
using test::Random;

namespace {

Bounds random_box(Random& random, double place, double size) {
    const Vec3 center = random.vector(place);
    const Vec3 half(random(0, size), random(0, size), random(0, size));
    return {.min = center - half, .max = center + half};
}

Vec3 point_in(Random& random, const Bounds& box) {
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = random(box.min[axis], box.max[axis]);
    return point;
}

bool holds(const Bounds& box, const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < box.min[axis] || p[axis] > box.max[axis]) return false;
    return true;
}

}  // namespace

TEST_CASE("groups of rays, touch every box and ball that one of the rays touches") {
    Random random;
    int shafts_apart = 0, capsules_apart = 0, beams_apart = 0, sweeps_apart = 0;
    for (int round = 0; round < 3000; ++round) {
        const Bounds from = random_box(random, 4, 1), to = random_box(random, 4, 1),
                     box = random_box(random, 6, 1);
        const Bounds directions = random_box(random, 1, 0.2);
        const Vec3 center = random.vector(5);
        const double radius = random(0, 1);
        const Shaft shaft = make_shaft(from, to);
        const Capsule capsule = make_capsule(from, to);
        const Beam beam = {.origins = from, .directions = directions};
        Vec3 direction = random.vector(1);
        if (round % 3 == 0) direction[round % 9 / 3] = 0;
        const Sweep sweep = make_sweep(from, direction);
        const bool shaft_apart = !touches(shaft, box);
        const bool capsule_apart = !touches(capsule, center, radius);
        const bool beam_apart = !touches(beam, box);
        const bool sweep_apart = !touches(sweep, box);
        shafts_apart += shaft_apart;
        capsules_apart += capsule_apart;
        beams_apart += beam_apart;
        sweeps_apart += sweep_apart;
        for (int k = 0; k < 60; ++k) {
            const Vec3 start = point_in(random, from), end = point_in(random, to);
            const Vec3 point = start + (end - start) * random(0, 1);
            if (shaft_apart && holds(box, point)) FAIL("shaft of round " << round);
            if (capsule_apart && (point - center).length() < radius)
                FAIL("capsule of round " << round);
            const Vec3 far = start + point_in(random, directions) * random(0, 20);
            if (beam_apart && holds(box, far)) FAIL("beam of round " << round);
            const Vec3 along = start + direction * random(0, 20);
            if (sweep_apart && holds(box, along)) FAIL("sweep of round " << round);
        }
    }
    CHECK(shafts_apart > 1000);
    CHECK(capsules_apart > 1000);
    CHECK(beams_apart > 1000);
    CHECK(sweeps_apart > 1000);
}

TEST_CASE("groups of rays, meet the spheres and planes that each ray meets") {
    const int spheres = GENERATE(3, 40, 400);
    Random random;
    Scene scene = test::empty_scene();
    scene.meshes.clear();
    scene.instances.clear();
    for (int i = 0; i < spheres; ++i)
        scene.spheres.push_back({"ball", random.vector(8), random(0.2, 1), 0});
    scene.planes = {{"floor", {0, -8, 0}, {0, 1, 0}, 0}, {"wall", {1, 2, -9}, {0.3, 0.1, 1}, 0}};
    const PreparedScene prepared(scene);
    constexpr std::size_t count = 640;
    Rays rays(count);
    rays.count = count;
    const bool narrow = GENERATE(true, false);
    for (std::size_t i = 0; i < count; ++i) {
        rays.origin.set(i, Vec3(0, 0, 12) + random.vector(narrow ? 0.01 : 9));
        rays.direction.set(i, (Vec3(0, 0, -1) + random.vector(narrow ? 0.4 : 5)).normalized());
    }
    Hits hits(count);
    std::vector<Index> scratch;
    closest_shapes(prepared, rays, hits, scratch);
    std::size_t found = 0;
    for (std::size_t i = 0; i < count; ++i) {
        Hit expected;
        const auto offer = [&](Index object, const Crossings& crossings) {
            for (int k = 0; k < crossings.count; ++k)
                if (const double t = crossings.t[std::size_t(k)];
                    t >= least_distance && t < expected.t)
                    expected = {t, object, no_index};
        };
        const Vec3 origin = rays.origin[i], direction = rays.direction[i];
        for (Index k = 0; k < prepared.first_plane(); ++k)
            offer(k, cross_sphere(prepared.sphere(k), origin, direction));
        for (Index k = 0; k < prepared.planes.size(); ++k)
            offer(prepared.first_plane() + k, cross_plane(prepared.planes[k], origin, direction));
        found += expected.t != no_hit;
        CHECK(hits.t[i] == expected.t);
        CHECK(hits.object[i] == expected.object);
    }
    CHECK(found > count / 4);
}

TEST_CASE("groups of points, face away from a light only if each of them does") {
    Random random;
    const Scene scene = test::empty_scene();
    const PreparedScene prepared(scene);
    int away = 0, apart = 0;
    for (int round = 0; round < 2000; ++round) {
        const bool parallel = round % 2 == 0;
        SourceGroup light;
        for (int k = 0; k < (parallel ? 1 : 3); ++k) {
            light.sources.push_back(
                {.type = parallel ? Light::Type::directional : Light::Type::point,
                 .position = random.vector(9),
                 .axis = random.vector(1).normalized()});
            light.box.extend(light.sources.back().position);
        }
        constexpr std::size_t count = 6;
        SurfacePoints surfaces(count);
        surfaces.count = count;
        const Vec3 normal = random.vector(1);
        for (std::size_t i = 0; i < count; ++i) {
            surfaces.position.set(i, random.vector(2));
            surfaces.normal.set(i, (normal + random.vector(0.1)).normalized());
        }
        PointGroups points;
        points.add(prepared, surfaces, {0, count});
        bool lit = false;
        for (std::size_t i = 0; i < count; ++i)
            for (const PreparedSource& source : light.sources)
                lit |= surfaces.normal[i].dot(
                           parallel ? -source.axis : source.position - surfaces.position[i]) > 0;
        if (points.face_away(0, light)) {
            ++away;
            if (lit) FAIL("group of round " << round);
        }
        apart += !lit;
    }
    CHECK(away > apart * 2 / 3);
}

TEST_CASE("groups of points, are shaded as each point by itself") {
    // Two lights, spheres and facets; a picture of 1 x 1 tiles has no groups to speak of.
    Random random;
    Scene scene = test::empty_scene();
    scene.cameras[0].position = {0, 3, 14};
    scene.cameras[0].direction = {0, -0.2, -1};
    for (int i = 0; i < 30; ++i)
        scene.spheres.push_back({"ball", random.vector(4), random(0.2, 0.8), 0});
    for (int i = 0; i < 20; ++i) {
        const Vec3 p = random.vector(4);
        test::add_quad(scene, p, p + Vec3(1, 0, 0.3), p + Vec3(1, 0.8, 0), p + Vec3(0, 0.8, 0.2));
    }
    scene.planes = {{"floor", {0, -4, 0}, {0, 1, 0}, 0}};
    scene.materials[0].reflection = Color(0.4F);
    scene.lights = {{.name = "a", .position = {5, 9, 6}, .penumbra = {.delta = 0.8}},
                    {.name = "b", .position = {-7, 5, 2}, .intensity = 0.5},
                    {.name = "c", .type = Light::Type::directional, .direction = {1, -1, -1}}};
    RenderOptions options = {.width = 96, .height = 72, .max_depth = 4};
    const NormalisedScene normalised = normalise(scene, options);
    const Image whole = render(normalised, options);
    // The same pixels in the corner of a picture in which they lie elsewhere in their tiles.
    options.width = 90;
    Scene moved = scene;
    const double pixel = 2 * std::tan(scene.cameras[0].fov / 2) / 96;
    moved.cameras[0].fov = 2 * std::atan(pixel * 90 / 2);
    const Image part = render(normalise(moved, options), options);
    double largest = 0;
    for (int y = 0; y < 72; ++y)
        for (int x = 0; x < 90; ++x)
            for (int c = 0; c < 3; ++c)
                largest = std::max(
                    largest, std::abs(double(part.at(x, y)[c]) - double(whole.at(x + 3, y)[c])));
    CHECK(largest < 1e-5);
}
