#include "support/random.h"
#include "support/small_scenes.h"
#include "support/support.h"
#include "tracer/accel/facets.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace penumbra;
using test::Random;

namespace {

// Whether the point I of the plane of A, B, C lies in the contour (A, B, C), by two signs: seen
// from I the corners B and C lie on different sides of A, and A and C on different sides of B.
bool in_contour(const Vec3& i, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ia = a - i, ib = b - i, ic = c - i;
    const double s1 = ia.cross(ib).dot(ia.cross(ic));
    const double s2 = ib.cross(ia).dot(ib.cross(ic));
    return s1 < 0 && s2 < 0;
}

double distance_to_line(const Vec3& p, const Vec3& a, const Vec3& b) {
    return (p - a).cross(b - a).length() / (b - a).length();
}

const std::array<Index, 1> first_ray = {0};

// Shadow rays with arrays of their own.
struct Shadows {
    Vec3Array origin, direction;
    std::vector<double> distance, sin_to_facet;
    explicit Shadows(std::size_t count)
        : origin(count), direction(count), distance(count), sin_to_facet(count, 1) {}
    void set(std::size_t i, const Vec3& from, const Vec3& toward, double length) {
        origin.set(i, from);
        direction.set(i, toward.normalized());
        distance[i] = length;
    }
    ShadowRays rays() const {
        return {.origin = Vec3View(origin),
                .direction = Vec3View(direction),
                .distance = distance.data(),
                .sin_to_facet = sin_to_facet.data()};
    }
};

Rays one_ray(const Vec3& origin, const Vec3& direction) {
    Rays rays(1);
    rays.count = 1;
    rays.origin.set(0, origin);
    rays.direction.set(0, direction.normalized());
    return rays;
}

// Möller-Trumbore in double over all facets of all instances.
Hit brute_force(const Scene& scene, const Vec3& origin, const Vec3& direction) {
    Hit nearest;
    for (Index k = 0; k < scene.instances.size(); ++k) {
        const Mesh& mesh = scene.meshes[scene.instances[k].mesh];
        for (Index f = 0; f < mesh.triangles.size(); ++f) {
            const auto corner = [&](int c) {
                return Vec3(mesh.positions[mesh.triangles[f][std::size_t(c)]]) *
                       scene.instances[k].transform;
            };
            const Vec3 a = corner(0), e1 = corner(1) - a, e2 = corner(2) - a;
            const Vec3 p = direction.cross(e2);
            const double determinant = e1.dot(p);
            if (determinant == 0) continue;
            const Vec3 s = origin - a, q = s.cross(e1);
            const double u = s.dot(p) / determinant, v = direction.dot(q) / determinant;
            const double t = e2.dot(q) / determinant;
            if (u >= 0 && v >= 0 && u + v <= 1 && t >= 1e-4 && t < nearest.t) nearest = {t, k, f};
        }
    }
    return nearest;
}

Scene random_facets(Random& random, std::size_t count) {
    Scene scene = test::empty_scene();
    std::vector<Vec3f> positions;
    std::vector<std::array<Index, 3>> triangles;
    for (Index f = 0; f < count; ++f) {
        const Vec3 center = random.vector(8);
        for (int k = 0; k < 3; ++k) positions.emplace_back(center + random.vector(1.5));
        triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    }
    test::add_mesh(scene, std::move(positions), std::move(triangles));
    return scene;
}

}  // namespace

