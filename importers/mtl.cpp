// MTL statements -> Material.
#include "obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::obj {

namespace {

// Illumination models that let light through, by refraction or not, and those that mirror
// ("Wavefront Advanced Visualizer 4.0, appendix B2: Material Library File", illum).
bool is_glass(int illum) { return illum == 4 || illum == 6 || illum == 7 || illum == 9; }
bool is_mirror(int illum) { return illum == 3 || illum == 5 || illum == 8; }
bool traces_reflection(int illum) { return is_mirror(illum) || (is_glass(illum) && illum != 9); }

// Relative luminance of linear Rec. 709 RGB (ITU-R BT.709).
float luma(const Color& c) { return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z; }

// True when the channels differ by more than a tenth of the largest.
bool is_coloured(const Color& c) {
    const auto [least, most] = std::minmax({c.x, c.y, c.z});
    return most - least > 0.1F * most;
}

struct Maker {
    const MtlEntry& entry;
    const MtlValues& values;
    Losses& losses;
    Material material = {};

    void lose(Index line, const std::string& what) {
        losses.push_back({place_of(entry.file, line),
                          fmt::format("material '{}': {}", printable(entry.name), what)});
    }

    int illum() const {
        if (values.illum) return *values.illum;
        return values.specular && values.shininess ? 2 : 1;
    }

    // The highlight's (N.H)^Ns is as wide as Phong's (R.V)^(Ns / 4): the angle between R and V is
    // twice that between N and H (Fisher and Woo 1994, "R.E versus N.H Specular Highlights").
    void highlight() {
        const Color ks = values.specular.value_or(Color(0));
        material.specular = luma(ks);
        if (values.shininess) material.shininess = std::max(1.0F, *values.shininess / 4);
        if (is_coloured(ks))
            lose(entry.line, "the coloured highlight (Ks) becomes white of the same luminance");
    }

    // The format leaves the ambient light to the program and many write Ka 1 1 1, so a tenth of Ka
    // is taken. It multiplies the pigment, as everywhere in the scene, and not Kd's own colour.
    void phong() {
        material.diffuse = 1;
        material.specular = 0;
        material.ambient = values.ambient.value_or(Color(1)) * 0.1F;
        const int model = illum();
        if (model == 0) return constant();
        if (model == 10) lose(entry.line, "illum 10 is taken as 2");
        if (model != 1) highlight();
        const Color ks = values.specular.value_or(Color(0));
        if (is_mirror(model))
            material.reflection = ks;
        else if (traces_reflection(model) && luma(ks) > 0)
            lose(entry.line, fmt::format("the mirror reflection of illum {} is left out", model));
    }

    // illum 0: the colour as it is. Emission does not take a texture along, ambience does.
    void constant() {
        const bool plain = std::holds_alternative<std::monostate>(material.pattern);
        material.diffuse = 0;
        material.ambient = plain ? Color(0) : Color(1);
        if (plain) material.emission += material.color;
    }

    // Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", relate a
    // Blinn-Phong exponent to a roughness by alpha^2 = 2 / (Ns + 2); alpha is its square in glTF.
    void metallic_roughness() {
        const float ns = values.shininess.value_or(30.0F);
        const float roughness = values.roughness.value_or(std::pow(2 / (ns + 2), 0.25F));
        const float ior = values.ior.value_or(1.0F);
        const float r = (ior - 1) / (ior + 1);
        material.ambient = values.ambient.value_or(Color(1)) * 0.1F;
        set_metallic_roughness(material, values.metallic.value_or(0.0F), roughness,
                               ior > 1 ? r * r : 0.04F);
    }

    void transparency() {
        material.opacity = values.dissolve.value_or(1.0F);
        if (material.opacity < 1 && is_glass(illum()) && values.ior)
            material.ior = std::max(*values.ior, 1.0F);
        const Color filter = values.filter.value_or(Color(1));
        if (material.opacity < 1 && is_coloured(filter))
            lose(entry.line, "the colour of what shines through (Tf) is ignored");
    }
};

// The texture of map_Kd; every other map is a Loss, but map_Ka where it only repeats map_Kd, as
// ambience takes its colour from the pigment.
TextureFrame read_maps(Maker& maker, TextureReader& textures) {
    const Statement* base = nullptr;
    for (const Statement& map : maker.values.maps)
        if (map.key == "map_kd") base = &map;
    std::vector<std::string> told;
    for (const Statement& map : maker.values.maps) {
        if (map.key == "map_kd" || std::ranges::find(told, map.key) != told.end()) continue;
        if (map.key == "map_ka" && base &&
            parse_map(map.operands).file == parse_map(base->operands).file)
            continue;
        told.push_back(map.key);
        maker.lose(map.line, fmt::format("{} is ignored", printable(map.word)));
    }
    if (!base) return {};
    const MapOperands operands = parse_map(base->operands);
    const Index texture = textures.read(maker.entry, *base, operands);
    if (texture == no_index) return {};
    for (const std::string& option : operands.ignored)
        maker.lose(base->line, fmt::format("option {} of map_Kd is ignored", option));
    maker.material.pattern = ImageMap{.texture = texture};
    const Color kd = maker.values.diffuse.value_or(Color(1));
    maker.material.color = kd == Color(0) ? Color(1) : kd;  // black would hide the texture
    return operands.frame;
}

Material make_material(const MtlEntry& entry, TextureReader& textures, TextureFrame& frame,
                       Losses& losses) {
    const MtlValues values = read_values(entry, losses);
    Maker maker = {.entry = entry, .values = values, .losses = losses};
    maker.material.name = entry.name;
    maker.material.color = values.diffuse.value_or(Color(0.8F));
    maker.material.emission = values.emission.value_or(Color(0));
    frame = read_maps(maker, textures);
    if (values.roughness || values.metallic)
        maker.metallic_roughness();
    else
        maker.phong();
    maker.transparency();
    return maker.material;
}

std::unordered_map<std::string, const MtlEntry*> by_name(const std::vector<MtlEntry>& entries,
                                                         Losses& losses) {
    std::unordered_map<std::string, const MtlEntry*> result;
    for (const MtlEntry& entry : entries)
        if (!result.try_emplace(entry.name, &entry).second)
            losses.push_back({place_of(entry.file, entry.line),
                              fmt::format("material '{}' is defined again; the first is used",
                                          printable(entry.name))});
    return result;
}

}  // namespace

std::vector<TextureFrame> build_materials(const Model& model, const std::vector<MtlEntry>& entries,
                                          const std::filesystem::path& file, Imported& result) {
    const auto known = by_name(entries, result.losses);
    TextureReader textures(file, result.scene, result.losses);
    std::vector<TextureFrame> frames;
    std::size_t missing = 0;
    Named first_missing;
    for (const Named& used : model.materials) {
        const auto found = known.find(used.name);
        Material material = {.name = used.name};
        TextureFrame& frame = frames.emplace_back();
        if (found != known.end())
            material = make_material(*found->second, textures, frame, result.losses);
        else if (missing++ == 0)
            first_missing = used;
        result.scene.materials.push_back(std::move(material));
    }
    if (missing) {
        std::string what = fmt::format("material '{}' is not defined; it gets default values",
                                       printable(first_missing.name));
        if (missing > 1) what += fmt::format(" (and {} more)", missing - 1);
        result.losses.push_back({place_of(model.file, first_missing.line), what});
    }
    return frames;
}

}  // namespace penumbra::obj
