#include "penumbra/tracer.h"

#include "lighting.h"
#include "scatter.h"
#include "shapes.h"
#include "tile_rows.h"
#include "variation.h"
#include "world.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

namespace penumbra {

namespace {

// A point of a pixel relative to its centre, in pixels, and how much it counts.
struct PixelSample {
    double x = 0, y = 0, weight = 1;
};

// POV-Ray's fixed grid (`+AM1 +R<n> +A0.0 -J`): n x n and the centre once more.
std::vector<PixelSample> pixel_samples(int n, const Variation& variation) {
    const double x = variation.dx, y = variation.dy;
    if (n <= 1) return {{x, y}};
    const double weight = 1.0 / (n * n + 1);
    std::vector<PixelSample> samples = {{x, y, weight}};
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            samples.push_back({x + (i + 0.5) / n - 0.5, y + (j + 0.5) / n - 0.5, weight});
    return samples;
}

// What one thread needs to trace a tile; kept from tile to tile.
struct Workspace {
    Generation current, next;
    Hits hits;
    std::vector<Index> shapes;  // scratch
    Surfaces surfaces;
    std::vector<std::uint64_t> order, sorted;  // of the rays that hit: a key and the ray
    std::vector<std::size_t> ray_of;           // surface point -> ray
    Vectors radiance;
    LightWork light;
    std::vector<Vec3> pixels;  // of the tile

    Workspace()
        : current(capacity), next(capacity), hits(capacity), surfaces(capacity), radiance(capacity),
          light(capacity), pixels(capacity) {}

    static constexpr std::size_t capacity = std::size_t(tile_side) * tile_side;
};

struct Job {
    const World& world;
    const View view;
    const RenderOptions& options;
    const std::vector<PixelSample> samples;
    const Interiors inside;
};

void add_primary_ray(const Job& job, double x, double y, const Path& path, Generation& rays) {
    const double u = (x + 0.5) / job.options.width - 0.5;
    const double v = 0.5 - (y + 0.5) / job.options.height;
    const Vec3 shift = job.view.right * u + job.view.up * v;
    if (job.view.orthographic)
        rays.push(job.view.location + shift, job.view.direction, path);
    else
        rays.push(job.view.location, (job.view.direction + shift).normalized(), path);
}

struct TilePixel {
    int x = 0, y = 0;
};

// The pixels of a tile along a Z-order curve (Morton 1966): the bits of x and y take turns.
constexpr std::array<TilePixel, std::size_t(tile_side)* tile_side> curve = [] {
    std::array<TilePixel, std::size_t(tile_side) * tile_side> pixels{};
    for (unsigned i = 0; i < pixels.size(); ++i)
        for (unsigned bit = 0; bit < 5; ++bit) {
            pixels[i].x |= int(i >> bit & 1U << bit);
            pixels[i].y |= int(i >> (bit + 1) & 1U << bit);
        }
    return pixels;
}();

// The rays of a packet are close together, and so are those of a few packets.
void primary_rays(const Job& job, const Tile& tile, const PixelSample& sample, Generation& rays) {
    rays.clear();
    for (const auto& [x, y] : curve) {
        if (x >= tile.width || y >= tile.height) continue;
        const Path path = {.weight = Vec3(sample.weight),
                           .pixel = std::uint32_t(y * tile.width + x),
                           .inside = job.inside};
        add_primary_ray(job, tile.x + x + sample.x, tile.y + y + sample.y, path, rays);
    }
}

void find_hits(const World& world, bool coherent, Workspace& work) {
    work.hits.clear(work.current.rays.count);
    closest_shapes(world, work.current.rays, work.hits, work.shapes);
    world.facets.closest(work.current.rays, work.hits, coherent);
}

// What a ray that hits nothing sees.
Vec3 sky_light(const World& world, const Vec3& direction) {
    if (!world.scene.sky) return Vec3(world.scene.background);
    const Vec2 uv = sky_texcoord(direction);
    return Vec3(sample(world.samplers[world.scene.sky->texture], uv.x, uv.y)) *
           world.scene.sky->gain;
}

// Three bits of each of the lowest ten bits of a number: 0, 3, 6, ...
std::uint32_t spread(std::uint32_t x) {
    x = (x | (x << 16U)) & 0x030000FFU;
    x = (x | (x << 8U)) & 0x0300F00FU;
    x = (x | (x << 4U)) & 0x030C30C3U;
    return (x | (x << 2U)) & 0x09249249U;
}

// The place of a point on a Z-order curve through the box.
std::uint32_t place_on_curve(const Vec3& point, const Bounds& box) {
    std::uint32_t place = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double share = (point[axis] - box.min[axis]) / (box.max[axis] - box.min[axis]);
        place |= spread(std::uint32_t(std::clamp(share, 0.0, 1.0) * 1023)) << unsigned(axis);
    }
    return place;
}

// Orders entries by their upper half, of which 30 bits are in use: least significant digit first.
void sort_by_key(std::vector<std::uint64_t>& entries, std::vector<std::uint64_t>& scratch) {
    constexpr unsigned digit_bits = 10;
    constexpr std::size_t digits = 1U << digit_bits;
    scratch.resize(entries.size());
    for (unsigned shift = 32; shift < 32 + 3 * digit_bits; shift += digit_bits) {
        std::array<std::uint32_t, digits> place{};
        const auto digit = [&](std::uint64_t entry) { return entry >> shift & (digits - 1); };
        for (const std::uint64_t entry : entries) ++place[digit(entry)];
        std::exclusive_scan(place.begin(), place.end(), place.begin(), 0U);
        for (const std::uint64_t entry : entries) scratch[place[digit(entry)]++] = entry;
        entries.swap(scratch);
    }
}

// Lists the rays that hit something. What mirrors scatter is brought together again, so that blocks
// of surface points stay small.
void order_hits(const World& world, bool coherent, Workspace& work) {
    const Generation& rays = work.current;
    work.order.clear();
    for (std::size_t i = 0; i < rays.rays.count; ++i) {
        if (work.hits.object[i] == no_index) {
            work.pixels[rays.paths[i].pixel] +=
                rays.paths[i].weight * sky_light(world, rays.rays.direction[i]);
            continue;
        }
        std::uint64_t key = 0;
        if (!coherent)
            key = place_on_curve(rays.rays.origin[i] + rays.rays.direction[i] * work.hits.t[i],
                                 world.surroundings);
        work.order.push_back(key << 32U | i);
    }
    if (!coherent) sort_by_key(work.order, work.sorted);
}

void find_surfaces(const World& world, Workspace& work) {
    const Generation& rays = work.current;
    if (work.surfaces.finish.size() < rays.rays.count) {
        work.surfaces.resize(rays.rays.count);
        work.light = LightWork(rays.rays.count);
    }
    work.surfaces.count = 0;
    work.ray_of.clear();
    for (const std::uint64_t entry : work.order) {
        const std::size_t i = entry & 0xFFFFFFFFU;
        work.surfaces.inside[work.surfaces.count] = &rays.paths[i].inside;
        find_surface(world, rays.rays.origin[i], rays.rays.direction[i], work.hits[i],
                     work.surfaces, work.surfaces.count++);
        work.ray_of.push_back(i);
    }
}

// One generation after the other: all rays of a tile that were reflected equally often are traced
// together, then what they send on. The recursion of the light model is this loop.
void trace_generations(const Job& job, Workspace& work) {
    bool coherent = true;
    while (work.current.rays.count > 0) {
        find_hits(job.world, coherent, work);
        order_hits(job.world, coherent, work);
        find_surfaces(job.world, work);
        work.radiance.clear(work.surfaces.count);
        add_direct_light(job.world, work.surfaces, work.light, work.radiance);
        work.next.clear();
        for (std::size_t k = 0; k < work.surfaces.count; ++k) {
            const Path& path = work.current.paths[work.ray_of[k]];
            work.pixels[path.pixel] += path.weight * work.radiance[k];
            scatter(job.world, work.surfaces, k, path, job.options.max_depth, work.next);
        }
        std::swap(work.current, work.next);
        coherent = false;
    }
}

// `rows` begin with the first of the tile.
void render_tile(const Job& job, const Tile& tile, Workspace& work, Image& rows) {
    work.pixels.assign(Workspace::capacity, Vec3(0));
    for (const PixelSample& sample : job.samples) {
        primary_rays(job, tile, sample, work.current);
        trace_generations(job, work);
    }
    for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x)
            rows.at(tile.x + x, y) =
                Color(work.pixels[std::size_t(y) * std::size_t(tile.width) + std::size_t(x)]);
}

