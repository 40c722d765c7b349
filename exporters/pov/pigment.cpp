#include "exporters/pov/pigment.h"

#include "exporters/pov/sdl.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>

#include <optional>

namespace penumbra::pov {

namespace {

using sdl::number;

// An affine map as POV-Ray writes it: where the axes and the origin go.
struct Placement {
    Vec3 x = Vec3(1, 0, 0), y = Vec3(0, 1, 0), z = Vec3(0, 0, 1), move = Vec3(0);

    Vec3 turned(const Vec3& v) const { return x * v.x + y * v.y + z * v.z; }
    // This one, then `next`.
    Placement then(const Placement& next) const {
        return {next.turned(x), next.turned(y), next.turned(z), next.turned(move) + next.move};
    }
    // The rows of the inverse are the columns of the cofactors over the determinant.
    Placement inverse() const {
        const double scale = 1 / x.dot(y.cross(z));
        const Vec3 a = y.cross(z) * scale, b = z.cross(x) * scale, c = x.cross(y) * scale;
        Placement out{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}};
        out.move = out.turned(move) * -1;
        return out;
    }
};

std::string scale_and_move(const Vec3& scale, const Vec3& move) {
    std::string out;
    if (scale != Vec3(1)) {
        const bool uniform = scale.x == scale.y && scale.y == scale.z;
        out += " scale " + (uniform ? number(scale.x) : sdl::vector(scale));
    }
    if (move != Vec3(0)) out += " translate " + sdl::vector(move);
    return out;
}

std::string matrix(const Placement& p) {
    std::string out;
    for (const Vec3* row : {&p.x, &p.y, &p.z, &p.move})
        out += fmt::format("{}{}, {}, {}", out.empty() ? "" : ",  ", number(row->x), number(row->y),
                           number(row->z));
    return "matrix <" + out + ">";
}

// POV-Ray moves the pattern and not the lookup.
Placement inverse_lookup(const std::array<double, 6>& t) {
    const double scale = 1 / (t[0] * t[4] - t[1] * t[3]);
    const double a = t[4] * scale, b = -t[1] * scale, c = -t[3] * scale, d = t[0] * scale;
    return {{a, c, 0}, {b, d, 0}, {0, 0, 1}, {-(a * t[2] + b * t[5]), -(c * t[2] + d * t[5]), 0}};
}

// Where an image lies: scaled, moved, and then in a place of its own.
struct Placed {
    Vec3 scale, move;
    std::optional<Placement> then;
};

Placed placed(const Plan& plan, const Look& look, const ImageMap& map) {
    const TextureFile& file = plan.textures[map.texture];
    Placed image{{file.u.scale(), file.v.scale(), 1}, {file.u.shift(), file.v.shift(), 0}, {}};
    if (look.surface == Look::Surface::sphere) {
        // POV-Ray's u runs from +x towards +z, which is mirrored when seen from outside.
        image.scale.x = -image.scale.x;
        image.move.x = 1 - image.move.x;
    }
    if (look.surface == Look::Surface::plane) {
        const PlaneFrame& f = look.frame;
        image.then = {f.u * map.size, f.v * map.size, f.normal * map.size, f.origin};
    }
    if (look.surface == Look::Surface::mesh && map.transform != ImageMap{}.transform)
        image.then = inverse_lookup(map.transform);
    return image;
}

}  // namespace

std::string own_pattern(const Plan& plan) {
    return in_other_scenes(plan) ? " frequency 1 phase 0 ramp_wave turbulence 0 octaves 1" : "";
}

std::string color(const Color& c, const Passing& passing) {
    if (passing.filter == 0) return sdl::color(c, passing.transmit);
    return fmt::format("rgbft <{}, {}, {}, {}, {}>", number(c.x), number(c.y), number(c.z),
                       number(passing.filter), number(passing.transmit));
}

// Where the image lies. POV-Ray's image fills the unit square of x and y, or of u and v.
std::string image_placement(const Plan& plan, const Look& look, const ImageMap& map) {
    const Placed image = placed(plan, look, map);
    std::string out = scale_and_move(image.scale, image.move);
    if (image.then) out += "\n    " + matrix(*image.then);
    return out;
}

