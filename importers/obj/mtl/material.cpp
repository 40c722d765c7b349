// MTL statements -> Material.
#include "importers/obj/mtl/material.h"

#include "base/luminance.h"
#include "base/text/decomposed.h"
#include "base/text/utf8.h"
#include "importers/obj/mtl/maker.h"
#include "importers/obj/text/encoding.h"
#include "importers/obj/text/tally.h"
#include "importers/shared/specular_lobes.h"
#include "scene/surface/metallic_roughness.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

namespace penumbra::obj {

namespace {

// Illumination models that let light through, by refraction or not, and those that mirror
// ("Wavefront Advanced Visualizer 4.0, appendix B2: Material Library File", illum).
bool is_glass(int illum) { return illum == 4 || illum == 6 || illum == 7 || illum == 9; }
bool is_mirror(int illum) { return illum == 3 || illum == 5 || illum == 8; }
bool has_fresnel(int illum) { return illum == 5 || illum == 7; }

// True when the channels differ by more than a tenth of the largest.
bool is_coloured(const Color& c) {
    const auto [least, most] = std::minmax({c.x, c.y, c.z});
    return most - least > 0.1F * most;
}

// The spellings of a name in which OBJ and MTL files may differ: letters and marks as one character
// or as two, and another encoding than UTF-8.
std::vector<std::string> spellings_of(const std::string& name) {
    std::vector<std::string> result = {decomposed(name)};
    for (const Decoded& in : decodings(name)) result.push_back(decomposed(in.text));
    return result;
}

// Materials by their names.
struct Entries {
    using Known = std::unordered_map<std::string, const MtlEntry*>;
    const std::vector<MtlEntry>& all;
    Known exact = {}, spelled = {};

