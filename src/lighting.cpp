#include "lighting.h"

#include "shapes.h"
#include "simd.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

// Below this angle to its facet a shadow ray may find that facet again: float32 rounds the start
// point of a normalised scene by up to 1e-6, and shadow_margin is 1e-3.
constexpr double grazing_sine = 4e-3;

constexpr double least_light = 1e-10;   // POV-Ray skips a source whose light is weaker
constexpr std::size_t block_size = 64;  // neighbouring surface points that are tested together

// ---- dense loops over arrays -------------------------------------------------------------------

PENUMBRA_VECTORISED
void aim_at_point(const Vec3& source, Lanes position, std::size_t count, double* __restrict lx,
                  double* __restrict ly, double* __restrict lz, double* __restrict distance) {
    const double sx = source.x, sy = source.y, sz = source.z;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = sx - position.x[i], y = sy - position.y[i], z = sz - position.z[i];
        const double length = std::sqrt(x * x + y * y + z * z), scale = 1 / length;
        lx[i] = x * scale;
        ly[i] = y * scale;
        lz[i] = z * scale;
        distance[i] = length;
    }
}

PENUMBRA_VECTORISED
void aim_along(const Vec3& source, const Vec3& axis, Lanes position, std::size_t count,
               double* __restrict lx, double* __restrict ly, double* __restrict lz,
               double* __restrict distance) {
    const double sx = source.x, sy = source.y, sz = source.z, ax = axis.x, ay = axis.y, az = axis.z;
    for (std::size_t i = 0; i < count; ++i) {
        lx[i] = -ax;
        ly[i] = -ay;
        lz[i] = -az;
        distance[i] =
            (position.x[i] - sx) * ax + (position.y[i] - sy) * ay + (position.z[i] - sz) * az;
    }
}

PENUMBRA_VECTORISED
void dot_products(Lanes a, Lanes b, std::size_t count, double* __restrict out) {
    for (std::size_t i = 0; i < count; ++i)
        out[i] = a.x[i] * b.x[i] + a.y[i] * b.y[i] + a.z[i] * b.z[i];
}

// 1 where the surface faces the source, else 0.
PENUMBRA_VECTORISED
void facing(const double* __restrict cosine, std::size_t count, double* __restrict arriving) {
    for (std::size_t i = 0; i < count; ++i) arriving[i] = cosine[i] < least_cosine ? 0.0 : 1.0;
}

// f_a for the usual power, 2.
PENUMBRA_VECTORISED
void fade_by_square(const double* __restrict distance, double fade_distance, std::size_t count,
                    double* __restrict arriving) {
    for (std::size_t i = 0; i < count; ++i) {
        const double ratio = distance[i] / fade_distance;
        arriving[i] *= 2 / (1 + ratio * ratio);
    }
}

PENUMBRA_VECTORISED
void add_diffuse(const double* __restrict pigment, double color, const double* __restrict arriving,
                 const double* __restrict cosine, const double* __restrict diffuse,
                 std::size_t count, double* __restrict radiance) {
    for (std::size_t i = 0; i < count; ++i)
        radiance[i] += color * (pigment[i] * (diffuse[i] * cosine[i] * arriving[i]));
}

PENUMBRA_VECTORISED
void multiply(const double* __restrict a, const double* __restrict b, std::size_t count,
              double* __restrict out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = a[i] * b[i];
}

// All sources of a light at once, for matte points that nothing can shade: nothing is stored
// between the steps. The same sums in the same order as source by source.
PENUMBRA_VECTORISED
void add_open_matte(const PreparedSource* sources, std::size_t source_count, Lanes position,
                    Lanes normal, Lanes pigment, const double* __restrict diffuse,
                    std::size_t count, double* __restrict red, double* __restrict green,
                    double* __restrict blue) {
    for (std::size_t s = 0; s < source_count; ++s) {
        const double sx = sources[s].position.x, sy = sources[s].position.y,
                     sz = sources[s].position.z;
        const double r = sources[s].color.x, g = sources[s].color.y, b = sources[s].color.z;
        for (std::size_t i = 0; i < count; ++i) {
            const double x = sx - position.x[i], y = sy - position.y[i], z = sz - position.z[i];
            const double scale = 1 / std::sqrt(x * x + y * y + z * z);
            const double cosine =
                normal.x[i] * (x * scale) + normal.y[i] * (y * scale) + normal.z[i] * (z * scale);
            const double amount = diffuse[i] * (cosine < least_cosine ? 0.0 : cosine);
            red[i] += r * (pigment.x[i] * amount);
            green[i] += g * (pigment.y[i] * amount);
            blue[i] += b * (pigment.z[i] * amount);
        }
    }
}

