#include "exporters/pov/layers.h"

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
            .finish = {.emission = m.emission / veil},
            .note = glowing};
}

Layer image_glow(const Plan& plan, const Look& look, const Material& m) {
    const Passing passing = {.transmit = 1 - veil};
    return {.pigment = m.opacity < 1 ? image_pigment(plan, look, *m.emission_map, passing)
                                     : image_map(plan, look, *m.emission_map, passing),
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
    if (m.emission == black || m.emission_map) return add(finish);
    // POV-Ray scales a layer's emission by its opacity.
    if (std::holds_alternative<std::monostate>(m.pattern) && !look.tinted && m.opacity == 1) {
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
    if (m.emission != black && !m.emission_map) layers.push_back(glow(m));
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

// Transparent layers that reflect 1/n each, by displaced normals if there are several. POV-Ray adds
// what they reflect, and filters it by no layer above.
void add_mirrors(const Plan& plan, const Look& look, Layer gloss, const SpecularLobe& lobe,
                 int count, std::vector<Layer>& layers) {
    const std::vector<VirtualMirror> mirrors = virtual_mirrors(lobe.roughness, count);
    const bool metal = gloss.finish.reflection_metallic > 0;
    if (!metal) gloss.pigment = color(white, {.transmit = 1});
    gloss.tinted = gloss.tinted && metal;
    if (metal && gloss.tinted) gloss.passing = {.transmit = 1};
    if (metal && !gloss.tinted && gloss.pigment.empty())
        gloss.pigment = pigment(plan, look, {.transmit = 1});
    gloss.filter = false;
    gloss.finish = {.reflection = lobe.reflection * (1 / float(mirrors.size())),
                    .reflection_metallic = gloss.finish.reflection_metallic,
                    .fresnel = gloss.finish.fresnel,
                    .conserve_energy = gloss.finish.conserve_energy};
    gloss.note = "";
    for (const VirtualMirror& mirror : mirrors) {
        gloss.mirror = mirror;
        layers.push_back(gloss);
    }
}

// The clear coat: mirrors, and above them, where no normal is displaced, its highlight.
void add_coat(const Look& look, const Material& m, std::vector<Layer>& layers) {
    const Coat& coat = *m.coat;
    const bool sharp = look.mirrored || m.opacity < 1;
    const auto mirrors = virtual_mirrors(sharp ? 0 : coat.roughness, coat.mirrors);
    const float part = 1 / float(mirrors.size());
    Layer layer{.pigment = color(white, {.transmit = 1}), .note = "a clear coat"};
    if (penumbra::mirrors(coat)) {
        layer.finish = {.reflection = Color(coat.reflection * part),
                        .grazing = coat.grazing * part,
                        .conserve_energy = m.opacity >= 1};
        for (const VirtualMirror& mirror : mirrors) {
            layer.mirror = mirror;
            layers.push_back(layer);
        }
    }
    layer.mirror = {};
    layer.finish = {.phong = coat.specular, .phong_size = coat.shininess};
    if (coat.specular > 0) layers.push_back(layer);
}

// What sheen covers, by the angle at which it is seen.
Layer sheen_layer(const Plan& plan, const Sheen& sheen) {
    const std::array<float, 17> cover = sheen_cover(sheen);
    Layer layer{.finish = {.diffuse = 1}, .note = "sheen", .by_angle = true};
    layer.pigment = "aoi color_map {";
    for (std::size_t i = 0; i < cover.size(); ++i)
        layer.pigment += fmt::format(" [{} {}]", number(0.5 + double(i) / 32),
                                     color(sheen_tint(sheen), {.transmit = 1 - cover[i]}));
    layer.pigment += " }" + own_pattern(plan);
    return layer;
}

// Highlight and mirror of a look, and in which layers they stand.
struct Gloss {
    SpecularLobe shown = {};     ///< beside the other terms, or in a layer of its own colour
    SpecularLobe mirrored = {};  ///< in layers above all
    bool above = false;          ///< there are such layers
    bool by_image = false;       ///< its colour comes from an image
    bool own_color = false;      ///< it has a colour besides the pigment
};

Gloss gloss_in(const Look& look, const Material& m, std::size_t lobe) {
    const bool lobes = m.specular_lobes && look.surface == Look::Surface::mesh;
    const SpecularLobe own = {m.specular, m.shininess, m.reflection, m.roughness};
    Gloss gloss = {.shown = lobes ? m.specular_lobes->lobes[lobe] : own,
                   .by_image = lobes && m.specular_lobes->color.texture != no_index};
    gloss.mirrored = gloss.shown;
    if (look.mirrored || !blurs(m)) gloss.mirrored.roughness = 0;
    const bool reflects = gloss.shown.reflection != black;
    gloss.above = reflects && (takes_reflected(m) || gloss.mirrored.roughness > 0);
    if (gloss.above) gloss.shown.reflection = black;
    gloss.own_color =
        gloss.by_image || (m.specular_color && (gloss.shown.specular > 0 || reflects));
    return gloss;
}

// The layers of those mirrors.
void add_mirrors_above(const Plan& plan, const Look& look, const Gloss& gloss,
                       std::vector<Layer>& layers) {
    const Material& m = material_of(plan, look);
    const bool image = std::holds_alternative<ImageMap>(m.pattern);
    // The pigment that tints a metal's reflection.
    Layer layer{.finish = gloss_of(m), .tinted = look.tinted && !image && !gloss.own_color};
    if (gloss.own_color)
        layer.pigment = gloss_layer(plan, look, m, gloss.shown, gloss.by_image).pigment;
    layer.finish.conserve_energy = takes_reflected(m);
    add_mirrors(plan, look, std::move(layer), gloss.mirrored, m.mirrors, layers);
}

// What the layers below those of gloss and coat show.
Material below_gloss(const Look& look, const Material& given, const Gloss& gloss) {
    Material m = given;
    const SpecularLobe base = gloss.own_color ? SpecularLobe{} : gloss.shown;
    m.specular = base.specular;
    m.shininess = base.shininess;
    m.reflection = base.reflection;
    if (gloss.own_color && !gloss.by_image) m.metallic = 0;
    if (look.surface != Look::Surface::mesh) {
        m.emission_map.reset();
        m.diffuse_transmission_map.reset();
    }
    return m;
}

}  // namespace

namespace {

// All but what stands above.
std::vector<Layer> lower_layers(const Plan& plan, const Look& look, const Gloss& gloss) {
    const Material& given = material_of(plan, look);
    const Material m = below_gloss(look, given, gloss);
    const bool image = std::holds_alternative<ImageMap>(m.pattern);
    std::vector<Layer> layers;
    if (image && (look.tinted || m.color != white))
        add_product_layers(plan, look, m, layers);
    else
        add_simple_layers(plan, look, m, layers);
    if (m.emission_map && m.emission != black) layers.push_back(image_glow(plan, look, m));
    if (m.diffuse_transmission != black && m.opacity > 0)
        layers.push_back(back_light(plan, look, m));
    if (gloss.own_color && (gloss.shown.specular > 0 || gloss.shown.reflection != black))
        layers.push_back(gloss_layer(plan, look, given, gloss.shown, gloss.by_image));
    return layers;
}

// Light that is scattered and highlights, which are the same in all textures of a mean, are found
// in one of them.
void scale_lit(Finish& finish, float factor) {
    for (Color* term : {&finish.ambient, &finish.emission}) *term *= factor;
    for (float* term : {&finish.diffuse, &finish.diffuse_behind, &finish.phong}) *term *= factor;
}

}  // namespace

std::vector<Layer> layers_of(const Plan& plan, const Look& look, std::size_t lobe) {
    const Material& m = material_of(plan, look);
    const Gloss gloss = gloss_in(look, m, lobe);
    std::vector<Layer> layers = lower_layers(plan, look, gloss);
    if (gloss.above) add_mirrors_above(plan, look, gloss, layers);
    if (covers(m)) layers.push_back(sheen_layer(plan, *m.sheen));
    if (m.coat) add_coat(look, m, layers);
    return layers;
}

std::vector<std::vector<Layer>> frosted_layers(const Plan& plan, const Look& look) {
    const Material& m = material_of(plan, look);
    Gloss gloss = gloss_in(look, m, 0);
    const Color reflection = gloss.shown.reflection;
    gloss.shown.reflection = black;
    gloss.mirrored.roughness = m.roughness;
    const std::vector<Layer> below = lower_layers(plan, look, gloss);
    std::vector<Layer> mirrors;
    add_mirrors_above(plan, look, gloss, mirrors);
    std::vector<std::vector<Layer>> textures;
    for (Layer& mirror : mirrors) {
        std::vector<Layer>& layers = textures.emplace_back(below);
        const bool first = textures.size() == 1;
        for (Layer& layer : layers) scale_lit(layer.finish, first ? float(mirrors.size()) : 0);
        mirror.finish.reflection = reflection;
        layers.push_back(mirror);
    }
    return textures;
}

}  // namespace penumbra::pov
