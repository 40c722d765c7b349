// Tangents of texture coordinates.
#include "support/mapped_square.h"
#include "support/support.h"

using namespace penumbra;
using test::angle, test::bumps, test::map_of, test::mapped_square;

TEST_CASE("tangents, point to where u grows, with a bitangent to where v grows") {
    Scene scene = mapped_square(map_of(4, bumps));
    Mesh& mesh = scene.meshes[0];
    SECTION("of an upright image") {
        compute_tangents(mesh, {.texture = 0});
        for (const Tangent& t : mesh.tangents) {
            CHECK(angle(Vec3(t.direction), {1, 0, 0}) < 1e-6);
            CHECK(t.handedness == 1);
        }
    }
    SECTION("whatever the winding") {
        for (auto& facet : mesh.triangles) std::swap(facet[0], facet[1]);
        compute_tangents(mesh, {.texture = 0});
        for (const Tangent& t : mesh.tangents) {
            CHECK(angle(Vec3(t.direction), {1, 0, 0}) < 1e-6);
            CHECK(t.handedness == 1);
        }
    }
    SECTION("of an image that is mirrored") {
        compute_tangents(mesh, {.texture = 0, .transform = {-1, 0, 0, 0, 1, 0}});
        for (const Tangent& t : mesh.tangents) {
            CHECK(angle(Vec3(t.direction), {-1, 0, 0}) < 1e-6);
            CHECK(t.handedness == -1);
        }
    }
    SECTION("of an image that is turned") {
        compute_tangents(mesh, {.texture = 0, .transform = {0, 1, 0, -1, 0, 0}});
        for (const Tangent& t : mesh.tangents) {
            CHECK(angle(Vec3(t.direction), {0, 1, 0}) < 1e-6);
            CHECK(t.handedness == 1);
        }
    }
}

TEST_CASE("tangents, split a vertex where the image changes its handedness") {
    Mesh mesh = {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                 .normals = std::vector(4, Vec3f(0, 0, 1)),
                 .texcoords = {{0, 0}, {1, 0}, {0, 1}, {0, 0}},
                 .triangles = {{0, 1, 2}, {1, 3, 2}}};
    compute_tangents(mesh, {.texture = 0});
    CHECK(mesh.positions.size() == 6);
    CHECK(mesh.tangents.size() == 6);
    CHECK(mesh.tangents[mesh.triangles[0][0]].handedness == 1);
    CHECK(mesh.tangents[mesh.triangles[1][0]].handedness == -1);
    for (unsigned k = 0; k < 3; ++k) {
        CHECK(mesh.tangents[mesh.triangles[0][k]].handedness == 1);
        CHECK(mesh.tangents[mesh.triangles[1][k]].handedness == -1);
    }
}

TEST_CASE("tangents, are the same at vertices that only a file's indices keep apart") {
    // A bent strip, once with shared vertices and once with three of its own for each facet.
    Mesh shared = {.positions = {{0, 0, 0}, {1, 0, 1}, {0, 1, 0}, {1, 1, 1}, {3, 0, 1}},
                   .texcoords = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {2, 0.5F}},
                   .triangles = {{0, 1, 2}, {1, 3, 2}, {1, 4, 3}}};
    shared.normals.assign(5, Vec3f(0, 0, 1));
    Mesh apart = shared;
    apart.positions.clear(), apart.normals.clear(), apart.texcoords.clear();
    for (auto& facet : apart.triangles)
        for (Index& corner : facet) {
            apart.positions.push_back(shared.positions[corner]);
            apart.normals.push_back(shared.normals[corner]);
            apart.texcoords.push_back(shared.texcoords[corner]);
            corner = Index(apart.positions.size() - 1);
        }
    compute_tangents(shared, {.texture = 0});
    compute_tangents(apart, {.texture = 0});
    for (std::size_t f = 0; f < 3; ++f)
        for (unsigned k = 0; k < 3; ++k)
            CHECK(shared.tangents[shared.triangles[f][k]].direction ==
                  apart.tangents[apart.triangles[f][k]].direction);
}

TEST_CASE("tangents, are there for facets without an area in the image") {
    Scene scene = mapped_square(map_of(4, bumps));
    Mesh& mesh = scene.meshes[0];
    mesh.texcoords.assign(4, Vec2f(0.5F));
    compute_tangents(mesh, {.texture = 0});
    REQUIRE(mesh.tangents.size() == 4);
    for (const Tangent& t : mesh.tangents) {
        CHECK(std::abs(t.direction.length() - 1) < 1e-6F);
        CHECK(std::abs(t.direction.z) < 1e-6F);
    }
}
