// glTF materials -> Materials: colour, alpha, light of their own, relief.
#include "importers/gltf/material/material.h"

#include "importers/gltf/material/material_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::gltf {
namespace {

constexpr float unreadable_grey = 0.5F;

const tinygltf::Material& source_of(const Reader& reader, int index) {
    // glTF 2.0, section 3.7.2.1: what a primitive without a material has.
    static const tinygltf::Material standard;
    return index < 0 ? standard : reader.document.model.materials[std::size_t(index)];
}

// What of a material is read from one of two places: the core or
// KHR_materials_pbrSpecularGlossiness.
struct Base {
    std::vector<double> factor = {1, 1, 1, 1};
    TextureInfo texture = {};
};

Base base_of(const MaterialReader& read) {
    if (const auto* glossy = read.extension("KHR_materials_pbrSpecularGlossiness"))
        return {numbers(*glossy, "diffuseFactor", {1, 1, 1, 1}),
                texture_info(*glossy, "diffuseTexture")};
    const auto& pbr = read.source.pbrMetallicRoughness;
    return {pbr.baseColorFactor,
            texture_info(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord,
                         pbr.baseColorTexture.extensions)};
}

// Extensions that change nothing while `factor` is 0.
struct Unsupported {
    const char* extension;
    const char* factor;
    const char* name;
};

constexpr std::array unsupported = {
    Unsupported{"KHR_materials_anisotropy", "anisotropyStrength", "anisotropy"},
    Unsupported{"KHR_materials_iridescence", "iridescenceFactor", "iridescence"},
    Unsupported{"KHR_materials_dispersion", "dispersion", "dispersion"},
};

bool is_zero(const tinygltf::Value& extension, const std::string& key) {
    if (!extension.IsObject() || !extension.Has(key)) return true;
    const tinygltf::Value& value = extension.Get(key);
    if (value.IsNumber()) return value.GetNumberAsDouble() == 0;
    return numbers(extension, key, {0, 0, 0}) == std::vector<double>{0, 0, 0};
}

}  // namespace

Color color_of(const std::vector<double>& numbers) {
    return {float(numbers[0]), float(numbers[1]), float(numbers[2])};
}

const tinygltf::Value* MaterialReader::extension(const std::string& name) const {
    const auto found = source.extensions.find(name);
    return found == source.extensions.end() ? nullptr : &found->second;
}

void MaterialReader::note_loss(Loss::Kind kind, const std::string& what) const {
    // All else has been said of the same material with all its images.
    if (!textured || one_set || (said != nullptr && !said->insert(what).second)) return;
    if (trial != nullptr) {
        trial->losses.emplace_back(kind, what);
        return;
    }
    reader.note_loss_in_material(kind, pointer, what);
}

void MaterialReader::note_mean(const std::string& what) const {
    if (trial != nullptr) trial->averaged = true;
    note_loss(Loss::approximated, what);
}

MaterialReader::Map MaterialReader::find(const TextureInfo& info, const std::string& name,
                                         Loss::Kind otherwise) {
    if (!textured || info.texture < 0) return {};
    if (raster_of(reader, info.texture) == nullptr) return {.state = Map::State::unreadable};
    Map map = {.state = Map::State::constant, .texture = info.texture, .texcoord = info.texcoord};
    map.laid.transform = transform_of(info);
    const char* const instead =
        otherwise == Loss::dropped ? "is ignored" : "is replaced by its mean";
    const auto& t = map.laid.transform;
    if (!(std::abs(t[0] * t[4] - t[1] * t[3]) > 1e-12)) {
        note_loss(otherwise,
                  fmt::format("{} {}: its KHR_texture_transform has no area", name, instead));
    } else if (one_set && texcoord.value_or(info.texcoord) != info.texcoord) {
        reader.note_loss_in_material(
            otherwise, pointer,
            fmt::format("{} {}: it has other texture coordinates than the first image", name,
                        instead));
    } else {
        if (!texcoord) texcoord = info.texcoord;
        map.state = Map::State::laid;
    }
    return map;
}

