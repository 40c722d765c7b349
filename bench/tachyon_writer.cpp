#include "tachyon_writer.h"

#include "penumbra/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <memory>

namespace penumbra::bench {
namespace {

// A text file that is written in large pieces.
class Text {
  public:
    explicit Text(const std::filesystem::path& path)
        : path_(path.string()), file_(std::fopen(path_.c_str(), "wb"), &std::fclose) {
        if (!file_) fail();
    }
    template <class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(buffer_), format, std::forward<Values>(values)...);
        if (buffer_.size() > 1000000) flush();
    }
    void flush() {
        if (std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size()) fail();
        buffer_.clear();
    }

  private:
    [[noreturn]] void fail() const { throw Error(Failure::output, path_, "cannot be written"); }
    std::string path_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
    fmt::memory_buffer buffer_;
};

// Tachyon's space is left-handed: z is turned over.
template <class V>
std::string vector(const V& v) {
    return fmt::format("{:.7g} {:.7g} {:.7g}", v.x, v.y, -v.z);
}
std::string color(const Color& c) { return fmt::format("{:.6g} {:.6g} {:.6g}", c.x, c.y, c.z); }
float mean(const Color& c) { return (c.x + c.y + c.z) / 3; }

// ---- textures -----------------------------------------------------------------------------------

float linear_sample(const Texture& texture, std::size_t sample) {
    const std::byte* data = texture.raster.data.data();
    float value = 0;
    if (texture.raster.depth == Depth::f32) {
        std::memcpy(&value, data + 4 * sample, 4);
        return value;
    }
    if (texture.raster.depth == Depth::u16) {
        std::uint16_t whole = 0;
        std::memcpy(&whole, data + 2 * sample, 2);
        value = float(whole) / 65535.0F;
    } else {
        value = float(std::to_integer<unsigned>(data[sample])) / 255.0F;
    }
    return texture.srgb ? srgb_to_linear(value) : value;
}

Color texel(const Texture& texture, std::size_t index) {
    const auto channels = std::size_t(texture.raster.channels);
    const std::size_t first = index * channels, step = channels < 3 ? 0 : 1;
    return {linear_sample(texture, first), linear_sample(texture, first + step),
            linear_sample(texture, first + 2 * step)};
}

Color mean(const Texture& texture) {
    Vec3 sum(0);
    for (std::size_t i = 0; i < texture.raster.texels(); ++i) sum += Vec3(texel(texture, i));
    return Color(sum / double(texture.raster.texels()));
}

// The image in linear light, as Tachyon computes without gamma.
void write_ppm(const std::filesystem::path& file, const Texture& texture) {
    Text out(file);
    out.add("P6\n{} {}\n255\n", texture.raster.width, texture.raster.height);
    for (std::size_t i = 0; i < texture.raster.texels(); ++i) {
        const Color c = texel(texture, i);
        for (int k = 0; k < 3; ++k)
            out.add("{}", char(std::clamp(int(c[k] * 255.0F + 0.5F), 0, 255)));
    }
    out.flush();
}

// ---- the scene ----------------------------------------------------------------------------------

struct Writer {
    const Scene& scene;
    const std::filesystem::path& file;
    Text out;
    Losses losses = {};

    void lose(const std::string& place, const std::string& what) {
        const Loss loss{place, what};
        if (std::find(losses.begin(), losses.end(), loss) == losses.end()) losses.push_back(loss);
    }
};

// One colour in place of a pattern.
Color plain(Writer& w, const Material& m) {
    Color pattern(1);
    if (const auto* map = std::get_if<ImageMap>(&m.pattern)) {
        pattern = m.color * mean(w.scene.textures[map->texture]);
    } else if (const auto* checker = std::get_if<Checker>(&m.pattern)) {
        pattern = (checker->colors[0] + checker->colors[1]) * 0.5F;
    } else if (const auto* noise = std::get_if<Noise>(&m.pattern)) {
        pattern = (noise->colors[0] + noise->colors[1]) * 0.5F;
    } else {
        return m.color;
    }
    w.lose(m.name, "the pattern becomes its mean colour");
    return pattern;
}

// What stands after TEXTURE or TEXDEF; `plane` when the surface is one.
std::string texture_of(Writer& w, const Material& m, const Plane* plane = nullptr) {
    if (!opaque(m)) w.lose(m.name, "the surface becomes opaque");
    if (m.emission != Color(0)) w.lose(m.name, "emission is left out");
    std::string out = fmt::format("AMBIENT {:.6g} DIFFUSE {:.6g} SPECULAR {:.6g} OPACITY 1",
                                  mean(m.ambient * w.scene.ambient), m.diffuse, mean(m.reflection));
    if (m.specular > 0)
        out += fmt::format(" PHONG {} {:.6g} PHONG_SIZE {:.6g}",
                           m.metallic > 0.5F ? "METAL" : "PLASTIC", m.specular, m.shininess);
    const auto* map = std::get_if<ImageMap>(&m.pattern);
    if (plane == nullptr || map == nullptr)
        return out + " COLOR " + color(plain(w, m)) + " TEXFUNC 0";
    const std::string image = fmt::format("{}-{}.ppm", w.file.stem().string(), map->texture);
    write_ppm(w.file.parent_path() / image, w.scene.textures[map->texture]);
    const PlaneFrame frame = plane_frame(*plane);
    return out + fmt::format(" COLOR 1 1 1 TEXFUNC 9 {} CENTER {} ROTATE 0 0 0 SCALE {} {} 1 "
                             "UAXIS {} VAXIS {}",
                             image, vector(frame.origin), 1 / map->size, 1 / map->size,
                             vector(frame.u), vector(-frame.v));  // rows of images go down
}

