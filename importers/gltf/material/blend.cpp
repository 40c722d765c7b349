// Surfaces that are glass in one part of an image and something else in another.
#include "importers/gltf/material/material_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra::gltf {
namespace {

using Map = MaterialReader::Map;

constexpr const char* transmission = "KHR_materials_transmission";

// An image of one number, and whether what the facets show of it varies.
struct Varying {
    TextureInfo info = {};
    std::string name = {};
    TexelSource texels = {};
    bool varies = false;
    float mean = 1;
};

Varying look_at(MaterialReader& read, const TextureInfo& info, const std::string& name,
                const TexelSource& texels) {
    Varying image = {.info = info, .name = name, .texels = texels};
    image.texels.raster = info.texture < 0 ? nullptr : raster_of(read.reader, info.texture);
    Map map = {.texture = info.texture, .texcoord = info.texcoord};
    map.laid.transform = transform_of(info);
    const TexelSource shown = read.as_shown(image.texels, map);
    image.varies = image.texels.raster != nullptr && !even_of(shown);
    image.mean = mean_of(shown).x;
    return image;
}

// Where the surface shows any of its clear look.
TexelMask clear_texels(const TexelSource& shown, const TexelSource& clear) {
    const TexelReader reader(clear);
    const int width = clear.raster->width, height = clear.raster->height;
    TexelMask mask(std::size_t(width) * std::size_t(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto at = std::size_t(y) * std::size_t(width) + std::size_t(x);
            mask[at] = (shown.only == nullptr || (*shown.only)[at]) && reader.value(x, y) > 0.002F;
        }
    return mask;
}

bool same_set(const tinygltf::Material& m, int texcoord) {
    const auto same = [&](const auto& given) {
        return texture_info(given.index, given.texCoord, given.extensions).texcoord == texcoord ||
               given.index < 0;
    };
    return same(m.pbrMetallicRoughness.baseColorTexture) &&
           same(m.pbrMetallicRoughness.metallicRoughnessTexture) && same(m.emissiveTexture) &&
           same(m.normalTexture);
}

}  // namespace

// KHR_materials_transmission: of what is not metal, 1 - m, the part t is clear. Where m or t comes
// from an image the surface is mixed from its clear look, c = (1 - m) t, and from the rest of it.
// That is a metal where t = 1; for other t it is the surface without transmission, which is the
// same where m is 0 or 1.
bool MaterialReader::read_blend() {
    const auto* given = extension(transmission);
    if (given == nullptr || !textured || look != Look::whole || source.alphaMode != "OPAQUE")
        return false;
    const double factor = number(*given, "transmissionFactor", 0);
    const auto& pbr = source.pbrMetallicRoughness;
    const auto& lobes = pbr.metallicRoughnessTexture;
    if (factor <= 0) return false;
    const Varying metal =
        look_at(*this, texture_info(lobes.index, lobes.texCoord, lobes.extensions),
                "metallicRoughnessTexture",
                {.channel = 2, .single = true, .factor = Color(float(pbr.metallicFactor))});
    const Varying through = look_at(*this, texture_info(*given, "transmissionTexture"),
                                    "transmissionTexture", {.factor = Color(float(factor))});
    // Two images at once would have to be joined; what varies least is left to its mean.
    if (metal.varies == through.varies) return false;
    const Varying& image = metal.varies ? metal : through;
    const int set = image.info.texcoord;
    if (texcoord.value_or(set) != set || !same_set(source, set)) return false;
    Map map = find(image.info, image.name, Loss::approximated);
    if (!map.is_laid()) return false;

    TexelSource clear = image.texels;
    clear.factor *= metal.varies ? -through.mean : 1 - metal.mean;
    clear.offset = metal.varies ? through.mean : 0;
    if (range_of(as_shown(clear, map))[1] <= 0) return false;
    const TexelMask mask = clear_texels(as_shown(clear, map), clear);
    map.laid.texture = derived_texture(reader, map.texture,
                                       fmt::format("clear {} {}", clear.factor.x, clear.offset),
                                       false, [&] { return grey_of(clear); });
    MaterialReader glass = part(Look::clear), rest = part(Look::scattering);
    if (metal.varies) glass.clear_part = &mask;
    std::set<std::string> said_of_both;
    glass.said = rest.said = &said_of_both;
    rest.all_metal = metal.varies && through.mean >= 1;
    glass.read();
    rest.read();
    material = std::move(glass.material);
    material.normal_map = rest.material.normal_map;
    rest.material.normal_map.reset();
    material.blend = Blend{.map = map.laid, .other = {std::move(rest.material)}};
    return true;
}

MaterialReader MaterialReader::part(Look of) const {
    MaterialReader made = {.reader = reader,
                           .source = source,
                           .pointer = pointer,
                           .index = index,
                           .alone = alone,
                           .trial = trial,
                           .textured = textured,
                           .one_set = one_set,
                           .look = of};
    made.material.name = material.name;
    made.material.ambient = material.ambient;
    made.texcoord = texcoord;
    return made;
}

}  // namespace penumbra::gltf
