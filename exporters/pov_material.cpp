#include "pov_material.h"

#include "sdl.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra::pov {

namespace {

using sdl::color;
using sdl::number;

const Color black(0), white(1);

std::string scale_and_move(const Vec3& scale, const Vec3& move) {
    std::string out;
    if (scale != Vec3(1)) {
        const bool uniform = scale.x == scale.y && scale.y == scale.z;
        out += " scale " + (uniform ? number(scale.x) : sdl::vector(scale));
    }
    if (move != Vec3(0)) out += " translate " + sdl::vector(move);
    return out;
}

std::string matrix(const Vec3& x, const Vec3& y, const Vec3& z, const Vec3& move) {
    std::string out;
    for (const Vec3* row : {&x, &y, &z, &move})
        out += fmt::format("{}{}, {}, {}", out.empty() ? "" : ",  ", number(row->x), number(row->y),
                           number(row->z));
    return "matrix <" + out + ">";
}

// Where the image lies. POV-Ray's image fills the unit square of x and y, or of u and v.
std::string image_placement(const Plan& plan, const Look& look, const ImageMap& map) {
    const TextureFile& file = plan.textures[map.texture];
    Vec3 scale(file.u.scale(), file.v.scale(), 1), move(file.u.shift(), file.v.shift(), 0);
    if (look.surface == Look::Surface::sphere) {
        // POV-Ray's u runs from +x towards +z, which is mirrored when seen from outside.
        scale.x = -scale.x;
        move.x = 1 - move.x;
    }
    std::string out = scale_and_move(scale, move);
    if (look.surface == Look::Surface::plane) {
        const PlaneFrame& f = look.frame;
        out += "\n    " + matrix(f.u * map.size, f.v * map.size, f.normal * map.size, f.origin);
    }
    return out;
}

std::string image_pigment(const Plan& plan, const Look& look, const ImageMap& map, float transmit) {
    const Texture& texture = plan.scene->textures[map.texture];
    const std::string& file = plan.textures[map.texture].file;
    const bool floats = texture.raster.depth == Depth::f32;
    std::string out = look.surface == Look::Surface::plane ? "" : "uv_mapping ";
    out += fmt::format("image_map {{ {} \"{}\" gamma {}", floats ? "exr" : "png", file,
                       texture.srgb && !floats ? "srgb" : "1.0");
    if (texture.bilinear) out += " interpolate 2";
    if (transmit != 0) out += " transmit all " + number(transmit);
    out += " }" + image_placement(plan, look, map);
    if (plan.scene->materials[look.material].opacity == 1) return out;
    // POV-Ray takes whatever wears an opaque image for opaque when it looks for shadows, `transmit
    // all` or not (source/backend/support/imageutil.cpp, is_image_opaque).
    return "average pigment_map {  // the entry without weight makes shadows translucent\n      "
           "[1 " +
           out + "]\n      [0 rgbt 1]\n    }";
}

std::string checker_pigment(const Checker& checker, float transmit) {
    return "checker " + color(checker.colors[0], transmit) + ", " +
           color(checker.colors[1], transmit) + scale_and_move(Vec3(checker.size), checker.origin);
}

// sum of noise(2^i p) / 2^i, divided by the sum of the weights
std::string noise_function(int octaves) {
    std::string sum = "Perlin_noise(x, y, z, 3)";
    double weight = 1;
    for (int i = 1; i < octaves; ++i) {
        const int n = 1 << i;
        sum += fmt::format("\n      + Perlin_noise({0}*x, {0}*y, {0}*z, 3)/{0}", n);
        weight += 1.0 / n;
    }
    return fmt::format("function {{ ({})/{} }}", sum, number(weight));
}

std::string noise_pigment(const Noise& noise, float transmit) {
    const std::string pattern =
        noise.octaves == 1 ? "bozo noise_generator 3" : noise_function(noise.octaves);
    return pattern + "\n    color_map { [0 " + color(noise.colors[0], transmit) + "] [1 " +
           color(noise.colors[1], transmit) + "] }" +
           scale_and_move(Vec3(noise.size), noise.origin);
}

std::string pigment(const Plan& plan, const Look& look, float transmit) {
    const Material& material = plan.scene->materials[look.material];
    if (const auto* map = std::get_if<ImageMap>(&material.pattern))
        return image_pigment(plan, look, *map, transmit);
    if (const auto* checker = std::get_if<Checker>(&material.pattern))
        return checker_pigment(*checker, transmit);
    if (const auto* noise = std::get_if<Noise>(&material.pattern))
        return noise_pigment(*noise, transmit);
    return color(material.color, transmit);
}

// Without ambient, diffuse and emission: what does not depend on the opacity.
Finish gloss_of(const Material& m) {
    return {.phong = m.specular,
            .phong_size = m.shininess,
            .metallic = m.metallic,
            .reflection = m.reflection,
            .reflection_metallic = m.metallic};
}

Finish finish_of(const Material& m) {
    Finish finish = gloss_of(m);
    finish.ambient = m.ambient;
    finish.diffuse = m.diffuse;
    return finish;
}

// POV-Ray multiplies `emission` by the pigment. True when dividing by it undoes that.
bool divide_emission(const Color& pigment, const Color& emission, Color& quotient) {
    for (int i = 0; i < 3; ++i) {
        quotient[i] = emission[i] == 0 ? 0 : emission[i] / pigment[i];
        if (!std::isfinite(quotient[i])) return false;
        if (std::abs(quotient[i] * pigment[i] - emission[i]) > 1e-6F * emission[i]) return false;
    }
    return true;
}

// Two layers share a surface of opacity a = 1 - T so that each shows half of it: the upper one has
// opacity a/2, the lower one (a/2) / (1 - a/2), and together they transmit 1 - a. Doubling a
// layer's terms makes up for its half.
struct Halves {
    float upper, lower;  ///< transmit
    explicit Halves(float opacity)
        : upper(float(1 - double(opacity) / 2)),
          lower(float((1 - double(opacity)) / (1 - double(opacity) / 2))) {}
};

Finish doubled(Finish finish) {
    finish.ambient *= 2;
    finish.diffuse *= 2;
    return finish;
}

// Emission that does not take the pigment's colour: a white layer that emits.
Layer glow(const Material& m, float transmit) {
    return {.pigment = color(white, transmit), .finish = {.emission = m.emission * 2.0F}};
}

// A surface whose pigment is one of POV-Ray's own.
std::vector<Layer> simple_layers(const Plan& plan, const Look& look, const Material& m) {
    const float transmit = 1 - m.opacity;
    const auto layer = [&](float through, const Finish& finish) {
        return Layer{.pigment = look.tinted ? "" : pigment(plan, look, through),
                     .finish = finish,
                     .tinted = look.tinted,
                     .transmit = through};
    };
    Finish finish = finish_of(m);
    if (m.emission == black || m.opacity == 0) return {layer(transmit, finish)};
    if (std::holds_alternative<std::monostate>(m.pattern) && !look.tinted) {
        if (divide_emission(m.color, m.emission, finish.emission)) return {layer(transmit, finish)};
        const bool unseen = m.color == black || (m.ambient == black && m.diffuse == 0);
        if (unseen && m.metallic == 0) {
            finish = gloss_of(m);
            finish.emission = m.emission;
            return {{.pigment = color(white, transmit), .finish = finish}};
        }
    }
    const Halves halves(m.opacity);
    return {glow(m, halves.lower), layer(halves.upper, doubled(finish_of(m)))};
}

// Splits the gloss of a metal whose pigment is a product: no layer's pigment is the product, but
// the highlight of the image's layer, filtered by the tint above it, takes both colours.
void tint_gloss(const Material& m, Finish& image, float image_weight, Finish& top) {
    image.phong = m.specular * m.metallic / image_weight;
    image.phong_size = m.shininess;
    image.metallic = 1;
    image.reflection = m.reflection;
    image.reflection_metallic = m.metallic;
    top.phong = m.specular * (1 - m.metallic);
    top.metallic = 0;
    top.reflection = black;
}

// An image times a colour: the colour is a filter over the image.
std::vector<Layer> product_layers(const Plan& plan, const Look& look, const Material& m) {
    const bool glows = m.emission != black && m.opacity != 0;
    const Halves halves(m.opacity);
    const float through = glows ? halves.lower : 1 - m.opacity;
    Layer image{.pigment = pigment(plan, look, through)};
    image.finish.ambient = m.ambient;
    image.finish.diffuse = m.diffuse;
    if (glows) image.finish = doubled(image.finish);
    Finish top = gloss_of(m);
    if (m.metallic > 0) tint_gloss(m, image.finish, glows ? halves.upper : 1, top);
    Layer filter{.pigment = fmt::format("rgbf <{}, {}, {}, 1>", number(m.color.x),
                                        number(m.color.y), number(m.color.z)),
                 .tinted = look.tinted,
                 .filter = true};
    if (!glows) {
        filter.finish = top;
        return {image, filter};
    }
    Layer light = glow(m, halves.upper);
    top.emission = light.finish.emission;
    light.finish = top;
    return {image, filter, light};
}

// "ambient 0.1" is what people write for "ambient rgb 0.1".
std::string item(const char* name, const Color& c) {
    const bool grey = c.x == c.y && c.y == c.z;
    return fmt::format("{} {}", name, grey ? number(c.x) : color(c));
}

std::string finish_text(const Finish& f, const char* indent) {
    std::string phong = "phong " + number(f.phong) + " phong_size " + number(f.phong_size);
    if (f.metallic != 0) phong += " metallic " + number(f.metallic);
    std::string reflection = "reflection 0";
    if (f.reflection != black) {
        reflection = "reflection { " + color(f.reflection);
        if (f.reflection_metallic != 0) reflection += " metallic " + number(f.reflection_metallic);
        reflection += " }";
    }
    return fmt::format("finish {{\n{0}  {1} {2} diffuse {3}\n{0}  {4}\n{0}  {5}\n{0}}}", indent,
                       item("ambient", f.ambient), item("emission", f.emission), number(f.diffuse),
                       phong, reflection);
}

std::string texture_text(const Layer& layer) {
    return "texture {\n  pigment { " + layer.pigment + " }\n  " + finish_text(layer.finish, "  ") +
           "\n}\n";
}

std::string tinted_look_text(const Look& look, const std::vector<Layer>& layers) {
    std::string out;
    bool above = false;
    for (const Layer& layer : layers) {
        const std::string name = layer.tinted ? finish_name(look)
                                 : above      ? above_name(look)
                                              : below_name(look);
        out += "#declare " + name + " = " +
               (layer.tinted ? finish_text(layer.finish, "") + "\n" : texture_text(layer));
        above = above || layer.tinted;
    }
    return out;
}

}  // namespace

std::vector<Layer> layers_of(const Plan& plan, const Look& look) {
    const Material& m = plan.scene->materials[look.material];
    const bool image = std::holds_alternative<ImageMap>(m.pattern);
    if (image && (look.tinted || m.color != white)) return product_layers(plan, look, m);
    return simple_layers(plan, look, m);
}

std::string tinted_pigment(const Layer& layer, const Color& tint) {
    if (!layer.filter) return "{ " + color(tint, layer.transmit) + " }";
    return fmt::format("{{ rgbf <{}, {}, {}, 1> }}", number(tint.x), number(tint.y),
                       number(tint.z));
}

std::string look_text(const Plan& plan, const Look& look) {
    const std::vector<Layer> layers = layers_of(plan, look);
    if (look.tinted)
        return "// pigments: the vertex colours in the geometry\n" + tinted_look_text(look, layers);
    std::string out = "#declare Material_" + look.name + " =\n";
    for (const Layer& layer : layers) out += texture_text(layer);
    return out;
}

}  // namespace penumbra::pov
