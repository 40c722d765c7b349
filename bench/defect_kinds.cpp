#include "defect_kinds.h"

#include <algorithm>
#include <cmath>

namespace defects {
namespace {

using Applies = std::function<bool(const Stage&)>;

// ---- what a scene has -------------------------------------------------------------------------

bool always(const Stage&) { return true; }

Applies any_light(bool (*has)(const Light&)) {
    return [=](const Stage& s) { return std::ranges::any_of(s.scene.scene.lights, has); };
}

Index material_of(const Scene& scene, std::size_t object) {
    if (object < scene.instances.size()) return scene.meshes[scene.instances[object].mesh].material;
    object -= scene.instances.size();
    if (object < scene.spheres.size()) return scene.spheres[object].material;
    return scene.planes[object - scene.spheres.size()].material;
}

std::size_t pixels_of_material(const Stage& stage, Index material) {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < stage.pixels.size(); ++i)
        if (material_of(stage.scene.scene, i) == material) sum += stage.pixels[i];
    return sum;
}

// Of the picture's pixels.
constexpr double visible = 0.01;

std::size_t enough(const Stage& stage) {
    return std::size_t(visible * double(stage.picture.pixels.size()));
}

// Can a material that has it be seen?
Applies any_material(bool (*has)(const Material&)) {
    return [=](const Stage& s) {
        const auto& materials = s.scene.scene.materials;
        for (Index i = 0; i < materials.size(); ++i)
            if (has(materials[i]) && pixels_of_material(s, i) > enough(s)) return true;
        return false;
    };
}

bool shines(const Material& m) { return m.specular > 0 || m.specular_lobes; }
bool mirrors(const Material& m) { return m.reflection != Color(0) || m.specular_lobes; }
bool clear(const Material& m) { return m.opacity < 1; }
bool bends(const Material& m) { return m.opacity < 1 && m.ior != 1; }
bool glows(const Material& m) { return m.emission != Color(0); }
bool has_penumbra(const Light& light) { return light.penumbra.delta > 0; }
bool fades(const Light& light) { return light.attenuation.has_value(); }
bool any(const Light&) { return true; }

// The material that most pixels show.
Index main_material(const Stage& stage) {
    Index best = 0;
    for (Index i = 0; i < stage.scene.scene.materials.size(); ++i)
        if (pixels_of_material(stage, i) > pixels_of_material(stage, best)) best = i;
    return best;
}

bool has_mesh(const Stage& stage) {
    const auto& instances = stage.scene.scene.instances;
    std::size_t sum = 0;
    for (std::size_t i = 0; i < instances.size(); ++i) sum += stage.pixels[i];
    return sum > enough(stage);
}

bool has_smooth_mesh(const Stage& stage) {
    const Scene& scene = stage.scene.scene;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        if (!mesh.normals.empty() && scene.materials[mesh.material].smooth &&
            stage.pixels[i] > enough(stage))
            return true;
    }
    return false;
}

// The sphere or mesh whose share of the picture is nearest to a twentieth.
std::size_t middling_object(const Stage& stage) {
    const Scene& scene = stage.scene.scene;
    const double wanted = 0.05 * double(stage.picture.pixels.size());
    std::size_t best = 0;
    for (std::size_t i = 0; i < scene.instances.size() + scene.spheres.size(); ++i)
        if (std::abs(double(stage.pixels[i]) - wanted) <
            std::abs(double(stage.pixels[best]) - wanted))
            best = i;
    return best;
}

bool has_object(const Stage& stage) {
    const Scene& scene = stage.scene.scene;
    return scene.instances.size() + scene.spheres.size() > 1 &&
           stage.pixels[middling_object(stage)] > enough(stage);
}

std::vector<Index> textured_materials(const Stage& stage) {
    std::vector<Index> result;
    const Scene& scene = stage.scene.scene;
    for (Index i = 0; i < scene.materials.size(); ++i) {
        const bool of_mesh = std::ranges::any_of(scene.instances, [&](const Instance& instance) {
            return scene.meshes[instance.mesh].material == i;
        });
        if (of_mesh && std::holds_alternative<ImageMap>(scene.materials[i].pattern) &&
            pixels_of_material(stage, i) > enough(stage))
            result.push_back(i);
    }
    return result;
}

bool has_texture(const Stage& stage) { return !textured_materials(stage).empty(); }

// Half a texel is seen where texels are.
bool has_coarse_texture(const Stage& stage) {
    return std::ranges::any_of(textured_materials(stage), [&](Index i) {
        const auto& map = std::get<ImageMap>(stage.scene.scene.materials[i].pattern);
        return stage.scene.scene.textures[map.texture].raster.width <= 64;
    });
}

