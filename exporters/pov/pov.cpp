#include "base/file.h"
#include "base/hash.h"
#include "exporters/pov/files.h"
#include "exporters/pov/geometry.h"
#include "exporters/pov/material.h"
#include "exporters/pov/object_text.h"
#include "exporters/pov/objects.h"
#include "exporters/pov/plan.h"
#include "exporters/pov/sdl.h"
#include "exporters/shared/targets.h"
#include "scene/mirror_sky.h"

#include "penumbra/exporters.h"
#include "penumbra/light_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
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
    const ExportOptions& options;
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

    std::string sampling() const {
        if (render.antialiasing) return to_string(sampling_of(render));
        if (render.samples == 1) return "one ray each";
        return fmt::format("a grid of {0} x {0} rays each", render.samples);
    }

    void header() {
        out += "#version 3.7;\n\n";
        origin();
        out += fmt::format("//\n// Picture:  {} x {} pixels, ", render.width, render.height);
        out += sampling() + ", ";
        out += plural(std::size_t(render.max_depth), "segment") + " along a path";
        if (render.exposure != 0) out += fmt::format(", exposure {:+g} EV", render.exposure);
        out += '\n';
        out += fmt::format("// Render:   povray {}.ini     (in this folder)\n", plan.stem);
        if (plan.stem != stem)
            out += fmt::format("//           (the same scene as this file, under a name that "
                               "POV-Ray can open)\n");
        all_losses();
    }

    std::string scale_name() const { return identifier(plan, "Model", "scale"); }
    std::string offset_name() const { return identifier(plan, "Model", "offset"); }

    void units() {
        out += fmt::format(
            "\n// POV-Ray's tolerances are absolute, so the scene is scaled by a power of two:\n"
            "//   position here = (position in the model - {}) * {}\n",
            offset_name(), scale_name());
        out += "#declare " + scale_name() + " = " + number(scene.factor) + ";\n";
        out += "#declare " + offset_name() + " = " + sdl::vector(scene.offset) + ";\n";
    }

    void settings() {
        out += "\nglobal_settings {\n  assumed_gamma 1.0\n";
        out += fmt::format("  max_trace_level {}\n", std::min(render.max_depth, 256));
        out += "  adc_bailout 0\n  ambient_light " + sdl::color(scene.scene.ambient) + "\n}\n\n";
        out += "background { " + sdl::color(scene.scene.background) + " }\n";
        sky();
    }

    // A ray that was mirrored once sees what is marked no_image, and so do all that come of it.
    // Inverted, the sphere has no interior that rays would be inside of.
    void sky() {
        const Scene& s = scene.scene;
        if (s.sky)
            out +=
                "sky_sphere {\n  pigment {\n    " + pov::sky_pigment(plan, *s.sky) + "\n  }\n}\n";
        if (!s.mirror_sky) return;
        out += "\n// what mirrors show where they show nothing else\nsphere { 0, 1\n  pigment {\n  "
               "  " +
               pov::sky_pigment(plan, *s.mirror_sky) +
               "\n  }\n  finish { ambient 0 diffuse 0 emission 1 }\n  scale " +
               number(mirror_sky_radius) + " translate " + sdl::vector(mirror_sky_center(s)) +
               " inverse hollow no_image no_shadow\n}\n";
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
            out += "// f_noise_generator of functions.inc\n#declare " +
                   identifier(plan, "Perlin_noise") + " = function { internal(78) }\n\n";
        if (needs_nothing(plan))
            out += "// where a surface is not there\n" + nothing_text(plan) + "\n";
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
        out += "  // " + pov::light_title(light, sources.size()) + "\n";
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

    void world() {
        section("lights and objects");
        out +=
            "// In a light_group POV-Ray does not reuse the object that shadowed the last pixel,\n"
            "// so that the picture does not depend on the order of its pixels.\n"
            "light_group {\n";
        for (const Light& l : scene.scene.lights) light(l);
        out += '\n';
        out += pov::objects_text(plan);
        out += "}\n";
    }

    void geometry() {
        if (std::none_of(plan.meshes.begin(), plan.meshes.end(), pov::is_drawn)) return;
        section("geometry");
        out += "#include \"" + plan.stem + "_geometry.inc\"\n";
    }

    std::string text() {
        if (options.pov_style == PovStyle::include) return include_text();
        header();
        units();
        settings();
        camera();
        materials();
        geometry();
        world();
        return std::move(out);
    }

    // In one file, so that a scene and an include file of one name can lie side by side.
    std::string include_text() {
        const std::string name = identifier(plan, "Model");
        const std::string version = identifier(plan, "Version_before");
        origin();
        all_losses();
        usage(name);
        out += "\n#local " + version + " = version;\n#version 3.7;\n";
        const std::string above = std::exchange(out, "");
        units();
        materials();
        if (const std::string meshes = geometry_text(plan); !meshes.empty()) {
            section("geometry");
            out += meshes;
        }
        section("the model");
        const std::size_t count = pov::object_count(plan);
        out += "#declare " + name + (count == 1 ? " =\n" : " = union {\n");
        out += pov::objects_text(plan);
        out += count == 1 ? "\n" : "}\n\n";
        out += "#version " + version + ";\n";
        return above + only_one(out) + out;
    }

    // A file of the same name from another folder would replace some of the declarations.
    std::string only_one(const std::string& content) const {
        const std::string name = identifier(plan, "Content");
        const auto number = std::uint32_t(hash_of(std::as_bytes(std::span(content)))) >> 1U;
        return fmt::format("#ifdef ({0})\n  #if ({0} != {1})\n    #error \"Another model named {2} "
                           "is included already: export one of them under another name.\"\n"
                           "  #end\n#end\n#declare {0} = {1};\n",
                           name, number, plan.model);
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
        sky();
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
                           "//   object {{ {} scale 1/{} translate {} }}\n"
                           "// The model and this camera are right-handed. Among POV-Ray's usual "
                           "left-handed things\n"
                           "// it is mirrored unless turned by scale <1, 1, -1>.\n"
                           "// No #default changes it but these, which nothing can undo: "
                           "conserve_energy and subsurface in a\n"
                           "// finish, warps and transforms of a pigment. State such a #default "
                           "after this file is included.\n",
                           name, scale_name(), offset_name());
    }
};

}  // namespace

