#include "pov_material.h"

#include "sdl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::pov {

namespace {

using sdl::number;

const Color black(0), white(1);

Passing passing_of(const Material& m) {
    const double through = 1 - double(m.opacity);
    return {.filter = float(through * double(m.transmission)),
            .transmit = m.transmission == 0 ? 1 - m.opacity
                                            : float(through * (1 - double(m.transmission)))};
}

// Without ambient, diffuse and emission: what does not depend on the opacity.
Finish gloss_of(const Material& m) {
    return {.phong = m.specular,
            .phong_size = m.shininess,
            .metallic = m.metallic,
            .reflection = m.reflection,
            .reflection_metallic = m.metallic,
            .fresnel = m.fresnel};
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

// A layer that only adds light: all but transparent, and emitting the more for it. The layers below
// lose a millionth.
constexpr float veil = 1 / 1048576.0F;

Layer glow(const Material& m) {
    return {.pigment = color(white, {.transmit = 1 - veil}),
            .finish = {.emission = m.emission * (m.opacity / veil)},
            .adds_light = true};
}

Layer image_glow(const Plan& plan, const Look& look, const Material& m) {
    return {.pigment = image_map(plan, look, *m.emission_map, {.transmit = 1 - veil}),
            .finish = {.emission = m.emission / veil},
            .adds_light = true};
}

// A surface whose pigment is one of POV-Ray's own.
void add_simple_layers(const Plan& plan, const Look& look, const Material& m,
                       std::vector<Layer>& layers) {
    const Passing passing = passing_of(m);
    const auto add = [&](const Finish& finish) {
        layers.push_back({.pigment = look.tinted ? "" : pigment(plan, look, passing),
                          .finish = finish,
                          .tinted = look.tinted,
                          .passing = passing});
    };
    Finish finish = finish_of(m);
    if (m.emission == black || m.emission_map || m.opacity == 0) return add(finish);
    if (std::holds_alternative<std::monostate>(m.pattern) && !look.tinted) {
        if (divide_emission(m.color, m.emission, finish.emission)) return add(finish);
        const bool unseen = m.color == black || (m.ambient == black && m.diffuse == 0);
        if (unseen && m.metallic == 0 && m.transmission == 0) {
            finish = gloss_of(m);
            finish.emission = m.emission;
            layers.push_back({.pigment = color(white, passing), .finish = finish});
            return;
        }
    }
    add(finish_of(m));
    layers.push_back(glow(m));
}

// An image times a colour: the colour is a filter over the image.
void add_product_layers(const Plan& plan, const Look& look, const Material& m,
                        std::vector<Layer>& layers) {
    Layer image{.pigment = pigment(plan, look, passing_of(m))};
    image.finish.ambient = m.ambient;
    image.finish.diffuse = m.diffuse;
    layers.push_back(image);
    layers.push_back({.pigment = fmt::format("rgbf <{}, {}, {}, 1>", number(m.color.x),
                                             number(m.color.y), number(m.color.z)),
                      .finish = m.metallic > 0 ? Finish{} : gloss_of(m),
                      .tinted = look.tinted,
                      .filter = true});
    // The highlight of a metal takes the colour of the image, which needs a layer of its own.
    if (m.metallic > 0)
        layers.push_back({.pigment = image_pigment(plan, look, *std::get_if<ImageMap>(&m.pattern),
                                                   {.transmit = 1}),
                          .finish = gloss_of(m)});
    if (m.emission != black && !m.emission_map && m.opacity != 0) layers.push_back(glow(m));
}

// Highlight and mirror in a colour of their own: a transparent layer that wears that colour.
Layer gloss_layer(const Plan& plan, const Look& look, const Material& m, const Lobe& lobe) {
    Material shown = m;
    shown.specular = lobe.specular;
    shown.shininess = lobe.shininess;
    shown.reflection = lobe.reflection;
    return {.pigment = image_map(plan, look, m.gloss->color, {.transmit = 1}),
            .finish = gloss_of(shown)};
}

// "ambient 0.1" is what people write for "ambient rgb 0.1".
std::string item(const char* name, const Color& c) {
    const bool grey = c.x == c.y && c.y == c.z;
    return fmt::format("{} {}", name, grey ? number(c.x) : sdl::color(c));
}

std::string finish_text(const Finish& f, const char* indent) {
    std::string phong = "phong " + number(f.phong) + " phong_size " + number(f.phong_size);
    if (f.metallic != 0) phong += " metallic " + number(f.metallic);
    std::string reflection = "reflection 0";
    if (f.reflection != black) {
        reflection = "reflection { " + std::string(f.fresnel ? "rgb 0, " : "") +
                     sdl::color(f.reflection) + (f.fresnel ? " fresnel on" : "");
        if (f.reflection_metallic != 0) reflection += " metallic " + number(f.reflection_metallic);
        reflection += " }";
    }
    return fmt::format("finish {{\n{0}  {1} {2} diffuse {3}\n{0}  {4}\n{0}  {5}\n{0}}}", indent,
                       item("ambient", f.ambient), item("emission", f.emission), number(f.diffuse),
                       phong, reflection);
}

std::string texture_text(const Layer& layer) {
    return fmt::format("texture {{{}\n  pigment {{ ",
                       layer.adds_light
                           ? "  // adds light: emits the more for being all but transparent"
                           : "") +
           layer.pigment + " }\n  " + finish_text(layer.finish, "  ") + "\n}\n";
}

std::string tinted_pigment(const Layer& layer, const Color& tint) {
    if (!layer.filter) return color(tint, layer.passing);
    return fmt::format("rgbf <{}, {}, {}, 1>", number(tint.x), number(tint.y), number(tint.z));
}

std::size_t lobe_count(const Material& m) {
    return m.gloss && m.gloss->level.texture != no_index ? m.gloss->lobes.size() : 1;
}

// What the identifier of one layer of a tinted look ends in. Names of materials have no two
// underscores in a row.
std::string part_name(const Plan& plan, const Look& look, std::size_t lobe, std::size_t layer,
                      std::size_t layers) {
    std::string name = look.name;
    if (lobe_count(plan.scene->materials[look.material]) > 1)
        name += fmt::format("__lobe{}", lobe + 1);
    if (layers > 1) name += fmt::format("__{}", layer + 1);
    return name;
}

// What the tints of a look have in common: the finishes of their layers, and whole layers.
std::string shared_parts(const Plan& plan, const Look& look) {
    std::string out = "// pigments: the vertex colours in the geometry\n";
    for (std::size_t k = 0; k < lobe_count(plan.scene->materials[look.material]); ++k) {
        const std::vector<Layer> layers = layers_of(plan, look, k);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const std::string name = part_name(plan, look, k, i, layers.size());
            out += layers[i].tinted ? "#declare Finish_" + name + " = " +
                                          finish_text(layers[i].finish, "") + "\n"
                                    : "#declare Layer_" + name + " =\n" + texture_text(layers[i]);
        }
    }
    return out;
}

// The layers of a tint, from those parts.
std::string tinted_layers(const Plan& plan, const Look& look, std::size_t lobe, const Color& tint) {
    const std::vector<Layer> layers = layers_of(plan, look, lobe);
    std::string out;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::string name = part_name(plan, look, lobe, i, layers.size());
        out += layers[i].tinted
                   ? fmt::format("texture {{ pigment {{ {} }} finish {{ Finish_{} }} }}",
                                 tinted_pigment(layers[i], tint), name)
                   : "texture { Layer_" + name + " }";
        out += '\n';
    }
    return out;
}

