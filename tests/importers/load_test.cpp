// Several inputs and sidecars become one scene.
#include "importers/gltf/gltf_materials.h"
#include "support/inputs.h"

using namespace penumbra;
using test::Inputs, test::StudioFiles, test::facet_obj, test::material_of, test::near;

namespace {

// Two cameras and a light.
const char* const stage = R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
    "nodes": [{"name": "Front", "camera": 0, "translation": [0, 0, 5]},
              {"name": "Side", "camera": 1, "translation": [1, 0, 0]},
              {"name": "Bulb", "translation": [0, 2, 0],
               "extensions": {"KHR_lights_punctual": {"light": 0}}}],
    "cameras": [{"name": "Front", "type": "perspective",
                 "perspective": {"yfov": 0.5, "znear": 0.1}},
                {"name": "Side", "type": "orthographic",
                 "orthographic": {"xmag": 2, "ymag": 2, "znear": 0.1, "zfar": 10}}],
    "extensionsUsed": ["KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"name": "Bulb", "type": "point"}]}}
})";

}  // namespace

TEST_CASE("A sidecar alone is a complete scene") {
    const Imported result = StudioFiles().load({"studio.toml"});
    CHECK(defects(result.scene).empty());
    CHECK(result.scene.cameras.size() == 1);
    CHECK(result.scene.lights.size() == 1);
    REQUIRE(result.models.size() == 1);
    CHECK(result.models[0].format == "sidecar");
    CHECK(result.losses.empty());
}

TEST_CASE("An empty sidecar still makes a picture") {
    Inputs inputs;
    const Scene scene = inputs.file("empty.toml", "").load({"empty.toml"}).scene;
    CHECK(scene.lights.size() == 3);
    CHECK(scene.cameras.size() == 1);
}

TEST_CASE("Inputs that cannot be read are named") {
    Inputs inputs;
    inputs.file("chair.fbx", "").file("noextension", "");
    CHECK(inputs.problem({"missing.obj"}) == "missing.obj: no such file");
    CHECK(inputs.problem({"missing.toml"}) == "missing.toml: no such file");
    CHECK(inputs.problem({"chair.fbx"}) ==
          "chair.fbx: unknown file format (supported are .gltf, .glb, .obj and .toml)");
    CHECK(inputs.problem({"noextension"}) ==
          "noextension: unknown file format (supported are .gltf, .glb, .obj and .toml)");
    CHECK(inputs.problem({}) == "no input is given");
    CHECK(inputs.problem({}, {.sidecar = inputs.folder / "no.toml"}) == "no.toml: no such file");
    test::fs::create_directory(inputs.folder / "folder.toml");
    CHECK(inputs.problem({"folder.toml"}) == "folder.toml: is a folder");
}

TEST_CASE("Several sidecars form one scene and a later one wins") {
    StudioFiles inputs;
    inputs.file("Night.TOML", "[lighting]\nambient = 0.125\n[material.floor]\ndiffuse = 0.75\n"
                              "[[light]]\nname = \"moon\"\nposition = [0, 9, 0]");
    const Scene scene = inputs.load({"studio.toml", "Night.TOML"}).scene;
    CHECK(scene.ambient == Color(0.125F));
    REQUIRE(scene.lights.size() == 2);
    CHECK(scene.lights[1].name == "moon");
    CHECK(material_of(scene, "floor").diffuse == 0.75F);
    CHECK(material_of(scene, "floor").specular == 0.25F);
    CHECK(inputs.load({"Night.TOML", "studio.toml"}).scene.ambient == Color(0.5F));
    CHECK(inputs.load({"studio.toml"}, {.sidecar = inputs.folder / "Night.TOML"}).scene.ambient ==
          Color(0.125F));
}

TEST_CASE("Only the keys that are given change a material") {
    StudioFiles inputs;
    inputs.file("a.toml",
                "[material.floor]\nchecker = { colors = [[1, 0, 0], [0, 1, 0]], size = 3 }");
    const auto pattern = [&](const std::string& setting) {
        const Scene scene = inputs.set({"studio.toml", "a.toml"}, {setting}).scene;
        return material_of(scene, "floor").pattern;
    };
    const auto resized = std::get<Checker>(pattern("material.floor.checker.size=7"));
    CHECK(resized.size == 7);
    CHECK(resized.colors[0] == Color(1, 0, 0));
    CHECK(std::holds_alternative<Checker>(pattern("material.floor.diffuse=0.1")));
    CHECK(std::holds_alternative<Noise>(pattern("material.floor.noise={size=2}")));
    CHECK(std::holds_alternative<std::monostate>(pattern("material.floor.color=[1,1,1]")));
}

