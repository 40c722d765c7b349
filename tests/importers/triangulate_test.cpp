#include "importers/shared/triangulate.h"
#include "importers/shared/triangulate_sweep.h"
#include "support/support.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>
#include <set>

using namespace penumbra;

namespace {

using Polygon = std::vector<Vec3>;

Vec3 position(const Polygon& polygon, const Triangulation& result, Index i) {
    return i < polygon.size() ? polygon[i] : result.added[i - polygon.size()].position;
}

// Shoelace formula, for polygons in the xy plane.
double shoelace(const Polygon& polygon) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        sum += a.x * b.y - b.x * a.y;
    }
    return std::abs(sum) / 2;
}

double area(const Polygon& polygon, const Triangulation& result) {
    double sum = 0;
    for (const auto& t : result.triangles) {
        const Vec3 a = position(polygon, result, t[0]);
        sum += (position(polygon, result, t[1]) - a)
                   .cross(position(polygon, result, t[2]) - a)
                   .length();
    }
    return sum / 2;
}

std::size_t corners_used(const Triangulation& result) {
    std::set<Index> used;
    for (const auto& t : result.triangles) used.insert(t.begin(), t.end());
    return used.size();
}

// n - 2 triangles that use every corner, add none, and cover the polygon once.
void check_simple(const Polygon& polygon) {
    const Triangulation result = triangulate(polygon);
    CHECK(result.triangles.size() == polygon.size() - 2);
    CHECK(corners_used(result) == polygon.size());
    CHECK(result.added.empty());
    CHECK_FALSE(result.crossing);
    CHECK_FALSE(result.bent);
    const double expected = shoelace(polygon);
    CHECK(area(polygon, result) == Approx(expected).epsilon(1e-9));
    CHECK(result.area == Approx(expected).epsilon(1e-9));
    CHECK(result.outline == Approx(expected).epsilon(1e-9));
}

// Any starting corner and both orientations.
void check_turned(Polygon polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
        check_simple(polygon);
    }
    std::reverse(polygon.begin(), polygon.end());
    check_simple(polygon);
}

Polygon regular(int n) {
    Polygon polygon;
    for (int i = 0; i < n; ++i)
        polygon.emplace_back(std::cos(radians(360.0 * i / n)), std::sin(radians(360.0 * i / n)), 0);
    return polygon;
}

Polygon star(int points, double inner) {
    Polygon polygon = regular(2 * points);
    for (std::size_t i = 1; i < polygon.size(); i += 2) polygon[i] *= inner;
    return polygon;
}

// `teeth` spikes of base 2 and height 10 on a bar of height 1.
Polygon comb(int teeth) {
    Polygon polygon = {{0, -1, 0}, {2.0 * teeth, -1, 0}};
    for (int i = teeth; i-- > 0;) {
        polygon.emplace_back(2 * i + 2, 0, 0);
        polygon.emplace_back(2 * i + 1, 10, 0);
    }
    polygon.emplace_back(0, 0, 0);
    return polygon;
}

// A band of width 0.3 wound several times.
Polygon spiral(int steps) {
    Polygon outside, inside;
    for (int i = 0; i < steps; ++i) {
        const double angle = 0.2 * i, radius = 1 + 0.1 * angle;
        const Vec3 direction = {std::cos(angle), std::sin(angle), 0};
        outside.push_back(direction * radius);
        inside.push_back(direction * (radius - 0.3));
    }
    outside.insert(outside.end(), inside.rbegin(), inside.rend());
    return outside;
}

// Star-shaped around the origin with radii that jump.
Polygon random_simple(std::mt19937& random, int n) {
    std::uniform_real_distribution<double> radius(0.05, 1.0);
    Polygon polygon = regular(n);
    for (Vec3& corner : polygon) corner *= radius(random);
    return polygon;
}

}  // namespace

TEST_CASE("Triangulation, a triangle stays as it is") {
    const Polygon polygon = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
    const Triangulation result = triangulate(polygon);
    REQUIRE(result.triangles == std::vector<std::array<Index, 3>>{{0, 1, 2}});
    CHECK(result.area == 3);
}