// What one thread does until no tiles are left.
void work_on(const Job& job, const Watch& watch, std::mutex& reporting, TileRows& tiles) {
    Workspace work;
    while (const auto next = tiles.next()) {
        if (watch.stop.stop_requested()) return tiles.stop();
        render_tile(job, next->tile, work, *next->rows);
        const double done = tiles.finish(next->tile);
        if (!watch.progress) continue;
        const std::lock_guard lock(reporting);
        watch.progress(done);
    }
}

void render_tiles(const Job& job, const RowRange& rows, const TakeRows& take, const Watch& watch) {
    TileRows tiles(job.options, rows, take);
    std::mutex reporting;
    const int threads = tbb::this_task_arena::max_concurrency();
    tbb::parallel_for(
        tbb::blocked_range<int>(0, threads, 1),
        [&](const tbb::blocked_range<int>&) {
            try {
                work_on(job, watch, reporting, tiles);
            } catch (...) {
                tiles.stop();  // or the others would wait for this one
                throw;
            }
        },
        tbb::simple_partitioner());
    if (watch.stop.stop_requested()) throw Error(Failure::interrupted, "", "interrupted");
}

void render_from(const NormalisedScene& normalised, const RenderOptions& options,
                 const Variation& variation, const RowRange& rows, const TakeRows& take,
                 const Watch& watch) {
    const Scene& scene = normalised.scene;
    tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
    arena.execute([&] {
        World world(scene);
        world.shadows = variation.shadows;
        const View view = view_of(scene.cameras[scene.camera], options.width, options.height);
        const Job job = {world, view, options, pixel_samples(options.samples, variation),
                         interiors_at(world, view.location)};
        if (watch.progress) watch.progress(0);
        render_tiles(job, rows, take, watch);
    });
}

}  // namespace

Image render(const NormalisedScene& normalised, const RenderOptions& options, const Watch& watch) {
    return render_variation(normalised, options, {}, watch);
}

Image render_variation(const NormalisedScene& normalised, const RenderOptions& options,
                       const Variation& variation, const Watch& watch) {
    Image image(options.width, options.height);
    const auto take = [&](int first, const Image& rows) {
        std::ranges::copy(rows.pixels, &image.at(0, first));
    };
    render_from(normalised, options, variation, {0, options.height}, take, watch);
    return image;
}

void render_rows(const NormalisedScene& scene, const RenderOptions& options, const RowRange& rows,
                 const TakeRows& take, const Watch& watch) {
    render_from(scene, options, {}, rows, take, watch);
}

}  // namespace penumbra
