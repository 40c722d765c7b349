#include "fidelity/features_stage.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace test {

using namespace penumbra;

namespace {

std::string text(const Stage& stage) {
    return "[render]\nsize = [160, 120]\nbackground = " + stage.background + "\n" + stage.render +
           stage.camera + stage.lights + stage.floor + stage.rest;
}

const std::string show_model = "[[model]]\nfile = ";

// The content of a file that `save` writes.
template <class Save>
std::string content(const std::string& name, Save&& save) {
    const TempDir folder;
    save(folder / name);
    return read(folder / name);
}

// Numbers without a pattern, the same on every machine.
struct Random {
    unsigned state = 20240229;
    unsigned next() {
        state = state * 1664525U + 1013904223U;
        return state >> 16U;
    }
    double unit() { return double(next()) / 65535; }
};

void append(std::vector<float>& values, const Vec3& v) {
    for (int i = 0; i < 3; ++i) values.push_back(float(v[i]));
}

// Vertices of a closed body by rings from top to bottom; the first of a ring is its last again.
struct Rings {
    int around = 0, along = 0;
    Vec3 direction(int i, int j) const {
        const double a = 2 * std::numbers::pi * i / around, b = std::numbers::pi * j / along;
        return {std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a)};
    }
    void add_facets(Shape& shape) const {
        const auto facet = [&](int a, int b, int c) {
            for (const int vertex : {a, b, c}) shape.indices.push_back(std::uint16_t(vertex));
        };
        for (int j = 0; j < along; ++j)
            for (int i = 0; i < around; ++i) {
                const int p = j * (around + 1) + i, q = p + around + 1;
                if (j > 0) facet(p, p + 1, q + 1);
                if (j + 1 < along) facet(p, q + 1, q);
            }
    }
};

}  // namespace

std::string tiles() {
    return "[[plane]]\nmaterial = \"tiles\"\n[material.tiles]\n"
           "checker = { colors = [[0.6, 0.55, 0.5], [0.3, 0.25, 0.4]], size = 0.6 }\n";
}

Stage marked_stage() {
    return {.render = "max_depth = 8\n",
            .floor = tiles(),
            .rest = "[[sphere]]\ncenter = [-0.9, 0.5, -1.3]\nradius = 0.5\n"
                    "material = \"marked\"\n"
                    "[[sphere]]\ncenter = [0.5, 0.3, 1.2]\nradius = 0.3\n"
                    "material = \"marked\"\n"
                    "[material.marked]\n"
                    "checker = { colors = [[0.9, 0.2, 0.1], [0.8, 0.8, 0.7]], size = 0.23 }\n"};
}

Feature staged(const std::string& name, const Stage& stage) {
    return {.name = name, .files = {{"stage.toml", text(stage)}}};
}

Feature staged(const std::string& name, const Gltf& gltf, const Stage& stage) {
    Stage whole = stage;
    whole.rest = show_model + "\"model.gltf\"\n" + stage.rest;
    return {.name = name, .files = {{"stage.toml", text(whole)}, {"model.gltf", gltf.text()}}};
}

Feature staged(const std::string& name, const std::string& obj, const std::string& mtl,
               const Stage& stage) {
    Stage whole = stage;
    whole.rest = show_model + "\"model.obj\"\n" + stage.rest;
    return {.name = name,
            .files = {{"stage.toml", text(whole)},
                      {"model.obj", "mtllib model.mtl\n" + obj},
                      {"model.mtl", mtl}}};
}

std::string ball_of(const std::string& material) {
    return "[[sphere]]\ncenter = [0.1, 0.85, 0]\nradius = 0.85\nmaterial = \"ball\"\n"
           "[material.ball]\n" +
           material;
}

Shape egg() {
    const Rings rings = {.around = 24, .along = 14};
    const Vec3 radii(0.7, 0.85, 0.55);
    Shape shape;
    for (int j = 0; j <= rings.along; ++j)
        for (int i = 0; i <= rings.around; ++i) {
            const Vec3 unit = rings.direction(i, j);
            append(shape.positions, unit * radii + Vec3(0.1, 0.85, 0));
            append(shape.normals, (unit / radii).normalized());
            shape.texcoords.push_back(float(i) / float(rings.around));
            shape.texcoords.push_back(float(j) / float(rings.along));
        }
    rings.add_facets(shape);
    return shape;
}

Shape rock() {
    const Rings rings = {.around = 8, .along = 5};
    Random random;
    Shape shape;
    for (int j = 0; j <= rings.along; ++j)
        for (int i = 0; i <= rings.around; ++i) {
            const bool pole = j == 0 || j == rings.along;
            const double radius = pole ? 0.85 : 0.6 + 0.4 * random.unit();
            if (i == rings.around)  // closes the ring
                for (int k = 0; k < 3; ++k)
                    shape.positions.push_back(*(shape.positions.end() - 3 * rings.around));
            else
                append(shape.positions, rings.direction(i, j) * radius + Vec3(0.1, 0.85, 0));
        }
    rings.add_facets(shape);
    return shape;
}

