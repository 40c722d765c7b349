// The loops over the tiles of a picture and over the generations of rays of a tile.
#include "tracer/tiles.h"

#include "base/isolated.h"
#include "scene/mirror_sky.h"
#include "scene/view.h"
#include "tracer/back_light.h"
#include "tracer/direct_light.h"
#include "tracer/mirrors.h"
#include "tracer/pixel_sampler.h"
#include "tracer/prepared/shapes.h"
#include "tracer/ray_order.h"
#include "tracer/scatter.h"
#include "tracer/tile_rows.h"

#include "penumbra/light_model.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <span>
#include <stop_token>

namespace penumbra {

namespace {

// A point of a pixel relative to its centre, in pixels, and how much it counts.
struct PixelSample {
    double x = 0, y = 0, weight = 1;
};

// POV-Ray's fixed grid (`+AM1 +R<n> +A0.0 -J`): n x n and the centre once more.
std::vector<PixelSample> pixel_samples(int n, const Shift& shift) {
    const double x = shift.x, y = shift.y;
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
    struct {
        std::vector<double> t;
        std::vector<Index> object;
    } before;  // hits, scratch
    SurfacePoints surfaces;
    std::vector<std::uint64_t> order, sorted;  // of the rays that hit: a key and the ray
    std::vector<std::size_t> ray_of;           // surface point -> ray
    Vec3Array radiance;
    LightWork light;
    Media media;               // of the tile's paths
    std::vector<Vec3> pixels;  // of the tile, or of points that are traced together
    AdaptiveSampler sampler;

    Workspace()
        : current(capacity), next(capacity), hits(capacity), surfaces(capacity), radiance(capacity),
          light(capacity), pixels(capacity) {}

    // As many as a tile's pixels have corners.
    static constexpr std::size_t capacity = std::size_t(tile_side + 1) * (tile_side + 1);
};

// One picture of a scene.
struct Job {
    const PreparedScene& prepared;
    const View view;
    const RenderOptions& options;
    const Shift shift;
    const std::vector<PixelSample> samples;
    const MediumStack inside;  // where the eye is
    const std::stop_token& stop;
    const Vec3 sky_center = mirror_sky_center(prepared.scene);
};

// The ray through a point of the picture, in pixels from its upper left corner.
CameraRay ray_through(const View& view, const RenderOptions& options, double x, double y) {
    return camera_ray(view, x / options.width - 0.5, 0.5 - y / options.height);
}

struct TilePixel {
    int x = 0, y = 0;
};

// The pixels of a tile along a Z-order curve (Morton 1966): the bits of x and y take turns.
constexpr std::array<TilePixel, std::size_t(tile_side) * tile_side> curve = [] {
    std::array<TilePixel, std::size_t(tile_side) * tile_side> pixels{};
    for (unsigned i = 0; i < pixels.size(); ++i)
        for (unsigned bit = 0; bit < 5; ++bit) {
            pixels[i].x |= int(i >> bit & 1U << bit);
            pixels[i].y |= int(i >> (bit + 1) & 1U << bit);
        }
    return pixels;
}();

// The rays of a packet are close together, and so are those of a few packets.
void primary_rays(const Job& job, const PictureTile& tile, const PixelSample& sample,
                  Generation& rays) {
    rays.clear();
    for (const auto& [x, y] : curve) {
        if (x >= tile.width || y >= tile.height) continue;
        const Path path = {.weight = Vec3(sample.weight),
                           .pixel = std::uint32_t(y * tile.width + x),
                           .inside = job.inside};
        // The pixel's centre first, as POV-Ray adds.
        const CameraRay ray = ray_through(job.view, job.options, tile.x + x + sample.x + 0.5,
                                          tile.y + y + sample.y + 0.5);
        rays.push(ray.origin, ray.direction, path);
    }
}

// Of a plane that rays which were mirrored do not see.
void find_hits_on_unmirrored(const PreparedScene& prepared, std::size_t plane, bool coherent,
                             Workspace& work) {
    const Generation& rays = work.current;
    if (coherent) return closest_on_plane(prepared, plane, rays.rays, work.hits);  // from the eye
    work.before = {work.hits.t, work.hits.object};
    closest_on_plane(prepared, plane, rays.rays, work.hits);
    for (std::size_t i = 0; i < rays.rays.count; ++i) {
        if (!rays.paths[i].mirrored) continue;
        work.hits.t[i] = work.before.t[i];
        work.hits.object[i] = work.before.object[i];
    }
}

void find_hits(const PreparedScene& prepared, bool coherent, Workspace& work) {
    work.hits.clear(work.current.rays.count);
    closest_shapes(prepared, work.current.rays, work.hits, work.shapes);
    for (std::size_t k = 0; k < prepared.planes.size(); ++k)
        if (!prepared.scene.planes[k].in_mirrors)
            find_hits_on_unmirrored(prepared, k, coherent, work);
    prepared.facets->closest(work.current.rays, work.hits, coherent);
}

Vec3 light_of(const PreparedScene& prepared, const Sky& sky, const Vec3& direction) {
    const Vec2 uv = sky_texcoord(sky, direction);
    return Vec3(sample(prepared.textures[sky.texture], uv.x, uv.y)) * sky.gain;
}

// What a ray that hits nothing sees.
Vec3 sky_light(const Job& job, const Rays& rays, std::size_t i, bool mirrored) {
    const PreparedScene& prepared = job.prepared;
    const Scene& scene = prepared.scene;
    const Vec3 direction = rays.direction[i];
    if (mirrored && scene.mirror_sky)
        return light_of(prepared, *scene.mirror_sky,
                        on_mirror_sky(rays.origin[i] - job.sky_center, direction));
    if (scene.sky) return light_of(prepared, *scene.sky, direction);
    return Vec3(scene.background);
}

// Lists the rays that hit something. What mirrors scatter is brought together again, so that blocks
// of surface points stay small.
void order_hits(const Job& job, bool coherent, Workspace& work) {
    const PreparedScene& prepared = job.prepared;
    const Generation& rays = work.current;
    work.order.clear();
    for (std::size_t i = 0; i < rays.rays.count; ++i) {
        if (work.hits.object[i] == no_index) {
            const Path& path = rays.paths[i];
            work.pixels[path.pixel] += path.weight * sky_light(job, rays.rays, i, path.mirrored);
            continue;
        }
        std::uint64_t key = 0;
        if (!coherent)
            key = place_on_curve(rays.rays.origin[i] + rays.rays.direction[i] * work.hits.t[i],
                                 prepared.surroundings);
        work.order.push_back(key << 32U | i);
    }
    if (!coherent) sort_by_key(work.order, work.sorted);
}

void find_surface_points(const PreparedScene& prepared, Workspace& work) {
    const Generation& rays = work.current;
    const std::size_t most = prepared.blended ? 2 * rays.rays.count : rays.rays.count;
    if (work.surfaces.material.size() < most) {
        work.surfaces.resize(most);
        work.light = LightWork(most);
    }
    work.surfaces.count = 0;
    work.ray_of.clear();
    for (const std::uint64_t entry : work.order) {
        const std::size_t i = entry & 0xFFFFFFFFU;
        work.surfaces.inside[work.surfaces.count] = rays.paths[i].inside;
        const std::size_t found =
            find_surface_point(prepared, rays.rays.origin[i], rays.rays.direction[i], work.hits[i],
                               work.surfaces, work.surfaces.count);
        for (std::size_t k = 0; k < found; ++k)
            if (const std::size_t slot = work.surfaces.count + k;
                work.surfaces.material[slot]->takes_reflected)
                find_kept(prepared, rays.paths[i].mirrored, work.surfaces, slot);
        work.surfaces.count += found;
        work.ray_of.insert(work.ray_of.end(), found, i);
    }
}

// Adds the light of a surface point to its pixel, and goes on from there.
void follow(const Job& job, std::size_t point, const Path& path, Workspace& work) {
    work.pixels[path.pixel] += path.weight * work.radiance[point];
    scatter(job.prepared, work.surfaces, point, path,
            {job.options.max_depth, work.media, work.next});
}

// One generation after the other: all rays of a tile that were reflected equally often are traced
// together, then what they send on. The recursion of the light model is this loop.
void trace_generations(const Job& job, Workspace& work) {
    bool coherent = true;
    while (work.current.rays.count > 0) {
        find_hits(job.prepared, coherent, work);
        order_hits(job, coherent, work);
        find_surface_points(job.prepared, work);
        work.radiance.clear(work.surfaces.count);
        add_direct_light(job.prepared, work.surfaces, work.light, work.radiance);
        if (job.prepared.backlit) add_back_light(job.prepared, work.surfaces, work.radiance);
        work.next.clear();
        for (std::size_t k = 0; k < work.surfaces.count; ++k) {
            const Path& path = work.current.paths[work.ray_of[k]];
            const double share = work.surfaces.share[k];
            if (share == 1) {
                follow(job, k, path, work);
            } else if (share > 0) {
                Path part = path;
                part.weight *= share;
                follow(job, k, part, work);
            }
        }
        std::swap(work.current, work.next);
        coherent = false;
    }
}

void render_fixed(const Job& job, const PictureTile& tile, Workspace& work) {
    work.pixels.assign(Workspace::capacity, Vec3(0));
    for (const PixelSample& sample : job.samples) {
        work.media.clear();
        primary_rays(job, tile, sample, work.current);
        trace_generations(job, work);
    }
}

// The light that comes from points of the picture.
void trace_points(const Job& job, std::span<const Vec2> points, std::span<Color> colors,
                  Workspace& work) {
    for (std::size_t first = 0; first < points.size(); first += Workspace::capacity) {
        // A tile may have any number of them.
        if (job.stop.stop_requested()) throw Error(Failure::interrupted, "", "interrupted");
        const std::size_t count = std::min(points.size() - first, Workspace::capacity);
        work.pixels.assign(count, Vec3(0));
        work.media.clear();
        work.current.clear();
        for (std::size_t i = 0; i < count; ++i) {
            const Vec2 at = points[first + i] + Vec2(job.shift.x, job.shift.y);
            const CameraRay ray = ray_through(job.view, job.options, at.x, at.y);
            work.current.push(ray.origin, ray.direction,
                              {.pixel = std::uint32_t(i), .inside = job.inside});
        }
        trace_generations(job, work);
        for (std::size_t i = 0; i < count; ++i) colors[first + i] = Color(work.pixels[i]);
    }
}

// `rows` begin with the first of the tile.
void render_tile(const Job& job, const PictureTile& tile, Workspace& work, Image& rows) {
    if (job.options.antialiasing)
        work.sampler.sample(tile, *job.options.antialiasing,
                            [&](std::span<const Vec2> points, std::span<Color> colors) {
                                trace_points(job, points, colors, work);
                            });
    else
        render_fixed(job, tile, work);
    const std::vector<Vec3>& pixels =
        job.options.antialiasing ? work.sampler.pixels() : work.pixels;
    for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x)
            rows.at(tile.x + x, y) =
                Color(pixels[std::size_t(y) * std::size_t(tile.width) + std::size_t(x)]);
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
        call_isolated([&] { watch.progress(done); });
    }
}

}  // namespace

