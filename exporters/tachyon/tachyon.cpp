#include "base/text/text.h"
#include "exporters/shared/targets.h"
#include "exporters/tachyon/images.h"
#include "exporters/tachyon/material.h"
#include "exporters/tachyon/output.h"
#include "scene/check_options.h"

#include "penumbra/exporters.h"
#include "penumbra/light_model.h"

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <variant>
#include <vector>

namespace penumbra {

namespace {

using tachyon::color;
using tachyon::mean;
using tachyon::Output;
using tachyon::remove_old_images;
using tachyon::texture_of;
using tachyon::vector;

void write_camera(Output& out, const RenderOptions& options) {
    const View view = view_of(out.scene.cameras[out.scene.camera], options.width, options.height);
    const double scale = view.orthographic ? 1 : 1 / view.direction.length();
    const double width = view.right.length() * scale, height = view.up.length() * scale;
    const int side = options.antialiasing ? options.antialiasing->depth : options.samples;
    const int more_rays = side > 1 ? side * side : 0;
    // Tachyon's samples lie on the upper right corners of the pixels.
    const double dx = width / options.width / 2, dy = height / options.height / 2;
    out.text.add(
        "CAMERA\nPROJECTION {} ZOOM 1 ASPECTRATIO 1 ANTIALIASING {} RAYDEPTH {}\n"
        "CENTER {}\nVIEWDIR {}\nUPDIR {}\nFRUSTUM {:.9g} {:.9g} {:.9g} {:.9g}\nEND_CAMERA\n",
        view.orthographic ? "ORTHOGRAPHIC" : "PERSPECTIVE", more_rays, options.max_depth,
        vector(view.location), vector(view.direction), vector(view.up), -width / 2 - dx,
        width / 2 - dx, -height / 2 - dy, height / 2 - dy);
}

// Falls off with the distance d as 1 / (constant + linear d + quadratic d^2).
struct Falloff {
    double constant = 1, linear = 0, quadratic = 0;
};

Falloff falloff_of(const Attenuation& a) {
    // scene.h: f_a = 2 / (1 + (d / distance)^power)
    if (a.power == 1) return {0.5, 0.5 / a.distance, 0};
    return {0.5, 0, 0.5 / (a.distance * a.distance)};
}

// A source as Tachyon takes it.
struct Lamp {
    Source source;
    Falloff falloff = {};
};

// Tachyon drops what falls below 1/512 before it multiplies by the colour, and its highlights do
// not fall off at all; so the factor is made 1 in the middle of the scene.
Lamp lamp_of(const Source& source, const Vec3& middle) {
    Lamp lamp{source};
    if (!source.attenuation || source.type == Light::Type::directional) return lamp;
    const Falloff f = falloff_of(*source.attenuation);
    const double d = (source.position - middle).length();
    const double scale = 1 / (f.constant + (f.linear + f.quadratic * d) * d);
    lamp.source.color *= float(scale);
    lamp.falloff = {scale * f.constant, scale * f.linear, scale * f.quadratic};
    return lamp;
}

std::vector<Lamp> lamps_of(const Light& light, const Vec3& middle) {
    std::vector<Lamp> lamps;
    for (const Source& source : virtual_sources(light)) lamps.push_back(lamp_of(source, middle));
    return lamps;
}

void write_lamp(Output& out, const Lamp& lamp) {
    const Source& source = lamp.source;
    const Vec3 direction = (source.point_at - source.position).normalized();
    if (source.type == Light::Type::directional) {
        out.text.add("DIRECTIONAL_LIGHT DIRECTION {} COLOR {}\n", vector(direction),
                     color(source.color));
        return;
    }
    const bool spot = source.type == Light::Type::spot;
    out.text.add("{} CENTER {} RAD 0 ", spot ? "SPOTLIGHT" : "LIGHT", vector(source.position));
    if (spot)
        out.text.add("DIRECTION {} FALLOFF_START {:.7g} FALLOFF_END {:.7g} ", vector(direction),
                     degrees(source.inner), degrees(source.outer));
    if (source.attenuation)
        out.text.add("ATTENUATION CONSTANT {:.7g} LINEAR {:.7g} QUADRATIC {:.7g} ",
                     lamp.falloff.constant, lamp.falloff.linear, lamp.falloff.quadratic);
    out.text.add("COLOR {}\n", color(source.color));
}

void note_losses(Output& out, const Light& light) {
    const auto note = [&](bool lost, const char* what) {
        if (lost) out.note_loss(Loss::approximated, light.name, "a light", what);
    };
    const bool spot = light.type == Light::Type::spot;
    const bool fades = light.attenuation && light.type != Light::Type::directional;
    note(spot, "the edge of its cone fades linearly with the angle");
    note(fades && light.attenuation->power != 1 && light.attenuation->power != 2,
         "it fades with the square of the distance");
    note(spot || fades, "its highlights do not fade with its light");
}

void write_lights(Output& out) {
    const Bounds box = bounds(out.scene);
    const Vec3 middle = box.empty() ? Vec3(0) : box.center();
    double sum = 0, count = 0;
    for (const Light& light : out.scene.lights) {
        note_losses(out, light);
        for (const Lamp& lamp : lamps_of(light, middle)) {
            write_lamp(out, lamp);
            sum += double(mean(lamp.source.color));
            ++count;
        }
    }
    if (count > 0) out.light = float(sum / count);
}

Vec3 placed_normal(const Matrix& to_mesh, const Vec3f& n) {
    Vec3 out(0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            out[row] += to_mesh[row][column] * double(n[column]);
    return out.normalized();
}

void write_smooth(Output& out, const Instance& instance, const Mesh& mesh) {
    const Matrix to_mesh = instance.transform.inverse();
    const bool turned = instance.transform.determinant() < 0;
    out.text.add("VERTEXARRAY NUMVERTS {}\nCOORDS\n", mesh.positions.size());
    for (const Vec3f& p : mesh.positions)
        out.text.add("{}\n", vector(Vec3(p) * instance.transform));
    out.text.add("NORMALS\n");
    for (const Vec3f& n : mesh.normals) out.text.add("{}\n", vector(placed_normal(to_mesh, n)));
    out.text.add("TEXTURE {}\nTRIMESH {}\n", texture_of(out, mesh.material), mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        // Tachyon takes the side from the winding, which must go with the normals.
        const Vec3f first = mesh.positions[a];
        const Vec3f facet = (mesh.positions[b] - first).cross(mesh.positions[c] - first);
        const float along = facet.dot(mesh.normals[a] + mesh.normals[b] + mesh.normals[c]);
        if ((along < 0) == turned)
            out.text.add("{} {} {}\n", a, c, b);  // z is turned over
        else
            out.text.add("{} {} {}\n", a, b, c);
    }
    out.text.add("END_VERTEXARRAY\n");
}

void write_flat(Output& out, const Instance& instance, const Mesh& mesh) {
    out.text.add("TEXDEF m{} {}\n", mesh.material, texture_of(out, mesh.material));
    for (const auto& corners : mesh.triangles) {
        out.text.add("TRI");
        for (std::size_t k = 0; k < 3; ++k)
            out.text.add(" V{} {}", k,
                         vector(Vec3(mesh.positions[corners[k]]) * instance.transform));
        out.text.add(" m{}\n", mesh.material);
    }
}

void write_instance(Output& out, const Instance& instance) {
    const Mesh& mesh = out.scene.meshes[instance.mesh];
    const Material& m = out.scene.materials[mesh.material];
    if (!mesh.colors.empty())
        out.note_loss(Loss::dropped, mesh.name, "a mesh", "vertex colours are left out");
    if (mesh.normals.empty() || !m.smooth)
        write_flat(out, instance, mesh);
    else
        write_smooth(out, instance, mesh);
}

void write_plane(Output& out, const Plane& plane) {
    const auto note = [&](bool lost, const char* what) {
        if (lost) out.note_loss(Loss::approximated, plane.name, "a plane", what);
    };
    note(!plane.casts_shadow, "it casts shadows");
    note(!plane.in_mirrors, "mirrors show it");
    out.text.add("PLANE CENTER {} NORMAL {} TEXTURE {}\n", vector(plane.point),
                 vector(plane.normal), texture_of(out, plane));
}

void write_objects(Output& out) {
    for (const Plane& plane : out.scene.planes) write_plane(out, plane);
    for (const Sphere& s : out.scene.spheres)
        out.text.add("SPHERE CENTER {} RAD {:.7g} TEXTURE {}\n", vector(s.center), s.radius,
                     texture_of(out, s.material));
    for (const Instance& instance : out.scene.instances) write_instance(out, instance);
}

void note_losses(Output& out, const RenderOptions& render) {
    const Scene& scene = out.scene;
    if (scene.sky || scene.mirror_sky)
        out.note_loss(Loss::dropped, "background", "", "the image is left out");
    if (render.antialiasing)
        out.note_loss(Loss::approximated, "antialias", "",
                      "every pixel has as many rays, at random in it");
    else if (render.samples > 1)
        out.note_loss(Loss::approximated, "samples", "", "rays lie at random in the pixel");
    const auto splits = [](const Material& m) {
        return m.reflection != Color(0) || m.specular_lobes || m.opacity < 1;
    };
    if (scene.background != Color(0) &&
        std::any_of(scene.materials.begin(), scene.materials.end(), splits))
        out.note_loss(Loss::approximated, "max_depth", "",
                      "where a path ends, the background is added");
}

// All files that an export may write.
std::vector<std::filesystem::path> targets(const Scene& scene, const std::filesystem::path& file) {
    std::vector<std::filesystem::path> all = {file};
    for (const Plane& plane : scene.planes)
        if (const auto* map = std::get_if<ImageMap>(&scene.materials[plane.material].pattern))
            all.push_back(tachyon::image_file(file, map->texture));
    return all;
}

}  // namespace

Exported write_tachyon(const NormalisedScene& normalised, const RenderOptions& render,
                       const std::filesystem::path& file, const ExportOptions& options) {
    const Scene& scene = normalised.scene;
    check(render);
    assert(defects(scene).empty());
    if (lower_extension(file) != ".dat")
        throw Error(Failure::output, file.string(), "a Tachyon scene must end in .dat");
    check_targets(targets(scene, file), options);
    Output out(scene, file, options);
    note_losses(out, render);
    out.text.add("# A scene for Tachyon 0.99, {}.\n", own_mark);
    out.text.add("BEGIN_SCENE\nRESOLUTION {} {}\n", render.width, render.height);
    write_camera(out, render);
    out.text.add("BACKGROUND {}\n", color(scene.background));
    write_lights(out);
    write_objects(out);
    out.text.add("END_SCENE\n");
    out.text.commit();

    Exported exported{.files = {file}, .losses = std::move(out.losses)};
    exported.files.insert(exported.files.end(), out.images.begin(), out.images.end());
    exported.removed = remove_old_images(out);
    return exported;
}

}  // namespace penumbra