std::string without_placement(const Plan& plan, const Look& look, const ImageMap& map) {
    const auto [scale, move, next] = placed(plan, look, map);
    if (scale == Vec3(1) && move == Vec3(0) && !next) return "";
    const Placement first{{scale.x, 0, 0}, {0, scale.y, 0}, {0, 0, scale.z}, move};
    return " " + matrix((next ? first.then(*next) : first).inverse());
}

std::string image_file(const Plan& plan, const ImageMap& map) {
    const Texture& texture = plan.scene->textures[map.texture];
    const std::string& file = plan.textures[map.texture].file;
    const bool floats = texture.raster.depth == Depth::f32;
    return fmt::format("{} \"{}\" gamma {}{}", floats ? "exr" : "png", file,
                       texture.srgb && !floats ? "srgb" : "1.0",
                       texture.bilinear ? " interpolate 2" : "");
}

std::string image_map(const Plan& plan, const Look& look, const ImageMap& map,
                      const Passing& passing) {
    std::string out = look.surface == Look::Surface::plane ? "" : "uv_mapping ";
    out += "image_map { " + image_file(plan, map);
    if (passing.filter != 0) out += " filter all " + number(passing.filter);
    if (passing.transmit != 0) out += " transmit all " + number(passing.transmit);
    return out + " }" + own_pattern(plan) + image_placement(plan, look, map);
}

std::string image_pigment(const Plan& plan, const Look& look, const ImageMap& map,
                          const Passing& passing) {
    std::string out = image_map(plan, look, map, passing);
    if (passing.none()) return out;
    // POV-Ray takes whatever wears an opaque image for opaque when it looks for shadows, `transmit
    // all` or not (source/backend/support/imageutil.cpp, is_image_opaque).
    return "average pigment_map {  // the entry without weight makes shadows translucent\n      "
           "[1 " +
           out + "]\n      [0 rgbt 1]\n    }" + own_pattern(plan);
}

namespace {

std::string checker_pigment(const Plan& plan, const Checker& checker, const Passing& passing) {
    return "checker " + color(checker.colors[0], passing) + ", " +
           color(checker.colors[1], passing) + own_pattern(plan) +
           scale_and_move(Vec3(checker.size), checker.origin);
}

// sum of noise(2^i p) / 2^i, divided by the sum of the weights
std::string noise_function(const Plan& plan, int octaves) {
    const std::string noise = identifier(plan, "Perlin_noise");
    std::string sum = noise + "(x, y, z, 3)";
    double weight = 1;
    for (int i = 1; i < octaves; ++i) {
        const int n = 1 << i;
        sum += fmt::format("\n      + {1}({0}*x, {0}*y, {0}*z, 3)/{0}", n, noise);
        weight += 1.0 / n;
    }
    return fmt::format("function {{ ({})/{} }}", sum, number(weight));
}

std::string noise_pigment(const Plan& plan, const Noise& noise, const Passing& passing) {
    const std::string pattern =
        noise.octaves == 1 ? "bozo noise_generator 3" : noise_function(plan, noise.octaves);
    return pattern + "\n    color_map { [0 " + color(noise.colors[0], passing) + "] [1 " +
           color(noise.colors[1], passing) + "] }" + own_pattern(plan) +
           scale_and_move(Vec3(noise.size), noise.origin);
}

}  // namespace

std::string pigment(const Plan& plan, const Look& look, const Passing& passing) {
    const Material& material = material_of(plan, look);
    if (const auto* map = std::get_if<ImageMap>(&material.pattern))
        return image_pigment(plan, look, *map, passing);
    if (const auto* checker = std::get_if<Checker>(&material.pattern))
        return checker_pigment(plan, *checker, passing);
    if (const auto* noise = std::get_if<Noise>(&material.pattern))
        return noise_pigment(plan, *noise, passing);
    return color(material.color, passing);
}

std::string sky_pigment(const Plan& plan, const Sky& sky) {
    const ImageMap map{.texture = sky.texture};
    const auto turned = [&](const Vec3& axis) {
        Vec3 result(0);
        sky.rotation.multDirMatrix(axis, result);
        return result;
    };
    // POV-Ray's image begins in +x and runs towards +z; ours has its middle in -z.
    return "image_map { " + image_file(plan, map) + " map_type 1 }\n    " +
           matrix({turned({0, 0, 1}), turned({0, 1, 0}), turned({-1, 0, 0}), Vec3(0)});
}

}  // namespace penumbra::pov
