// Metalness and roughness, or specular and glossiness -> highlight, mirror, scattering and
// SpecularLobes.
#include "importers/gltf/material/material_reader.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::gltf {
namespace {

using Map = MaterialReader::Map;

constexpr const char* specular_glossiness = "KHR_materials_pbrSpecularGlossiness";

// An image and what of LobeMaps comes from it.
struct Input {
    Map map = {};
    std::string name = {};
    bool srgb = false;
    std::vector<TexelSource*> parts = {};
};

// The maps of a material and the images they come from, the base colour's not among them.
struct Plan {
    MaterialReader& read;
    LobeMaps maps = {};
    std::vector<Input> inputs = {};

    void metallic_roughness();
    void glossiness();
    void specular();
    void add(const TextureInfo& info, const std::string& name, bool srgb,
             std::vector<TexelSource*> parts);
    void flatten(Input& input, const std::string& why);
    void flatten_all(const std::string& why);
    void flatten_even();
    bool is_even(const Input& input) const;
    bool even_on_any();
    const Map* frame() const;
    void align();
    void make_constant();
    void bake();
    BakedLobes baked(const Map& laid, const Map& level);
    std::string key(const Map& laid) const;
    const char* subject() const;
};

void Plan::add(const TextureInfo& info, const std::string& name, bool srgb,
               std::vector<TexelSource*> parts) {
    Input input = {.map = read.find(info, name, Loss::approximated),
                   .name = name,
                   .srgb = srgb,
                   .parts = std::move(parts)};
    if (input.map.texture < 0) return;
    for (TexelSource* part : input.parts) {
        part->raster = raster_of(read.reader, input.map.texture);
        part->srgb = srgb;
    }
    inputs.push_back(std::move(input));
    if (!inputs.back().map.is_laid()) flatten(inputs.back(), "");
}

// Takes the mean of an image in its place; `why` is empty where that was said.
void Plan::flatten(Input& input, const std::string& why) {
    bool varies = false;
    for (TexelSource* part : input.parts) {
        const TexelSource source = read.as_shown(*part, input.map);
        const auto even = even_of(source);
        varies = varies || !even;
        *part = {.factor = even ? *even : mean_of(source)};
    }
    if (varies && read.trial != nullptr) read.trial->averaged = true;
    if (varies && !why.empty())
        read.note_mean(fmt::format("{} is replaced by its mean over what the facets show: {}",
                                   input.name, why));
    input.map.state = Map::State::constant;
}

void Plan::flatten_all(const std::string& why) {
    for (Input& input : inputs)
        if (input.map.is_laid()) flatten(input, why);
}

// Where all that the facets show of an image is alike, it need not be laid.
void Plan::flatten_even() {
    for (Input& input : inputs)
        if (input.map.is_laid() && is_even(input)) flatten(input, "");
}

bool Plan::is_even(const Input& input) const {
    return std::ranges::all_of(input.parts, [&](const TexelSource* part) {
        return even_of(read.as_shown(*part, input.map)).has_value();
    });
}

// Does any primitive show but one value of each image? Without an image of the base colour it then
// needs none at all.
bool Plan::even_on_any() {
    if (read.base.is_laid()) return false;
    bool any = false;
    for (const tinygltf::Primitive* primitive : read.reader.cache.wearers(read.index)) {
        read.alone = primitive;
        any = any || std::ranges::all_of(inputs, [&](const Input& input) {
                  return !input.map.is_laid() || is_even(input);
              });
    }
    read.alone = nullptr;
    return any;
}

void Plan::metallic_roughness() {
    const auto& pbr = read.source.pbrMetallicRoughness;
    const auto& given = pbr.metallicRoughnessTexture;
    maps.metallic = {.channel = 2, .single = true, .factor = Color(float(pbr.metallicFactor))};
    maps.roughness = {.channel = 1, .single = true, .factor = Color(float(pbr.roughnessFactor))};
    const DielectricReflectance dielectric = read.dielectric();
    maps.specular.factor = dielectric.f0;
    maps.white = dielectric.white;
    const TextureInfo info = texture_info(given.index, given.texCoord, given.extensions);
    std::vector<TexelSource*> parts = {&maps.metallic, &maps.roughness};
    if (read.look == MaterialReader::Look::clear || read.all_metal) {
        maps.metallic = {.factor = Color(read.all_metal ? 1.0F : 0.0F)};
        parts = {&maps.roughness};
    }
    // Without its image, whose factors are mostly 1, it would all be metal.
    if (read.textured && info.texture >= 0 && raster_of(read.reader, info.texture) == nullptr)
        maps.metallic.factor = Color(0);
    add(info, "metallicRoughnessTexture", false, std::move(parts));
    specular();
}

// KHR_materials_specular: its two images cannot both be laid, as they are not one.
void Plan::specular() {
    const auto* given = read.extension("KHR_materials_specular");
    if (given == nullptr) return;
    const TextureInfo color = texture_info(*given, "specularColorTexture");
    const TextureInfo strength = texture_info(*given, "specularTexture");
    if (color.texture >= 0) {
        add(color, "specularColorTexture", true, {&maps.specular});
        TexelSource mean = {.channel = 3};
        const std::size_t before = inputs.size();
        add(strength, "specularTexture", false, {&mean});
        if (inputs.size() == before) return;
        if (inputs.back().map.is_laid())
            flatten(inputs.back(), "there is a specularColorTexture too");
        maps.specular.factor *= mean.factor;
        *maps.white *= mean.factor.x;
        inputs.pop_back();
    } else {
        maps.specular.channel = 3;
        add(strength, "specularTexture", false, {&maps.specular});
    }
}

void Plan::glossiness() {
    const auto& given = *read.extension(specular_glossiness);
    maps.metallic.factor = Color(0);
    maps.specular.factor = color_of(numbers(given, "specularFactor", {1, 1, 1}));
    maps.roughness = {
        .channel = 3, .factor = Color(-float(number(given, "glossinessFactor", 1))), .offset = 1};
    add(texture_info(given, "specularGlossinessTexture"), "specularGlossinessTexture", true,
        {&maps.specular, &maps.roughness});
}

// Which image says how those that are made of several are laid.
const Map* Plan::frame() const {
    if (read.base.is_laid()) return &read.base;
    for (const Input& input : inputs)
        if (input.map.is_laid()) return &input.map;
    return nullptr;
}

// Images that are laid in another way than the first cannot be joined with it.
void Plan::align() {
    if (keeps_base(maps)) return;
    const Map* first = frame();
    const Texture sampling = frame_of(read.reader, first->texture);
    for (Input& input : inputs) {
        if (!input.map.is_laid()) continue;
        const Texture own = frame_of(read.reader, input.map.texture);
        if (input.map.texcoord != first->texcoord || input.map.laid != first->laid ||
            own.wrap_u != sampling.wrap_u || own.wrap_v != sampling.wrap_v)
            flatten(input, "it is laid in another way than the base colour's");
    }
}

void Plan::make_constant() {
    DielectricReflectance dielectric = *reflectance_of(maps);
    if (has_lobe_maps(maps)) {
        dielectric.metal = 0;
        read.note_loss(Loss::approximated, "what it reflects is not tinted by the base colour's "
                                           "image: the surface is transparent");
    }
    set_constant_lobes(read.material, constant_of(maps.metallic)->x, constant_of(maps.roughness)->x,
                       dielectric, maps.illumination,
                       maps.base.raster != nullptr || read.has_vertex_colors());
    read.lay_base();
}

std::string Plan::key(const Map& laid) const {
    const auto text = [](const Color& c) { return fmt::format("{} {} {}", c.x, c.y, c.z); };
    std::string key;
    if (!keeps_base(maps))
        key = key_of(read.reader, laid.texture) + ' ' + text(read.material.color);
    for (const TexelSource* source : {&maps.metallic, &maps.roughness, &maps.specular})
        key += fmt::format(", {} {}", source->raster != nullptr, text(source->factor));
    if (maps.white) key += fmt::format(", {}", *maps.white);
    for (const Input& input : inputs) key += ", " + key_of(read.reader, input.map.texture);
    return key;
}

// `level` is the image that has the roughness, if any.
BakedLobes Plan::baked(const Map& laid, const Map& level) {
    const std::string name = key(laid);
    const auto known = read.reader.cache.baked_lobes.find(name);
    if (known != read.reader.cache.baked_lobes.end()) return known->second;

    const Texture sampling = frame_of(read.reader, laid.texture);
    maps.wrap_u = sampling.wrap_u;
    maps.wrap_v = sampling.wrap_v;
    maps.bilinear = sampling.bilinear;
    maps.place = read.reader.document.place(fmt::format("/textures/{}", laid.texture));
    LobeImages images = bake_specular_lobes(maps);
    const auto keep = [&](const Map& map, const char* use, Raster& raster) {
        if (raster.texels() == 0) return no_index;
        return derived_texture(read.reader, map.texture, fmt::format("{} {}", use, name),
                               use[0] != 'l', [&] { return std::move(raster); });
    };
    BakedLobes made = {.scattered = keep(laid, "scattered", images.scattered)};
    made.specular_lobes.color.texture = keep(laid, "reflected", images.reflected);
    made.specular_lobes.level.texture = keep(level, "level", images.level);
    made.specular_lobes.lobes = std::move(images.lobes);
    return read.reader.cache.baked_lobes[name] = made;
}

void Plan::bake() {
    // The images move when others are made.
    const bool mixed = has_lobe_maps(maps);
    const DielectricReflectance dielectric =
        reflectance_of(maps).value_or(dielectric_reflectance(maps.specular.factor, maps.white));
    const auto of_roughness = std::find_if(inputs.begin(), inputs.end(), [&](const Input& input) {
        return std::find(input.parts.begin(), input.parts.end(), &maps.roughness) !=
               input.parts.end();
    });
    const Map& laid = *frame();
    const Map& level = of_roughness == inputs.end() ? laid : of_roughness->map;
    const BakedLobes lobe = baked(laid, level);

    SpecularLobes specular_lobes = lobe.specular_lobes;
    specular_lobes.color.transform = laid.laid.transform;
    specular_lobes.level.transform = level.laid.transform;
    const std::size_t lobes = specular_lobes.lobes.size();
    ImageMap scattered = laid.laid;
    scattered.texture = lobe.scattered;
    lay_specular_lobes(read.material, std::move(specular_lobes), scattered, dielectric,
                       maps.illumination);
    if (read.material.specular_lobes && read.material.specular_lobes->level.texture != no_index)
        read.note_set(level, [](Material& m) -> ImageMap& { return m.specular_lobes->level; });
    if (scattered.texture == no_index) read.lay_base();
    if (!mixed) return;
    read.note_loss(Loss::approximated, fmt::format("{} texture: mixed from {} Phong lobe{}",
                                                   subject(), lobes, lobes == 1 ? "" : "s"));
}

const char* Plan::subject() const {
    if (inputs.empty()) return "base colour";
    if (inputs.front().name == "specularGlossinessTexture") return "specular-glossiness";
    return inputs.front().name == "metallicRoughnessTexture" ? "metallic-roughness" : "specular";
}

}  // namespace