// ---- one source --------------------------------------------------------------------------------

void aim(const PreparedSource& source, const Surfaces& surfaces, LightWork& work) {
    auto& [lx, ly, lz] = work.toward.axis;
    const Lanes position(surfaces.position);
    if (source.type == Light::Type::directional)
        aim_along(source.position, source.axis, position, surfaces.count, lx.data(), ly.data(),
                  lz.data(), work.distance.data());
    else
        aim_at_point(source.position, position, surfaces.count, lx.data(), ly.data(), lz.data(),
                     work.distance.data());
    dot_products(Lanes(surfaces.normal), Lanes(work.toward), surfaces.count, work.cosine.data());
}

// The falloff of a spot: POV-Ray's cubic smoothstep in the cosine.
double spot_falloff(const PreparedSource& source, const Vec3& toward) {
    const double cosine = -source.axis.dot(toward);
    if (cosine <= 0 || cosine <= source.cos_outer) return 0;
    if (cosine >= source.cos_inner) return 1;
    const double s = (cosine - source.cos_outer) / (source.cos_inner - source.cos_outer);
    return s * s * (3 - 2 * s);
}

// The share of the source's light that would arrive with nothing in its way.
void weigh(const PreparedSource& source, const Surfaces& surfaces, LightWork& work) {
    double* arriving = work.arriving.data();
    facing(work.cosine.data(), surfaces.count, arriving);
    if (source.fades && source.fade_power == 2)
        fade_by_square(work.distance.data(), source.fade_distance, surfaces.count, arriving);
    else if (source.fades)
        for (std::size_t i = 0; i < surfaces.count; ++i)
            arriving[i] *=
                2 / (1 + std::pow(work.distance[i] / source.fade_distance, source.fade_power));
    if (source.type == Light::Type::spot)
        for (std::size_t i = 0; i < surfaces.count; ++i)
            if (arriving[i] != 0) arriving[i] *= spot_falloff(source, work.toward[i]);
}

// Lists the points that get light unless something stands in its way, and may have that. Returns
// whether any point gets light at all.
bool gather_lit(const PreparedSource& source, const Surfaces& surfaces, LightWork& work) {
    const double brightest = std::max({source.color.x, source.color.y, source.color.z});
    bool any = false;
    work.lit.clear();
    for (std::size_t i = 0; i < surfaces.count; ++i) {
        if (brightest * work.arriving[i] < least_light) {
            work.arriving[i] = 0;
            continue;
        }
        any = true;
        if (work.shaded && work.blockers.groups[i / block_size].any &&
            (surfaces.diffuse[i] > 0 || surfaces.finish[i]->shines))
            work.lit.push_back(i);
    }
    return any;
}

// What translucent surfaces leave of the light along the shadow ray from a surface point: a factor
// for each crossing, except those within shadow_margin of the one before.
Vec3 filtered(const World& world, const Surfaces& surfaces, std::size_t slot, const Vec3& toward,
              double distance) {
    const Vec3 origin = surfaces.position[slot];
    Vec3 light(1);
    Interiors inside = *surfaces.inside[slot];
    double from = 0;
    while (light != Vec3(0)) {
        Hit hit = {.t = distance - shadow_margin};
        const double nearest = from + shadow_margin;
        const bool shape = translucent_shape(world, origin, toward, nearest, hit);
        const bool facet = world.facets.translucent(origin, toward, nearest, hit.t, hit);
        if (!shape && !facet) break;
        light *= light_through(world, origin, toward, hit);
        const Finish& finish = world.finish_of(hit.object);
        if (!inside.toggle(hit.object) && finish.absorbs)
            for (int c = 0; c < 3; ++c)
                light[c] *= std::exp(-finish.absorption[c] * (hit.t - from));
        from = hit.t;
    }
    return light;
}

