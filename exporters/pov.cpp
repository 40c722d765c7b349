#include "file.h"
#include "pov_plan.h"
#include "sdl.h"

#include "penumbra/exporters.h"
#include "penumbra/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

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
    std::string out = {};

    void section(const char* title) { out += fmt::format("\n// ---- {} ----\n\n", title); }

    void losses(const char* title, const Losses& list) {
        if (list.empty()) return;
        out += fmt::format("//\n// {}\n", title);
        for (const Loss& loss : list)
            out += "//   " + sdl::comment(loss.place + ": " + loss.what, 300) + "\n";
    }

    void header() {
        out += "#version 3.7;\n\n";
        out += "// " + (options.source.empty() ? "A scene" : sdl::comment(options.source, 300)) +
               ", written by penumbra.\n";
        if (!options.command.empty()) out += "//   " + sdl::comment(options.command, 500) + "\n";
        out += fmt::format("//\n// Picture:  {} x {} pixels, ", render.width, render.height);
        out += render.samples > 1 ? fmt::format("a grid of {0} x {0} rays each, ", render.samples)
                                  : std::string("one ray each, ");
        out += fmt::format("{} along a path\n", plural(std::size_t(render.max_depth), "segment"));
        out += fmt::format("// Render:   povray {}.ini     (in this folder)\n", plan.stem);
        if (plan.stem != stem)
            out += fmt::format("//           (the same scene as this file, under a name that "
                               "POV-Ray can open)\n");
        Losses approximate = plan.losses;
        approximate.insert(approximate.begin(), options.losses.begin(), options.losses.end());
        losses("Not carried over exactly:", approximate);
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

    // The material and what else stands in an object, after its transform: patterns in world space
    // must not move with it.
    std::string surface(const Look& look) const {
        const Material& m = scene.scene.materials[look.material];
        std::string text = look.tinted ? "" : " texture { Material_" + look.name + " }";
        if (m.ior != 1 && m.opacity < 1) text += " interior { ior " + number(m.ior) + " }";
        return text;
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
        out += "  object { Mesh_" + mesh.name + where + surface(plan.looks[mesh.look]);
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
        for (const Instance& i : scene.scene.instances) instance(i);
        for (std::size_t i = 0; i < scene.scene.spheres.size(); ++i)
            sphere(scene.scene.spheres[i], plan.looks[plan.spheres[i]]);
        for (std::size_t i = 0; i < scene.scene.planes.size(); ++i)
            plane(scene.scene.planes[i], plan.looks[plan.planes[i]]);
        out += "}\n";
    }

    std::string text() {
        header();
        units();
        settings();
        camera();
        materials();
        const auto drawn = [](const pov::MeshPlan& mesh) { return !mesh.name.empty(); };
        if (std::any_of(plan.meshes.begin(), plan.meshes.end(), drawn)) {
            section("geometry");
            out += "#include \"" + plan.stem + "_geometry.inc\"\n";
        }
        world();
        return std::move(out);
    }
};

std::string ini_text(const RenderOptions& render, const std::string& stem) {
    std::string out = fmt::format("; Run in this folder: povray {0}.ini\n"
                                  "Input_File_Name=\"{0}.pov\"\n"
                                  "Output_File_Name=\"{0}.exr\"\n"
                                  "Output_File_Type=E\n"
                                  "Width={1}\n"
                                  "Height={2}\n",
                                  stem, render.width, render.height);
    if (render.samples > 1)
        out += fmt::format("; every pixel on a fixed grid of {0} x {0} rays\n"
                           "Antialias=On\n"
                           "Sampling_Method=1\n"
                           "Antialias_Threshold=0.0\n"
                           "Antialias_Depth={0}\n"
                           "Jitter=Off\n",
                           render.samples);
    else
        out += "Antialias=Off\n";
    return out + "Display=Off\nPause_When_Done=Off\n";
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    if (fs::create_directory(folder, error) || fs::is_directory(folder)) return;
    throw Error(Failure::output, folder.string(),
                "cannot make the folder: " +
                    (fs::exists(folder) ? "a file of that name is in the way" : error.message()));
}

// The textures in use; appends their paths to `files`.
void write_textures(const Plan& plan, const fs::path& folder, std::vector<fs::path>& files) {
    for (std::size_t i = 0; i < plan.textures.size(); ++i) {
        const pov::TextureFile& texture = plan.textures[i];
        if (texture.file.empty()) continue;
        const fs::path file = folder / texture.file;
        if (std::find(files.begin(), files.end(), file) != files.end()) continue;
        make_folder(file.parent_path());
        save_raster(file, baked(plan.scene->textures[i], texture));
        files.push_back(file);
    }
}

}  // namespace

std::string pov_text(const NormalisedScene& scene, const RenderOptions& render,
                     const std::string& stem, const PovOptions& options) {
    const Plan plan = pov::make_plan(scene.scene, render, stem);
    return Writer{scene, render, options, stem, plan}.text();
}

Exported write_pov(const NormalisedScene& scene, const RenderOptions& render, const fs::path& file,
                   const PovOptions& options) {
    if (file.extension() != ".pov")
        throw Error(Failure::output, file.string(), "a POV-Ray scene must end in .pov");
    const std::string stem = file.stem().string();
    const fs::path folder = file.parent_path();
    const Plan plan = pov::make_plan(scene.scene, render, stem);

    // What the .pov refers to comes first: when it is there, so is all that it needs.
    std::vector<fs::path> others;
    const auto write = [&](const fs::path& path, const std::string& text) {
        write_file(path, text);
        others.push_back(path);
    };
    const std::string ini = ini_text(render, plan.stem);
    const std::string text = Writer{scene, render, options, stem, plan}.text();
    const std::string geometry = geometry_text(plan);
    write(folder / (plan.stem + ".ini"), ini);
    if (!geometry.empty()) write(folder / (plan.stem + "_geometry.inc"), geometry);
    write_textures(plan, folder, others);
    if (plan.stem != stem) {
        write(folder / (stem + ".ini"), ini);
        write(folder / (plan.stem + ".pov"), text);
    }
    write_file(file, text);

    Exported exported{.files = {file}, .losses = plan.losses};
    exported.files.insert(exported.files.end(), others.begin(), others.end());
    return exported;
}

}  // namespace penumbra
