#include "exporters/pov/material.h"

#include "exporters/pov/sdl.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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

constexpr const char* glowing = "adds light: emits the more for being all but transparent";

Layer glow(const Material& m) {
    return {.pigment = color(white, {.transmit = 1 - veil}),
            .finish = {.emission = m.emission * (m.opacity / veil)},
            .note = glowing};
}

Layer image_glow(const Plan& plan, const Look& look, const Material& m) {
    return {.pigment = image_map(plan, look, *m.emission_map, {.transmit = 1 - veil}),
            .finish = {.emission = m.emission / veil},
            .note = glowing};
}

// Light from behind in a colour of its own: `diffuse 0, b` of a layer that hides nothing. The
// factor of an image is grey: see normalise().
Layer back_light(const Plan& plan, const Look& look, const Material& m) {
    const Passing passing = {.transmit = 1 - veil};
    const auto& image = m.diffuse_transmission_map;
    Layer layer{.note = "adds light from behind: scatters the more for being all but transparent"};
    layer.pigment =
        image ? image_map(plan, look, *image, passing) : color(m.diffuse_transmission, passing);
    layer.finish.diffuse_behind = m.opacity / veil * (image ? m.diffuse_transmission.x : 1);
    return layer;
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

// Highlight and mirror in a colour of their own: a transparent layer that wears that colour. Light
// passes it whole, and its phong and reflection are not scaled by that.
Layer gloss_layer(const Plan& plan, const Look& look, const Material& m, const SpecularLobe& lobe,
                  bool by_image) {
    Material shown = m;
    shown.specular = lobe.specular;
    shown.shininess = lobe.shininess;
    shown.reflection = lobe.reflection;
    Layer layer{.finish = gloss_of(shown)};
    if (m.specular_color) layer.finish.metallic = 1;
    layer.pigment = by_image ? image_map(plan, look, m.specular_lobes->color, {.transmit = 1})
                             : color(*m.specular_color, {.transmit = 1});
    return layer;
}

// "ambient 0.1" is what people write for "ambient rgb 0.1".
std::string item(const char* name, const Color& c) {
    const bool grey = c.x == c.y && c.y == c.z;
    return fmt::format("{} {}", name, grey ? number(c.x) : sdl::color(c));
}

std::string reflection_text(const Finish& f, bool explicitly) {
    if (f.reflection == black) return "reflection 0";
    std::string text =
        "reflection { " + std::string(f.fresnel ? "rgb 0, " : "") + sdl::color(f.reflection);
    if (f.fresnel || explicitly) text += f.fresnel ? " fresnel on" : " fresnel off";
    if (f.reflection_metallic != 0 || explicitly)
        text += " metallic " + number(f.reflection_metallic);
    return text + (explicitly ? " falloff 1 exponent 1 }" : " }");
}

// In scenes by others a finish says all that it would take over from a #default.
std::string finish_text(const Plan& plan, const Finish& f, const char* indent) {
    const bool explicitly = in_other_scenes(plan);
    std::string phong = "phong " + number(f.phong) + " phong_size " + number(f.phong_size);
    if (f.metallic != 0 || explicitly) phong += " metallic " + number(f.metallic);
    std::string rest;
    if (explicitly)
        rest = fmt::format("{0}  specular 0 brilliance 1 crand 0 irid {{ 0 }}\n", indent);
    return fmt::format("finish {{\n{0}  {1} {2} diffuse {3}{4}\n{0}  {5}\n{0}  {6}\n{7}{0}}}",
                       indent, item("ambient", f.ambient), item("emission", f.emission),
                       number(f.diffuse),
                       explicitly || f.diffuse_behind != 0 ? ", " + number(f.diffuse_behind) : "",
                       phong, reflection_text(f, explicitly), rest);
}

// The same for what a texture has besides pigment and finish: a #default normal stays, but does
// nothing.
std::string no_normal(const Plan& plan, const char* before) {
    return in_other_scenes(plan) ? before + std::string("normal { bumps 0 }") : "";
}

std::string texture_text(const Plan& plan, const Layer& layer) {
    return fmt::format("texture {{{}\n  pigment {{ ",
                       layer.note[0] != 0 ? std::string("  // ") + layer.note : "") +
           layer.pigment + " }" + no_normal(plan, "\n  ") + "\n  " +
           finish_text(plan, layer.finish, "  ") + "\n}\n";
}

std::string tinted_pigment(const Layer& layer, const Color& tint) {
    if (!layer.filter) return color(tint, layer.passing);
    return fmt::format("rgbf <{}, {}, {}, 1>", number(tint.x), number(tint.y), number(tint.z));
}

// The pigment and the finish of a tinted layer whose declarations end in `name`.
std::string tinted_text(const Plan& plan, const Layer& layer, const std::string& name,
                        const Color& tint) {
    return fmt::format("pigment {{ {} }}{} finish {{ {} }}", tinted_pigment(layer, tint),
                       no_normal(plan, " "), identifier(plan, "Finish", name));
}

std::size_t lobe_count(const Material& m) {
    return m.specular_lobes && m.specular_lobes->level.texture != no_index
               ? m.specular_lobes->lobes.size()
               : 1;
}

// The second look of a Blend on a mesh.
std::optional<Look> other_look(const Plan& plan, const Look& look) {
    if (look.other || look.surface != Look::Surface::mesh || !material_of(plan, look).blend)
        return std::nullopt;
    Look other = look;
    other.other = true;
    other.name += "__other";
    return other;
}

// What the identifier of one layer of a tinted look ends in. Names of materials have no two
// underscores in a row.
std::string part_name(const Plan& plan, const Look& look, std::size_t lobe, std::size_t layer,
                      std::size_t layers) {
    std::string name = look.name;
    if (lobe_count(material_of(plan, look)) > 1) name += fmt::format("__lobe{}", lobe + 1);
    if (layers > 1) name += fmt::format("__{}", layer + 1);
    return name;
}

// What the tints of a look have in common: the finishes of their layers, and whole layers.
std::string shared_parts(const Plan& plan, const Look& look) {
    std::string out = look.other ? "" : "// pigments: the vertex colours in the geometry\n";
    for (std::size_t k = 0; k < lobe_count(material_of(plan, look)); ++k) {
        const std::vector<Layer> layers = layers_of(plan, look, k);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const std::string name = part_name(plan, look, k, i, layers.size());
            out += layers[i].tinted ? "#declare " + identifier(plan, "Finish", name) + " = " +
                                          finish_text(plan, layers[i].finish, "") + "\n"
                                    : "#declare " + identifier(plan, "Layer", name) + " =\n" +
                                          texture_text(plan, layers[i]);
        }
    }
    if (const auto other = other_look(plan, look)) out += shared_parts(plan, *other);
    return out;
}

