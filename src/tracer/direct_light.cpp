#include "tracer/direct_light.h"

#include "tracer/mirrors.h"
#include "tracer/prepared/shapes.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr std::size_t block_size = 64;  // neighbouring surface points that are looked at together

// Of LightWork::shown_from, beyond all cosines.
constexpr double any_source = -2, no_source = 2;

// ---- shadows -----------------------------------------------------------------------------------

// What translucent surfaces leave of the light along the shadow ray from a surface point: a factor
// for each crossing, except those within shadow_margin of the one before.
Vec3 filtered(const PreparedScene& prepared, const SurfacePoints& surfaces, std::size_t slot,
              LightWork& work) {
    const Vec3 origin = surfaces.position[slot], toward = work.arrival.toward[slot];
    const double end = work.arrival.distance[slot] - shadow_margin;
    TranslucentFacets facets(*prepared.facets, origin, toward, end, work.crossed);
    Vec3 light(1);
    MediumStack inside = surfaces.inside[slot];
    double from = 0;
    while (light != Vec3(0)) {
        Hit hit = {.t = end};
        const double nearest = from + shadow_margin;
        const bool shape = translucent_shape(prepared, origin, toward, nearest, hit);
        const bool facet = facets.next(nearest, hit);
        if (!shape && !facet) break;
        light *= light_through(prepared, origin, toward, hit);
        const PreparedMaterial& material = prepared.material_of(hit.object);
        if (!work.media.toggle(inside, hit.object) && material.absorbs)
            for (int c = 0; c < 3; ++c)
                light[c] *= std::exp(-material.absorption[c] * (hit.t - from));
        from = hit.t;
    }
    return light;
}

// Does light from where `arrival` says show at a point that faces it? Where no point of a block
// shines `reflected` is that of something else, a cosine still.
bool shows(const LightWork& work, std::size_t i) {
    return work.arrival.share[i] != 0 && work.arrival.reflected[i] >= work.shown_from[i];
}

ShadowRays shadow_rays(const SurfacePoints& surfaces, const LightSamples& arrival) {
    return {.origin = Vec3View(surfaces.position),
            .direction = Vec3View(arrival.toward),
            .distance = arrival.distance.data(),
            .sin_to_facet = arrival.sin_to_facet.data(),
            .object = surfaces.object.data()};
}

// Takes from the light of every point that gets some what translucent surfaces keep of it.
void filter_light(const PreparedScene& prepared, const SurfacePoints& surfaces, const Block& block,
                  LightWork& work) {
    LightSamples& arrival = work.arrival;
    work.media.clear();
    work.asked.clear();
    for (std::size_t i = block.first; i < block.last; ++i) {
        arrival.filter.set(i, Vec3(1));
        arrival.filtered.set(i, surfaces.pigment[i]);
        if (shows(work, i)) work.asked.push_back(Index(i));
    }
    prepared.facets->find_filtered(shadow_rays(surfaces, arrival), work.asked, work.filtered);
    const bool shapes = !prepared.translucent_shapes.empty();
    for (const Index i : shapes ? work.asked : work.filtered) {
        const Vec3 light = filtered(prepared, surfaces, i, work);
        if (light == Vec3(0)) arrival.share[i] = 0;
        arrival.filter.set(i, light);
        arrival.filtered.set(i, surfaces.pigment[i] * light);
    }
}

// Takes the source from the points of a block that opaque spheres and planes hide it from, and
// lists those that facets may hide it from.
void ask(const PreparedScene& prepared, const SurfacePoints& surfaces, std::size_t index,
         LightWork& work) {
    const Block& block = work.blocks[index];
    const BlockedBy& by = work.blockers.groups[index];
    LightSamples& arrival = work.arrival;
    block_by_shapes(
        prepared,
        std::span(work.blockers.shapes).subspan(by.first_shape, by.last_shape - by.first_shape),
        shadow_rays(surfaces, arrival), {block.first, block.last}, arrival.share);
    if (!by.facets) return;
    find_sin_to_facet(surfaces, block, arrival);
    for (std::size_t i = block.first; i < block.last; ++i)
        if (shows(work, i)) work.asked.push_back(Index(i));
}