TEST_CASE("Triangulation, a convex quad is cut from its first corner") {
    const Triangulation result = triangulate(Polygon{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    CHECK(result.triangles == std::vector<std::array<Index, 3>>{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("Triangulation, a concave quad is cut through its inner corner") {
    check_turned({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}});
}

TEST_CASE("Triangulation, a corner on a straight edge is kept") {
    check_turned({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 2, 0}});
    check_turned({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {0, 2, 0}});
}

TEST_CASE("Triangulation, simple polygons of all shapes are covered once") {
    check_turned(regular(7));
    check_turned(star(5, 0.2));
    check_turned(comb(12));
    check_simple(comb(300));
    check_simple(star(150, 0.5));
    check_simple(spiral(100));
    check_turned(
        {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}});
}

TEST_CASE("Triangulation, random simple polygons have their shoelace area") {
    std::mt19937 random(1);
    for (int n = 4; n < 200; ++n) check_simple(random_simple(random, n));
}

TEST_CASE("Triangulation, the plane does not matter") {
    // A rotation about (1, 1, 1) by 120 degrees turns xy into yz; then a shear-free tilt.
    const Polygon flat = comb(8);
    Polygon tilted;
    for (const Vec3& p : flat)
        tilted.push_back(Vec3(100, -50, 25) + Vec3(0.6, 0, 0.8) * p.x +
                         Vec3(-0.48, 0.8, 0.36) * p.y);
    const Triangulation result = triangulate(tilted);
    CHECK(result.triangles.size() == flat.size() - 2);
    CHECK(area(tilted, result) == Approx(shoelace(flat)).epsilon(1e-9));
    CHECK_FALSE(result.crossing);
}

TEST_CASE("Triangulation, size and distance do not matter") {
    for (const double scale : {1e-12, 1e-3, 1e15}) {
        Polygon polygon = comb(5);
        for (Vec3& corner : polygon) corner = corner * scale + Vec3(7 * scale, 0, -2 * scale);
        const Triangulation result = triangulate(polygon);
        CHECK(result.triangles.size() == polygon.size() - 2);
        CHECK_FALSE(result.crossing);
        CHECK(result.area == Approx(shoelace(comb(5)) * scale * scale).epsilon(1e-9));
    }
}

TEST_CASE("Triangulation, a bow-tie gets a corner where its edges cross") {
    // The symmetric one has no signed area at all.
    const Polygon polygon = {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}};
    const Triangulation result = triangulate(polygon);
    CHECK(result.crossing);
    CHECK(result.outline == Approx(0).margin(1e-12));
    REQUIRE(result.added.size() == 1);
    CHECK((result.added[0].position - Vec3(1, 1, 0)).length() < 1e-12);
    double sum = 0;
    Vec3 blended(0);
    for (std::size_t i = 0; i < 4; ++i) {
        sum += result.added[0].weight[i];
        blended += polygon[result.added[0].from[i]] * result.added[0].weight[i];
    }
    CHECK(sum == Approx(1));
    CHECK((blended - Vec3(1, 1, 0)).length() < 1e-6);
    CHECK(result.triangles.size() == 2);
    CHECK(area(polygon, result) == Approx(2));  // two triangles of base 2 and height 1
}

TEST_CASE("Triangulation, a pentagram is filled to its middle") {
    const Polygon outer = regular(5);
    const Polygon polygon = {outer[0], outer[2], outer[4], outer[1], outer[3]};
    const Triangulation result = triangulate(polygon);
    CHECK(result.crossing);
    CHECK(result.added.size() == 5);
    // The inner corners lie at the golden ratio's inverse square.
    const double inner = 2 / (3 + std::sqrt(5.0));
    CHECK(area(polygon, result) == Approx(shoelace(star(5, inner))));
}

TEST_CASE("Triangulation, a hole joined by a bridge stays open") {
    const Polygon polygon = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                             {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    const Triangulation result = triangulate(polygon);
    CHECK(area(polygon, result) == Approx(12));
    CHECK_FALSE(result.crossing);
}

TEST_CASE("Triangulation, a folded quad is told from a flat one") {
    CHECK(triangulate(Polygon{{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}}).bent);
    const Triangulation nearly =
        triangulate(Polygon{{0, 0, 0}, {1, 0, 0.01}, {1, 1, 0}, {0, 1, 0.01}});
    CHECK_FALSE(nearly.bent);
    CHECK_FALSE(nearly.crossing);
}

TEST_CASE("Triangulation, polygons without area give triangles without area") {
    for (const Polygon& polygon :
         {Polygon(5, Vec3(1, 2, 3)), Polygon{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}},
          Polygon{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}}) {
        const Triangulation result = triangulate(polygon);
        CHECK(result.triangles.size() == polygon.size() - 2);
        CHECK(result.area == 0);
        CHECK_FALSE(result.crossing);
    }
}

TEST_CASE("Triangulation, repeated corners do no harm") {
    const Polygon polygon = {{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 2, 0}};
    const Triangulation result = triangulate(polygon);
    CHECK(area(polygon, result) == Approx(4));
    CHECK_FALSE(result.crossing);
}

TEST_CASE("Triangulation, tangles of every kind give valid triangles") {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> grid(0, 6), size(3, 60);
    std::uniform_real_distribution<double> fine(-1, 1);
    for (int round = 0; round < 600; ++round) {
        Polygon polygon(std::size_t(size(random)));
        for (Vec3& corner : polygon)  // on a grid most edges meet, overlap or coincide
            corner = round % 2 ? Vec3(grid(random), grid(random), 0)
                               : Vec3(fine(random), fine(random), fine(random));
        const Triangulation result = triangulate(polygon);
        const std::size_t count = polygon.size() + result.added.size();
        bool in_range = true;
        for (const auto& t : result.triangles)
            for (const Index i : t) in_range = in_range && i < count;
        for (std::size_t i = 0; i < result.added.size(); ++i)
            for (const Index from : result.added[i].from)
                in_range = in_range && from < polygon.size() + i;
        REQUIRE(in_range);
        REQUIRE(std::isfinite(result.area));
        if (round % 2) REQUIRE(result.area <= 36 + 1e-9);  // nothing is covered twice
    }
}

TEST_CASE("Triangulation, the sweep alone covers simple polygons once") {
    std::mt19937 random(3);
    std::vector<Polygon> polygons = {comb(40), star(40, 0.1), spiral(60), regular(3)};
    for (int n = 3; n < 150; ++n) polygons.push_back(random_simple(random, n));
    for (Polygon& polygon : polygons) {
        const double angle = 0.7;  // no two corners at one height, and then as they are
        for (const bool turned : {true, false}) {
            std::vector<Vec2> flat;
            for (const Vec3& p : polygon)
                flat.emplace_back(turned ? p.x * std::cos(angle) - p.y * std::sin(angle) : p.x,
                                  turned ? p.x * std::sin(angle) + p.y * std::cos(angle) : p.y);
            if (newell_normal(polygon).z < 0) std::reverse(flat.begin(), flat.end());
            const auto triangles = triangulate_simple(flat);
            REQUIRE(triangles);
            REQUIRE(triangles->size() == flat.size() - 2);
            double sum = 0;
            for (const auto& t : *triangles)
                sum += (flat[t[1]] - flat[t[0]]).cross(flat[t[2]] - flat[t[0]]) / 2;
            CHECK(sum == Approx(shoelace(polygon)).epsilon(1e-9));
        }
    }
}

TEST_CASE("Triangulation, the sweep refuses what is not simple") {
    CHECK_FALSE(triangulate_simple(std::vector<Vec2>{{0, 0}, {2, 2}, {2, 0}, {0, 2}}));
    CHECK_FALSE(triangulate_simple(std::vector<Vec2>(9, Vec2(1, 1))));
    std::mt19937 random(11);
    std::uniform_int_distribution<int> grid(0, 9);
    for (int round = 0; round < 3000; ++round) {
        std::vector<Vec2> tangle(40);
        for (Vec2& corner : tangle) corner = Vec2(grid(random), grid(random));
        CHECK_FALSE(triangulate_simple(tangle));  // 40 edges on 100 points touch somewhere
    }
}

TEST_CASE("Triangulation, a large polygon that crosses itself everywhere is given up quickly") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-1, 1);
    Polygon polygon(20000);
    for (Vec3& corner : polygon) corner = Vec3(place(random), place(random), 0);
    const auto start = std::clock();
    const Triangulation result = triangulate(polygon);
    CHECK(double(std::clock() - start) / CLOCKS_PER_SEC < 1);
    CHECK(result.tangled);
    CHECK(result.triangles.size() == 19998);
}

TEST_CASE("Triangulation, a large polygon with one crossing is filled") {
    Polygon polygon = star(1000, 0.9);
    std::swap(polygon[0], polygon[2]);
    const Triangulation result = triangulate(polygon);
    CHECK(result.crossing);
    CHECK_FALSE(result.tangled);
    CHECK_FALSE(result.added.empty());
}

TEST_CASE("Triangulation, 40,000 corners take well under a second") {
    Polygon fingers;  // side by side above each other: the sweep meets all at once when turned
    for (int i = 0; i < 20000; ++i) {
        fingers.emplace_back(i, 0, 0);
        fingers.emplace_back(i + 0.5, 20000, 0);
    }
    fingers.emplace_back(20000, -1, 0);
    Polygon lying = fingers;
    for (Vec3& p : lying) p = Vec3(-p.y, p.x, 0);
    for (const Polygon& polygon : {star(20000, 0.9), fingers, lying}) {
        const auto start = std::clock();
        const Triangulation result = triangulate(polygon);
        CHECK(double(std::clock() - start) / CLOCKS_PER_SEC < 1);
        CHECK(result.triangles.size() == polygon.size() - 2);
        CHECK(area(polygon, result) == Approx(shoelace(polygon)).epsilon(1e-9));
    }
}