Losses pov_losses(const NormalisedScene& scene, const RenderOptions& render) {
    return pov::make_plan(scene.scene, render, "scene").losses;
}

std::string pov_text(const NormalisedScene& scene, const RenderOptions& render,
                     const std::string& stem, const ExportOptions& options) {
    const Plan plan = pov::make_plan(scene.scene, render, stem, options.pov_style);
    return Writer{scene, render, options, stem, plan}.text();
}

Exported write_pov(const NormalisedScene& scene, const RenderOptions& render, const fs::path& file,
                   const ExportOptions& options) {
    pov::check_name(file, options.pov_style);
    const bool include = options.pov_style == PovStyle::include;
    const std::string extension = file.extension().string();
    const std::string stem = file.stem().string();
    const fs::path folder = file.parent_path();
    const Plan plan = pov::make_plan(scene.scene, render, stem, options.pov_style);

    check_targets(pov::target_files(plan, file, options.pov_style), options);

    // What the .pov refers to comes first: when it is there, so is all that it needs.
    std::vector<fs::path> others;
    const auto write = [&](const fs::path& path, const std::string& text) {
        write_file(path, text);
        others.push_back(path);
    };
    const std::string ini = include ? "" : pov::ini_text(render, plan.stem, extension);
    const std::string text = Writer{scene, render, options, stem, plan, extension}.text();
    const std::string geometry = include ? "" : geometry_text(plan);
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
    exported.removed = pov::remove_old_textures(plan, file, options);
    return exported;
}

}  // namespace penumbra