TEST_CASE("facet hits, agree with the two signs of the contour on 40,000 facets and rays") {
    Random random;
    int inside = 0, outside = 0;
    for (int round = 0; round < 200; ++round) {
        Scene scene = random_facets(random, 1);
        Mesh& mesh = scene.meshes[0];
        const FacetAccel facets(scene);
        const Vec3 a(mesh.positions[0]), b(mesh.positions[1]), c(mesh.positions[2]);
        const Vec3 normal = (b - a).cross(c - a).normalized();
        for (int k = 0; k < 200; ++k) {
            // A point of the facet's plane near the contour, and a ray to it.
            const double u = random(-0.5, 1.5), v = random(-0.5, 1.5);
            const Vec3 point = a + (b - a) * u + (c - a) * v;
            const Vec3 origin = point + random.vector(10);
            const Vec3 direction = (point - origin).normalized();
            const double margin = 1e-4;  // nearer than this to an edge float32 may decide otherwise
            if (std::abs(normal.dot(direction)) < 0.02 || distance_to_line(point, a, b) < margin ||
                distance_to_line(point, b, c) < margin || distance_to_line(point, c, a) < margin)
                continue;
            Hits hits(1);
            facets.closest(one_ray(origin, direction), hits, false);
            const bool expected = in_contour(point, a, b, c);
            if (expected != (hits[0].t != no_hit))
                FAIL("facet " << round << ", point " << k << ": contour says " << expected);
            // The stored plane is float32: its error grows with the slant.
            const double tolerance = 4e-6 / std::abs(normal.dot(direction));
            if (expected && std::abs(hits[0].t - (point - origin).length()) > tolerance)
                FAIL("facet " << round << ", point " << k << ": distance " << hits[0].t);
            ++(expected ? inside : outside);
        }
    }
    CHECK(inside > 4000);
    CHECK(outside > 20000);
}

TEST_CASE("facet hits, equal brute force in double, with and without instances") {
    Random random;
    Scene scene = random_facets(random, 300);
    if (GENERATE(false, true)) {
        Instance second = scene.instances[0];
        second.transform.setEulerAngles(Vec3(0.3, 1.1, -0.4));
        Matrix stretch;
        stretch.setScale(Vec3(1.3, -0.7, 0.9));  // mirrored
        second.transform = stretch * second.transform;
        second.transform[3][0] = 5;
        scene.instances.push_back(second);
    }
    const FacetAccel facets(scene);
    constexpr std::size_t count = 4000;
    Rays rays(count);
    rays.count = count;
    for (std::size_t i = 0; i < count; ++i) {
        rays.origin.set(i, random.vector(12));
        rays.direction.set(i, random.vector(1).normalized());
    }
    Hits hits(count);
    facets.closest(rays, hits, false);
    int unequal = 0, found = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Hit expected = brute_force(scene, rays.origin[i], rays.direction[i]);
        found += expected.t != no_hit;
        const bool same = expected.t == no_hit ? hits[i].t == no_hit
                                               : hits[i].object == expected.object &&
                                                     hits[i].facet == expected.facet &&
                                                     std::abs(hits[i].t - expected.t) < 1e-4;
        unequal += !same;
    }
    CHECK(found > 500);
    CHECK(unequal <= 2);  // rays within float32 of an edge
}

