// Texture statements of MTL -> the images of a Material.
#include "base/luminance.h"
#include "base/memory.h"
#include "importers/obj/mtl/maker.h"
#include "importers/obj/text/encoding.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra::obj {

namespace {

constexpr int alpha = 3;
constexpr int exponent_lobes = 8;

// The channel that -imfchan names; without it the first.
int channel_of(const MapImage& image) {
    switch (image.operands.channel) {
    case 'g': return 1;
    case 'b': return 2;
    case 'm': return alpha;
    default: return 0;
    }
}

// One channel times `factor`.
TexelSource single(const MapImage& image, const Raster& raster, int channel, float factor) {
    return {.raster = &raster,
            .channel = channel,
            .single = true,
            .factor = Color(factor * float(image.operands.gain)),
            .offset = factor * float(image.operands.base)};
}

bool laid_alike(const MapImage& a, const MapImage& b) {
    return a.operands.transform == b.operands.transform && a.operands.clamp == b.operands.clamp;
}

// The number that goes with an image; programs write 0 where they leave it to the image.
float factor_of(const std::optional<float>& number) { return number.value_or(0) > 0 ? *number : 1; }

}  // namespace

std::optional<MapImage> MaterialMaker::image(std::string_view key) {
    const Statement* found = nullptr;
    for (const Statement& map : values.maps)
        if (map.key == key) found = &map;
    if (!found) return {};
    handled.emplace_back(key);
    return textures.open(entry, *found);
}

void MaterialMaker::color_image() {
    base = image("map_kd");
    if (!base) return;
    const char channel = base->operands.channel;
    if (channel != '\0' && channel != 'l')
        note_loss(Loss::dropped, base->line,
                  fmt::format("option -imfchan of {} is ignored", printable(base->word)));
    const Color kd = values.diffuse.value_or(Color(1));
    material.color = kd == Color(0) ? Color(1) : kd;  // black would hide the texture
}

void MaterialMaker::lay_base() {
    if (!base) return;
    ImageMap map = base->laid();
    map.texture = textures.texture(*base, true);
    material.pattern = map;
}

// map_d, from the alpha of its image if there is one; without it the alpha of map_Kd, unless there
// is nothing to be seen by it.
void MaterialMaker::alpha_image() {
    const std::optional<MapImage> own = image("map_d");
    const std::optional<MapImage>& map = own ? own : base;
    if (!map) return;
    const Raster& raster = textures.raster(*map);
    const bool has_alpha = raster.channels == 2 || raster.channels == 4;
    if (!own && !has_transparency(raster)) return;
    const bool chosen = own && own->operands.channel != '\0';
    const int channel = chosen ? channel_of(*own) : has_alpha ? alpha : 0;
    TexelSource texels = single(*map, raster, channel, material.opacity);
    if (!own) {
        texels.factor = Color(material.opacity);  // -mm is about the colours
        texels.offset = 0;
    }
    const auto [least, most] = range_of(texels);
    if (!own && most <= 0) return;
    if (least == most) {
        material.opacity = std::clamp(most, 0.0F, 1.0F);
        return;
    }
    AlphaMap alpha_map = {.map = map->laid()};
    alpha_map.map.texture = textures.derived(
        *map, fmt::format("alpha {} {} {}", channel, texels.factor.x, texels.offset), false,
        [&] { return grey_of(texels); });
    material.alpha_map = alpha_map;
    material.opacity = 1;
}

void MaterialMaker::emission_image() {
    const std::optional<MapImage> map = image("map_ke");
    if (!map) return;
    if (material.emission == Color(0)) material.emission = Color(1);
    ImageMap laid = map->laid();
    laid.texture = textures.texture(*map, true);
    material.emission_map = laid;
}

void MaterialMaker::normal_image() {
    const std::optional<MapImage> map = image("norm");
    if (!map) return;
    NormalMap normal = {.map = map->laid(), .scale = float(map->operands.bump)};
    normal.map.texture = textures.texture(*map, false);
    material.normal_map = normal;
}

// map_Ks tints highlight and mirror image, which SpecularLobes does but for grazing light. map_Ns
// chooses between lobes whose exponents go from 1 to that of Ns.
void MaterialMaker::specular_images() {
    const std::optional<MapImage> color = image("map_ks"), exponent = image("map_ns");
    if (!color && !exponent) return;
    if (!opaque()) {
        for (const std::optional<MapImage>& map : {color, exponent})
            if (map)
                note_loss(
                    Loss::dropped, map->line,
                    fmt::format("{} is ignored: the surface is transparent", printable(map->word)));
        return;
    }
    SpecularLobe lobe = {.specular = material.specular,
                         .shininess = material.shininess,
                         .reflection = material.reflection};
    SpecularLobes specular_lobes;
    if (color) {
        const Color ks = values.specular.value_or(Color(0));
        if (ks == Color(0)) lobe.specular = 1;
        if (material.specular_color) {
            lobe.specular = luminance(ks);
            material.specular_color.reset();
            note_loss(
                Loss::approximated, color->line,
                fmt::format("the colour of Ks is left out beside {}", printable(color->word)));
        }
        specular_lobes.color = color->laid();
        specular_lobes.color.texture = textures.texture(*color, true);
        material.metallic = 1;
        note_loss(Loss::approximated, color->line,
                  fmt::format("{} is approximate: the highlight is white in grazing light",
                              printable(color->word)));
    }
    const int lobes = exponent ? exponent_lobes : 1;
    for (int i = 1; i <= lobes; ++i) {
        specular_lobes.lobes.push_back(lobe);
        if (lobes > 1)
            specular_lobes.lobes.back().shininess =
                std::max(1.0F, lobe.shininess * float(i - 1) / float(lobes - 1));
    }
    if (exponent) {
        specular_lobes.level = exponent->laid();
        specular_lobes.level.texture = textures.texture(*exponent, false);
        note_loss(Loss::approximated, exponent->line,
                  fmt::format("{}: mixed from {} Phong lobes", printable(exponent->word), lobes));
    }
    material.specular_lobes = std::move(specular_lobes);
}

