// One-sided facets in POV-Ray's words, and through POV-Ray.
#include "exporters/pov_stage.h"

using namespace penumbra;

namespace {

const RenderOptions small = {.width = 160, .height = 120};

// A wall of two facets towards the camera, in one-sided clay.
Scene wall() {
    Scene scene = test::empty_scene();
    scene.materials[0].name = "clay";
    scene.materials[0].sides = Sides::front;
    test::add_quad(scene, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
    scene.meshes[0].name = "wall";
    return scene;
}

// The text of the objects, and that of the geometry.
struct Text {
    std::string scene = {}, geometry = {};
};

Text text_of(const Scene& scene) {
    const test::TempDir folder;
    write_pov(test::as_is(scene), small, folder / "a.pov");
    return {test::read(folder / "a.pov"), test::read(folder / "a_geometry.inc")};
}

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

void lean(Mesh& mesh, float aside) {
    mesh.normals.assign(mesh.positions.size(), Vec3f(0, 0, 1));
    mesh.normals[0] = Vec3f(aside, 0, 1).normalized();
}

}  // namespace

TEST_CASE("pov sides, are those that POV-Ray knows unless a material says otherwise") {
    Scene scene = wall();
    scene.materials[0].sides = Sides::both;
    const Text text = text_of(scene);
    CHECK_FALSE(holds(text.scene, "interior_texture"));
    CHECK_FALSE(holds(text.scene, "Nothing"));
    CHECK(holds(text.geometry, "<0,1,2>, <0,2,3>"));
}

TEST_CASE("pov sides, of flat facets are an interior texture and the corners' order") {
    const Text text = text_of(wall());
    CHECK(holds(text.scene, "#declare Nothing = texture { pigment { rgbt 1 }"));
    CHECK(holds(text.scene, "object { Mesh_wall texture { Material_clay } interior { ior 1 } "
                            "interior_texture { Nothing } }"));
    CHECK(holds(text.geometry, "<0,2,1>, <0,3,2>"));
}

TEST_CASE("pov sides, of smooth facets depend on the angle of incidence") {
    Scene scene = wall();
    lean(scene.meshes[0], 1);
    CHECK(holds(text_of(scene).scene,
                "interior_texture { aoi texture_map { [0.75 Material_clay] [0.75 Nothing] } }"));
}

TEST_CASE("pov sides, of vertex colours need a texture beside them") {
    Scene scene = wall();
    scene.meshes[0].colors = {Color(1), Color(0), Color(1), Color(0)};
    CHECK(holds(text_of(scene).scene, "Mesh_wall interior { ior 1 } texture { pigment { rgb 0 } } "
                                      "interior_texture { Nothing } }"));
    lean(scene.meshes[0], 1);
    CHECK_FALSE(holds(text_of(scene).scene, "interior_texture"));
}

TEST_CASE("pov sides, of include files have names of their own") {
    const test::TempDir folder;
    write_pov(test::as_is(wall()), small, folder / "a.inc", {.pov_style = PovStyle::include});
    CHECK(holds(test::read(folder / "a.inc"), "interior_texture { Nothing_a }"));
}

// Balls whose lower halves are missing, some seen from below: their insides.
TEST_CASE("pov sides, are shown alike by both renderers") {
    NEEDS_POVRAY();
    test::Stage stage;
    for (const double turn : {0.0, 2.2, -2.5, 1.2})
        for (const bool colored : {false, true}) {
            Material material = test::shiny("shell");
            material.sides = Sides::front;
            material.reflection = Color(0.2F);
            if (turn > 2) material.opacity = 0.5F;
            Mesh shell = test::ball(stage.add(material), colored);
            shell.triangles.resize(shell.triangles.size() / 2 + 40);
            if (turn == 1.2) shell.normals.clear();
            stage.mesh(shell);
            Matrix& place = stage.scene.instances.back().transform;
            Matrix rotation;
            rotation.setEulerAngles(Imath::V3d(turn, 0, 0.4));
            if (colored) rotation = Matrix().setScale(Vec3(-0.9, 0.8, 1)) * rotation;
            place = rotation * place;
        }
    const test::Agreement found = test::agreement(stage.scene);
    CHECK(found.exact >= 0.999);
    CHECK(found.close >= 0.9999);
    CHECK(found.lit > 0.3);
}
