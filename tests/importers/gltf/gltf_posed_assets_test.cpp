// Skinned, morphed and animated glTF files by other people.
#include "support/support.h"

#include "penumbra/importers.h"

using namespace penumbra;

namespace {

struct Posed {
    const char* file;
    ModelOptions options;
    Vec3 min, max;
};

// Computed by a program of its own that shares no code with the importer.
const Posed all[] = {
    {"SimpleSkin/SimpleSkin.gltf", {}, {-0.5, 0, 0}, {0.5, 2, 0}},
    {"SimpleSkin/SimpleSkin.gltf", {.time = 1.25}, {-1, 0, 0}, {0.5, 1.5, 0}},
    {"RiggedSimple/RiggedSimple.gltf", {}, {-1, -4.575077, -1}, {1, 4.575078, 0.9999996}},
    {"RiggedSimple/RiggedSimple.gltf",
     {.time = 1},
     {-1, -4.575077, -1},
     {2.866495, 4.100509, 0.9999996}},
    {"SimpleMorph/SimpleMorph.gltf", {}, {0, 0, 0}, {1, 1.5, 0}},
    {"SimpleMorph/SimpleMorph.gltf", {.time = 2.5}, {0, 0, 0}, {1, 2, 0}},
    {"AnimatedMorphCube/AnimatedMorphCube.gltf", {}, {-1, -1, -1}, {1, 1, 1}},
    {"AnimatedMorphCube/AnimatedMorphCube.gltf",
     {.time = 1},
     {-1, -1, -1},
     {1, 0.9999999, -0.2942153}},
    {"AnimatedMorphCube-Quantized/AnimatedMorphCube.gltf",
     {.time = 1},
     {-1.00002, -1.000021, -1.00001},
     {1, 0.9999999, -0.291755}},
    {"MorphPrimitivesTest/MorphPrimitivesTest.gltf", {}, {-0.5, 0, -0.5}, {0.5, 0.1, 0.5}},
    {"RecursiveSkeletons/RecursiveSkeletons.glb", {}, {-30, 0, -30}, {30, 125.1, 30}},
    {"RecursiveSkeletons/RecursiveSkeletons.glb",
     {.time = 0.7},
     {-114.5856, -0.6977156, -34.44013},
     {52.52625, 125.1, 114.6376}},
    {"Fox/Fox.glb", {}, {-12.59272, -0.1217442, -88.09501}, {12.59272, 78.9072, 66.62486}},
    {"Fox/Fox.glb",
     {.animation = "Run", .time = 0.3},
     {-13.37966, -0.1840779, -90.51177},
     {13.68691, 72.83589, 75.18983}},
    {"Fox/Fox.glb",
     {.animation = "Survey", .time = 1.7},
     {-11.59651, -0.1307018, -84.91232},
     {18.53742, 77.72589, 67.44333}},
    {"InterpolationTest/InterpolationTest.glb",
     {.animation = "2", .time = 0.6},
     {-4.386776, -2.159462, -1},
     {4.34834, 7.958913, 1.003675}},
    {"InterpolationTest/InterpolationTest.glb",
     {.animation = "4", .time = 0.6},
     {-4.386776, -2.159462, -1},
     {4.703301, 7.958913, 1.008945}},
    {"InterpolationTest/InterpolationTest.glb",
     {.animation = "5", .time = 0.6},
     {-4.656396, -2.159462, -1},
     {4.34834, 7.958913, 1.008945}},
    {"InterpolationTest/InterpolationTest.glb",
     {.animation = "8", .time = 1.3},
     {-4.386776, -2.159462, -1},
     {4.34834, 10.52, 1.008945}},
    {"robot/robot.glb", {}, {-3.31199, -0.0203044, -1.308376}, {3.308916, 4.539135, 1.308376}},
    {"robot/robot.glb",
     {.animation = "3", .time = 0.4},
     {-1.851406, 0.5963413, -1.525193},
     {2.066423, 5.539455, 1.936058}},
    {"SparseMorphTargets-issue280/singleBlendshapeCube_sparse.glb",
     {.time = 1},
     {-0.005, -0.005, -0.005},
     {0.005, 0.005, 0.005}},
    {"box-morph/box-morph.gltf", {.time = 1}, {-1, -1, -1}, {1, 0.9999999, -0.2942153}},
    {"unassigned-skeleton/unassigned-skeleton.gltf",
     {.time = 0.5},
     {-1.061115, 0, 0},
     {0.5518007, 2.060494, 0}},
};

void check_near(const Vec3& a, const Vec3& b, double tolerance) {
    INFO(a << " is not " << b);
    CHECK((a - b).length() <= tolerance);
}

}  // namespace

TEST_CASE("Posed glTF assets, fill the space that they should") {
    if (!test::fs::exists(test::assets())) PENUMBRA_SKIP("the assets are not here");
    for (const Posed& posed : all) {
        INFO(posed.file << ' ' << posed.options.animation << ' '
                        << posed.options.time.value_or(-1));
        const Bounds box =
            bounds(read_gltf(test::assets() / "gltf" / posed.file, posed.options).scene);
        const double tolerance = 2e-6 * (posed.max - posed.min).length();
        check_near(box.min, posed.min, tolerance);
        check_near(box.max, posed.max, tolerance);
    }
}

// The same box, compressed in three ways.
TEST_CASE("Posed glTF assets, are the same with and without compression") {
    if (!test::fs::exists(test::assets())) PENUMBRA_SKIP("the assets are not here");
    const auto box_of = [](const char* file) {
        return bounds(read_gltf(test::assets() / "gltf" / file).scene);
    };
    const auto same = [&](const char* plain, const char* compressed, double tolerance) {
        const Bounds a = box_of(plain), b = box_of(compressed);
        check_near(a.min, b.min, tolerance);
        check_near(a.max, b.max, tolerance);
    };
    same("Box/Box.gltf", "Box-Draco/Box.gltf", 1e-4);
    same("MorphPrimitivesTest/MorphPrimitivesTest.gltf",
         "MorphPrimitivesTest-Draco/MorphPrimitivesTest.gltf", 1e-4);
    same("meshopt-fallback/meshopt-fallback.gltf", "meshopt-no-fallback/meshopt-no-fallback.gltf",
         1e-6);
}
