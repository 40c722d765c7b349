// Files, nodes, cameras and lights of glTF.
#include "importers/gltf/gltf_builder.h"

#include <algorithm>
#include <cmath>

using namespace penumbra;
using test::Gltf;
namespace fs = std::filesystem;
using test::json;
using test::read;
using test::triangle;

namespace {

void check_near(const Vec3& a, const Vec3& b, double tolerance = 1e-6) {
    INFO(a << " is not " << b);
    CHECK((a - b).length() <= tolerance);
}

}  // namespace

TEST_CASE("glTF, reads the same model from every container") {
    const Gltf gltf = triangle();
    const Imported text = read(gltf);
    const Imported glb = test::read_content(gltf.glb(), "box.glb");

    test::TempDir folder;
    json external = gltf.root;
    external["buffers"] = {
        {{"byteLength", gltf.bin.size()}, {"uri", "sub%20folder/caf\xc3\xa9.bin"}}};
    test::write(folder / "sub folder/caf\xc3\xa9.bin", gltf.bin + "longer than its byteLength");
    const Imported files = read_gltf(test::write(folder / "box.gltf", external.dump()));

    for (const Imported* imported : {&text, &glb, &files}) {
        REQUIRE(imported->scene.meshes.size() == 1);
        const Mesh& mesh = imported->scene.meshes[0];
        CHECK(mesh.positions == std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        CHECK(mesh.triangles == std::vector<std::array<Index, 3>>{{0, 1, 2}});
        CHECK(mesh.normals.empty());
        CHECK(mesh.name == "mesh0");
        CHECK(imported->losses.empty());
    }
}

TEST_CASE("glTF, reads data: URIs in every form") {
    const Gltf gltf = triangle();
    const std::string data = test::base64(gltf.bin);
    std::string percent;
    for (const char c : gltf.bin) {
        const char* digits = "0123456789ABCDEF";
        percent += {'%', digits[std::uint8_t(c) >> 4], digits[std::uint8_t(c) & 15]};
    }
    const std::string broken = data.substr(0, 7) + "\n " + data.substr(7);
    for (const std::string& uri :
         {"data:;base64," + data, "DATA:application/gltf-buffer;BASE64," + data,
          "data:application/octet-stream;charset=utf-8;base64," + data, "data:," + percent,
          "data:text/plain;base64," + broken}) {
        json root = gltf.root;
        root["buffers"] = {{{"byteLength", gltf.bin.size()}, {"uri", uri}}};
        CHECK(test::read_content(root.dump()).scene.meshes.size() == 1);
    }
}

TEST_CASE("glTF, says what the file is") {
    Gltf gltf = triangle();
    gltf.root["extensionsUsed"] = {"KHR_materials_unlit", "ACME_gizmo"};
    const Imported imported = read(gltf);
    REQUIRE(imported.models.size() == 1);
    CHECK(fs::path(imported.models[0].file).filename() == "box.gltf");
    CHECK(imported.models[0].format == "glTF 2.0");
    CHECK(imported.models[0].nodes == 1);
    CHECK(imported.models[0].extensions ==
          std::vector<std::string>{"KHR_materials_unlit", "ACME_gizmo"});
    CHECK(imported.losses == Losses{{Loss::dropped, "box.gltf#/extensionsUsed",
                                     "the extension ACME_gizmo is ignored"}});
}

TEST_CASE("glTF, places nodes by translation, rotation and scale") {
    Gltf gltf = triangle();
    const double h = std::sqrt(0.5);
    gltf.root["nodes"][0].update({{"name", "leaf \xe2\x98\x95"},
                                  {"translation", {1, 2, 3}},
                                  {"rotation", {0, 0, h, h}},
                                  {"scale", {2, 3, 4}}});
    const Instance instance = read(gltf).scene.instances.at(0);
    CHECK(instance.name == "leaf \xe2\x98\x95");
    // Scaled, then turned by 90 degrees about z, then moved.
    check_near(Vec3(1, 0, 0) * instance.transform, Vec3(1, 4, 3));
    check_near(Vec3(0, 1, 0) * instance.transform, Vec3(-2, 2, 3));
    check_near(Vec3(0, 0, 1) * instance.transform, Vec3(1, 2, 7));
}

TEST_CASE("glTF, multiplies transforms down the tree") {
    Gltf gltf = triangle();
    gltf.root["nodes"] = {
        {{"children", {1}}, {"translation", {10, 0, 0}}},
        {{"children", {2}}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}},
        {{"mesh", 0}, {"scale", {-2, 1, 1}}}};
    const Scene scene = read(gltf).scene;
    check_near(Vec3(1, 1, 0) * scene.instances.at(0).transform, Vec3(9, -2, 5));
    CHECK(scene.instances[0].transform.determinant() == Approx(-2));
    CHECK(scene.instances[0].name == "node2");
}