// Reflectance at normal incidence: Schlick's F0 of KHR_materials_ior, of which 0 stands for an
// infinite index, scaled as KHR_materials_specular says.
DielectricReflectance MaterialReader::dielectric() const {
    double f0 = 0.04;
    if (const auto* ior = extension("KHR_materials_ior")) {
        const double n = number(*ior, "ior", 1.5);
        f0 = std::pow((n - 1) / (n + 1), 2);
    }
    const auto* specular = extension("KHR_materials_specular");
    if (specular == nullptr) return dielectric_reflectance(Color(float(f0)));
    const auto tint = numbers(*specular, "specularColorFactor", {1, 1, 1});
    const double strength = number(*specular, "specularFactor", 1);
    Color result;
    for (std::size_t i = 0; i < 3; ++i)
        result[int(i)] = float(std::min(f0 * tint[i], 1.0) * strength);
    const double most = std::max({1.0, tint[0], tint[1], tint[2]});
    return dielectric_reflectance(result, float(std::min(f0 * most, 1.0) * strength));
}

TexelSource MaterialReader::metallic_roughness_source(int channel) {
    const auto& given = source.pbrMetallicRoughness.metallicRoughnessTexture;
    const TextureInfo info = texture_info(given.index, given.texCoord, given.extensions);
    TexelSource texels = {.channel = channel, .single = true};
    if (!textured || info.texture < 0) return texels;
    texels.raster = raster_of(reader, info.texture);
    if (texels.raster == nullptr && channel == 2) texels.factor = Color(0);  // no metal
    Map map = {.texture = info.texture, .texcoord = info.texcoord};
    map.laid.transform = transform_of(info);
    return as_shown(texels, map);
}