TEST_CASE("A camera follows the shape of the picture") {
    Inputs inputs;
    inputs.file("ball.toml", "[[sphere]]");
    const auto distance = [&](const std::string& size) {
        return inputs.set({"ball.toml"}, {"render.size=" + size})
            .scene.cameras.at(0)
            .position.length();
    };
    CHECK(distance("[400, 100]") > 2 * distance("[100, 100]"));
}

TEST_CASE("A texture on a mesh without texture coordinates is a loss") {
    Inputs inputs;
    inputs.file("t.obj", facet_obj);
    Image image(2, 2);
    save_image(inputs.folder / "wood.png", image);
    inputs.file("a.toml", "[material.paint]\ncolor = [0.5, 0.25, 1]\ntexture = \"wood.png\"\n"
                          "[[plane]]\nmaterial = \"paint\"");
    const Imported result = inputs.load({"t.obj", "a.toml"});
    const Scene& scene = result.scene;
    const Material& plain = scene.materials.at(scene.meshes.at(0).material);
    CHECK(std::holds_alternative<std::monostate>(plain.pattern));
    CHECK(plain.color == Color(0.5F, 0.25F, 1));
    CHECK(
        std::holds_alternative<ImageMap>(scene.materials.at(scene.planes.at(0).material).pattern));
    const auto lost =
        std::find_if(result.losses.begin(), result.losses.end(), [](const Loss& loss) {
            return loss.what.rfind("has no texture coordinates", 0) == 0;
        });
    REQUIRE(lost != result.losses.end());
    CHECK(lost->what == "has no texture coordinates for the texture of material 'paint'; its "
                        "plain colour is used");
}

TEST_CASE("A translucent material is shown without the maps that it has, and those are named") {
    Inputs inputs;
    inputs.file("a.toml", "[material.leaf]\nopacity = 0.5");
    const auto lost = [&](const char* name, const test::json& maps) {
        test::json material = {{"name", "leaf"}};
        material.update(maps);
        test::Gltf gltf = test::with_material(material);
        const test::json image = test::pixels(3, {255, 51, 0, 0, 204, 255});
        gltf.add("textures", {{"source", gltf.add("images", image)}});
        inputs.file(name, gltf.text());
        const Imported result = inputs.load({name, "a.toml"});
        CHECK(defects(result.scene).empty());
        std::vector<std::string> said;
        for (const Loss& loss : result.losses)
            if (loss.place == "material 'leaf'") said.push_back(loss.what);
        return said;
    };
    const test::json emission = {{"emissiveTexture", {{"index", 0}}},
                                 {"emissiveFactor", {1, 1, 1}}};
    test::json both = emission;
    both["pbrMetallicRoughness"] = {{"metallicRoughnessTexture", {{"index", 0}}}};
    using Lines = std::vector<std::string>;
    CHECK(lost("a.gltf", emission).empty());
    CHECK(lost("b.gltf", both) == Lines{"is shown without its specular lobes: it is translucent"});
    CHECK(lost("c.gltf", test::json::object()).empty());
}

TEST_CASE("Facets that lie on one another are a loss with their number") {
    Inputs inputs;
    const std::string corners = facet_obj;
    inputs.file("same.obj", corners + "f 1 2 3\nf 1 2 3\n");
    inputs.file("back.obj", corners + "f 3 2 1\n");
    const auto lost = [&](const char* name, const LoadOptions& options) {
        const Losses losses = inputs.load({name}, options).losses;
        const auto found = std::ranges::find(losses, "facets", &Loss::place);
        REQUIRE(found != losses.end());
        CHECK(found->what.starts_with("2 that lie "));
        return found->count;
    };
    CHECK(lost("same.obj", {}) == 2);
    CHECK(lost("back.obj", {.sides = Sides::front}) == 2);
}