// The layers of a tint, from those parts.
std::string tinted_layers(const Plan& plan, const Look& look, std::size_t lobe, const Color& tint) {
    const std::vector<Layer> layers = layers_of(plan, look, lobe);
    std::string out;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::string name = part_name(plan, look, lobe, i, layers.size());
        out += layers[i].tinted
                   ? fmt::format("texture {{ {} }}", tinted_text(plan, layers[i], name, tint))
                   : "texture { " + identifier(plan, "Layer", name) + " }";
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
    const Material& m = material_of(plan, look);
    const std::size_t count = lobe_count(m);
    std::string out, entries;
    for (std::size_t k = 0; k < count; ++k) {
        const std::string part = count == 1 ? name : fmt::format("{}__lobe{}", name, k + 1);
        out += "#declare " + part + " =\n";
        if (tint != nullptr)
            out += tinted_layers(plan, look, k, *tint);
        else
            for (const Layer& layer : layers_of(plan, look, k)) out += texture_text(plan, layer);
        entries +=
            fmt::format("{}[{} {}]", k == 0 ? "" : " ",
                        number(double(k) / double(std::max<std::size_t>(1, count - 1))), part);
    }
    if (count > 1)
        out += "#declare " + name + " =\n" +
               pattern_text(plan, look, m.specular_lobes->level, entries);
    return out;
}

}  // namespace