double MaterialReader::mean_metallic() {
    if (extension(specular_glossiness) != nullptr || look == Look::clear) return 0;
    return source.pbrMetallicRoughness.metallicFactor *
           double(penumbra::mean_of(metallic_roughness_source(2)).x);
}

double MaterialReader::mean_roughness() {
    return source.pbrMetallicRoughness.roughnessFactor *
           double(penumbra::mean_of(metallic_roughness_source(1)).x);
}

bool MaterialReader::has_vertex_colors() const {
    const auto colored = [](const tinygltf::Primitive* primitive) {
        return primitive->attributes.contains("COLOR_0");
    };
    return reader.cache.wearers && std::ranges::any_of(reader.cache.wearers(index), colored);
}

void MaterialReader::read_metallic_roughness() {
    Plan plan = {.read = *this, .maps = {.illumination = reader.options.illumination}};
    if (extension(specular_glossiness) != nullptr)
        plan.glossiness();
    else
        plan.metallic_roughness();
    if (!opaque()) plan.flatten_all("the surface is transparent");
    // Of images for all of a model many surfaces use one part.
    if (extension("KHR_materials_transmission") != nullptr ||
        (opaque() && has_lobe_maps(plan.maps)))
        plan.flatten_even();
    plan.maps.base.factor = material.color;
    if (base.is_laid()) {
        plan.maps.base.raster = raster_of(reader, base.texture);
        plan.maps.base.srgb = true;
    }
    const bool dulls = dulls_base(plan.maps);
    const bool baked = opaque() && (dulls || has_lobe_maps(plan.maps));
    if (baked && trial != nullptr && plan.even_on_any()) trial->averaged = true;
    if (baked) plan.align();
    if (baked && (dulls || has_lobe_maps(plan.maps)))
        plan.bake();
    else
        plan.make_constant();
}

}  // namespace penumbra::gltf