// ---- highlights --------------------------------------------------------------------------------

// K_S (R.V)^N of one lobe.
double highlight(const PreparedLobe& lobe, double reflected) {
    if (lobe.specular == 0 || reflected < lobe.highlight_end) return 0;
    return lobe.specular * std::pow(reflected, lobe.shininess);
}

// The same of the lobes that the surface point shows; `reflected` is R.V.
double highlight(const PreparedMaterial& material, const LobeMix& mix, double reflected) {
    const double first = highlight(material.lobes[mix.first], reflected);
    if (mix.share == 0) return first;
    return first * (1 - mix.share) +
           highlight(material.lobes[mix.first + 1], reflected) * mix.share;
}

// And with what their mirrors leave of each.
Vec3 kept_highlight(const SurfacePoints& surfaces, std::size_t i, double reflected) {
    const LobeMix& mix = surfaces.lobes[i];
    const std::vector<PreparedLobe>& lobes = surfaces.material[i]->lobes;
    Vec3 sum = surfaces.kept[i] * (highlight(lobes[mix.first], reflected) * (1 - mix.share));
    if (mix.share > 0)
        sum += surfaces.next_kept[i] * (highlight(lobes[mix.first + 1], reflected) * mix.share);
    return sum;
}

// The highlight of a surface point, that of its coat included, for light from where `arrival` says.
Vec3 whole_highlight(const SurfacePoints& surfaces, std::size_t i, const LightSamples& arrival) {
    const PreparedMaterial& material = *surfaces.material[i];
    const double reflected = arrival.reflected[i];
    Vec3 sum = material.takes_reflected ? kept_highlight(surfaces, i, reflected)
                                        : Vec3(highlight(material, surfaces.lobes[i], reflected));
    if (material.highlight_metallic > 0 && sum != Vec3(0))
        sum *= metallic_tint(material.highlight_metallic, arrival.cosine[i], surfaces.tint[i]);
    if (material.coat) sum += Vec3(highlight(material.coat->lobe, reflected));
    return sum;
}

void add_highlights(const PreparedSource& source, const SurfacePoints& surfaces, const Block& block,
                    const Vec3Array* filter, LightSamples& arrival, Vec3Array& radiance) {
    for (std::size_t i = block.first; i < block.last; ++i) {
        if (arrival.reflected[i] <= 0 || arrival.share[i] == 0 || !surfaces.material[i]->shines)
            continue;
        const Vec3 amount = whole_highlight(surfaces, i, arrival);
        if (amount == Vec3(0)) continue;
        Vec3 light = source.color * (arrival.share[i] * surfaces.alpha[i]) * amount;
        if (filter != nullptr) light *= (*filter)[i];
        for (std::size_t c = 0; c < 3; ++c) radiance.axis[c][i] += light[int(c)];
    }
}

// ---- one light ---------------------------------------------------------------------------------

void add_open_block(const SourceGroup& light, const SurfacePoints& surfaces, const Block& block,
                    LightSamples& arrival, Vec3Array& radiance) {
    if (!block.shines && plain(light)) return add_open_matte(light, surfaces, block, radiance);
    for (const PreparedSource& source : light.sources) {
        aim(source, surfaces, block, arrival);
        weigh(source, block, arrival);
        add_diffuse(source.color, surfaces.pigment, surfaces.diffuse, block, arrival, radiance);
        if (!block.shines) continue;
        find_reflected(surfaces, block, arrival);
        add_highlights(source, surfaces, block, nullptr, arrival, radiance);
    }
}