void MaterialReader::note_set(const Map& map, ImageMap& (*member)(Material&)) {
    if (map.texcoord != texcoord) other_sets.push_back({map.texcoord, member});
}

const TexelMask* MaterialReader::shown(int texture, int set, const ImageMap& laid) {
    const auto& t = laid.transform;
    const std::string key =
        fmt::format("{} {} {} {} {} {} {} {} {} {}", index, static_cast<const void*>(alone),
                    texture, set, t[0], t[1], t[2], t[3], t[4], t[5]);
    MaterialCache& cache = reader.cache;
    if (const auto known = cache.shown.find(key); known != cache.shown.end())
        return known->second.empty() ? nullptr : &known->second;
    TexelMask& mask = cache.shown[key];
    const Raster* raster = raster_of(reader, texture);
    const auto facets = cache.facets ? cache.facets({index, alone}, set) : std::nullopt;
    if (raster == nullptr || !facets || facets->empty()) return nullptr;
    if (auto found =
            texels_under(*facets, laid, frame_of(reader, texture), raster->width, raster->height))
        mask = std::move(*found);
    return mask.empty() ? nullptr : &mask;
}

TexelSource MaterialReader::as_shown(TexelSource texels, const Map& map) {
    if (texels.raster == nullptr) return texels;
    const bool lobes = map.texture == source.pbrMetallicRoughness.metallicRoughnessTexture.index;
    texels.only =
        clear_part != nullptr && lobes ? clear_part : shown(map.texture, map.texcoord, map.laid);
    return texels;
}

Color MaterialReader::mean_of(const tinygltf::Value& from, const std::string& key, bool srgb,
                              int channel) {
    const TextureInfo info = texture_info(from, key);
    if (!textured || info.texture < 0) return Color(1);
    const Raster* raster = raster_of(reader, info.texture);
    if (raster == nullptr) return Color(1);
    Map map = {.texture = info.texture, .texcoord = info.texcoord};
    map.laid.transform = transform_of(info);
    const TexelSource texels = as_shown({.raster = raster, .channel = channel, .srgb = srgb}, map);
    if (const auto even = even_of(texels)) return *even;
    note_mean(fmt::format("{} is replaced by its mean over what the facets show", key));
    return penumbra::mean_of(texels);
}

void MaterialReader::read_base() {
    const Base given = base_of(*this);
    material.color = color_of(given.factor);
    alpha = given.factor[3];
    base = find(given.texture, "baseColorTexture", Loss::approximated);
    if (base.state == Map::State::unreadable) material.color *= unreadable_grey;
    if (base.state == Map::State::constant) {
        material.color *= texture_mean(reader, base.texture, true).value_or(Color(1));
        alpha *= double(penumbra::mean_of({raster_of(reader, base.texture), 3}).x);
    }
}

// glTF 2.0, section 3.9.4: the alpha of the base colour, times that of its texture, blends or cuts.
void MaterialReader::read_alpha() {
    if (source.alphaMode == "OPAQUE") return;
    const bool cuts = source.alphaMode == "MASK";
    const Raster* raster = base.is_laid() ? raster_of(reader, base.texture) : nullptr;
    if (raster != nullptr && has_transparency(*raster)) {
        const TexelSource texels = {.raster = raster, .channel = 3, .factor = Color(float(alpha))};
        const auto [least, most] = range_of(texels);
        const double cutoff = source.alphaCutoff;
        if (cuts ? double(least) < cutoff && double(most) >= cutoff : least != most)
            return cover(texels);
        alpha = double(most);
    }
    if (cuts) alpha = alpha < source.alphaCutoff ? 0 : 1;
    material.opacity = covered = float(alpha);
}