// Takes from the light of every point that gets some what translucent surfaces keep of it.
void filter_light(const World& world, const Surfaces& surfaces, LightWork& work) {
    for (const std::size_t i : work.lit) {
        if (work.arriving[i] == 0) continue;
        const Vec3 light = filtered(world, surfaces, i, work.toward[i], work.distance[i]);
        if (light == Vec3(0))
            work.arriving[i] = 0;
        else
            work.filter.set(i, light);
    }
}

// Asks what may block the shadow rays, block by block of the points that they start from.
void block(const World& world, LightWork& work) {
    work.asked.clear();
    const std::size_t count = work.shadows.count;
    for (std::size_t first = 0, last = 0; first < count; first = last) {
        const std::size_t group = work.lit[first] / block_size;
        while (last < count && work.lit[last] / block_size == group) ++last;
        const BlockedBy& by = work.blockers.groups[group];
        block_by_shapes(
            world,
            std::span(work.blockers.shapes).subspan(by.first_shape, by.last_shape - by.first_shape),
            work.shadows, first, last, work.visible);
        if (!by.facets) continue;
        for (std::size_t k = first; k < last; ++k)
            if (work.visible[k] != 0) work.asked.push_back(Index(k));
    }
    world.facets.block(work.shadows, work.asked, work.visible);
}

void cast_shadows(const World& world, const Surfaces& surfaces, LightWork& work) {
    ShadowRays& rays = work.shadows;
    rays.count = work.lit.size();
    if (rays.count == 0) return;
    for (std::size_t k = 0; k < rays.count; ++k) {
        const std::size_t i = work.lit[k];
        const Vec3 toward = work.toward[i];
        rays.origin.set(k, surfaces.position[i]);
        rays.direction.set(k, toward);
        rays.distance[k] = work.distance[i];
        rays.object[k] = surfaces.object[i];
        const bool on_facet = surfaces.object[i] < world.first_sphere();
        rays.grazing[k] = on_facet && std::abs(surfaces.facet_normal[i].dot(toward)) < grazing_sine;
        work.visible[k] = 1;
    }
    block(world, work);
    for (std::size_t k = 0; k < rays.count; ++k) work.arriving[work.lit[k]] *= work.visible[k];
}

// M K_S (R.V)^N of the lobes that the surface point shows; `mirrored` is R.V.
double highlight(const Finish& finish, const LobeMix& mix, double mirrored) {
    const auto lobe = [&](std::size_t i) {
        const PreparedLobe& l = finish.lobes[i];
        if (l.specular == 0 || mirrored < l.highlight_end) return 0.0;
        return l.specular * std::pow(mirrored, l.shininess);
    };
    if (mix.share == 0) return lobe(mix.first);
    return lobe(mix.first) * (1 - mix.share) + lobe(mix.first + 1) * mix.share;
}

void add_highlights(const World& world, const PreparedSource& source, const Surfaces& surfaces,
                    LightWork& work, Vectors& radiance) {
    // The distance has served; its array takes the cosine of the mirrored eye ray.
    std::vector<double>& mirrored_cosine = work.distance;
    dot_products(Lanes(surfaces.mirrored), Lanes(work.toward), surfaces.count,
                 mirrored_cosine.data());
    for (std::size_t i = 0; i < surfaces.count; ++i) {
        const double k = mirrored_cosine[i];
        const Finish& finish = *surfaces.finish[i];
        if (k <= 0 || work.arriving[i] == 0 || !finish.shines) continue;
        const double amount = highlight(finish, surfaces.lobes[i], k);
        if (amount == 0) continue;
        Vec3 light = source.color * (amount * work.arriving[i] * surfaces.coverage[i]);
        if (world.translucent) light *= work.filter[i];
        if (finish.metallic > 0)
            light *= metallic_tint(finish.metallic, work.cosine[i], surfaces.tint[i]);
        for (std::size_t c = 0; c < 3; ++c) radiance.axis[c][i] += light[int(c)];
    }
}