void write_camera(Writer& w, const RenderOptions& options) {
    const View view = view_of(w.scene.cameras[w.scene.camera], options.width, options.height);
    const double scale = view.orthographic ? 1 : 1 / view.direction.length();
    const double width = view.right.length() * scale, height = view.up.length() * scale;
    // Tachyon's samples lie on the upper right corners of the pixels.
    const double dx = width / options.width / 2, dy = height / options.height / 2;
    w.out.add("CAMERA\nPROJECTION {} ZOOM 1 ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH {}\n"
              "CENTER {}\nVIEWDIR {}\nUPDIR {}\nFRUSTUM {:.9g} {:.9g} {:.9g} {:.9g}\nEND_CAMERA\n",
              view.orthographic ? "ORTHOGRAPHIC" : "PERSPECTIVE", options.max_depth,
              vector(view.location), vector(view.direction), vector(view.up), -width / 2 - dx,
              width / 2 - dx, -height / 2 - dy, height / 2 - dy);
}

void write_source(Writer& w, const Light& light, const Source& source) {
    if (source.type == Light::Type::directional) {
        w.out.add("DIRECTIONAL_LIGHT DIRECTION {} COLOR {}\n",
                  vector((source.point_at - source.position).normalized()), color(source.color));
        return;
    }
    if (source.type == Light::Type::spot) w.lose(light.name, "the spot becomes a point light");
    w.out.add("LIGHT CENTER {} RAD 0 ", vector(source.position));
    if (source.attenuation) {
        const double fade = 0.5 / (source.attenuation->distance * source.attenuation->distance);
        if (source.attenuation->power != 2) w.lose(light.name, "light fades with the square");
        w.out.add("ATTENUATION CONSTANT 0.5 LINEAR 0 QUADRATIC {:.7g} ", fade);
    }
    w.out.add("COLOR {}\n", color(source.color));
}

Vec3 placed_normal(const Matrix& to_mesh, const Vec3f& n) {
    Vec3 out(0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            out[row] += to_mesh[row][column] * double(n[column]);
    return out.normalized();
}

void write_smooth(Writer& w, const Instance& instance, const Mesh& mesh, const Material& m) {
    const Matrix to_mesh = instance.transform.inverse();
    const bool turned = instance.transform.determinant() < 0;
    w.out.add("VERTEXARRAY NUMVERTS {}\nCOORDS\n", mesh.positions.size());
    for (const Vec3f& p : mesh.positions) w.out.add("{}\n", vector(Vec3(p) * instance.transform));
    w.out.add("NORMALS\n");
    for (const Vec3f& n : mesh.normals) w.out.add("{}\n", vector(placed_normal(to_mesh, n)));
    w.out.add("TEXTURE {}\nTRIMESH {}\n", texture_of(w, m), mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        // Tachyon takes the side from the winding, which must go with the normals.
        const Vec3f first = mesh.positions[a];
        const Vec3f facet = (mesh.positions[b] - first).cross(mesh.positions[c] - first);
        const float along = facet.dot(mesh.normals[a] + mesh.normals[b] + mesh.normals[c]);
        if ((along < 0) == turned)
            w.out.add("{} {} {}\n", a, c, b);  // z is turned over
        else
            w.out.add("{} {} {}\n", a, b, c);
    }
    w.out.add("END_VERTEXARRAY\n");
}

void write_flat(Writer& w, const Instance& instance, const Mesh& mesh, const Material& m) {
    w.out.add("TEXDEF m{} {}\n", mesh.material, texture_of(w, m));
    for (const auto& corners : mesh.triangles) {
        w.out.add("TRI");
        for (std::size_t k = 0; k < 3; ++k)
            w.out.add(" V{} {}", k, vector(Vec3(mesh.positions[corners[k]]) * instance.transform));
        w.out.add(" m{}\n", mesh.material);
    }
}

void write_instance(Writer& w, const Instance& instance) {
    const Mesh& mesh = w.scene.meshes[instance.mesh];
    const Material& m = w.scene.materials[mesh.material];
    if (!mesh.colors.empty()) w.lose(mesh.name, "vertex colours are left out");
    if (mesh.normals.empty() || !m.smooth)
        write_flat(w, instance, mesh, m);
    else
        write_smooth(w, instance, mesh, m);
}

}  // namespace

Losses write_tachyon(const NormalisedScene& normalised, const RenderOptions& options,
                     const std::filesystem::path& file) {
    const Scene& scene = normalised.scene;
    Writer w{scene, file, Text(file)};
    w.out.add("BEGIN_SCENE\nRESOLUTION {} {}\n", options.width, options.height);
    write_camera(w, options);
    w.out.add("BACKGROUND {}\n", color(scene.background));
    if (scene.sky) w.lose("background", "the image is left out");
    for (const Light& light : scene.lights)
        for (const Source& source : virtual_sources(light)) write_source(w, light, source);
    for (const Plane& p : scene.planes)
        w.out.add("PLANE CENTER {} NORMAL {} TEXTURE {}\n", vector(p.point), vector(p.normal),
                  texture_of(w, scene.materials[p.material], &p));
    for (const Sphere& s : scene.spheres)
        w.out.add("SPHERE CENTER {} RAD {:.7g} TEXTURE {}\n", vector(s.center), s.radius,
                  texture_of(w, scene.materials[s.material]));
    for (const Instance& instance : scene.instances) write_instance(w, instance);
    w.out.add("END_SCENE\n");
    w.out.flush();
    return w.losses;
}

}  // namespace penumbra::bench