TEST_CASE("A model's first camera is the active one until another is picked by name") {
    Inputs inputs;
    inputs.file("stage.gltf", stage).file("a.toml", "[camera]\nname = \"Side\"");
    const Scene first = inputs.load({"stage.gltf"}).scene;
    CHECK(first.cameras.size() == 2);
    CHECK(first.cameras.at(first.camera).name == "Front");
    const Scene picked = inputs.load({"stage.gltf", "a.toml"}).scene;
    CHECK(picked.cameras.size() == 2);
    CHECK(picked.cameras.at(picked.camera).name == "Side");
    const Scene again = inputs.set({"stage.gltf", "a.toml"}, {"camera.name=Front"}).scene;
    CHECK(again.cameras.at(again.camera).name == "Front");
    const Scene second = inputs.set({"stage.gltf"}, {"camera.name=\"1\""}).scene;
    CHECK(second.cameras.at(second.camera).name == "Side");
    CHECK(inputs.set_problem({"stage.gltf"}, "camera.name=Frnt") ==
          "setting 'camera.name=Frnt': no camera 'Frnt' (did you mean 'Front'?)");
    CHECK(inputs.set_problem({"stage.gltf"}, "camera.name=Top") ==
          "setting 'camera.name=Top': no camera 'Top' (cameras: Front, Side)");
}

TEST_CASE("A sidecar's camera without a position is the model's with other keys") {
    Inputs inputs;
    inputs.file("stage.gltf", stage).file("a.toml", "[camera]\nfov = 30");
    const Scene scene = inputs.load({"stage.gltf", "a.toml"}).scene;
    REQUIRE(scene.cameras.size() == 3);
    const Camera& camera = scene.cameras.at(scene.camera);
    CHECK(camera.name == "sidecar");
    CHECK(camera.position == Vec3(0, 0, 5));
    CHECK(camera.fov == Approx(radians(30)));
    CHECK(camera.side == Camera::Side::horizontal);
    const Scene moved = inputs.set({"stage.gltf"}, {"camera.position=[0,1,5]"}).scene;
    CHECK(moved.cameras.size() == 2);
    CHECK(near(moved.cameras[0].direction.normalized(), {0, 0, -1}));
}

TEST_CASE("A model's camera gives the picture its shape when nobody asks for a size") {
    Inputs inputs;
    std::string wide = stage, tall = stage;
    const std::string fov = "\"yfov\": 0.5";
    wide.insert(wide.find(fov), "\"aspectRatio\": 2, ");
    tall.insert(tall.find(fov), "\"aspectRatio\": 0.5, ");
    inputs.file("wide.gltf", wide).file("tall.gltf", tall);
    const auto size = [&](const std::string& model, const std::vector<std::string>& settings) {
        const RenderOptions render = inputs.set({model}, settings).render;
        return std::array{render.width, render.height};
    };
    CHECK(size("wide.gltf", {}) == std::array{800, 400});
    CHECK(size("tall.gltf", {}) == std::array{300, 600});
    CHECK(size("wide.gltf", {"camera.name=Side"}) == std::array{600, 600});
    CHECK(size("wide.gltf", {"camera.position=[1, 2, 3]"}) == std::array{800, 400});
    // Somebody else's view, or size, even the usual one.
    CHECK(size("wide.gltf", {"camera.fov=30"}) == std::array{800, 600});
    CHECK(size("wide.gltf", {"render.size=[800, 600]"}) == std::array{800, 600});
}

TEST_CASE("Lights and cameras of a model move with it") {
    Inputs inputs;
    inputs.file("stage.gltf", stage);
    inputs.file("a.toml", "[[model]]\nfile = \"stage.gltf\"\nscale = 3\nrotate = [0, 90, 0]\n"
                          "translate = [0, 1, 0]\n[[light]]\nposition = [0, 0, 0]");
    const Scene plain = inputs.load({"stage.gltf"}).scene;
    const Scene scene = inputs.load({"a.toml"}).scene;
    REQUIRE(scene.lights.size() == 2);
    CHECK(near(scene.lights[0].position, {0, 7, 0}));
    REQUIRE(scene.lights[0].attenuation);
    CHECK(scene.lights[0].attenuation->distance ==
          Approx(3 * plain.lights.at(0).attenuation->distance));
    REQUIRE(scene.cameras.size() == 2);
    CHECK(near(scene.cameras[0].position, {15, 1, 0}));
    CHECK(near(scene.cameras[0].direction, {-1, 0, 0}));
    CHECK(scene.cameras[1].extent == Approx(3 * plain.cameras.at(1).extent));
    const Scene set = inputs.set({"stage.gltf"}, {"light.0.intensity=7"}).scene;
    CHECK(set.lights.at(0).intensity == 7);
}