// With a cutoff it, rather than every texel, is adapted to the factor.
void MaterialReader::cover(TexelSource texels) {
    AlphaMap alpha_map = {.map = base.laid};
    if (source.alphaMode == "MASK") {
        alpha_map.cutoff = float(source.alphaCutoff / alpha);
        texels.factor = Color(1);
    }
    const float factor = texels.factor.x;
    alpha_map.map.texture = derived_texture(reader, base.texture,
                                            factor == 1 ? "alpha" : fmt::format("alpha {}", factor),
                                            false, [&] { return grey_of(texels); });
    material.alpha_map = alpha_map;
}

void MaterialReader::lay_base() {
    if (!base.is_laid()) return;
    ImageMap map = base.laid;
    map.texture = read_texture(reader, base.texture, true);
    material.pattern = map;
}

void MaterialReader::read_emission() {
    if (source.emissiveFactor.size() == 3) material.emission = color_of(source.emissiveFactor);
    if (const auto* strength = extension("KHR_materials_emissive_strength"))
        material.emission *= float(number(*strength, "emissiveStrength", 1));
    // What shines through does not dim it (KHR_materials_transmission).
    material.emission *= under_coat * covered;
    if (material.emission == Color(0)) return;
    const auto& given = source.emissiveTexture;
    Map map = find(texture_info(given.index, given.texCoord, given.extensions), "emissiveTexture",
                   Loss::approximated);
    if (map.state == Map::State::absent) return;
    if (map.is_laid()) {
        map.laid.texture = read_texture(reader, map.texture, true);
        material.emission_map = map.laid;
        note_set(map, [](Material& m) -> ImageMap& { return *m.emission_map; });
        return;
    }
    // Where it cannot be read nothing shines, rather than everything.
    if (map.state == Map::State::unreadable) {
        material.emission = Color(0);
        return;
    }
    material.emission *=
        penumbra::mean_of({.raster = raster_of(reader, map.texture), .srgb = true});
}

void MaterialReader::read_normal() {
    const auto& given = source.normalTexture;
    Map map = find(texture_info(given.index, given.texCoord, given.extensions), "normalTexture",
                   Loss::dropped);
    if (!map.is_laid() || given.scale == 0) return;
    map.laid.texture = read_texture(reader, map.texture, false);
    material.normal_map = NormalMap{.map = map.laid, .scale = float(given.scale)};
    note_set(map, [](Material& m) -> ImageMap& { return m.normal_map->map; });
}

// glTF 2.0, section 3.9.3: occlusion dims indirect light, and the only one that there is here,
// Material::ambient, is not the file's.
void MaterialReader::name_the_rest() {
    if (source.occlusionTexture.index >= 0)
        note_loss(Loss::dropped, "occlusionTexture is ignored: it would only dim indirect light");
    for (const auto& [name, factor, what] : unsupported)
        if (const auto* found = extension(name); found != nullptr && !is_zero(*found, factor))
            note_loss(Loss::dropped, fmt::format("{} is ignored", what));
}

// KHR_materials_unlit: the base colour whatever the light. As full ambience rather than as
// emission, which would leave out textures and vertex colours.
void MaterialReader::make_unlit() {
    lay_base();
    material.ambient = Color(1);
    material.emission = Color(0);
    material.reflection = Color(0);
    material.diffuse = material.specular = material.metallic = 0;
}

// glTF 2.0, section 3.9.6. The backs of a body's surface are where light leaves it.
void MaterialReader::read_sides() {
    const bool body = material.ior != 1 || material.absorption;
    material.sides = source.doubleSided || body ? Sides::both : Sides::front;
}

void MaterialReader::read() {
    read_base();
    read_alpha();
    if (extension("KHR_materials_unlit") != nullptr) return make_unlit();
    if (read_blend()) return;
    read_transmission();
    read_metallic_roughness();
    read_volume();
    read_diffuse_transmission();
    read_clearcoat();
    read_sheen();
    read_emission();
    read_normal();
    name_clear();
    name_the_rest();
    if (alpha > 0 || material.opacity > 0) return;
    material.specular = 0;
    material.reflection = Color(0);
}

