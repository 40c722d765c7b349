#include "penumbra/tracer.h"

#include "scene/check_options.h"
#include "scene/defects.h"
#include "scene/objects.h"
#include "tracer/accel/embree.h"
#include "tracer/prepared/prepared_scene.h"
#include "tracer/tiles.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cassert>

namespace penumbra {

namespace {

// Runs `work` with that many threads; 0: as many as the machine has.
template <class Work>
void with_threads(int threads, const Work& work) {
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    arena.execute(work);
}

std::vector<Light> single_sources(std::vector<Light> lights) {
    for (Light& light : lights) light.penumbra.delta = 0;
    return lights;
}

// No ray goes further than greatest_depth, so that all start near the camera.
bool in_reach(const Camera& camera) { return embree::takes(camera.position); }

bool need_copy(const Overrides& overrides, const Camera& camera) {
    return !overrides.shadows || !overrides.penumbrae || !in_reach(camera);
}

// A copy of the scene with what is not a matter of the camera alone.
PreparedScene overridden(const PreparedScene& prepared, const Overrides& overrides,
                         const Camera& camera) {
    PreparedScene copy = prepared;
    copy.shadows = overrides.shadows;
    if (!overrides.penumbrae)
        copy.lights = source_groups(single_sources(prepared.scene.lights), prepared.planes);
    if (!in_reach(camera)) copy.facets = std::make_shared<FacetAccel>();
    return copy;
}

// Calls work(Shot), with the threads that the options want.
template <class Work>
void take_picture(const PreparedScene& prepared, const RenderOptions& options,
                  const Overrides& overrides, const Work& work) {
    check(options);
    const Scene& scene = prepared.scene;
    const Camera camera = overrides.camera.value_or(scene.cameras[scene.camera]);
    assert(camera_defects(camera).empty());
    const Shift shift = {overrides.dx, overrides.dy};
    with_threads(options.threads, [&] {
        if (!need_copy(overrides, camera)) return work(Shot{prepared, camera, options, shift});
        const PreparedScene copy = overridden(prepared, overrides, camera);
        work(Shot{copy, camera, options, shift});
    });
}

void check(const RowRange& rows, int height) {
    const auto ends_band = [&](int row) { return row % render_band == 0 || row == height; };
    if (rows.first < 0 || rows.last < rows.first || rows.last > height || !ends_band(rows.first) ||
        !ends_band(rows.last))
        throw Error(Failure::usage, "",
                    fmt::format("the rows from {} to {} are no range of a picture of {} rows, or "
                                "begin or end within a band of {}",
                                rows.first, rows.last, height, render_band));
}

}  // namespace

struct Tracer::Prepared {
    const NormalisedScene* given = nullptr;
    int threads = 0;
    bool instances_move = false;
    std::unique_ptr<PreparedScene> scene = {};

    void prepare(const NormalisedScene& normalised) {
        assert(defects(normalised.scene).empty());
        with_threads(threads, [&] {
            scene = std::make_unique<PreparedScene>(normalised.scene, scene.get(), instances_move);
        });
        given = &normalised;
    }
};

Tracer::Tracer(const NormalisedScene& scene, int threads, bool instances_move)
    : prepared_(std::make_unique<Prepared>(
          Prepared{.threads = threads, .instances_move = instances_move})) {
    prepared_->prepare(scene);
}

Tracer::Tracer(Tracer&& other) noexcept = default;
Tracer& Tracer::operator=(Tracer&& other) noexcept = default;
Tracer::~Tracer() = default;

void Tracer::update(const NormalisedScene& scene) { prepared_->prepare(scene); }

const NormalisedScene& Tracer::scene() const { return *prepared_->given; }

Image Tracer::render(const RenderOptions& options, const Overrides& overrides,
                     const Watch& watch) const {
    check(options);
    Image image(options.width, options.height);
    const auto take = [&](int first, const Image& rows) {
        std::ranges::copy(rows.pixels, &image.at(0, first));
    };
    render_rows(options, {0, options.height}, take, overrides, watch);
    return image;
}

void Tracer::render_rows(const RenderOptions& options, const RowRange& rows, const TakeRows& take,
                         const Overrides& overrides, const Watch& watch) const {
    check(options);
    check(rows, options.height);
    if (rows.first == rows.last) return;
    take_picture(*prepared_->scene, options, overrides, [&](const Shot& shot) {
        if (watch.progress) watch.progress(0);
        render_tiles(shot, rows, take, watch);
    });
}

std::vector<Index> Tracer::objects_seen(const RenderOptions& options,
                                        const Overrides& overrides) const {
    std::vector<Index> objects;
    take_picture(*prepared_->scene, options, overrides,
                 [&](const Shot& shot) { objects = objects_in_picture(shot); });
    return objects;
}

std::vector<bool> Tracer::subject_seen(const RenderOptions& options) const {
    const Scene& shown = prepared_->scene->scene;
    std::vector<bool> seen;
    for (const Index object : objects_seen(options))
        seen.push_back(object != no_index && !is_backdrop(shown, object));
    return seen;
}

Image render(const NormalisedScene& scene, const RenderOptions& options, const Watch& watch) {
    return Tracer(scene, options.threads).render(options, {}, watch);
}

void render_rows(const NormalisedScene& scene, const RenderOptions& options, const RowRange& rows,
                 const TakeRows& take, const Watch& watch) {
    Tracer(scene, options.threads).render_rows(options, rows, take, {}, watch);
}

std::vector<Index> objects_seen(const NormalisedScene& scene, const RenderOptions& options) {
    return Tracer(scene, options.threads).objects_seen(options);
}

}  // namespace penumbra
