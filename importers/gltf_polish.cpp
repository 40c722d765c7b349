// Metalness and roughness, or specular and glossiness -> highlight, mirror, scattering and Gloss.
#include "gltf_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::gltf {
namespace {

using Map = MaterialReader::Map;

constexpr const char* white_highlight = "the colour of the highlight becomes white";
constexpr const char* specular_glossiness = "KHR_materials_pbrSpecularGlossiness";

float largest(const Color& c) { return std::max({c.x, c.y, c.z}); }

bool is_grey(const Color& c) { return c.x == c.y && c.y == c.z; }

// An image and what of PolishMaps comes from it.
struct Input {
    Map map = {};
    std::string name = {};
    bool srgb = false;
    std::vector<TexelSource*> parts = {};
};

// The maps of a material and the images they come from, the base colour's not among them.
struct Plan {
    MaterialReader& read;
    PolishMaps maps = {};
    std::vector<Input> inputs = {};

    void metallic_roughness();
    void glossiness();
    void specular();
    void add(const TextureInfo& info, const std::string& name, bool srgb,
             std::vector<TexelSource*> parts);
    void flatten(Input& input, const std::string& why);
    void flatten_all(const std::string& why);
    const Map* frame() const;
    void align();
    void make_constant();
    void bake();
    BakedPolish baked(const Map& laid, const Map& level);
    std::string key(const Map& laid) const;
    const char* subject() const;
};

void Plan::add(const TextureInfo& info, const std::string& name, bool srgb,
               std::vector<TexelSource*> parts) {
    Input input = {.map = read.find(info, name, "is replaced by its mean"),
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
        varies = varies || !constant_of(*part);
        *part = {.factor = mean_of(*part)};
    }
    if (varies && !why.empty())
        read.lose(fmt::format("{} is replaced by its mean: {}", input.name, why));
    input.map.state = Map::State::constant;
}

void Plan::flatten_all(const std::string& why) {
    for (Input& input : inputs)
        if (input.map.is_laid()) flatten(input, why);
}

void Plan::metallic_roughness() {
    const auto& pbr = read.source.pbrMetallicRoughness;
    const auto& given = pbr.metallicRoughnessTexture;
    maps.metallic = {.channel = 2, .single = true, .factor = Color(float(pbr.metallicFactor))};
    maps.roughness = {.channel = 1, .single = true, .factor = Color(float(pbr.roughnessFactor))};
    maps.specular.factor = read.dielectric_f0();
    const TextureInfo info = texture_info(given.index, given.texCoord, given.extensions);
    // Without its image, whose factors are mostly 1, it would all be metal.
    if (read.textured && info.texture >= 0 && raster_of(read.reader, info.texture) == nullptr)
        maps.metallic.factor = Color(0);
    add(info, "metallicRoughnessTexture", false, {&maps.metallic, &maps.roughness});
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
    Material& material = read.material;
    const Color f0 = constant_of(maps.specular).value_or(Color(0));
    const float metallic = constant_of(maps.metallic)->x, most = largest(f0);
    set_metallic_roughness(material, metallic, constant_of(maps.roughness)->x, most);
    read.lay_base();
    if (is_grey(f0)) return;
    material.reflection *= Color(metallic) + f0 * ((1 - metallic) / most);
    if (material.specular > 0) read.lose(white_highlight);
}

std::string Plan::key(const Map& laid) const {
    const auto text = [](const Color& c) { return fmt::format("{} {} {}", c.x, c.y, c.z); };
    std::string key;
    if (!keeps_base(maps))
        key = key_of(read.reader, laid.texture) + ' ' + text(read.material.color);
    for (const TexelSource* source : {&maps.metallic, &maps.roughness, &maps.specular})
        key += fmt::format(", {} {}", source->raster != nullptr, text(source->factor));
    for (const Input& input : inputs) key += ", " + key_of(read.reader, input.map.texture);
    return key;
}

// `level` is the image that has the roughness, if any.
BakedPolish Plan::baked(const Map& laid, const Map& level) {
    const std::string name = key(laid);
    const auto known = read.reader.looks.polishes.find(name);
    if (known != read.reader.looks.polishes.end()) return known->second;

    const Texture sampling = frame_of(read.reader, laid.texture);
    maps.wrap_u = sampling.wrap_u;
    maps.wrap_v = sampling.wrap_v;
    maps.bilinear = sampling.bilinear;
    maps.place = read.reader.document.place(fmt::format("/textures/{}", laid.texture));
    PolishImages images = bake_polish(maps);
    const auto keep = [&](const Map& map, const char* use, Raster& raster) {
        if (raster.texels() == 0) return no_index;
        return derived_texture(read.reader, map.texture, fmt::format("{} {}", use, name),
                               use[0] != 'l', [&] { return std::move(raster); });
    };
    BakedPolish made = {.scattered = keep(laid, "scattered", images.scattered)};
    made.gloss.color.texture = keep(laid, "reflected", images.reflected);
    made.gloss.level.texture = keep(level, "level", images.level);
    made.gloss.lobes = std::move(images.lobes);
    return read.reader.looks.polishes[name] = made;
}

void Plan::bake() {
    const auto of_roughness = std::find_if(inputs.begin(), inputs.end(), [&](const Input& input) {
        return std::find(input.parts.begin(), input.parts.end(), &maps.roughness) !=
               input.parts.end();
    });
    const Map& laid = *frame();
    const Map& level = of_roughness == inputs.end() ? laid : of_roughness->map;
    const BakedPolish polish = baked(laid, level);

    Gloss gloss = polish.gloss;
    gloss.color.transform = laid.laid.transform;
    gloss.level.transform = level.laid.transform;
    const std::size_t lobes = gloss.lobes.size();
    ImageMap scattered = laid.laid;
    scattered.texture = polish.scattered;
    const Color f0 = maps.specular.factor;
    lay_polish(read.material, std::move(gloss), scattered, largest(f0));
    if (read.material.gloss && read.material.gloss->level.texture != no_index)
        read.note_set(level, [](Material& m) -> ImageMap& { return m.gloss->level; });
    if (scattered.texture == no_index) {
        read.lay_base();
        if (!is_grey(f0)) read.lose(white_highlight);
    }
    read.lose(fmt::format("{} texture: mixed from {} Phong lobe{}", subject(), lobes,
                          lobes == 1 ? "" : "s"));
}

const char* Plan::subject() const {
    if (inputs.front().name == "specularGlossinessTexture") return "specular-glossiness";
    return inputs.front().name == "metallicRoughnessTexture" ? "metallic-roughness" : "specular";
}

}  // namespace

