// MTL statements -> Material.
#include "mtl_material.h"
#include "phong.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::obj {

namespace {

// Illumination models that let light through, by refraction or not, and those that mirror
// ("Wavefront Advanced Visualizer 4.0, appendix B2: Material Library File", illum).
bool is_glass(int illum) { return illum == 4 || illum == 6 || illum == 7 || illum == 9; }
bool is_mirror(int illum) { return illum == 3 || illum == 5 || illum == 8; }
bool has_fresnel(int illum) { return illum == 5 || illum == 7; }

// Relative luminance of linear Rec. 709 RGB (ITU-R BT.709).
float luma(const Color& c) { return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z; }

// True when the channels differ by more than a tenth of the largest.
bool is_coloured(const Color& c) {
    const auto [least, most] = std::minmax({c.x, c.y, c.z});
    return most - least > 0.1F * most;
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

int MaterialMaker::illum() const {
    if (values.illum) return *values.illum;
    return values.specular && values.shininess ? 2 : 1;
}

bool MaterialMaker::is_pbr() const {
    const auto names_polish = [](const Statement& map) {
        return map.key == "map_pr" || map.key == "map_pm";
    };
    return values.roughness || values.metallic || std::ranges::any_of(values.maps, names_polish);
}

// The highlight's (N.H)^Ns is as wide as Phong's (R.V)^(Ns / 4): the angle between R and V is
// twice that between N and H (Fisher and Woo 1994, "R.E versus N.H Specular Highlights").
void MaterialMaker::highlight() {
    const Color ks = values.specular.value_or(Color(0));
    material.specular = luma(ks);
    if (values.shininess) material.shininess = std::max(1.0F, *values.shininess / 4);
    if (is_coloured(ks))
        lose(entry.line, "the coloured highlight (Ks) becomes white of the same luminance");
}

// The format leaves the ambient light to the program and many write Ka 1 1 1, so a tenth of Ka
// is taken. It multiplies the pigment, as everywhere in the scene, and not Kd's own colour.
void MaterialMaker::phong() {
    lay_base();
    material.diffuse = 1;
    material.specular = 0;
    material.ambient = values.ambient.value_or(Color(1)) * 0.1F;
    const int model = illum();
    if (model == 0) return constant();
    if (model == 10) lose(entry.line, "illum 10 is taken as 2");
    if (model == 1) return;
    highlight();
    mirror();
    specular_images();
}

// illum 0: the colour as it is. Emission does not take a texture along, ambience does.
void MaterialMaker::constant() {
    const bool plain = !base && !material.emission_map;
    material.diffuse = 0;
    material.ambient = plain ? Color(0) : Color(1);
    if (plain) material.emission += material.color;
}

// What only mirrors if it is glass, but is opaque, is what some programs write for any surface.
void MaterialMaker::mirror() {
    const int model = illum();
    const Color ks = values.specular.value_or(Color(0));
    const bool glass = is_glass(model) && model != 9;
    if (is_mirror(model) || (glass && material.opacity < 1))
        material.reflection = ks;
    else if (glass && luma(ks) > 0)
        lose(entry.line, fmt::format("the mirror reflection of illum {} is left out", model));
    if (!has_fresnel(model) || material.reflection == Color(0)) return;
    if (is_mirror(model) && material.opacity < 1) {
        lose(entry.line,
             fmt::format("the Fresnel reflection of illum {} is replaced by Ks", model));
        return;
    }
    material.fresnel = true;
    material.ior = values.ior.value_or(1) > 1 ? *values.ior : 1.5F;
}

// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", relate a
// Blinn-Phong exponent to a roughness by alpha^2 = 2 / (Ns + 2); alpha is its square in glTF.
void MaterialMaker::metallic_roughness() {
    const float ns = values.shininess.value_or(30.0F);
    const float ior = values.ior.value_or(1.0F), r = (ior - 1) / (ior + 1);
    Polished polished = {.metallic = values.metallic.value_or(0.0F),
                         .roughness = values.roughness.value_or(std::pow(2 / (ns + 2), 0.25F)),
                         .f0 = ior > 1 ? r * r : 0.04F};
    material.ambient = values.ambient.value_or(Color(1)) * 0.1F;
    if (polish_images(polished)) return;
    lay_base();
    set_metallic_roughness(material, polished.metallic, polished.roughness, polished.f0);
}

void MaterialMaker::transparency() {
    if (material.opacity == 1) return;
    if (is_glass(illum()) && values.ior) material.ior = std::max(*values.ior, 1.0F);
    const Color tf = values.filter.value_or(Color(1));
    if (is_coloured(tf)) filter(tf);
}

// Tf tints what shines through; here that is the pigment P, by 1 - t + t P. A body without a colour
// of its own can have Tf as its pigment, of others the t is taken that comes nearest.
void MaterialMaker::filter(const Color& tf) {
    if (!base && material.color == Color(0)) {
        material.color = tf;
        material.transmission = 1;
        material.diffuse = 0;
        material.ambient = Color(0);
        return;
    }
    const Color lacks = Color(1) - material.color, wanted = Color(1) - tf;
    const float most = lacks.dot(lacks);
    if (most > 0) material.transmission = std::clamp(lacks.dot(wanted) / most, 0.0F, 1.0F);
    const Color error = lacks * material.transmission - wanted;
    if (material.transmission == 0)
        lose(entry.line, "the colour of what shines through (Tf) is ignored");
    else if (error.length() > 0.02F)
        lose(entry.line, "Tf is approximate: what shines through is tinted by Kd");
}

// Pc, as the clear coat of glTF: a second surface with the reflectance of glass.
void MaterialMaker::coat() {
    const float amount = values.coat.value_or(0.0F);
    if (amount == 0) return;
    const double f0 = 0.04 * double(amount), roughness = double(values.coat_roughness.value_or(0));
    lose(entry.line, "Pc is approximate: its mirror image is added, the stronger highlight stays");
    if (material.gloss) {
        for (Lobe& lobe : material.gloss->lobes) add_coat(lobe, f0, roughness);
        return;
    }
    Lobe lobe = {material.specular, material.shininess, material.reflection};
    add_coat(lobe, f0, roughness);
    material.specular = lobe.specular;
    material.shininess = lobe.shininess;
    material.reflection = lobe.reflection;
}

void MaterialMaker::make() {
    material.name = entry.name;
    material.color = values.diffuse.value_or(Color(0.8F));
    material.emission = values.emission.value_or(Color(0));
    material.opacity = values.dissolve.value_or(1.0F);
    color_image();
    coverage_image();
    emission_image();
    if (is_pbr())
        metallic_roughness();
    else
        phong();
    normal_image();
    transparency();
    coat();
    name_other_maps();
}

void MaterialTally::add(const MtlEntry& entry, Index line, const std::string& what) {
    const auto [found, fresh] = by_what.try_emplace(what, all.size());
    if (fresh) {
        all.push_back({place_of(entry.file, line), entry.name, what, 0, &entry});
        return;
    }
    Told& told = all[found->second];
    if (std::exchange(told.last, &entry) != &entry) ++told.others;
}

void MaterialTally::append_to(Losses& losses) const {
    for (const Told& told : all) {
        std::string what = fmt::format("material '{}': {}", printable(told.material), told.what);
        if (told.others > 0)
            what +=
                fmt::format(" (and {} more material{})", told.others, told.others == 1 ? "" : "s");
        losses.push_back({told.place, what});
    }
}

namespace {

// What becomes part of a Material.
constexpr auto drawn = std::to_array<std::string_view>(
    {"map_kd", "map_d", "map_ke", "norm", "map_ks", "map_ns", "map_pm", "map_pr"});

void expect_images(const Model& model,
                   const std::unordered_map<std::string, const MtlEntry*>& known,
                   TextureReader& textures) {
    MaterialTally told_later;
    for (const Named& used : model.materials) {
        const auto found = known.find(used.name);
        if (found == known.end()) continue;
        for (const Statement& map : read_values(*found->second, told_later).maps)
            if (std::ranges::find(drawn, map.key) != drawn.end())
                textures.expect(*found->second, map);
    }
}

}  // namespace

void build_materials(const Model& model, const std::vector<MtlEntry>& entries,
                     const ModelFolders& folders, Imported& result) {
    const auto known = by_name(entries, result.losses);
    MaterialTally tally;
    TextureReader textures(folders, result.scene, tally);
    expect_images(model, known, textures);
    std::size_t missing = 0;
    Named first_missing;
    for (const Named& used : model.materials) {
        const auto found = known.find(used.name);
        Material material = {.name = used.name};
        if (found != known.end()) {
            const MtlEntry& entry = *found->second;
            const MtlValues values = read_values(entry, tally);
            MaterialMaker maker = {
                .entry = entry, .values = values, .textures = textures, .tally = tally};
            maker.make();
            material = std::move(maker.material);
        } else if (missing++ == 0) {
            first_missing = used;
        }
        result.scene.materials.push_back(std::move(material));
    }
    tally.append_to(result.losses);
    if (missing == 0) return;
    std::string what = fmt::format("material '{}' is not defined; it gets default values",
                                   printable(first_missing.name));
    if (missing > 1) what += fmt::format(" (and {} more)", missing - 1);
    result.losses.push_back({place_of(model.file, first_missing.line), what});
}

}  // namespace penumbra::obj