TEST_CASE("Models of several inputs share one scene") {
    Inputs inputs;
    inputs.file("t.obj", std::string("mtllib t.mtl\n") + facet_obj);
    inputs.file("t.mtl", "newmtl paint\nKd 1 0 0\n");
    inputs.file("u.obj", std::string("mtllib u.mtl\n") + facet_obj);
    inputs.file("u.mtl", "newmtl paint\nKd 0 0 1\n");
    inputs.file("stage.gltf", stage);
    const Imported result = inputs.load({"t.obj", "stage.gltf", "u.obj"});
    const Scene& scene = result.scene;
    REQUIRE(scene.instances.size() == 2);
    CHECK(scene.materials.at(scene.meshes.at(scene.instances[0].mesh).material).color ==
          Color(1, 0, 0));
    CHECK(scene.materials.at(scene.meshes.at(scene.instances[1].mesh).material).color ==
          Color(0, 0, 1));
    CHECK(scene.lights.size() == 1);
    CHECK(result.models.size() == 3);
    CHECK(defects(scene).empty());
}

TEST_CASE("The light of a glTF file asks for an exposure unless somebody gives one") {
    StudioFiles inputs;
    inputs.file("stage.gltf", stage).file("facet.obj", facet_obj);
    const auto asks = [&](const std::vector<std::string>& names,
                          const std::vector<std::string>& settings = {}) {
        return inputs.set(names, settings).auto_exposure;
    };
    CHECK(asks({"stage.gltf", "facet.obj"}));
    CHECK(asks({"stage.gltf", "studio.toml"}));
    CHECK_FALSE(asks({"stage.gltf"}, {"render.exposure=2"}));
    CHECK_FALSE(asks({"facet.obj"}));
    CHECK_FALSE(asks({"studio.toml"}));
    CHECK(asks({"studio.toml"}, {"render.exposure=auto"}));
    CHECK(inputs.set_problem({"studio.toml"}, "render.exposure=bright") ==
          "setting 'render.exposure=bright': 'exposure' in [render] must be a number or \"auto\"");
}

TEST_CASE("A glTF file with lights of its own stands before a grey, as bright as it is shown") {
    StudioFiles inputs;
    inputs.file("stage.gltf", stage).file("facet.obj", facet_obj);
    const std::vector<std::string> names = {"stage.gltf", "facet.obj"};
    const auto load = [&](std::vector<std::string> settings = {}, Studio studio = Studio::floor) {
        return inputs.load(names, {.settings = std::move(settings), .studio = studio});
    };
    const Imported metered = load();
    CHECK(metered.plain_background);  // to be divided by what is metered
    CHECK(metered.scene.background == Color(0.18F));
    const Imported given = load({"render.exposure=2"});
    CHECK_FALSE(given.plain_background);
    CHECK(given.scene.background == Color(0.045F));
    const Imported own = load({"render.background=[0.5,0,0]"});
    CHECK_FALSE(own.plain_background);
    CHECK(own.scene.background == Color(0.5F, 0, 0));
    const Imported black = load({}, Studio::black);
    CHECK_FALSE(black.plain_background);
    CHECK(black.scene.background == Color(0));
}