// A texture that shows another one for every value of an image's first channel.
std::string pattern_text(const Plan& plan, const Look& look, const ImageMap& map,
                         const std::string& entries) {
    return "texture {\n  uv_mapping image_pattern { " + image_file(plan, map) + " }\n  " +
           "texture_map { " + entries + " }" + image_placement(plan, look, map) + "\n}\n";
}

// Declares the textures of the look's lobes and, as `name`, their mixture.
std::string declare_lobes(const Plan& plan, const Look& look, const std::string& name,
                          const Color* tint) {
    const Material& m = plan.scene->materials[look.material];
    const std::size_t count = lobe_count(m);
    std::string out, entries;
    for (std::size_t k = 0; k < count; ++k) {
        const std::string part = count == 1 ? name : fmt::format("{}__lobe{}", name, k + 1);
        out += "#declare " + part + " =\n";
        if (tint != nullptr)
            out += tinted_layers(plan, look, k, *tint);
        else
            for (const Layer& layer : layers_of(plan, look, k)) out += texture_text(layer);
        entries +=
            fmt::format("{}[{} {}]", k == 0 ? "" : " ",
                        number(double(k) / double(std::max<std::size_t>(1, count - 1))), part);
    }
    if (count > 1)
        out += "#declare " + name + " =\n" + pattern_text(plan, look, m.gloss->level, entries);
    return out;
}

}  // namespace