std::vector<Layer> layers_of(const Plan& plan, const Look& look, std::size_t lobe) {
    const Material& given = material_of(plan, look);
    Material m = given;
    const bool mesh = look.surface == Look::Surface::mesh;
    const bool specular_lobes = m.specular_lobes && mesh;
    const bool by_image = specular_lobes && m.specular_lobes->color.texture != no_index;
    const SpecularLobe own = {m.specular, m.shininess, m.reflection};
    const SpecularLobe shown = specular_lobes ? m.specular_lobes->lobes[lobe] : own;
    const bool own_color =
        by_image || (m.specular_color && (shown.specular > 0 || shown.reflection != black));
    const SpecularLobe base = own_color ? SpecularLobe{} : shown;
    m.specular = base.specular;
    m.shininess = base.shininess;
    m.reflection = base.reflection;
    if (own_color && !by_image) m.metallic = 0;
    if (!mesh) {
        m.emission_map.reset();
        m.diffuse_transmission_map.reset();
    }
    const bool image = std::holds_alternative<ImageMap>(m.pattern);
    std::vector<Layer> layers;
    if (image && (look.tinted || m.color != white))
        add_product_layers(plan, look, m, layers);
    else
        add_simple_layers(plan, look, m, layers);
    if (m.emission_map && m.emission != black) layers.push_back(image_glow(plan, look, m));
    if (m.diffuse_transmission != black && m.opacity > 0)
        layers.push_back(back_light(plan, look, m));
    if (own_color) layers.push_back(gloss_layer(plan, look, given, shown, by_image));
    return layers;
}

namespace {

// Declarations that end in that of `name`, the look's texture; `tint` is that of a tinted look.
std::string texture_declaration(const Plan& plan, const Look& look, const std::string& name,
                                const Tint* tint) {
    const Material& m = material_of(plan, look);
    const Color* const color = tint == nullptr ? nullptr : &tint->color;
    if (const auto other = other_look(plan, look)) {
        const std::string first = name + "__first", second = name + "__other";
        return declare_lobes(plan, look, first, color) +
               declare_lobes(plan, *other, second, tint == nullptr ? nullptr : &tint->other) +
               "#declare " + name + " =\n" +
               pattern_text(plan, look, m.blend->map, fmt::format("[0 {}] [1 {}]", second, first));
    }
    if (!m.alpha_map || m.alpha_map->map.texture == no_index || look.surface != Look::Surface::mesh)
        return declare_lobes(plan, look, name, color);
    const std::string there = name + "__there";
    const AlphaMap& alpha_map = *m.alpha_map;
    const double from = alpha_map.cutoff ? cutoff_threshold(*alpha_map.cutoff) : 0;
    const double to = alpha_map.cutoff ? from : 1;
    return declare_lobes(plan, look, there, color) + "#declare " + name + " =\n" +
           pattern_text(plan, look, alpha_map.map,
                        fmt::format("[{} {}] [{} {}]", number(from), identifier(plan, "Nothing"),
                                    number(to), there));
}

}  // namespace

std::string tint_declaration(const Plan& plan, const Look& look, const std::string& name,
                             const Tint& tint) {
    const bool faded = tint.alpha != 1;
    std::string out, whole = identifier(plan, "Material", look.name);
    if (look.tinted) {
        whole = faded ? name + "__whole" : name;
        out = texture_declaration(plan, look, whole, &tint);
        if (!faded) return out;
    }
    out += "#declare " + name + " =\ntexture { ";
    if (faded)
        out += fmt::format("average texture_map {{ [{} {}] [{} {}] }}", number(tint.alpha), whole,
                           number(1 - double(tint.alpha)), identifier(plan, "Nothing"));
    else
        out += whole;
    return out + " }\n";
}

bool is_single(const Plan& plan, const Look& look) {
    const Material& m = material_of(plan, look);
    return lobe_count(m) == 1 && !m.alpha_map && !m.blend && layers_of(plan, look).size() == 1;
}

std::string single_texture(const Plan& plan, const Look& look, const Color& tint) {
    return tinted_text(plan, layers_of(plan, look)[0], look.name, tint);
}

std::string nothing_text(const Plan& plan) {
    const std::string finish =
        in_other_scenes(plan) ? finish_text(plan, {}, "") : "finish { ambient 0 diffuse 0 }";
    return "#declare " + identifier(plan, "Nothing") + " = texture { pigment { rgbt 1 }" +
           no_normal(plan, " ") + " " + finish + " }\n";
}

std::string look_text(const Plan& plan, const Look& look) {
    if (look.tinted) return shared_parts(plan, look);
    return texture_declaration(plan, look, identifier(plan, "Material", look.name), nullptr);
}

}  // namespace penumbra::pov