TEST_CASE("Rough glass whose vertices have colours is shown clear, and said to be") {
    Inputs inputs;
    inputs
        .file("sheet.obj", "mtllib glass.mtl\nusemtl glass\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\n"
                           "v 0 1 0 0 0 1\nv 0 0 1 1 1 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
        .file("glass.mtl", "newmtl glass\n")
        .file("rough.toml", "[material.glass]\nopacity = 0.1\nior = 1.5\nroughness = 0.3\n");
    const auto lost = [&](const std::vector<std::string>& names) {
        return std::ranges::count(inputs.load(names).losses,
                                  "its rough glass is shown as clear: its vertices have colours",
                                  &Loss::what);
    };
    CHECK(lost({"sheet.obj", "rough.toml"}) == 1);
    CHECK(lost({"sheet.obj"}) == 0);
}

TEST_CASE("Normal maps are baked, dropped or kept as the caller wants") {
    Scene scene;
    scene.meshes = {{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                     .normals = std::vector(3, Vec3f(0, 0, 1)),
                     .texcoords = {{0, 0}, {1, 0}, {0, 1}},
                     .triangles = {{0, 1, 2}},
                     .material = 0}};
    scene.instances = {{.name = "facet", .mesh = 0}};
    scene.textures = {{.name = "bumps",
                       .raster = {.width = 1,
                                  .height = 1,
                                  .channels = 3,
                                  .data = {std::byte(200), std::byte(128), std::byte(230)}},
                       .srgb = false}};
    scene.materials = {{.name = "paint"}};
    scene.materials[0].normal_map = NormalMap{.map = {.texture = 0}};

    Scene baked = scene, dropped = scene, kept = scene;
    CHECK(settle_normal_maps(baked, NormalMaps::bake).size() == 1);
    CHECK_FALSE(baked.materials[0].normal_map.has_value());
    CHECK(baked.meshes[0].normals[0].x > 0.5F);
    CHECK(settle_normal_maps(dropped, NormalMaps::drop).size() == 1);
    CHECK_FALSE(dropped.materials[0].normal_map.has_value());
    CHECK(dropped.meshes[0].normals[0].x == 0);
    CHECK(settle_normal_maps(kept, NormalMaps::pixel).empty());
    CHECK(kept.materials[0].normal_map.has_value());
    CHECK(kept.meshes[0].tangents.size() == 3);
}

TEST_CASE("All files that a scene comes from are listed, read or only named") {
    const Inputs inputs;
    const auto image = [&](const std::string& name) {
        test::write(inputs.folder / name, "");
        Image pixels(2, 2);
        save_image(inputs.folder / name, pixels);
    };
    for (const char* name : {"maps/wood.png", "sky.png", "floor.png", "skin.png", "unused.png"})
        image(name);
    test::write(inputs.folder / "a.mtl", "newmtl paint\nKd 1 1 1\nmap_Kd maps\\wood.png\n"
                                         "newmtl other\nmap_Bump -bm 1 unused.png\n");
    test::write(inputs.folder / "a.obj", "mtllib a.mtl\nmtllib none.mtl\nvt 0 0\nusemtl paint\n"
                                         "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1/1 2/1 3/1\n");
    test::Gltf gltf = test::triangle();
    gltf.add("images", {{"uri", "skin.png"}});
    gltf.add("images", {{"uri", "data:image/png;base64,"}});
    test::write(inputs.folder / "b.gltf", gltf.text());
    test::write(inputs.folder / "c.toml",
                "[render]\nbackground = \"sky.png\"\n"
                "[[model]]\nfile = \"b.gltf\"\n[[plane]]\nmaterial = \"f\"\n"
                "[material.f]\ntexture = \"floor.png\"\n");
    const Imported loaded = inputs.load({"a.obj", "c.toml"});
    std::vector<std::string> found;
    for (const auto& file : loaded.files)
        found.push_back(file.lexically_relative(inputs.folder.path).string());
    CHECK(found == std::vector<std::string>{"a.mtl", "a.obj", "b.gltf", "c.toml", "floor.png",
                                            "maps/wood.png", "skin.png", "sky.png", "unused.png"});
}

TEST_CASE("Inputs are found whichever way their accents are spelled") {
    Inputs inputs;
    inputs.file("mu\u0308ll.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    inputs.file("ta\u0308g.toml", "[[model]]\nfile = \"m\u00fcll.obj\"\n");
    CHECK(inputs.load({"m\u00fcll.obj"}).scene.meshes.size() == 1);
    CHECK(inputs.load({"t\u00e4g.toml"}).scene.meshes.size() == 1);
}
