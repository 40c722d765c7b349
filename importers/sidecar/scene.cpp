// [[model]], [render], [lighting], [[sphere]] and [[plane]].
#include "importers/shared/formats.h"
#include "importers/sidecar/sidecar.h"
#include "scene/transforms.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra {

namespace {

void read_matrix(Section& section, Placement& placement) {
    std::array<double, 16> m = {};
    if (!section.read_numbers("matrix", m, "a column-major 4 x 4 matrix")) return;
    // Column-major for column vectors is row-major for row vectors: the memory order is the same.
    Matrix matrix(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7],  //
                  m[8], m[9], m[10], m[11], m[12], m[13], m[14], m[15]);
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
        section.reject("matrix", "must be affine: its numbers 4, 8, 12 and 16 must be 0, 0, 0, 1");
    if (!std::isnormal(matrix.determinant())) section.reject("matrix", "cannot be inverted");
    placement.matrix = matrix;
}

void read_placement(Section& section, Placement& placement) {
    std::string file;
    if (section.read("file", file)) {
        placement.file = (section.layer().folder / file).lexically_normal();
        section.read("file", placement.named_by);
        if (!is_model(file))
            section.reject("file",
                           fmt::format("must be a {} file", listed(model_extensions(), "or")));
    }
    section.read("name", placement.name);
    const bool moved = section.read("translate", placement.translate);
    const bool turned = section.read("rotate", placement.rotate);
    const bool scaled = section.read_scale("scale", placement.scale);
    for (int axis = 0; axis < 3; ++axis)
        if (placement.scale[axis] == 0) section.reject("scale", "must not be 0");
    if (moved || turned || scaled) {
        if (section.has("matrix"))
            section.reject("matrix", "cannot stand beside translate, rotate or scale");
        placement.matrix.reset();
    }
    read_matrix(section, placement);
    section.read("material", placement.material);
    section.read("backdrop", placement.backdrop);
    section.finish();
}

void read_sphere(Section& section, Sphere& sphere, const Scene& scene) {
    std::optional<Reference> material;
    section.read("name", sphere.name);
    section.read("center", sphere.center);
    section.read("radius", sphere.radius, positive);
    section.read("backdrop", sphere.backdrop);
    section.read("material", material);
    section.finish();
    if (material) sphere.material = material_named(scene, *material);
}

void read_plane(Section& section, Plane& plane, const Scene& scene) {
    std::optional<Reference> material;
    section.read("name", plane.name);
    section.read("point", plane.point);
    section.read("normal", plane.normal);
    section.read("backdrop", plane.backdrop);
    section.read("material", material);
    section.finish();
    if (!std::isnormal(plane.normal.length()))
        section.reject("normal", "must not have length zero");
    if (material) plane.material = material_named(scene, *material);
}

// background = "sky.exr", or a colour.
void read_background(Section& section, Scene& scene, TextureFiles& files) {
    std::string text;
    if (section.is_string("background")) section.read("background", text);
    if (text.empty() || text[0] == '#') {
        if (section.read_color("background", scene.background)) scene.sky.reset();
        return;
    }
    scene.sky = Sky{.texture = load_texture(section, "background", text, scene, files)};
}

// samples, or antialias and antialias_depth.
void read_sampling(Section& section, Imported& result) {
    RenderOptions& render = result.render;
    Antialiasing adaptive = render.antialiasing.value_or(Antialiasing());
    const bool fixed = section.read("samples", render.samples, {.low = 1, .high = 9});
    const bool threshold = section.read("antialias", adaptive.threshold, {.low = 0, .high = 1000});
    const bool depth = section.read("antialias_depth", adaptive.depth, {.low = 1, .high = 9});
    if (fixed && (threshold || depth))
        section.reject(threshold ? "antialias" : "antialias_depth", "cannot stand beside samples");
    if (fixed) render.antialiasing.reset();
    if (threshold || depth) render.antialiasing = adaptive;
    if (fixed || threshold || depth) result.sampled = true;
}

// exposure = "auto", or EV.
void read_exposure(Section& section, Imported& result) {
    if (section.is_string("exposure")) {
        std::string text;
        section.read("exposure", text);
        if (text != "auto") section.reject("exposure", "must be a number or \"auto\"");
        result.auto_exposure = true;
    } else if (section.read("exposure", result.render.exposure, {.low = -32, .high = 32})) {
        result.auto_exposure = false;
    }
}

}  // namespace

Matrix Placement::transform() const {
    if (matrix) return *matrix;
    Matrix scaling, translation;
    scaling.setScale(scale);
    translation.setTranslation(translate);
    return scaling * rotation_about(0, rotate.x) * rotation_about(1, rotate.y) *
           rotation_about(2, rotate.z) * translation;
}

void check_top_level(const Layer& layer) {
    Section top(layer, layer.table);
    for (const char* key : {"render", "lighting", "environment", "camera", "light", "sphere",
                            "plane", "model", "material"})
        top.has(key);
    top.finish();
}

void read_placements(const Layer& layer, std::vector<Placement>& placements) {
    Section top(layer, layer.table);
    for (auto& [index, section] : top.edits("model", placements.size(), "models"))
        read_placement(section, placements[index]);
    for (Section& section : top.list("model")) {
        Placement placement;
        read_placement(section, placement);
        section.require("file");
        placements.push_back(std::move(placement));
    }
}

bool lay_globals(const Layer& layer, Imported& result, TextureFiles& files) {
    RenderOptions& render = result.render;
    Section top(layer, layer.table);
    bool sized = false;
    if (auto section = top.table("render")) {
        std::array<int, 2> size = {render.width, render.height};
        sized = section->read("size", size, {.low = 1, .high = 32767});
        render.width = size[0];
        render.height = size[1];
        read_sampling(*section, result);
        // POV-Ray clamps its trace level to 256, and its sampling depth to 9.
        section->read("max_depth", render.max_depth, {.low = 1, .high = 256});
        read_background(*section, result.scene, files);
        read_exposure(*section, result);
        section->finish();
    }
    if (auto section = top.table("lighting")) {
        section->read_factor("ambient", result.scene.ambient);
        section->finish();
    }
    return sized;
}

void lay_objects(const Layer& layer, Scene& scene) {
    Section top(layer, layer.table);
    for (auto& [index, section] : top.edits("sphere", scene.spheres.size(), "spheres"))
        read_sphere(section, scene.spheres[index], scene);
    for (auto& [index, section] : top.edits("plane", scene.planes.size(), "planes"))
        read_plane(section, scene.planes[index], scene);
    for (Section& section : top.list("sphere")) {
        Sphere sphere;
        read_sphere(section, sphere, scene);
        scene.spheres.push_back(std::move(sphere));
    }
    for (Section& section : top.list("plane")) {
        Plane plane;
        read_plane(section, plane, scene);
        scene.planes.push_back(std::move(plane));
    }
}

}  // namespace penumbra