std::size_t count_visible(const Stage& stage, bool (*has)(const Material&)) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < stage.pixels.size(); ++i)
        if (stage.pixels[i] > enough(stage) &&
            has(stage.scene.scene.materials[material_of(stage.scene.scene, i)]))
            ++count;
    return count;
}

// ---- defects of the scene ---------------------------------------------------------------------

std::function<Image(const Stage&)> changed(std::function<void(const Stage&, Scene&)> change) {
    return [=](const Stage& stage) {
        NormalisedScene scene = stage.scene;
        change(stage, scene.scene);
        return render(scene, stage.options);
    };
}

std::function<Image(const Stage&)> each_material(void (*change)(Material&)) {
    return changed([=](const Stage&, Scene& scene) {
        for (Material& m : scene.materials) change(m);
    });
}

std::function<Image(const Stage&)> each_light(void (*change)(Light&)) {
    return changed([=](const Stage&, Scene& scene) {
        for (Light& light : scene.lights) change(light);
    });
}

void scale_pigment(Material& m, const Color& factor) {
    m.color *= factor;
    if (auto* checker = std::get_if<Checker>(&m.pattern))
        for (Color& color : checker->colors) color *= factor;
    if (auto* noise = std::get_if<Noise>(&m.pattern))
        for (Color& color : noise->colors) color *= factor;
}

void remove_object(Scene& scene, std::size_t object) {
    if (object < scene.instances.size())
        scene.instances.erase(scene.instances.begin() + std::ptrdiff_t(object));
    else
        scene.spheres.erase(scene.spheres.begin() +
                            std::ptrdiff_t(object - scene.instances.size()));
}

// Every textured material looks its image up at (a u + c, b v + d).
std::function<Image(const Stage&)> looked_up(double a, double b, double c, double d, bool texels) {
    return changed([=](const Stage& stage, Scene& scene) {
        for (const Index i : textured_materials(stage)) {
            auto& map = std::get<ImageMap>(scene.materials[i].pattern);
            const Raster& raster = scene.textures[map.texture].raster;
            auto& t = map.transform;
            for (std::size_t k = 0; k < 3; ++k) {
                t[k] *= a;
                t[3 + k] *= b;
            }
            t[2] += texels ? c / raster.width : c;
            t[5] += texels ? d / raster.height : d;
        }
    });
}

// Every mesh, about the origin of the user's world.
void place_meshes(const Stage& stage, Scene& scene, const Matrix& change) {
    const Vec3 origin = stage.scene.offset * -stage.scene.factor;
    Matrix there, back;
    there.setTranslation(-origin);
    back.setTranslation(origin);
    for (Instance& i : scene.instances) i.transform = i.transform * there * change * back;
}

void turn_meshes(const Stage& stage, Scene& scene) {
    Matrix turn;
    turn.setAxisAngle(Vec3(0, 1, 0), radians(1));
    place_meshes(stage, scene, turn);
}

void tip_meshes(const Stage& stage, Scene& scene) {
    Matrix turn;
    turn.setAxisAngle(Vec3(1, 0, 0), -radians(0.6));
    place_meshes(stage, scene, turn);
}

void mirror_meshes(const Stage& stage, Scene& scene) {
    Matrix mirror;
    mirror.setScale(Vec3(-1, 1, 1));
    place_meshes(stage, scene, mirror);
}

Image traced_twice(const Stage& stage) {
    RenderOptions options = stage.options;
    options.max_depth = 2;
    return render(stage.scene, options);
}

Image shadowless(const Stage& stage) {
    return Tracer(stage.scene).render(stage.options, {.shadows = false});
}

// ---- the list ---------------------------------------------------------------------------------

std::vector<Defect> of_light() {
    const auto has_lights = any_light(any), has_soft_light = any_light(has_penumbra);
    return {{"light 5 % brighter", {"light"}, has_lights, each_light([](Light& l) {
                 l.intensity *= 1.05;
             })},
            {"first light 3 % dimmer", {"light"}, has_lights, changed([](const Stage&, Scene& s) {
                 s.lights.front().intensity *= 0.97;
             })},
            {"one light missing",
             {"light_missing"},
             [](const Stage& s) { return s.scene.scene.lights.size() > 1; },
             changed([](const Stage&, Scene& s) { s.lights.pop_back(); })},
            {"ambient light missing",
             {"ambient"},
             any_material([](const Material& m) { return m.ambient != Color(0); }),
             changed([](const Stage&, Scene& s) { s.ambient = Color(0); })},
            {"attenuation ignored", {"attenuation"}, any_light(fades), each_light([](Light& l) {
                 l.attenuation.reset();
             })},
            {"emission missing", {"emission"}, any_material(glows), each_material([](Material& m) {
                 m.emission = Color(0);
             })},
            {"shadows missing", {"shadows"}, has_lights, shadowless},
            {"penumbra missing", {"penumbra"}, has_soft_light, each_light([](Light& l) {
                 l.penumbra.delta = 0;
             })},
            {"delta doubled", {"penumbra"}, has_soft_light, each_light([](Light& l) {
                 l.penumbra.delta *= 2;
             })},
            {"delta 0.6 times as large", {"penumbra"}, has_soft_light, each_light([](Light& l) {
                 l.penumbra.delta *= 0.6;
             })},
            {"another background",
             {"background"},
             [](const Stage& s) { return s.behind > enough(s); },
             changed([](const Stage&, Scene& s) { s.background += Color(0.02F, 0.03F, 0.05F); })}};
}

