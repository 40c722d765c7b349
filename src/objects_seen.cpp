// Which object each pixel shows.
#include "shapes.h"
#include "world.h"

#include "penumbra/tracer.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace penumbra {
namespace {

// The rays through the centres of one row.
Rays row_of_rays(const View& view, const RenderOptions& options, int y) {
    Rays rays(std::size_t(options.width));
    const double v = 0.5 - (y + 0.5) / options.height;
    for (int x = 0; x < options.width; ++x) {
        const double u = (x + 0.5) / options.width - 0.5;
        const Vec3 shift = view.right * u + view.up * v;
        rays.origin.set(std::size_t(x), view.orthographic ? view.location + shift : view.location);
        rays.direction.set(std::size_t(x), view.orthographic
                                               ? view.direction
                                               : (view.direction + shift).normalized());
    }
    rays.count = std::size_t(options.width);
    return rays;
}

}  // namespace

std::vector<Index> objects_seen(const NormalisedScene& normalised, const RenderOptions& options) {
    const Scene& scene = normalised.scene;
    std::vector<Index> objects(std::size_t(options.width) * std::size_t(options.height), no_index);
    tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
    arena.execute([&] {
        const World world(scene);
        const View view = view_of(scene.cameras[scene.camera], options.width, options.height);
        tbb::parallel_for(0, options.height, [&](int y) {
            const Rays rays = row_of_rays(view, options, y);
            Hits hits(rays.count);
            std::vector<Index> scratch;
            closest_shapes(world, rays, hits, scratch);
            world.facets.closest(rays, hits, true);
            std::ranges::copy(hits.object, objects.begin() + std::ptrdiff_t(y) * options.width);
        });
    });
    return objects;
}

}  // namespace penumbra
