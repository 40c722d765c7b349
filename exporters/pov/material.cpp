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

const Color black(0);

// "ambient 0.1" is what people write for "ambient rgb 0.1".
std::string item(const char* name, const Color& c) {
    const bool grey = c.x == c.y && c.y == c.z;
    return fmt::format("{} {}", name, grey ? number(c.x) : sdl::color(c));
}

std::string reflection_text(const Finish& f, bool explicitly) {
    if (f.grazing)
        return fmt::format("reflection {{ {}, {} falloff 5{} }}", sdl::color(f.reflection),
                           sdl::color(Color(*f.grazing)),
                           explicitly ? " fresnel off metallic 0 exponent 1" : "");
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
    if (f.conserve_energy) rest += fmt::format("{}  conserve_energy\n", indent);
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

std::size_t lobe_count(const Material& m) {
    return m.specular_lobes && m.specular_lobes->level.texture != no_index
               ? m.specular_lobes->lobes.size()
               : 1;
}

bool wears_alpha_map(const Plan& plan, const Look& look) {
    const auto& map = material_of(plan, look).alpha_map;
    return map && map->map.texture != no_index && look.surface == Look::Surface::mesh;
}

// What keeps a normal where it is, inside of the patterns that the look's layers stand in; outer
// patterns are undone first.
std::string without_patterns(const Plan& plan, const Look& look) {
    const Material& m = material_of(plan, look);
    std::string out;
    if (m.blend && look.surface == Look::Surface::mesh)
        out = without_placement(plan, look, m.blend->map);
    else if (wears_alpha_map(plan, look))
        out = without_placement(plan, look, m.alpha_map->map);
    if (lobe_count(m) > 1) out += without_placement(plan, look, m.specular_lobes->level);
    return out;
}

// The normal of a layer. The gradient is stretched so that it rises everywhere.
std::string normal_text(const Plan& plan, const Look& look, const Layer& layer,
                        const char* before) {
    const auto& [axis, amount, offset] = layer.mirror;
    // POV-Ray's `aoi` would go by the last normal that was displaced at the same point.
    if (layer.by_angle) return before + std::string("normal { gradient y, 0 }");
    if (amount == 0) return no_normal(plan, before);
    return fmt::format("{}normal {{ gradient {}, {}{} phase 0.5 scale 1e9{} }}", before,
                       sdl::vector(axis), number(amount),
                       in_other_scenes(plan) ? " frequency 1 ramp_wave turbulence 0" : "",
                       without_patterns(plan, look));
}

std::string texture_text(const Plan& plan, const Look& look, const Layer& layer) {
    return fmt::format("texture {{{}\n  pigment {{ ",
                       layer.note[0] != 0 ? std::string("  // ") + layer.note : "") +
           layer.pigment + " }" + normal_text(plan, look, layer, "\n  ") + "\n  " +
           finish_text(plan, layer.finish, "  ") + "\n}\n";
}

std::string tinted_pigment(const Layer& layer, const Color& tint) {
    if (!layer.filter) return color(tint, layer.passing);
    return fmt::format("rgbf <{}, {}, {}, 1>", number(tint.x), number(tint.y), number(tint.z));
}

// The pigment and the finish of a tinted layer whose declarations end in `name`.
std::string tinted_text(const Plan& plan, const Look& look, const Layer& layer,
                        const std::string& name, const Color& tint) {
    return fmt::format("pigment {{ {} }}{} finish {{ {} }}", tinted_pigment(layer, tint),
                       normal_text(plan, look, layer, " "), identifier(plan, "Finish", name));
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
                                          texture_text(plan, look, layers[i]);
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
                   ? fmt::format("texture {{ {} }}", tinted_text(plan, look, layers[i], name, tint))
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

// Declares the texture of frosted glass where light goes in, and as NAME__inside the other, by
// which rays go out: where that one is clear their number does not grow again.
std::string declare_frosted(const Plan& plan, const Look& look, const std::string& name) {
    std::string out, entries;
    for (const std::vector<Layer>& layers : frosted_layers(plan, look)) {
        const std::string part =
            fmt::format("{}__way{}", name, std::ranges::count(entries, '[') + 1);
        out += "#declare " + part + " =\n";
        for (const Layer& layer : layers) out += texture_text(plan, look, layer);
        entries += fmt::format("{}[1 {}]", entries.empty() ? "" : " ", part);
    }
    out += "#declare " + name + " =\ntexture { average texture_map { " + entries + " } }\n";
    out += "#declare " + name + "__inside =\n";
    for (const Layer& layer : layers_of(plan, look)) out += texture_text(plan, look, layer);
    return out;
}

// Declares the textures of the look's lobes and, as `name`, their mixture.
std::string declare_lobes(const Plan& plan, const Look& look, const std::string& name,
                          const Color* tint) {
    const Material& m = material_of(plan, look);
    if (frosted(plan, look)) return declare_frosted(plan, look, name);
    const std::size_t count = lobe_count(m);
    std::string out, entries;
    for (std::size_t k = 0; k < count; ++k) {
        const std::string part = count == 1 ? name : fmt::format("{}__lobe{}", name, k + 1);
        out += "#declare " + part + " =\n";
        if (tint != nullptr)
            out += tinted_layers(plan, look, k, *tint);
        else
            for (const Layer& layer : layers_of(plan, look, k))
                out += texture_text(plan, look, layer);
        const double last = double(std::max<std::size_t>(1, count - 1));
        if (m.specular_lobes && !m.specular_lobes->mixed)
            entries += fmt::format("{}[{} {}] [{} {}]", k == 0 ? "" : " ",
                                   number(std::max(0.0, (double(k) - lobe_reach) / last)), part,
                                   number(std::min(1.0, (double(k) + lobe_reach) / last)), part);
        else
            entries += fmt::format("{}[{} {}]", k == 0 ? "" : " ", number(double(k) / last), part);
    }
    if (count > 1)
        out += "#declare " + name + " =\n" +
               pattern_text(plan, look, m.specular_lobes->level, entries);
    return out;
}

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
    if (!wears_alpha_map(plan, look)) return declare_lobes(plan, look, name, color);
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
    return lobe_count(m) == 1 && !m.alpha_map && !m.blend && !frosted(plan, look) &&
           layers_of(plan, look).size() == 1;
}

std::string single_texture(const Plan& plan, const Look& look, const Color& tint) {
    return tinted_text(plan, look, layers_of(plan, look)[0], look.name, tint);
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