// The blocks that something may shade, all of them for one source, so that packets are full.
void add_shaded_blocks(const PreparedScene& prepared, const PreparedSource& source,
                       const SurfacePoints& surfaces, LightWork& work, Vec3Array& radiance) {
    LightSamples& arrival = work.arrival;
    work.asked.clear();
    for (const std::size_t index : work.shaded) {
        aim(source, surfaces, work.blocks[index], arrival);
        weigh(source, work.blocks[index], arrival);
        if (work.blocks[index].shines) find_reflected(surfaces, work.blocks[index], arrival);
        ask(prepared, surfaces, index, work);
    }
    prepared.facets->occluded(shadow_rays(surfaces, arrival), work.asked, arrival.share);
    for (const std::size_t index : work.shaded) {
        const Block& block = work.blocks[index];
        const bool filters = work.blockers.groups[index].filters;
        const Vec3Array* filter = filters ? &arrival.filter : nullptr;
        if (filters) filter_light(prepared, surfaces, block, work);
        add_diffuse(source.color, filters ? arrival.filtered : surfaces.pigment, surfaces.diffuse,
                    block, arrival, radiance);
        if (block.shines) add_highlights(source, surfaces, block, filter, arrival, radiance);
    }
}

void add_light(const PreparedScene& prepared, const SourceGroup& light,
               const SurfacePoints& surfaces, LightWork& work, Vec3Array& radiance) {
    work.blockers.find(prepared, work.points, light);
    work.shaded.clear();
    for (std::size_t index = 0; index < work.blocks.size(); ++index) {
        const BlockedBy& by = work.blockers.groups[index];
        if (by.away) continue;
        if (prepared.shadows && by.any)
            work.shaded.push_back(index);
        else
            add_open_block(light, surfaces, work.blocks[index], work.arrival, radiance);
    }
    if (work.shaded.empty()) return;
    for (const PreparedSource& source : light.sources)
        add_shaded_blocks(prepared, source, surfaces, work, radiance);
}

// The least cosine of the mirrored eye ray at which a source shows: any where light is scattered,
// and none where neither is.
double shown_from(const SurfacePoints& surfaces, std::size_t i) {
    if (surfaces.diffuse[i] > 0) return any_source;
    const PreparedMaterial& material = *surfaces.material[i];
    if (!material.shines || surfaces.alpha[i] == 0) return no_source;
    const auto from = [&](const PreparedLobe& lobe) {
        return lobe.specular == 0 ? no_source : lobe.highlight_end;
    };
    const LobeMix& mix = surfaces.lobes[i];
    double least = from(material.lobes[mix.first]);
    if (mix.share > 0) least = std::min(least, from(material.lobes[mix.first + 1]));
    return material.coat ? std::min(least, from(material.coat->lobe)) : least;
}

// What is the same for all lights.
void find_blocks(const PreparedScene& prepared, const SurfacePoints& surfaces, LightWork& work) {
    work.blocks.clear();
    work.points.clear();
    for (std::size_t first = 0; first < surfaces.count; first += block_size) {
        Block block = {.first = first, .last = std::min(first + block_size, surfaces.count)};
        bool lit = false;
        for (std::size_t i = block.first; i < block.last; ++i) {
            block.shines |= surfaces.material[i]->shines && surfaces.alpha[i] > 0;
            work.shown_from[i] = shown_from(surfaces, i);
            lit |= work.shown_from[i] != no_source;
        }
        if (!lit) continue;
        work.points.add(prepared, surfaces, {block.first, block.last});
        work.blocks.push_back(block);
    }
}

}  // namespace

void add_direct_light(const PreparedScene& prepared, const SurfacePoints& surfaces, LightWork& work,
                      Vec3Array& radiance) {
    if (surfaces.count == 0) return;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < surfaces.count; ++i)
            radiance.axis[c][i] += surfaces.emitted.axis[c][i];
    find_blocks(prepared, surfaces, work);
    if (work.blocks.empty()) return;
    for (const SourceGroup& light : prepared.lights)
        add_light(prepared, light, surfaces, work, radiance);
}

}  // namespace penumbra