void render_tiles(const Shot& shot, const RowRange& rows, const TakeRows& take,
                  const Watch& watch) {
    const View view = view_of(shot.camera, shot.options.width, shot.options.height);
    Media media;  // around the eye
    const Job job = {shot.prepared,
                     view,
                     shot.options,
                     shot.shift,
                     pixel_samples(shot.options.samples, shot.shift),
                     media_at(shot.prepared, view.location, media),
                     watch.stop};
    TileRows tiles(shot.options, rows, take);
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

std::vector<Index> objects_in_picture(const Shot& shot) {
    const RenderOptions& options = shot.options;
    const View view = view_of(shot.camera, options.width, options.height);
    const auto width = std::size_t(options.width), height = std::size_t(options.height);
    std::vector<Index> objects(width * height, no_index);
    tbb::parallel_for(std::size_t(0), height, [&](std::size_t y) {
        Rays rays(width);
        for (rays.count = 0; rays.count < width; ++rays.count) {
            const CameraRay ray =
                ray_through(view, options, double(rays.count) + 0.5, double(y) + 0.5);
            rays.origin.set(rays.count, ray.origin);
            rays.direction.set(rays.count, ray.direction);
        }
        Hits hits(width);
        std::vector<Index> scratch;
        closest_shapes(shot.prepared, rays, hits, scratch);
        shot.prepared.facets->closest(rays, hits, true);
        std::ranges::copy(hits.object, objects.begin() + std::ptrdiff_t(y * width));
    });
    return objects;
}

}  // namespace penumbra
