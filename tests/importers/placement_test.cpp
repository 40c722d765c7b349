// Models that a sidecar or a setting places.
#include "importers/gltf/gltf_materials.h"
#include "support/inputs.h"

using namespace penumbra;
using test::Inputs, test::facet_obj;

namespace {

// Where the instance puts the corners of the triangle.
std::array<Vec3, 3> corners(const Scene& scene, std::size_t instance) {
    const Instance& placed = scene.instances.at(instance);
    const Mesh& mesh = scene.meshes.at(placed.mesh);
    std::array<Vec3, 3> points;
    for (std::size_t i = 0; i < 3; ++i)
        points[i] = Vec3(mesh.positions[mesh.triangles.at(0)[i]]) * placed.transform;
    return points;
}

}  // namespace

TEST_CASE("A model is placed: scaled, rotated about x, y and z, and moved") {
    Inputs inputs;
    inputs.file("t.obj", facet_obj);
    inputs.file("a.toml", "[[model]]\nfile = \"t.obj\"\nscale = 2\nrotate = [90, 90, 0]\n"
                          "translate = [10, 0, 0]");
    const Scene scene = inputs.load({"a.toml"}).scene;
    const auto points = corners(scene, 0);
    // (1, 0, 0): x keeps it, then about y it goes to -z. (0, 0, 1): about x to -y.
    CHECK(points[0] == Vec3(10, 0, 0));
    CHECK(points[1] == Vec3(10, 0, -2));
    CHECK(points[2] == Vec3(10, -2, 0));
}

TEST_CASE("A model is placed by a column-major matrix") {
    Inputs inputs;
    inputs.file("t.obj", facet_obj);
    inputs.file("a.toml", "[[model]]\nfile = \"t.obj\"\n"
                          "matrix = [0,0,-1,0, 0,1,0,0, 1,0,0,0, 5,6,7,1]");
    const auto points = corners(inputs.load({"a.toml"}).scene, 0);
    CHECK(points[0] == Vec3(5, 6, 7));
    CHECK(points[1] == Vec3(5, 6, 6));
    CHECK(points[2] == Vec3(6, 6, 7));
}

TEST_CASE("A model's absorption has its scale") {
    const test::json volume = {
        {"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {1, 0.5, 0.25}}};
    Inputs inputs;
    inputs.file("glass.gltf",
                test::with_material(
                    {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                     {"extensions",
                      {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                       {"KHR_materials_volume", volume}}}})
                    .text());
    inputs.file("a.toml", "[[model]]\nfile = \"glass.gltf\"\nscale = 2\n"
                          "[[model]]\nfile = \"glass.gltf\"\n"
                          "[[model]]\nfile = \"glass.gltf\"\nscale = 2\ntranslate = [9, 0, 0]\n");
    const Scene scene = inputs.load({"a.toml"}).scene;
    REQUIRE(scene.instances.size() == 3);
    const auto distance = [&](std::size_t instance) {
        const Mesh& mesh = scene.meshes.at(scene.instances[instance].mesh);
        return scene.materials.at(mesh.material).absorption.value().distance;
    };
    CHECK(distance(0) == Approx(1));
    CHECK(distance(1) == Approx(0.5));
    CHECK(distance(2) == Approx(1));
    CHECK(scene.meshes.size() == 2);
}

TEST_CASE("A model setting places an input, and a model of a sidecar") {
    Inputs inputs;
    inputs.file("t.obj", facet_obj);
    const Scene scene =
        inputs.set({"t.obj"}, {"model.0.translate=[0,3,0]", "model.0.name=tri"}).scene;
    CHECK(corners(scene, 0)[0] == Vec3(0, 3, 0));
    CHECK(scene.instances.at(0).name.rfind("tri", 0) == 0);
    inputs.file("a.toml", "[[model]]\nfile = \"t.obj\"\ntranslate = [1, 0, 0]");
    const Scene two = inputs.set({"t.obj", "a.toml"}, {"model.1.scale=3"}).scene;
    CHECK(corners(two, 1)[1] == Vec3(4, 0, 0));
}

TEST_CASE("A model that is placed twice is stored once") {
    Inputs inputs;
    inputs.file("sub/t.obj", facet_obj);
    inputs.file("a.toml",
                "[material.red]\n[[model]]\nfile = \"sub/t.obj\"\n[[model]]\n"
                "file = \"sub/../sub/t.obj\"\ntranslate = [1, 0, 0]\n"
                "[[model]]\nfile = \"sub/t.obj\"\nmaterial = \"red\"\ntranslate = [0, 1, 0]");
    const Imported result = inputs.load({"a.toml"});
    CHECK(result.scene.instances.size() == 3);
    CHECK(result.scene.meshes.size() == 2);
    CHECK(corners(result.scene, 1)[0] == Vec3(1, 0, 0));
    const auto& worn = [&](std::size_t i) {
        return result.scene.materials[result.scene.meshes[result.scene.instances[i].mesh].material]
            .name;
    };
    CHECK(worn(0) != "red");
    CHECK(worn(1) != "red");
    CHECK(worn(2) == "red");
}

TEST_CASE("A sidecar's material lays over the model's of that name") {
    Inputs inputs;
    inputs.file("t.obj", std::string("mtllib t.mtl\n") + facet_obj);
    inputs.file("t.mtl", "newmtl paint\nKd 0.25 0.5 0.75\n");
    inputs.file("a.toml", "[material.paint]\nreflection = 0.5");
    const Scene scene = inputs.load({"t.obj"}, {.sidecar = inputs.folder / "a.toml"}).scene;
    const Material& paint = scene.materials.at(scene.meshes.at(0).material);
    CHECK(paint.name == "paint");
    CHECK(paint.reflection == Color(0.5F));
    CHECK(paint.color == Color(0.25F, 0.5F, 0.75F));
}