void add_source(const World& world, const PreparedSource& source, const Surfaces& surfaces,
                LightWork& work, Vectors& radiance) {
    aim(source, surfaces, work);
    weigh(source, surfaces, work);
    if (!gather_lit(source, surfaces, work)) return;
    cast_shadows(world, surfaces, work);
    if (world.translucent) {
        work.filter.fill(surfaces.count, 1);
        filter_light(world, surfaces, work);
    }
    for (std::size_t c = 0; c < 3; ++c) {
        const double* pigment = surfaces.pigment.axis[c].data();
        if (world.translucent) {
            multiply(pigment, work.filter.axis[c].data(), surfaces.count, work.filtered.data());
            pigment = work.filtered.data();
        }
        add_diffuse(pigment, source.color[int(c)], work.arriving.data(), work.cosine.data(),
                    surfaces.diffuse.data(), surfaces.count, radiance.axis[c].data());
    }
    add_highlights(world, source, surfaces, work, radiance);
}

// ---- one light ---------------------------------------------------------------------------------

Bounds bounds_of(const Surfaces& surfaces, std::size_t first, std::size_t last) {
    Bounds box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto& values = surfaces.position.axis[axis];
        const auto [low, high] = std::minmax_element(values.begin() + std::ptrdiff_t(first),
                                                     values.begin() + std::ptrdiff_t(last));
        box.min[int(axis)] = *low;
        box.max[int(axis)] = *high;
    }
    return box;
}

// Boxes around all points, and around those of each block.
void find_boxes(const Surfaces& surfaces, LightWork& work) {
    work.all = {};
    work.boxes.clear();
    for (std::size_t first = 0; first < surfaces.count; first += block_size) {
        const Bounds box = bounds_of(surfaces, first, std::min(first + block_size, surfaces.count));
        work.boxes.push_back(box);
        work.all.extend(box.min);
        work.all.extend(box.max);
    }
}

// Point sources that neither fade nor are too weak to count.
bool plain(const SourceGroup& light) {
    const PreparedSource& one = light.sources.front();
    return one.type == Light::Type::point && !one.fades &&
           std::max({one.color.x, one.color.y, one.color.z}) >= least_light;
}

bool matte(const Surfaces& surfaces) {
    return std::none_of(surfaces.finish.begin(),
                        surfaces.finish.begin() + std::ptrdiff_t(surfaces.count),
                        [](const Finish* finish) { return finish->shines; });
}

}  // namespace

LightWork::LightWork(std::size_t capacity)
    : toward(capacity), distance(capacity), cosine(capacity), arriving(capacity), filter(capacity),
      filtered(capacity), shadows(capacity), visible(capacity) {
    lit.reserve(capacity);
}

Vec3 metallic_tint(double metallic, double cosine, const Vec3& pigment) {
    const double x = std::acos(std::clamp(cosine, -1.0, 1.0)) / (std::numbers::pi / 2);
    const double curve =
        std::clamp(0.014567225 / ((x - 1.12) * (x - 1.12)) - 0.011612903, 0.0, 1.0);
    return Vec3(1) + (pigment - Vec3(1)) * (metallic * (1 - curve));
}

void add_direct_light(const World& world, const Surfaces& surfaces, LightWork& work,
                      Vectors& radiance) {
    if (surfaces.count == 0) return;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < surfaces.count; ++i)
            radiance.axis[c][i] += surfaces.own.axis[c][i];
    const bool all_matte = matte(surfaces);
    find_boxes(surfaces, work);
    for (const SourceGroup& light : world.lights) {
        work.shaded = work.blockers.find(world, work.all, work.boxes, light.box);
        if (!work.shaded && all_matte && plain(light)) {
            auto& [red, green, blue] = radiance.axis;
            add_open_matte(light.sources.data(), light.sources.size(), Lanes(surfaces.position),
                           Lanes(surfaces.normal), Lanes(surfaces.pigment), surfaces.diffuse.data(),
                           surfaces.count, red.data(), green.data(), blue.data());
            continue;
        }
        for (const PreparedSource& source : light.sources)
            add_source(world, source, surfaces, work, radiance);
    }
}

}  // namespace penumbra