namespace {

enum class Images { all, first_set, none };

// `id` is a glTF index, or one of MaterialCache::alone.
MaterialReader reader_of(Reader& reader, int id, Images images) {
    const Alone worn = id < -1 ? reader.cache.alone[std::size_t(-2 - id)] : Alone{id};
    const int index = worn.material;
    const tinygltf::Material& source = source_of(reader, index);
    MaterialReader read = {.reader = reader,
                           .source = source,
                           .pointer = fmt::format("/materials/{}", index),
                           .index = index,
                           .alone = worn.primitive,
                           .textured = images != Images::none,
                           .one_set = images == Images::first_set};
    read.material.name = index < 0             ? "default"
                         : source.name.empty() ? fmt::format("material{}", index)
                                               : source.name;
    // An environment stands for the ambience of a few lamps.
    if (reader.options.illumination == Illumination::environment)
        read.material.ambient = Color(0);
    else
        read.material.ambient = Color(0.1F);
    return read;
}

Index keep(Reader& reader, int id, Images images, MaterialReader read) {
    read.read_sides();
    if (images == Images::all && read.texcoord) reader.cache.texcoords[id] = *read.texcoord;
    if (!read.other_sets.empty()) reader.cache.other_sets[id] = std::move(read.other_sets);
    reader.scene.materials.push_back(std::move(read.material));
    return Index(reader.scene.materials.size() - 1);
}

Index add_material(Reader& reader, int id, Images images) {
    MaterialReader read = reader_of(reader, id, images);
    read.read();
    return keep(reader, id, images, std::move(read));
}

// Each becomes a material.
constexpr std::size_t most_wearers = 64;

// Reads the material for all of its primitives, and says whether that averages what each of them
// may show a single value of.
bool is_averaged(Reader& reader, int index) {
    const std::size_t wearers = reader.cache.wearers ? reader.cache.wearers(index).size() : 0;
    if (wearers < 2 || wearers > most_wearers) return false;
    Trial trial;
    MaterialReader read = reader_of(reader, index, Images::all);
    read.trial = &trial;
    read.read();
    if (trial.averaged) return true;
    read.trial = nullptr;
    for (const auto& [kind, what] : trial.losses) read.note_loss(kind, what);
    reader.cache.materials[index] = keep(reader, index, Images::all, std::move(read));
    return false;
}

}  // namespace

int material_on(Reader& reader, int index, const tinygltf::Primitive& primitive) {
    MaterialCache& cache = reader.cache;
    if (index < 0 || cache.materials.contains(index)) return index;
    const auto known = cache.divided.find(index);
    const bool divided = known != cache.divided.end() ? known->second : is_averaged(reader, index);
    cache.divided[index] = divided;
    if (!divided) return index;
    const auto [own, fresh] = cache.alone_on.emplace(&primitive, -2 - int(cache.alone.size()));
    if (fresh) cache.alone.push_back({index, &primitive});
    return own->second;
}

TextureUse texture_use(const Reader& reader, int index) {
    const auto found = reader.cache.texcoords.find(index);
    if (found == reader.cache.texcoords.end()) return {};
    return {.used = true, .texcoord = found->second};
}

namespace {

Index read_once(Reader& reader, int index, Images images, std::map<int, Index>& known) {
    if (const auto found = known.find(index); found != known.end()) return found->second;
    return known[index] = add_material(reader, index, images);
}

}  // namespace

Index read_material(Reader& reader, int index) {
    return read_once(reader, index, Images::all, reader.cache.materials);
}

Index untextured(Reader& reader, int index) {
    return read_once(reader, index, Images::none, reader.cache.untextured);
}

Index with_one_set(Reader& reader, int index) {
    return read_once(reader, index, Images::first_set, reader.cache.one_set);
}

}  // namespace penumbra::gltf