Shape board(int parts) {
    Shape shape;
    for (int j = 0; j <= parts; ++j)
        for (int i = 0; i <= parts; ++i) {
            const double u = double(i) / parts, v = double(j) / parts;
            append(shape.positions, Vec3(2 * u - 0.95, 1.7 * v, 0.2 - 0.6 * v + 0.2 * u));
            shape.texcoords.push_back(float(2.3 * u - 0.6));
            shape.texcoords.push_back(float(1.7 - 2.3 * v));  // glTF's v runs down
        }
    for (int j = 0; j < parts; ++j)
        for (int i = 0; i < parts; ++i) {
            const int p = j * (parts + 1) + i, q = p + parts + 1;
            for (const int vertex : {p, p + 1, q + 1, p, q + 1, q})
                shape.indices.push_back(std::uint16_t(vertex));
        }
    return shape;
}

std::vector<float> colors_of(const Shape& shape) {
    std::vector<float> colors;
    for (std::size_t i = 0; i < shape.vertices(); ++i)
        append(colors,
               Vec3(0.25 * double(i % 5), 1 - 0.4 * double(i % 3), 0.1 + 0.2 * double(i % 4)));
    return colors;
}

json primitive(Gltf& gltf, const Shape& shape, const json& material) {
    json result = {{"indices", gltf.accessor("SCALAR", shape.indices)}};
    json& attributes = result["attributes"];
    attributes["POSITION"] = gltf.accessor("VEC3", shape.positions);
    if (!shape.normals.empty()) attributes["NORMAL"] = gltf.accessor("VEC3", shape.normals);
    if (!shape.texcoords.empty()) attributes["TEXCOORD_0"] = gltf.accessor("VEC2", shape.texcoords);
    if (!material.is_null()) result["material"] = gltf.add("materials", material);
    return result;
}

Gltf showing(const Shape& shape, const json& material) {
    Gltf gltf;
    gltf.show(primitive(gltf, shape, material));
    return gltf;
}

json texture(Gltf& gltf, const std::string& uri, const json& sampler) {
    json made = {{"source", gltf.add("images", {{"uri", uri}})}};
    if (!sampler.is_null()) made["sampler"] = gltf.add("samplers", sampler);
    return {{"index", gltf.add("textures", made)}};
}

std::string obj_of(const Shape& shape) {
    std::string text;
    for (std::size_t i = 0; i < shape.vertices(); ++i) {
        const float* p = &shape.positions[3 * i];
        text += fmt::format("v {} {} {}\n", p[0], p[1], p[2]);
        if (!shape.texcoords.empty())
            text += fmt::format("vt {} {}\n", shape.texcoords[2 * i], shape.texcoords[2 * i + 1]);
        if (shape.normals.empty()) continue;
        const float* n = &shape.normals[3 * i];
        text += fmt::format("vn {} {} {}\n", n[0], n[1], n[2]);
    }
    text += "usemtl look\n";
    const auto word = [&](int i) {
        return shape.normals.empty() ? fmt::format(" {0}/{0}", i + 1)
                                     : fmt::format(" {0}/{0}/{0}", i + 1);
    };
    for (std::size_t i = 0; i < shape.indices.size(); i += 3)
        text += "f" + word(shape.indices[i]) + word(shape.indices[i + 1]) +
                word(shape.indices[i + 2]) + "\n";
    return text;
}

std::string png(int channels, Depth depth) {
    Raster raster = {.width = 7, .height = 5, .channels = channels, .depth = depth};
    Random random;
    for (std::size_t i = 0; i < raster.texels() * std::size_t(channels) * std::size_t(depth); ++i)
        raster.data.push_back(std::byte(random.next() & 0xff));
    return content("a.png", [&](const fs::path& file) { save_raster(file, raster); });
}

std::string normal_png(int size) {
    Raster raster = {.width = size, .height = size, .channels = 3};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double turn = 2 * std::numbers::pi / size;
            const Vec3 n =
                Vec3(0.5 * std::sin(turn * x), 0.4 * std::sin(turn * (2 * y + x)), 1).normalized();
            for (int c = 0; c < 3; ++c)
                raster.data.push_back(std::byte(std::lround((n[c] * 0.5 + 0.5) * 255)));
        }
    return content("a.png", [&](const fs::path& file) { save_raster(file, raster); });
}

std::string picture_file(const std::string& extension) {
    Image image(14, 10);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            image.at(x, y) = {0.07F * float(x), 0.3F + 0.05F * float(y % 4), 0.09F * float(y)};
    return content("a" + extension, [&](const fs::path& file) { save_image(file, image); });
}

}  // namespace test
