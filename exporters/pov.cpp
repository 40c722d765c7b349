#include "file.h"
#include "pov_files.h"
#include "pov_plan.h"
#include "sdl.h"

#include "penumbra/exporters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace penumbra {

namespace {

namespace fs = std::filesystem;
using pov::Look;
using pov::Plan;
using sdl::number;

std::string plural(std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

// What the .pov is written from.
struct Writer {
    const NormalisedScene& scene;
    const RenderOptions& render;
    const PovOptions& options;
    const std::string& stem;
    const Plan& plan;
    std::string extension = ".pov";  // of the file
    std::string out = {};

    void section(const char* title) { out += fmt::format("\n// ---- {} ----\n\n", title); }

    void losses(const char* title, const Losses& list) {
        if (list.empty()) return;
        out += fmt::format("//\n// {}\n", title);
        for (const Loss& loss : list)
            out += "//   " + sdl::comment(loss.place + ": " + loss.what, 300) + "\n";
    }

    void origin() {
        out += "// " + (options.source.empty() ? "A scene" : sdl::comment(options.source, 300)) +
               ", written by penumbra.\n";
        if (!options.command.empty()) out += "//   " + sdl::comment(options.command, 500) + "\n";
    }

    void all_losses() {
        Losses approximate = plan.losses;
        approximate.insert(approximate.begin(), options.losses.begin(), options.losses.end());
        losses("Not carried over exactly:", approximate);
    }

    void header() {
        out += "#version 3.7;\n\n";
        origin();
        out += fmt::format("//\n// Picture:  {} x {} pixels, ", render.width, render.height);
        out += render.samples > 1 ? fmt::format("a grid of {0} x {0} rays each, ", render.samples)
                                  : std::string("one ray each, ");
        out += plural(std::size_t(render.max_depth), "segment") + " along a path";
        if (render.exposure != 0) out += fmt::format(", exposure {:+g} EV", render.exposure);
        out += '\n';
        out += fmt::format("// Render:   povray {}.ini     (in this folder)\n", plan.stem);
        if (plan.stem != stem)
            out += fmt::format("//           (the same scene as this file, under a name that "
                               "POV-Ray can open)\n");
        all_losses();
    }

    void units() {
        out += "\n// POV-Ray's tolerances are absolute, so the scene is scaled by a power of two:\n"
               "//   position here = (position in the model - Model_offset) * Model_scale\n";
        out += "#declare Model_scale = " + number(scene.factor) + ";\n";
        out += "#declare Model_offset = " + sdl::vector(scene.offset) + ";\n";
    }

    void settings() {
        out += "\nglobal_settings {\n  assumed_gamma 1.0\n";
        out += fmt::format("  max_trace_level {}\n", std::min(render.max_depth, 256));
        out += "  adc_bailout 0\n  ambient_light " + sdl::color(scene.scene.ambient) + "\n}\n\n";
        out += "background { " + sdl::color(scene.scene.background) + " }\n";
        if (!scene.scene.sky) return;
        out += "sky_sphere {\n  pigment {\n    " + pov::sky_pigment(plan) + "\n  }\n}\n";
    }

    void camera() {
        const Camera& camera = scene.scene.cameras[scene.scene.camera];
        const View view = view_of(camera, render.width, render.height);
        out += "\ncamera {";
        if (!camera.name.empty()) out += "  // " + sdl::comment(camera.name);
        out += view.orthographic ? "\n  orthographic\n" : "\n  perspective\n";
        out += "  location  " + sdl::vector(view.location) + "\n";
        out += "  right     " + sdl::vector(view.right) + "\n";
        out += "  up        " + sdl::vector(view.up) + "\n";
        out += "  direction " + sdl::vector(view.direction) + "\n}\n";
    }

    void materials() {
        section("materials");
        const auto octaves = [](const Material& m) {
            const auto* noise = std::get_if<Noise>(&m.pattern);
            return noise != nullptr && noise->octaves > 1;
        };
        if (std::any_of(plan.looks.begin(), plan.looks.end(), [&](const Look& look) {
                return octaves(scene.scene.materials[look.material]);
            }))
            out += "// f_noise_generator of functions.inc\n"
                   "#declare Perlin_noise = function { internal(78) }\n\n";
        if (std::any_of(plan.looks.begin(), plan.looks.end(), [&](const Look& look) {
                return scene.scene.materials[look.material].coverage.has_value();
            }))
            out += "// where a surface is not there\n"
                   "#declare Nothing = texture { pigment { rgbt 1 } finish { ambient 0 diffuse 0 } "
                   "}\n\n";
        for (std::size_t i = 0; i < plan.looks.size(); ++i) {
            if (i > 0) out += '\n';
            const Look& look = plan.looks[i];
            const std::string& name = scene.scene.materials[look.material].name;
            if (!name.empty() && name != look.name) out += "// " + sdl::comment(name) + "\n";
            out += look_text(plan, look);
        }
    }

    void light(const Light& light) {
        const std::vector<Source> sources = virtual_sources(light);
        out += "  // " + light_title(light, sources.size()) + "\n";
        for (const Source& source : sources) {
            out += "  light_source { " + sdl::vector(source.position) + ", " +
                   sdl::color(source.color);
            if (source.type == Light::Type::directional) out += " parallel";
            if (source.type == Light::Type::spot)
                out += " spotlight radius " + number(degrees(source.inner)) + " falloff " +
                       number(degrees(source.outer)) + " tightness 0";
            if (source.type != Light::Type::point)
                out += " point_at " + sdl::vector(source.point_at);
            if (source.attenuation)
                out += " fade_distance " + number(source.attenuation->distance) + " fade_power " +
                       number(source.attenuation->power);
            out += " }\n";
        }
    }

    static std::string light_title(const Light& light, std::size_t count) {
        const char* const type = light.type == Light::Type::point  ? "point light"
                                 : light.type == Light::Type::spot ? "spot light"
                                                                   : "directional light";
        std::string title = light.name.empty() ? type : sdl::comment(light.name) + ": " + type;
        if (count == 1) return title;
        const Penumbra& penumbra = light.penumbra;
        title += fmt::format(", {} virtual sources (", count);
        switch (penumbra.layout) {
        case Penumbra::Layout::axes: title += "axes"; break;
        case Penumbra::Layout::sphere: title += "sphere"; break;
        case Penumbra::Layout::grid:
            title += fmt::format("grid of {} x {}", penumbra.count[0], penumbra.count[1]);
            break;
        }
        return title + ", delta " + number(penumbra.delta) + ")";
    }

    static std::string interior(const Material& m) {
        const bool bends = m.ior != 1 && (!opaque(m) || m.fresnel);
        const bool absorbs = m.absorption && !opaque(m);
        if (!bends && !absorbs && !m.fresnel) return "";
        std::string text = " interior { ior " + number(m.ior);
        if (absorbs)
            text += " fade_distance " + number(float(m.absorption->distance)) +
                    " fade_power 1001 fade_color " + sdl::color(fade_color(*m.absorption));
        return text + " }";
    }

    // The material and what else stands in an object, after its transform: patterns in world space
    // must not move with it.
    std::string surface(const Look& look, bool with_texture = true) const {
        const Material& m = scene.scene.materials[look.material];
        std::string text = with_texture ? " texture { Material_" + look.name + " }" : "";
        return text + interior(m);
    }

    void title(const std::string& name) {
        if (!name.empty()) out += "  // " + sdl::comment(name) + "\n";
    }

    static std::string placement(const Matrix& m) {
        Matrix linear = m;
        for (int column = 0; column < 3; ++column) linear[3][column] = 0;
        const Vec3 move(m[3][0], m[3][1], m[3][2]);
        if (linear == Matrix()) return move == Vec3(0) ? "" : " translate " + sdl::vector(move);
        std::string text = "\n    matrix <";
        for (int row = 0; row < 4; ++row)
            text += fmt::format("{}{}, {}, {}", row == 0 ? "" : ",\n            ",
                                number(m[row][0]), number(m[row][1]), number(m[row][2]));
        return text + ">\n   ";
    }

    void instance(const Instance& instance) {
        const pov::MeshPlan& mesh = plan.meshes[instance.mesh];
        if (mesh.name.empty()) return;
        if (instance.name != scene.scene.meshes[instance.mesh].name) title(instance.name);
        const std::string where = placement(instance.transform);
        out += "  object { Mesh_" + mesh.name + where +
               surface(plan.looks[mesh.look], mesh.tints.empty());
        out += where.find('\n') == std::string::npos ? " }\n" : "\n  }\n";
    }

    void sphere(const Sphere& sphere, const Look& look) {
        title(sphere.name);
        out += "  sphere { " + sdl::vector(sphere.center) + ", " + number(sphere.radius) +
               surface(look) + " }\n";
    }

    void plane(const Plane& plane, const Look& look) {
        title(plane.name);
        const Vec3 normal = plane.normal.normalized();
        out += "  plane { " + sdl::vector(normal) + ", " + number(normal.dot(plane.point)) +
               surface(look) + " }\n";
    }

    void world() {
        section("lights and objects");
        out +=
            "// In a light_group POV-Ray does not reuse the object that shadowed the last pixel,\n"
            "// so that the picture does not depend on the order of its pixels.\n"
            "light_group {\n";
        for (const Light& l : scene.scene.lights) light(l);
        out += '\n';
        objects();
        out += "}\n";
    }

    void objects() {
        for (const Instance& i : scene.scene.instances) instance(i);
        for (std::size_t i = 0; i < scene.scene.spheres.size(); ++i)
            sphere(scene.scene.spheres[i], plan.looks[plan.spheres[i]]);
        for (std::size_t i = 0; i < scene.scene.planes.size(); ++i)
            plane(scene.scene.planes[i], plan.looks[plan.planes[i]]);
    }

    static bool is_drawn(const pov::MeshPlan& mesh) { return !mesh.name.empty(); }

    std::size_t object_count() const {
        const auto drawn =
            std::count_if(scene.scene.instances.begin(), scene.scene.instances.end(),
                          [&](const Instance& i) { return is_drawn(plan.meshes[i.mesh]); });
        return std::size_t(drawn) + scene.scene.spheres.size() + scene.scene.planes.size();
    }

    void geometry() {
        if (std::none_of(plan.meshes.begin(), plan.meshes.end(), is_drawn)) return;
        section("geometry");
        out += "#include \"" + plan.stem + "_geometry.inc\"\n";
    }

    std::string text() {
        if (options.style == PovStyle::include) return include_text();
        header();
        units();
        settings();
        camera();
        materials();
        geometry();
        world();
        return std::move(out);
    }

    std::string include_text() {
        sdl::Names names;
        for (const char* taken : {"scale", "offset"}) names.unique(taken, "");
        const std::string name = "Model_" + names.unique(plan.stem, "scene");
        origin();
        all_losses();
        usage(name);
        out += "\n#local Version_of_caller = version;\n#version 3.7;\n";
        units();
        materials();
        geometry();
        section("the model");
        const std::size_t count = object_count();
        out += "#declare " + name + (count == 1 ? " =\n" : " = union {\n");
        objects();
        out += count == 1 ? "\n" : "}\n\n";
        out += "#version Version_of_caller;\n";
        return std::move(out);
    }

    // A scene around the model, ready to be copied: its own camera and lights, one source each.
    void usage(const std::string& name) {
        const std::string above = std::move(out);
        out = "#version 3.7;\nglobal_settings { assumed_gamma 1.0";
        if (scene.scene.ambient != Color(1))
            out += " ambient_light " + sdl::color(scene.scene.ambient);
        out += " }\n#include \"" + plan.stem + extension + "\"\n";
        camera();
        for (Light l : scene.scene.lights) {
            l.penumbra.delta = 0;
            light(l);
        }
        out += "object { " + name + " }\n";
        const std::string example = std::exchange(out, above);
        out += "//\n// Use it in a scene of your own in this folder, such as:\n//\n";
        std::istringstream lines(example);
        for (std::string line; std::getline(lines, line);) {
            const bool indented = line.starts_with("  light_source") || line.starts_with("  //");
            out += line.empty() ? "//" : "//   " + line.substr(indented ? 2 : 0);
            out += '\n';
        }
        out += fmt::format("//\n// In the model's own units it is\n"
                           "//   object {{ {} scale 1/Model_scale translate Model_offset }}\n"
                           "// The model and this camera are right-handed. Among POV-Ray's usual "
                           "left-handed things\n"
                           "// it is mirrored unless turned by scale <1, 1, -1>.\n",
                           name);
    }
};

}  // namespace

Losses pov_losses(const NormalisedScene& scene, const RenderOptions& render) {
    return pov::make_plan(scene.scene, render, "scene").losses;
}

std::string pov_text(const NormalisedScene& scene, const RenderOptions& render,
                     const std::string& stem, const PovOptions& options) {
    const Plan plan = pov::make_plan(scene.scene, render, stem);
    return Writer{scene, render, options, stem, plan}.text();
}

Exported write_pov(const NormalisedScene& scene, const RenderOptions& render, const fs::path& file,
                   const PovOptions& options) {
    const bool include = options.style == PovStyle::include;
    const std::string extension = file.extension().string();
    if (extension != ".pov" && !(include && extension == ".inc"))
        throw Error(Failure::output, file.string(),
                    include ? "an include file of POV-Ray must end in .inc or .pov"
                            : "a POV-Ray scene must end in .pov");
    const std::string stem = file.stem().string();
    const fs::path folder = file.parent_path();
    const Plan plan = pov::make_plan(scene.scene, render, stem);

    // What the .pov refers to comes first: when it is there, so is all that it needs.
    std::vector<fs::path> others;
    const auto write = [&](const fs::path& path, const std::string& text) {
        write_file(path, text);
        others.push_back(path);
    };
    const std::string ini = include ? "" : pov::ini_text(render, plan.stem);
    const std::string text = Writer{scene, render, options, stem, plan, extension}.text();
    const std::string geometry = geometry_text(plan);
    if (!include) write(folder / (plan.stem + ".ini"), ini);
    if (!geometry.empty()) write(folder / (plan.stem + "_geometry.inc"), geometry);
    pov::write_textures(plan, folder, others);
    if (plan.stem != stem) {
        if (!include) write(folder / (stem + ".ini"), ini);
        write(folder / (plan.stem + extension), text);
    }
    write_file(file, text);

    Exported exported{.files = {file}, .losses = plan.losses};
    exported.files.insert(exported.files.end(), others.begin(), others.end());
    return exported;
}

}  // namespace penumbra
