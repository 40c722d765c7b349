// Light from behind that a surface scatters to the eye.
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/tracer.h"

#include <cmath>

using namespace penumbra;

namespace {

// An upright sheet before the eye.
Scene sheet() {
    Scene scene = test::empty_scene();
    test::add_quad(scene, {-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
    scene.materials[0].color = Color(0.1F, 0.1F, 0.9F);
    scene.materials[0].diffuse = 0.5F;
    scene.materials[0].diffuse_transmission = Color(0.5F, 0.1F, 0.2F);
    return scene;
}

Light from(const Vec3& direction, double intensity = 1) {
    return {.type = Light::Type::directional, .direction = direction, .intensity = intensity};
}

Color middle(const Scene& scene) {
    RenderOptions options;
    options.width = options.height = 9;
    return render(test::as_is(scene), options).at(4, 4);
}

void check(const Color& found, const Color& wanted) {
    INFO(found.x << ' ' << found.y << ' ' << found.z);
    CHECK((found - wanted).length() < 1e-5F);
}

}  // namespace

TEST_CASE("back light, is scattered by the cosine in a colour of its own") {
    Scene scene = sheet();
    scene.lights = {from({0, 0, 1})};
    check(middle(scene), {0.5F, 0.1F, 0.2F});
    scene.lights = {from(Vec3(0, std::sqrt(3.0), 1).normalized(), 2)};  // 60 degrees
    check(middle(scene), {0.5F, 0.1F, 0.2F});
    scene.lights = {from({0, 0, -1})};  // from the eye's side
    check(middle(scene), {0.05F, 0.05F, 0.45F});
    scene.lights.push_back(from({0, 0, 1}));
    check(middle(scene), {0.55F, 0.15F, 0.65F});
    scene.cameras[0].position.z = -10;  // seen from the other side
    scene.cameras[0].direction.z = 1;
    check(middle(scene), {0.55F, 0.15F, 0.65F});
}

TEST_CASE("back light, is shadowed by what stands behind, and no highlight comes with it") {
    Scene scene = sheet();
    scene.materials[0].specular = 1;
    scene.materials[0].shininess = 1;
    scene.lights = {from(Vec3(1, 0, 0.2).normalized())};
    const float cosine = 0.2F / std::sqrt(1.04F);
    check(middle(scene), Color(0.5F, 0.1F, 0.2F) * cosine);
    test::add_quad(scene, {-8, -8, -1}, {8, -8, -1}, {8, 8, -1}, {-8, 8, -1});
    check(middle(scene), Color(0));
}

TEST_CASE("back light, fades with the surface") {
    Scene scene = sheet();
    scene.materials[0].opacity = 0.25F;
    scene.lights = {from({0, 0, 1})};
    check(middle(scene), Color(0.5F, 0.1F, 0.2F) * 0.25F);
}

TEST_CASE("back light, does not show on a back that is not there") {
    // Tiles on the left see the front of a sheet, those on the right the back of one.
    Scene scene = sheet();
    scene.materials[0].sides = Sides::front;
    scene.meshes.clear();
    scene.instances.clear();
    test::add_quad(scene, {-5, -5, 0}, {0, -5, 0}, {0, 5, 0}, {-5, 5, 0});
    test::add_quad(scene, {0, -5, 0}, {0, 5, 0}, {5, 5, 0}, {5, -5, 0});
    scene.lights = {from({0, 0, 1}), from({0, 0, -1})};
    RenderOptions options;
    options.width = 96;
    options.height = 32;
    options.threads = 1;
    const Image image = render(test::as_is(scene), options);
    check(image.at(20, 16), {0.55F, 0.15F, 0.65F});
    for (int x = 49; x < 90; ++x) check(image.at(x, 16), Color(0));
}