TEST_CASE("glTF, walks a deep tree without recursion") {
    Gltf gltf = triangle();
    const int depth = 5000;
    gltf.root["nodes"] = json::array();
    for (int i = 0; i < depth; ++i)
        gltf.root["nodes"].push_back({{"children", {i + 1}}, {"translation", {0, 1, 0}}});
    gltf.root["nodes"].push_back({{"mesh", 0}});
    check_near(Vec3(0) * read(gltf).scene.instances.at(0).transform, Vec3(0, depth, 0));
}

TEST_CASE("glTF, shares a mesh between its nodes") {
    Gltf gltf = triangle();
    gltf.root["meshes"][0]["primitives"].push_back(gltf.root["meshes"][0]["primitives"][0]);
    gltf.root["meshes"][0]["name"] = "pair";
    gltf.add("nodes", {{"mesh", 0}, {"translation", {0, 0, 1}}});
    gltf.root["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = read(gltf).scene;
    REQUIRE(scene.meshes.size() == 2);
    CHECK(scene.meshes[1].name == "pair");
    REQUIRE(scene.instances.size() == 4);
    CHECK(scene.instances[2].mesh == 0);
    CHECK(scene.instances[3].mesh == 1);
}

TEST_CASE("glTF, shows the default scene, else the first, else all roots") {
    Gltf gltf = triangle();
    gltf.add("nodes", {{"mesh", 0}, {"name", "second"}});
    gltf.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    gltf.root["scene"] = 1;
    CHECK(read(gltf).scene.instances.at(0).name == "second");
    gltf.root.erase("scene");
    CHECK(read(gltf).scene.instances.at(0).name == "node0");
    gltf.root.erase("scenes");
    CHECK(read(gltf).scene.instances.size() == 2);
    gltf.root["scene"] = 0;
    CHECK(read(gltf).losses == Losses{{Loss::approximated, "box.gltf#/scene",
                                       "the file has no scenes; all its nodes are shown"}});
}

TEST_CASE("glTF, hides what KHR_node_visibility hides") {
    Gltf gltf = triangle();
    gltf.root["nodes"][0]["extensions"] = {{"KHR_node_visibility", {{"visible", false}}}};
    const Imported imported = read(gltf);
    CHECK(imported.scene.instances.empty());
    CHECK(imported.losses ==
          Losses{{Loss::dropped, "box.gltf#/meshes", "none of them is shown by the file's scene"}});
}

TEST_CASE("glTF, flattens what a scale of zero flattens") {
    Gltf gltf = triangle();
    gltf.root["nodes"][0].update({{"scale", {2, 2, 0}}, {"translation", {0, 0, 3}}});
    const Scene scene = read(gltf).scene;
    const Instance& instance = scene.instances.at(0);
    // Counted from their middle, as that is farther from the origin than they are large.
    CHECK(instance.transform == Matrix().setTranslation(Vec3(1, 1, 3)));
    CHECK(scene.meshes.at(instance.mesh).positions ==
          std::vector<Vec3f>{{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}});

    gltf.root["nodes"][0]["scale"] = {2, 0, 0};
    const Imported nothing = read(gltf);
    CHECK(nothing.scene.instances.empty());
    CHECK(nothing.losses.at(0) == Loss{Loss::dropped, "box.gltf#/nodes/0",
                                       "it is scaled to nothing; its mesh is left out"});
}

TEST_CASE("glTF, repairs transforms and says so") {
    Gltf gltf = triangle();
    gltf.root["nodes"][0]["rotation"] = {0, 0, 3, 3};
    const Imported turned = read(gltf);
    check_near(Vec3(1, 0, 0) * turned.scene.instances.at(0).transform, Vec3(0, 1, 0));
    CHECK(turned.losses == Losses{{Loss::approximated, "box.gltf#/nodes/0/rotation",
                                   "it has length 4.24 instead of 1 and is normalised"}});
    gltf.root["nodes"][0] = {{"mesh", 0},
                             {"matrix", {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1}}};
    const Imported projective = read(gltf);
    check_near(Vec3(1, 0, 0) * projective.scene.instances.at(0).transform, Vec3(8, 0, 0));
    CHECK(projective.losses == Losses{{Loss::approximated, "box.gltf#/nodes/0/matrix",
                                       "its last row is not 0 0 0 1; it is taken as such"}});
    gltf.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1};
    gltf.root["nodes"][0]["translation"] = {0, 5, 0};
    const Imported doubled = read(gltf);
    check_near(Vec3(1, 0, 0) * doubled.scene.instances.at(0).transform, Vec3(8, 0, 0));
    CHECK(doubled.losses == Losses{{Loss::approximated, "box.gltf#/nodes/0",
                                    "it has a matrix and a translation, "
                                    "rotation or scale; the matrix is used"}});
}

