#include "exporters/tachyon/material.h"

#include "exporters/tachyon/images.h"

#include "penumbra/light_model.h"

namespace penumbra::tachyon {

namespace {

const Color black(0), white(1);

bool grey(const Color& c) { return c.x == c.y && c.y == c.z; }

// Finds what Tachyon's textures cannot say.
struct LossNotes {
    Output& out;
    const Material& material;

    void approximated(bool lost, const std::string& what) const {
        if (lost) out.note_loss(Loss::approximated, material.name, "a material", what);
    }
    void dropped(bool lost, const std::string& what) const {
        if (lost) out.note_loss(Loss::dropped, material.name, "a material", what);
    }
};

// One colour in place of a pattern.
Color plain(Output& out, const Material& m) {
    if (std::holds_alternative<std::monostate>(m.pattern)) return m.color;
    LossNotes{out, m}.approximated(true, "the pattern becomes its mean colour");
    if (const auto* map = std::get_if<ImageMap>(&m.pattern))
        return m.color * mean(out.scene.textures[map->texture]);
    if (const auto* checker = std::get_if<Checker>(&m.pattern))
        return (checker->colors[0] + checker->colors[1]) * 0.5F;
    const auto& noise = std::get<Noise>(m.pattern);
    return (noise.colors[0] + noise.colors[1]) * 0.5F;
}

// Highlight and mirror; of many lobes the one in the middle.
SpecularLobe lobe_of(const Material& m) {
    SpecularLobe lobe = {m.specular, m.shininess, m.reflection};
    if (m.specular_lobes) lobe = m.specular_lobes->lobes[m.specular_lobes->lobes.size() / 2];
    // Schlick 1994: Fresnel's term at normal incidence.
    const float root = (m.ior - 1) / (m.ior + 1);
    if (m.fresnel) lobe.reflection *= root * root;
    return lobe;
}

void note_losses(Output& out, const Material& m, const SpecularLobe& lobe) {
    const LossNotes note{out, m};
    const bool clear = m.opacity < 1, mirror = lobe.reflection != black;
    note.dropped(m.emission != black, "emission is left out");
    note.dropped(m.diffuse_transmission != black, "light from behind is left out");
    note.approximated(!grey(m.ambient * out.scene.ambient), "ambient light becomes grey");
    note.dropped(m.blend.has_value(), "the second look of a surface is left out");
    note.dropped(m.alpha_map.has_value(), "the alpha map is left out: the surface is whole");
    note.dropped(m.sides == Sides::front, "facets are seen from behind as well");
    note.dropped(m.normal_map.has_value(), "the normal map is dropped: Tachyon has none");
    note.approximated(m.specular_lobes.has_value(),
                      "highlight and mirror become the same all over it");
    note.approximated(!grey(lobe.reflection), "the mirror becomes grey");
    note.approximated(m.fresnel && mirror, "the mirror is no stronger in grazing light");
    note.approximated(blurs(m), "the reflection is sharp");
    note.approximated(takes_reflected(m) && mirror, "what it reflects is taken from nothing");
    note.dropped(covers(m), "the sheen is left out");
    note.dropped(m.coat.has_value(), "the clear coat is left out");
    note.approximated(m.metallic > 0 && mirror, "the mirror is not tinted by the metal");
    note.approximated(m.metallic > 0 && m.metallic < 1,
                      "highlights are those of a metal or of plastic");
    note.approximated(m.specular_color.has_value() && (mirror || lobe.specular > 0),
                      "what it reflects takes no colour of its own");
    note.approximated(m.metallic > 0.5F && lobe.specular > 0,
                      "a metal's highlight is the same for every light");
    note.approximated(clear && m.transmission > 0, "what is seen through it is not tinted");
    note.approximated(clear && m.ior != 1, "light passes straight through it");
    note.dropped(clear && m.absorption.has_value(), "absorption is left out");
}

// All but the colour.
std::string finish_of(Output& out, const Material& m) {
    const SpecularLobe lobe = lobe_of(m);
    note_losses(out, m, lobe);
    // Tachyon adds what lies behind and takes nothing off the surface's own light for it.
    std::string text = fmt::format("AMBIENT {:.6g} DIFFUSE {:.6g} SPECULAR {:.6g} OPACITY {:.6g}",
                                   m.opacity * mean(m.ambient * out.scene.ambient),
                                   m.opacity * m.diffuse, mean(lobe.reflection), m.opacity);
    const bool metal = m.metallic > 0.5F;
    if (lobe.specular > 0)
        text += fmt::format(" PHONG {} {:.6g} PHONG_SIZE {:.6g}", metal ? "METAL" : "PLASTIC",
                            metal ? lobe.specular * out.light : lobe.specular, lobe.shininess);
    return text;
}

}  // namespace

const std::string& texture_of(Output& out, Index material) {
    std::string& text = out.textures[material];
    const Material& m = out.scene.materials[material];
    if (text.empty()) text = finish_of(out, m) + " COLOR " + color(plain(out, m)) + " TEXFUNC 0";
    return text;
}

std::string texture_of(Output& out, const Plane& plane) {
    const Material& m = out.scene.materials[plane.material];
    const auto* map = std::get_if<ImageMap>(&m.pattern);
    const auto image = map != nullptr ? image_name(out, map->texture) : std::nullopt;
    if (!image) return texture_of(out, plane.material);
    const Texture& texture = out.scene.textures[map->texture];
    const LossNotes note{out, m};
    note.approximated(m.color != white, "the image is not tinted");
    note.approximated(texture.wrap_u != Wrap::repeat || texture.wrap_v != Wrap::repeat,
                      "the image repeats");
    note.approximated(true, "the image has 8 bits of linear light, and blurs with the distance");
    const PlaneFrame frame = plane_frame(plane);
    return finish_of(out, m) +
           fmt::format(" COLOR 1 1 1 TEXFUNC 9 {} CENTER {} ROTATE 0 0 0 SCALE {} {} 1 UAXIS {} "
                       "VAXIS {}",
                       *image, vector(frame.origin), 1 / map->size, 1 / map->size, vector(frame.u),
                       vector(-frame.v));  // rows of images go down
}

}  // namespace penumbra::tachyon