std::vector<Defect> of_surfaces() {
    return {
        {"flat shading", {"smoothing"}, has_smooth_mesh, each_material([](Material& m) {
             m.smooth = false;
         })},
        {"highlights missing", {"highlights"}, any_material(shines), each_material([](Material& m) {
             m.specular = 0;
         })},
        {"shininess 1.5 times as high",
         {"shininess"},
         any_material(shines),
         each_material([](Material& m) { m.shininess *= 1.5F; })},
        {"shininess 0.7 times as high",
         {"shininess"},
         any_material(shines),
         each_material([](Material& m) { m.shininess *= 0.7F; })},
        {"reflection missing",
         {"reflection"},
         any_material(mirrors),
         each_material([](Material& m) { m.reflection = Color(0); })},
        {"reflection a third weaker",
         {"reflection"},
         any_material(mirrors),
         each_material([](Material& m) { m.reflection *= 2 / 3.F; })},
        {"reflection a fifth stronger",
         {"reflection"},
         any_material(mirrors),
         each_material([](Material& m) { m.reflection *= 1.2F; })},
        {"recursion depth 2",
         {"depth"},
         [](const Stage& s) { return s.options.max_depth > 2 && count_visible(s, mirrors) > 1; },
         traced_twice},
        {"transparency missing",
         {"transparency"},
         any_material(clear),
         each_material([](Material& m) { m.opacity = 1; })},
        {"refraction missing", {"refraction"}, any_material(bends), each_material([](Material& m) {
             m.ior = 1;
         })}};
}

std::vector<Defect> of_pigments() {
    return {{"albedo of a material 0.6 for 0.7",
             {"albedo"},
             always,
             changed([](const Stage& stage, Scene& s) {
                 scale_pigment(s.materials[main_material(stage)], Color(0.6F / 0.7F));
             })},
            {"albedo of a material redder",
             {"albedo"},
             always,
             changed([](const Stage& stage, Scene& s) {
                 scale_pigment(s.materials[main_material(stage)], {1.05F, 0.95F, 0.9F});
             })},
            {"texture mirrored", {"texture"}, has_texture, looked_up(-1, 1, 1, 0, false)},
            {"texture upside down", {"texture"}, has_texture, looked_up(1, -1, 0, 1, false)},
            {"texture off by half a texel",
             {"texture"},
             has_coarse_texture,
             looked_up(1, 1, 0.5, 0.5, true)},
            {"texture missing", {"texture"}, has_texture, changed([](const Stage& stage, Scene& s) {
                 for (const Index i : textured_materials(stage))
                     s.materials[i].pattern = std::monostate();
             })}};
}

std::vector<Defect> of_geometry() {
    return {
        {"field of view 1 degree wider", {"fov"}, always, changed([](const Stage&, Scene& s) {
             s.cameras[s.camera].fov += radians(1);
         })},
        {"field of view 0.3 degrees narrower", {"fov"}, always, changed([](const Stage&, Scene& s) {
             s.cameras[s.camera].fov -= radians(0.3);
         })},
        {"object missing", {"object"}, has_object, changed([](const Stage& stage, Scene& s) {
             remove_object(s, middling_object(stage));
         })},
        {"models turned by 1 degree", {"rotation"}, has_mesh, changed(turn_meshes)},
        {"models tipped by 0.6 degrees", {"rotation"}, has_mesh, changed(tip_meshes)},
        {"models mirrored", {"handedness"}, has_mesh, changed(mirror_meshes)}};
}

}  // namespace

Stage make_stage(const std::string& name, NormalisedScene scene, const RenderOptions& options) {
    Stage stage = {.name = name, .scene = std::move(scene), .options = options};
    stage.picture = render(stage.scene, options);
    const Scene& s = stage.scene.scene;
    stage.pixels.resize(s.instances.size() + s.spheres.size() + s.planes.size());
    for (const Index object : objects_seen(stage.scene, options))
        ++(object == no_index ? stage.behind : stage.pixels[object]);
    return stage;
}

std::vector<Defect> all_defects() {
    std::vector<Defect> result;
    for (const auto list : {of_light, of_surfaces, of_pigments, of_geometry, of_pictures})
        std::ranges::move(list(), std::back_inserter(result));
    return result;
}

}  // namespace defects