TEST_CASE("glTF, reads cameras") {
    Gltf gltf = triangle();
    gltf.root["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}},
        {{"type", "perspective"},
         {"perspective", {{"yfov", 0.7}, {"aspectRatio", 2.5}, {"znear", 0.1}}}},
        {{"type", "orthographic"},
         {"name", "plan"},
         {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"znear", 0.1}, {"zfar", 9}}}}};
    const double h = std::sqrt(0.5);
    // Looking along -z, turned to look along -x; and looking down.
    gltf.add("nodes", {{"camera", 0}, {"translation", {5, 1, 0}}, {"rotation", {0, h, 0, h}}});
    gltf.add("nodes", {{"camera", 2}, {"rotation", {-h, 0, 0, h}}});
    gltf.add("nodes", {{"camera", 1}});
    gltf.root["scenes"][0]["nodes"] = {0, 1, 2, 3};

    const Scene scene = read(gltf).scene;
    REQUIRE(scene.cameras.size() == 3);
    CHECK(scene.camera == 0);
    const Camera &first = scene.cameras[0], &second = scene.cameras[1];
    CHECK(first.aspect == 0);
    CHECK(second.aspect == Approx(4.0 / 3));
    CHECK(scene.cameras[2].aspect == 2.5);
    CHECK(first.name == "camera0");
    CHECK(first.side == Camera::Side::vertical);
    CHECK(first.fov == Approx(0.7));
    check_near(first.position, Vec3(5, 1, 0));
    check_near(first.direction, Vec3(-1, 0, 0));
    check_near(first.up, Vec3(0, 1, 0));
    CHECK(second.name == "plan");
    CHECK(second.projection == Camera::Projection::orthographic);
    CHECK(second.extent == Approx(6));
    check_near(second.direction, Vec3(0, -1, 0));
    check_near(second.up, Vec3(0, 0, -1));
}

TEST_CASE("glTF, reads lights in candela and lux") {
    Gltf gltf = triangle();
    gltf.root["extensionsUsed"] = {"KHR_lights_punctual"};
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 50}, {"color", {1, 0.5, 0}}, {"range", 9}},
        {{"type", "directional"}, {"name", "sun"}, {"intensity", 2}},
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.4}, {"outerConeAngle", 0.6}}}},
        {{"type", "beacon"}}};
    for (int i = 0; i < 4; ++i)
        gltf.add("nodes", {{"translation", {0, 0, 4}},
                           {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    gltf.root["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
    const Imported imported = read(gltf);
    REQUIRE(imported.scene.lights.size() == 3);

    // What reaches a surface at distance d, times pi, is I / d^2.
    const Light& point = imported.scene.lights[0];
    CHECK(point.name == "light0");
    CHECK(point.color == Color(1, 0.5F, 0));
    REQUIRE(point.attenuation);
    for (const double d : {1.0, 3.0}) {
        const double f =
            2 / (1 + std::pow(d / point.attenuation->distance, point.attenuation->power));
        CHECK(point.intensity * f * std::numbers::pi == Approx(50 / (d * d)).epsilon(2e-6));
    }

    const Light& sun = imported.scene.lights[1];
    CHECK(sun.name == "sun");
    CHECK(sun.type == Light::Type::directional);
    CHECK(sun.intensity * std::numbers::pi == Approx(2));
    CHECK_FALSE(sun.attenuation);
    check_near(sun.direction, Vec3(0, 0, -1));

    CHECK(imported.losses ==
          Losses{{Loss::dropped, "box.gltf#/extensions/KHR_lights_punctual/lights/0",
                  "its range is ignored"},
                 {Loss::approximated, "box.gltf#/extensions/KHR_lights_punctual/lights/2",
                  "the falloff of its cone is approximated by a smoothstep"},
                 {Loss::dropped, "box.gltf#/extensions/KHR_lights_punctual/lights/3",
                  "its type 'beacon' is unknown; it is left out"}});
}

TEST_CASE("glTF, comes near the falloff of a spot") {
    Gltf gltf = triangle();
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.4}, {"outerConeAngle", 0.7}}}}};
    gltf.root["nodes"][0]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
    const Light light = read(gltf).scene.lights.at(0);
    double worst = 0;
    for (double angle = 0; angle < 1; angle += 0.001) {
        const auto ramp = [&](double inner, double outer) {
            return std::clamp((std::cos(angle) - std::cos(outer)) /
                                  (std::cos(inner) - std::cos(outer)),
                              0.0, 1.0);
        };
        const double theirs = std::pow(ramp(0.4, 0.7), 2), t = ramp(light.inner, light.outer);
        worst = std::max(worst, std::abs(theirs - t * t * (3 - 2 * t)));
    }
    CHECK(worst < 0.065);
}