    // nullptr: there is none.
    const MtlEntry* find(const std::string& name) {
        if (const auto found = exact.find(name); found != exact.end()) return found->second;
        if (is_ascii(name)) return nullptr;
        if (spelled.empty())
            for (const MtlEntry& entry : all)
                for (const std::string& spelling : spellings_of(entry.name))
                    spelled.try_emplace(spelling, &entry);
        for (const std::string& spelling : spellings_of(name))
            if (const auto found = spelled.find(spelling); found != spelled.end())
                return found->second;
        return nullptr;
    }
};

Entries by_name(const std::vector<MtlEntry>& entries, Losses& losses) {
    Entries result = {.all = entries};
    for (const MtlEntry& entry : entries)
        if (!result.exact.try_emplace(entry.name, &entry).second)
            losses.push_back({Loss::approximated, place_of(entry.file, entry.line),
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
    const auto names_lobes = [](const Statement& map) {
        return map.key == "map_pr" || map.key == "map_pm";
    };
    return values.roughness || values.metallic || std::ranges::any_of(values.maps, names_lobes);
}

// The highlight's (N.H)^Ns is as wide as Phong's (R.V)^(Ns / 4): the angle between R and V is
// twice that between N and H (Fisher and Woo 1994, "R.E versus N.H Specular Highlights").
void MaterialMaker::highlight() {
    const Color ks = values.specular.value_or(Color(0));
    const float most = std::max({ks.x, ks.y, ks.z});
    const bool grey = ks.x == ks.y && ks.y == ks.z;
    material.specular = grey ? luminance(ks) : most;
    if (!grey) material.specular_color = ks / most;
    if (values.shininess) material.shininess = std::max(1.0F, *values.shininess / 4);
    if (is_coloured(ks))
        note_loss(Loss::approximated, entry.line,
                  "the coloured highlight (Ks) is approximate: it becomes white in grazing light");
}

// The format leaves the ambient light to the program and many write Ka 1 1 1, so a tenth of Ka
// is taken. It multiplies the pigment, as everywhere in the scene, and not Kd's own colour.
void MaterialMaker::phong() {
    lay_base();
    material.diffuse = 1;
    material.specular = 0;
    material.ambient = values.ambient.value_or(Color(1)) * ambience();
    const int model = illum();
    if (model == 0) return constant();
    if (model == 10) note_loss(Loss::approximated, entry.line, "illum 10 is taken as 2");
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
    else if (glass && luminance(ks) > 0)
        note_loss(Loss::dropped, entry.line,
                  fmt::format("the mirror reflection of illum {} is left out", model));
    if (!has_fresnel(model) || material.reflection == Color(0)) return;
    if (is_mirror(model) && material.opacity < 1) {
        note_loss(Loss::approximated, entry.line,
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
    MetallicRoughness surface = {.metallic = values.metallic.value_or(0.0F),
                                 .roughness =
                                     values.roughness.value_or(std::pow(2 / (ns + 2), 0.25F)),
                                 .f0 = ior > 1 ? r * r : 0.04F};
    material.ambient = values.ambient.value_or(Color(1)) * ambience();
    if (lobe_images(surface)) return;
    // Under lamps an index beyond 3 keeps the law of what is clear.
    const DielectricReflectance dielectric =
        illumination == Illumination::environment
            ? dielectric_reflectance(Color(surface.f0))
            : DielectricReflectance{Color(surface.f0), surface.f0};
    set_constant_lobes(material, surface.metallic, surface.roughness, dielectric, illumination,
                       base.has_value());
    lay_base();
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
        note_loss(Loss::dropped, entry.line, "the colour of what shines through (Tf) is ignored");
    else if (error.length() > 0.02F)
        note_loss(Loss::approximated, entry.line,
                  "Tf is approximate: what shines through is tinted by Kd");
}

// Pc, as the clear coat of glTF: a second surface with the reflectance of glass.
void MaterialMaker::coat() {
    const float amount = values.coat.value_or(0.0F);
    if (amount == 0) return;
    const double f0 = 0.04 * double(amount), roughness = double(values.coat_roughness.value_or(0));
    if (illumination == Illumination::environment) {
        material.coat = clear_coat(double(amount), roughness);
        return;
    }
    note_loss(Loss::approximated, entry.line,
              "Pc is approximate: its mirror image is added, the stronger highlight stays");
    if (material.specular_lobes) {
        for (SpecularLobe& lobe : material.specular_lobes->lobes) add_coat(lobe, f0, roughness);
        return;
    }
    SpecularLobe lobe = {material.specular, material.shininess, material.reflection};
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
    alpha_image();
    emission_image();
    if (is_pbr())
        metallic_roughness();
    else
        phong();
    normal_image();
    material.emission *= material.opacity;  // d is how much there is of all of it
    transparency();
    coat();
    name_other_maps();
}

void note_loss(LossTally& tally, const MtlEntry& entry, const MtlLoss& loss) {
    tally.add({loss.kind, place_of(entry.file, loss.line),
               fmt::format("material '{}': {}", printable(entry.name), loss.what)},
              {.sentence = loss.what, .thing = &entry, .subject = loss.key});
}

namespace {

std::string and_more_materials(std::size_t count) {
    return fmt::format(" (and {} more material{})", count - 1, count == 2 ? "" : "s");
}

// What becomes part of a Material.
constexpr auto drawn = std::to_array<std::string_view>(
    {"map_kd", "map_d", "map_ke", "norm", "map_ks", "map_ns", "map_pm", "map_pr"});

void expect_images(const std::vector<Named>& used, Entries& known, TextureReader& textures) {
    LossTally reported_later;
    for (const Named& material : used) {
        const MtlEntry* const entry = known.find(material.name);
        if (!entry) continue;
        for (const Statement& map : read_values(*entry, reported_later).maps)
            if (std::ranges::find(drawn, map.key) != drawn.end()) textures.expect(*entry, map);
    }
}

// Of materials that no facet has, too.
void note_files(const std::vector<MtlEntry>& entries, const TextureReader& textures,
                Imported& result) {
    std::set<std::pair<std::filesystem::path, std::string>> seen;
    for (const MtlEntry& entry : entries) {
        for (const Statement& statement : entry.statements) {
            if (!names_a_texture(statement.key)) continue;
            if (!seen.emplace(entry.from, statement.operands).second) continue;
            if (auto file = textures.file(entry, statement); !file.empty())
                result.files.push_back(std::move(file));
        }
    }
}

}  // namespace

void build_materials(const std::vector<Named>& used, const std::string& file,
                     const std::vector<MtlEntry>& entries, const ModelFolders& folders,
                     Illumination illumination, Imported& result) {
    Entries known = by_name(entries, result.losses);
    LossTally tally(and_more_materials), missing(LossTally::and_more);
    TextureReader textures(folders, result.scene, tally);
    expect_images(used, known, textures);
    note_files(entries, textures, result);
    for (const Named& named : used) {
        const MtlEntry* const entry = known.find(named.name);
        Material material = {.name = named.name};
        if (entry) {
            const MtlValues values = read_values(*entry, tally);
            MaterialMaker maker = {.entry = *entry,
                                   .values = values,
                                   .textures = textures,
                                   .tally = tally,
                                   .illumination = illumination};
            maker.make();
            material = std::move(maker.material);
        } else {
            missing.add({Loss::approximated, place_of(file, named.line),
                         fmt::format("material '{}' is not defined; it gets default values",
                                     printable(named.name))},
                        {.sentence = "is not defined"});
        }
        result.scene.materials.push_back(std::move(material));
    }
    std::ranges::copy(tally.losses(), std::back_inserter(result.losses));
    std::ranges::copy(missing.losses(), std::back_inserter(result.losses));
}

}  // namespace penumbra::obj