TEST_CASE("facet hits, of a far eye keep their digits") {
    Scene scene = test::empty_scene();
    test::add_quad(scene, {-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
    const FacetAccel facets(scene);
    for (const double x : {3.999, 4.001}) {
        const Vec3 eye(200000, 0, 300000);
        Hits hits(1);
        const Vec3 aim = Vec3(x, 0.5, 0) - eye;
        facets.closest(one_ray(eye, aim), hits, true);
        CHECK((hits[0].t != no_hit) == (x < 4));
        if (x < 4) CHECK(hits[0].t == Approx(aim.length()).epsilon(1e-9));
    }
}

TEST_CASE("shadow rays, are blocked only between the margins of both ends") {
    Scene scene = test::empty_scene();
    const double height = GENERATE(0.0009, 0.0011, 1.0, 4.9985, 4.9995);
    const auto h = float(height);
    test::add_quad(scene, {-1, h, -1}, {1, h, -1}, {1, h, 1}, {-1, h, 1});
    const FacetAccel facets(scene);
    Shadows shadows(1);
    shadows.set(0, {0.1, 0, 0.2}, {0, 1, 0}, 5);
    for (const bool grazing : {false, true}) {  // both ways of asking
        shadows.sin_to_facet[0] = grazing ? 0 : 1;
        double visible = 1;
        facets.occluded(shadows.rays(), first_ray, {&visible, 1});
        CHECK((visible == 0) == (height > 1e-3 && height < 5 - 1e-3));
    }
}

TEST_CASE("shadow rays, at a grazing angle do not find their own facet") {
    Scene scene = test::empty_scene();
    test::add_quad(scene, {-9, -7.3F, -9}, {9, -7.31F, -9}, {9, -7.29F, 9}, {-9, -7.3F, 9});
    const FacetAccel facets(scene);
    const FacetPlane plane = facet_plane(scene.meshes[0], 0);
    Random random;
    for (int k = 0; k < 500; ++k) {
        // A point of facet 0 and a direction 1e-4 above its plane.
        Vec3 point(random(-3, 8), 0, random(-8, -4));
        point.y = -(plane.distance + plane.normal.x * point.x + plane.normal.z * point.z) /
                  plane.normal.y;
        const Vec3 up = plane.normal.y > 0 ? plane.normal : -plane.normal;
        Vec3 along = random.vector(1);
        along = (along - up * along.dot(up)).normalized();
        Shadows shadows(1);
        shadows.set(0, point, along + up * 1e-4, 0.5);
        shadows.sin_to_facet[0] = 1e-4;
        double visible = 1;
        facets.occluded(shadows.rays(), first_ray, {&visible, 1});
        REQUIRE(visible == 1);
    }
}

// Embree 3.13's coherent traversal does not end here (rtcOccluded16 over instances).
TEST_CASE("shadow rays, end in scenes with instances") {
    Random random;
    Scene scene = random_facets(random, 50);
    Instance second = scene.instances[0];
    second.transform.setTranslation(Vec3(3, 0, 0));
    scene.instances.push_back(second);
    const FacetAccel facets(scene);
    constexpr std::size_t count = 1024;
    Shadows shadows(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 from = random.vector(12), to = Vec3(0, 20, 0) - from;
        shadows.set(i, from, to, to.length());
    }
    std::vector<Index> asked(count);
    std::iota(asked.begin(), asked.end(), Index(0));
    std::vector<double> visible(count, 1);
    facets.occluded(shadows.rays(), asked, visible);
    const auto blocked = std::count(visible.begin(), visible.end(), 0);
    CHECK(blocked > 20);
    CHECK(blocked < 1000);
}

namespace {

// Facets that light passes, about a square that it does not.
Scene see_through_facets(Random& random, std::size_t count) {
    Scene scene = random_facets(random, count);
    scene.materials.push_back(test::matte());
    scene.materials.back().opacity = 0.5F;
    scene.meshes[0].material = 1;
    test::add_quad(scene, {-9, 4, -9}, {9, 4, -9}, {9, 4, 9}, {-9, 4, 9});
    return scene;
}

}  // namespace

TEST_CASE("translucent facets, are the same found one by one and at once") {
    Random random;
    Scene scene = see_through_facets(random, 1000);
    Instance second = scene.instances[0];
    second.transform.setTranslation(Vec3(3, 0, 0));
    scene.instances.push_back(second);
    const FacetAccel facets(scene);
    std::vector<Hit> scratch;
    int met = 0;
    for (int k = 0; k < 500; ++k) {
        const Vec3 from = random.vector(12);
        const Vec3 way = random.vector(9) - from, direction = way.normalized();
        const double end = way.length();
        TranslucentFacets in_turn(facets, from, direction, end, scratch);
        Hit one = {.t = end}, other = {.t = end};
        double nearest = 1e-3;
        for (;;) {
            const bool found = facets.translucent(from, direction, nearest, end, one);
            REQUIRE(in_turn.next(nearest, other) == found);
            if (!found) break;
            REQUIRE(other.t == one.t);
            REQUIRE(other.object == one.object);
            REQUIRE(other.facet == one.facet);
            nearest = one.t;
            other = {.t = end};
            ++met;
        }
    }
    CHECK(met > 1000);
}

TEST_CASE("shadow rays, that cross translucent facets are all found") {
    Random random;
    Scene scene = see_through_facets(random, 300);
    const FacetAccel facets(scene);
    constexpr std::size_t count = 500;
    Shadows shadows(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 from = random.vector(12), to = Vec3(0, 20, 0) - from;
        shadows.set(i, from, to, to.length());
    }
    std::vector<Index> asked(count), found;
    std::iota(asked.begin(), asked.end(), Index(0));
    facets.find_filtered(shadows.rays(), asked, found);
    std::vector<Hit> crossed;
    for (const Index i : asked) {
        facets.translucent(shadows.origin[i], shadows.direction[i], shadows.distance[i] - 1e-3,
                           crossed);
        CHECK(std::ranges::count(found, i) == (crossed.empty() ? 0 : 1));
    }
    CHECK(found.size() > 50);
    CHECK(found.size() < count);
}