std::vector<Layer> layers_of(const Plan& plan, const Look& look, std::size_t lobe) {
    Material m = plan.scene->materials[look.material];
    const bool mesh = look.surface == Look::Surface::mesh;
    const bool gloss = m.gloss && mesh;
    const bool own_color = gloss && m.gloss->color.texture != no_index;
    if (gloss) {
        const Lobe shown = own_color ? Lobe{} : m.gloss->lobes[lobe];
        m.specular = shown.specular;
        m.shininess = shown.shininess;
        m.reflection = shown.reflection;
    }
    if (!mesh) m.emission_map.reset();
    const bool image = std::holds_alternative<ImageMap>(m.pattern);
    std::vector<Layer> layers;
    if (image && (look.tinted || m.color != white))
        add_product_layers(plan, look, m, layers);
    else
        add_simple_layers(plan, look, m, layers);
    if (m.emission_map && m.emission != black) layers.push_back(image_glow(plan, look, m));
    if (own_color) layers.push_back(gloss_layer(plan, look, m, m.gloss->lobes[lobe]));
    return layers;
}

namespace {

// Declarations that end in that of `name`, the look's texture; `tint` is the vertex colour of a
// tinted look.
std::string texture_declaration(const Plan& plan, const Look& look, const std::string& name,
                                const Color* tint) {
    const Material& m = plan.scene->materials[look.material];
    if (!m.coverage || m.coverage->map.texture == no_index || look.surface != Look::Surface::mesh)
        return declare_lobes(plan, look, name, tint);
    const std::string there = name + "__there";
    const Coverage& coverage = *m.coverage;
    const double from = coverage.cutoff ? cutoff_threshold(*coverage.cutoff) : 0;
    const double to = coverage.cutoff ? from : 1;
    return declare_lobes(plan, look, there, tint) + "#declare " + name + " =\n" +
           pattern_text(plan, look, coverage.map,
                        fmt::format("[{} Nothing] [{} {}]", number(from), number(to), there));
}

}  // namespace

std::string tint_declaration(const Plan& plan, const Look& look, const std::string& name,
                             const Tint& tint) {
    const bool faded = tint.alpha != 1;
    std::string out, whole = "Material_" + look.name;
    if (look.tinted) {
        whole = faded ? name + "__whole" : name;
        out = texture_declaration(plan, look, whole, &tint.color);
        if (!faded) return out;
    }
    out += "#declare " + name + " =\ntexture { ";
    if (faded)
        out += fmt::format("average texture_map {{ [{} {}] [{} Nothing] }}", number(tint.alpha),
                           whole, number(1 - double(tint.alpha)));
    else
        out += whole;
    return out + " }\n";
}

bool is_single(const Plan& plan, const Look& look) {
    const Material& m = plan.scene->materials[look.material];
    return lobe_count(m) == 1 && !m.coverage && layers_of(plan, look).size() == 1;
}

std::string single_texture(const Plan& plan, const Look& look, const Color& tint) {
    return fmt::format("pigment {{ {} }} finish {{ Finish_{} }}",
                       tinted_pigment(layers_of(plan, look)[0], tint), look.name);
}

std::string look_text(const Plan& plan, const Look& look) {
    if (look.tinted) return shared_parts(plan, look);
    return texture_declaration(plan, look, "Material_" + look.name, nullptr);
}

}  // namespace penumbra::pov