void MaterialMaker::flatten(const std::optional<MapImage>& map, TexelSource& source,
                            const char* why) {
    if (!map || !source.raster) return;
    if (!constant_of(source))
        note_loss(Loss::approximated, map->line,
                  fmt::format("{} is replaced by its mean: {}", printable(map->word), why));
    source = {.factor = mean_of(source)};
}

bool MaterialMaker::lobe_images(MetallicRoughness& surface) {
    const std::optional<MapImage> metal = image("map_pm"), rough = image("map_pr");
    if (!metal && !rough && !base) return false;
    LobeMaps maps{.illumination = illumination};
    maps.base.factor = material.color;
    maps.metallic.factor = Color(surface.metallic);
    maps.roughness.factor = Color(surface.roughness);
    maps.specular.factor = Color(surface.f0);
    if (metal)
        maps.metallic =
            single(*metal, textures.raster(*metal), channel_of(*metal), factor_of(values.metallic));
    if (rough)
        maps.roughness = single(*rough, textures.raster(*rough), channel_of(*rough),
                                factor_of(values.roughness));
    Raster ranged;
    if (base) {
        maps.base.raster = &textures.raster(*base);
        maps.base.srgb = true;
        if (base->operands.is_ranged()) {
            const MemoryClaim claim(maps.base.raster->data.size(), base->file.string());
            ranged = remapped(*maps.base.raster, base->operands.base, base->operands.gain);
            maps.base.raster = &ranged;
        }
    }
    const MapImage& frame = base ? *base : metal ? *metal : *rough;
    const bool joined = !keeps_base(maps);
    for (const auto& [map, source] :
         {std::pair(&metal, &maps.metallic), std::pair(&rough, &maps.roughness)}) {
        if (!opaque()) flatten(*map, *source, "the surface is transparent");
        if (joined && *map && !laid_alike(**map, frame))
            flatten(*map, *source, "it is laid in another way than the first image");
    }
    if (has_lobe_maps(maps) || (opaque() && dulls_base(maps))) {
        bake(maps, frame, rough ? *rough : frame);
        return true;
    }
    surface.metallic = constant_of(maps.metallic)->x;
    surface.roughness = constant_of(maps.roughness)->x;
    return false;
}

void MaterialMaker::bake(LobeMaps& maps, const MapImage& frame, const MapImage& of_level) {
    maps.wrap_u = maps.wrap_v = frame.operands.clamp ? Wrap::clamp : Wrap::repeat;
    maps.place = frame.file.string();
    const bool plain = keeps_base(maps), mixed = has_lobe_maps(maps);
    LobeImages images = bake_specular_lobes(maps);
    std::string key;
    for (const TexelSource* source : {&maps.base, &maps.metallic, &maps.roughness, &maps.specular})
        if (!plain || source != &maps.base)
            key += fmt::format(" {} {} {} {} {} {}", source->factor.x, source->factor.y,
                               source->factor.z, source->offset, source->channel,
                               source->raster != nullptr);
    for (const char* word : {"map_pm", "map_pr"})
        for (const Statement& map : values.maps)
            if (map.key == word) key += ' ' + map.operands;
    const auto keep = [&](const MapImage& image, const char* use, Raster& raster, bool srgb) {
        if (raster.texels() == 0) return no_index;
        return textures.derived(image, use + key, srgb, [&] { return std::move(raster); });
    };
    ImageMap scattered = frame.laid();
    scattered.texture = keep(frame, "scattered", images.scattered, true);
    SpecularLobes specular_lobes = {
        .color = frame.laid(), .level = of_level.laid(), .lobes = images.lobes};
    specular_lobes.color.texture = keep(frame, "reflected", images.reflected, true);
    specular_lobes.level.texture = keep(of_level, "level", images.level, false);
    lay_specular_lobes(material, std::move(specular_lobes), scattered, {.f0 = maps.specular.factor},
                       illumination);
    if (plain) lay_base();
    if (!mixed) return;
    note_loss(Loss::approximated, entry.line,
              fmt::format("metallic and roughness images: mixed from {} Phong lobe{}",
                          images.lobes.size(), images.lobes.size() == 1 ? "" : "s"));
}

// map_Ka that only repeats map_Kd needs none of its own, as ambience takes its colour from the
// pigment.
void MaterialMaker::name_other_maps() {
    for (const Statement& map : values.maps) {
        if (std::ranges::find(handled, map.key) != handled.end()) continue;
        if (map.key == "map_ka" && base && parse_map(map.operands).file == base->operands.file)
            continue;
        handled.push_back(map.key);
        const bool bump = map.key == "bump" || map.key == "map_bump";
        note_loss(Loss::dropped, map.line,
                  fmt::format("{} is ignored{}", printable(map.word),
                              bump ? ": it gives heights, norm would give normals" : ""));
    }
}

}  // namespace penumbra::obj