// Reflectance at normal incidence: Schlick's F0 of KHR_materials_ior, scaled as
// KHR_materials_specular says.
Color MaterialReader::dielectric_f0() const {
    double f0 = 0.04;
    if (const auto* ior = extension("KHR_materials_ior")) {
        const double n = number(*ior, "ior", 1.5);
        f0 = std::pow((n - 1) / (n + 1), 2);
    }
    const auto* specular = extension("KHR_materials_specular");
    if (specular == nullptr) return Color(float(f0));
    const auto tint = numbers(*specular, "specularColorFactor", {1, 1, 1});
    const double strength = number(*specular, "specularFactor", 1);
    Color result;
    for (std::size_t i = 0; i < 3; ++i)
        result[int(i)] = float(std::min(f0 * tint[i], 1.0) * strength);
    return result;
}

double MaterialReader::mean_metallic() {
    if (extension(specular_glossiness) != nullptr) return 0;
    const auto& pbr = source.pbrMetallicRoughness;
    const int texture = textured ? pbr.metallicRoughnessTexture.index : -1;
    const auto mean = texture < 0 ? Color(1) : texture_mean(reader, texture, false);
    return pbr.metallicFactor * double(mean.value_or(Color(0)).z);
}

double MaterialReader::mean_roughness() {
    const auto& pbr = source.pbrMetallicRoughness;
    const int texture = textured ? pbr.metallicRoughnessTexture.index : -1;
    const auto mean = texture < 0 ? Color(1) : texture_mean(reader, texture, false);
    return pbr.roughnessFactor * double(mean.value_or(Color(1)).y);
}

void MaterialReader::read_polish() {
    Plan plan = {.read = *this};
    if (extension(specular_glossiness) != nullptr)
        plan.glossiness();
    else
        plan.metallic_roughness();
    if (!opaque()) plan.flatten_all("the surface is transparent");
    plan.maps.base.factor = material.color;
    if (base.is_laid()) {
        plan.maps.base.raster = raster_of(reader, base.texture);
        plan.maps.base.srgb = true;
    }
    if (has_polish_maps(plan.maps)) plan.align();
    if (has_polish_maps(plan.maps))
        plan.bake();
    else
        plan.make_constant();
}

}  // namespace penumbra::gltf
