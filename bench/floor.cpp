// penumbra-floor: traces the rays of a picture with Embree and nothing else, in packets over blocks
// of 4 x 4 pixels, and says how long that took. No ray is saved and nothing is shaded: the least
// time that a tracer of the same rays can take with Embree's packets on this machine.
#include "arguments.h"
#include "floor_scene.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>
#include <pmmintrin.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <thread>

namespace penumbra::bench {
namespace {

constexpr int tile_side = 32;                      // pixels
constexpr float near_ray = 1e-4F, margin = 1e-3F;  // the tracer's tolerances

enum Kind { primary, mirror, shadow, kinds };

// What one thread did. The clock runs only where times by kind are asked for.
struct Tally {
    std::array<std::uint64_t, kinds> rays = {};
    std::array<double, kinds> seconds = {};
    std::uint64_t blocked = 0;  // shadow rays
};

double now() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

struct Width8 {
    using RayHits = RTCRayHit8;
    using Shadows = RTCRay8;
    static constexpr int size = 8, rows = 2;
};
struct Width16 {
    using RayHits = RTCRayHit16;
    using Shadows = RTCRay16;
    static constexpr int size = 16, rows = 4;
};

template <int Count>
using Floats = std::array<float, std::size_t(Count)>;

// Where the rays of one packet hit, and how they go on.
template <int Count>
struct Points {
    alignas(64) Floats<Count> x, y, z, nx, ny, nz;
    alignas(64) std::array<int, std::size_t(Count)> hit, plane, mirrors;
};

template <class Width>
void aim(const View& view, const RenderOptions& options, int left, int top,
         typename Width::RayHits& packet, int* valid) {
    for (int lane = 0; lane < Width::size; ++lane) {
        const int x = left + lane % 4, y = top + lane / 4;
        valid[lane] = x < options.width && y < options.height ? -1 : 0;
        const auto u = float((x + 0.5) / options.width - 0.5);
        const auto v = float(0.5 - (y + 0.5) / options.height);
        const Vec3f shift = Vec3f(view.right) * u + Vec3f(view.up) * v;
        const Vec3f from = Vec3f(view.location) + (view.orthographic ? shift : Vec3f(0));
        const Vec3f to =
            (Vec3f(view.direction) + (view.orthographic ? Vec3f(0) : shift)).normalized();
        packet.ray.org_x[lane] = from.x;
        packet.ray.org_y[lane] = from.y;
        packet.ray.org_z[lane] = from.z;
        packet.ray.dir_x[lane] = to.x;
        packet.ray.dir_y[lane] = to.y;
        packet.ray.dir_z[lane] = to.z;
    }
}

template <class Width>
void reset(typename Width::RayHits& packet) {
    for (int lane = 0; lane < Width::size; ++lane) {
        packet.ray.tnear[lane] = near_ray;
        packet.ray.tfar[lane] = 1e7F;
        packet.ray.time[lane] = 0;
        packet.ray.mask[lane] = ~0U;
        packet.ray.flags[lane] = 0;
        packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
}

// The normal that is shaded with, not unit.
template <class Width>
Vec3f normal_at(const Placed& placed, const typename Width::RayHits& packet, int lane) {
    Vec3f n(packet.hit.Ng_x[lane], packet.hit.Ng_y[lane], packet.hit.Ng_z[lane]);
    if (placed.normals != nullptr) {
        const auto& corners = placed.triangles[packet.hit.primID[lane]];
        const float u = packet.hit.u[lane], v = packet.hit.v[lane];
        n = placed.normals[corners[0]] * (1 - u - v) + placed.normals[corners[1]] * u +
            placed.normals[corners[2]] * v;
    }
    if (!placed.moved) return n;
    return placed.to_world[0] * n.x + placed.to_world[1] * n.y + placed.to_world[2] * n.z;
}

// Lowers the distances where a plane is nearer; a ray never meets the plane that it starts on.
template <class Width>
void meet_planes(const std::vector<FlatPlane>& planes, typename Width::RayHits& packet,
                 const int* valid, const int* start, int* nearest) {
    for (int lane = 0; lane < Width::size; ++lane) nearest[lane] = -1;
    for (int k = 0; k < int(planes.size()); ++k) {
        const FlatPlane& p = planes[std::size_t(k)];
        for (int lane = 0; lane < Width::size; ++lane) {
            const float along = p.normal.x * packet.ray.dir_x[lane] +
                                p.normal.y * packet.ray.dir_y[lane] +
                                p.normal.z * packet.ray.dir_z[lane];
            const float height = p.normal.x * packet.ray.org_x[lane] +
                                 p.normal.y * packet.ray.org_y[lane] +
                                 p.normal.z * packet.ray.org_z[lane];
            const float t = (p.distance - height) / along;
            const bool nearer = (valid[lane] != 0) & (start[lane] != k) & (t > near_ray) &
                                (t < packet.ray.tfar[lane]);
            packet.ray.tfar[lane] = nearer ? t : packet.ray.tfar[lane];
            nearest[lane] = nearer ? k : nearest[lane];
        }
    }
}

template <class Width>
void find_points(const FloorScene& scene, const typename Width::RayHits& packet, const int* valid,
                 Points<Width::size>& points) {
    for (int lane = 0; lane < Width::size; ++lane) {
        const auto i = std::size_t(lane);
        const bool facet = packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
        points.hit[i] = valid[lane] != 0 && (facet || points.plane[i] >= 0) ? -1 : 0;
        if (points.hit[i] == 0) continue;
        Vec3f n;
        if (points.plane[i] >= 0) {
            n = scene.planes[std::size_t(points.plane[i])].normal;
            points.mirrors[i] = scene.planes[std::size_t(points.plane[i])].mirrors ? 1 : 0;
        } else {
            const unsigned instance = packet.hit.instID[0][lane];
            const Placed& placed =
                scene.placed[instance != RTC_INVALID_GEOMETRY_ID ? instance
                                                                 : packet.hit.geomID[lane]];
            n = normal_at<Width>(placed, packet, lane);
            n *= 1 / std::sqrt(n.dot(n));
            points.mirrors[i] =
                placed.each.empty() ? placed.mirrors : placed.each[packet.hit.primID[lane]];
        }
        const Vec3f d(packet.ray.dir_x[lane], packet.ray.dir_y[lane], packet.ray.dir_z[lane]);
        if (n.dot(d) > 0) n = -n;
        points.nx[i] = n.x;
        points.ny[i] = n.y;
        points.nz[i] = n.z;
        points.x[i] = packet.ray.org_x[lane] + d.x * packet.ray.tfar[lane];
        points.y[i] = packet.ray.org_y[lane] + d.y * packet.ray.tfar[lane];
        points.z[i] = packet.ray.org_z[lane] + d.z * packet.ray.tfar[lane];
    }
}

// A ray to `source` from every point that faces it. Returns how many.
template <class Width>
int aim_at(const Vec3f& source, const Points<Width::size>& points, typename Width::Shadows& rays,
           int* valid) {
    int count = 0;
    for (int lane = 0; lane < Width::size; ++lane) {
        const auto i = std::size_t(lane);
        const float x = source.x - points.x[i], y = source.y - points.y[i],
                    z = source.z - points.z[i];
        const float length = std::sqrt(x * x + y * y + z * z), scale = 1 / length;
        const bool faces = points.nx[i] * x + points.ny[i] * y + points.nz[i] * z > 0;
        valid[lane] = (points.hit[i] != 0) & faces ? -1 : 0;
        count -= valid[lane];
        rays.org_x[lane] = points.x[i];
        rays.org_y[lane] = points.y[i];
        rays.org_z[lane] = points.z[i];
        rays.dir_x[lane] = x * scale;
        rays.dir_y[lane] = y * scale;
        rays.dir_z[lane] = z * scale;
        rays.tnear[lane] = margin;
        rays.tfar[lane] = length - margin;
        rays.time[lane] = 0;
        rays.mask[lane] = ~0U;
        rays.flags[lane] = 0;
    }
    return count;
}

// Is a plane between the start and the source?
template <class Width>
void meet_planes(const std::vector<FlatPlane>& planes, const Points<Width::size>& points,
                 typename Width::Shadows& rays) {
    for (int k = 0; k < int(planes.size()); ++k) {
        const FlatPlane& p = planes[std::size_t(k)];
        for (int lane = 0; lane < Width::size; ++lane) {
            const float along = p.normal.x * rays.dir_x[lane] + p.normal.y * rays.dir_y[lane] +
                                p.normal.z * rays.dir_z[lane];
            const float height = p.normal.x * rays.org_x[lane] + p.normal.y * rays.org_y[lane] +
                                 p.normal.z * rays.org_z[lane];
            const float t = (p.distance - height) / along;
            const bool between =
                (points.plane[std::size_t(lane)] != k) & (t > margin) & (t < rays.tfar[lane]);
            rays.tfar[lane] = between ? -1 : rays.tfar[lane];
        }
    }
}

struct Job {
    const FloorScene& scene;
    const View view;
    const RenderOptions& options;
    bool coherent_shadows = true;  // the packets of shadow rays stay together in the hierarchy
    bool timed = false;
};

template <class Width>
void trace_shadows(const Job& job, const Points<Width::size>& points, Tally& tally) {
    const FloorScene& scene = job.scene;
    embree::Query query(job.coherent_shadows);
    typename Width::Shadows rays{};
    alignas(64) std::array<int, std::size_t(Width::size)> valid{};
    for (const Vec3f& source : scene.sources) {
        const int count = aim_at<Width>(source, points, rays, valid.data());
        tally.rays[shadow] += std::uint64_t(count);
        if (count == 0) continue;
        embree::occluded(valid.data(), scene.scene, query, rays);
        meet_planes<Width>(scene.planes, points, rays);
        for (int lane = 0; lane < Width::size; ++lane)
            tally.blocked += valid[std::size_t(lane)] != 0 && rays.tfar[lane] < 0 ? 1 : 0;
    }
}

// Turns the rays into those that mirrors send on. Returns how many.
template <class Width>
int reflect(const Points<Width::size>& points, typename Width::RayHits& packet, int* valid) {
    int count = 0;
    for (int lane = 0; lane < Width::size; ++lane) {
        const auto i = std::size_t(lane);
        valid[lane] = points.hit[i] != 0 && points.mirrors[i] != 0 ? -1 : 0;
        count -= valid[lane];
        const float dx = packet.ray.dir_x[lane], dy = packet.ray.dir_y[lane],
                    dz = packet.ray.dir_z[lane];
        const float twice = 2 * (dx * points.nx[i] + dy * points.ny[i] + dz * points.nz[i]);
        packet.ray.dir_x[lane] = dx - twice * points.nx[i];
        packet.ray.dir_y[lane] = dy - twice * points.ny[i];
        packet.ray.dir_z[lane] = dz - twice * points.nz[i];
        packet.ray.org_x[lane] = points.x[i];
        packet.ray.org_y[lane] = points.y[i];
        packet.ray.org_z[lane] = points.z[i];
    }
    return count;
}

template <class Width>
void trace_block(const Job& job, int left, int top, Tally& tally) {
    typename Width::RayHits packet{};
    Points<Width::size> points{};
    alignas(64) std::array<int, std::size_t(Width::size)> valid{}, start{};
    aim<Width>(job.view, job.options, left, top, packet, valid.data());
    int count = 0;
    for (const int lane : valid) count -= lane;
    start.fill(-1);
    for (int depth = 1; count > 0 && depth <= job.options.max_depth; ++depth) {
        const Kind kind = depth == 1 ? primary : mirror;
        const double began = job.timed ? now() : 0;
        embree::Query query(depth == 1 && !job.scene.instanced);
        reset<Width>(packet);
        embree::intersect(valid.data(), job.scene.scene, query, packet);
        meet_planes<Width>(job.scene.planes, packet, valid.data(), start.data(),
                           points.plane.data());
        find_points<Width>(job.scene, packet, valid.data(), points);
        tally.rays[kind] += std::uint64_t(count);
        const double found = job.timed ? now() : 0;
        trace_shadows<Width>(job, points, tally);
        if (job.timed) {
            tally.seconds[kind] += found - began;
            tally.seconds[shadow] += now() - found;
        }
        start = points.plane;
        count = reflect<Width>(points, packet, valid.data());
    }
}

template <class Width>
void trace_tiles(const Job& job, std::atomic<int>& next, Tally& tally) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    const int across = (job.options.width + tile_side - 1) / tile_side;
    const int down = (job.options.height + tile_side - 1) / tile_side;
    for (int tile = next++; tile < across * down; tile = next++) {
        const int left = tile % across * tile_side, top = tile / across * tile_side;
        for (int y = top; y < top + tile_side; y += Width::rows)
            for (int x = left; x < left + tile_side; x += 4) trace_block<Width>(job, x, y, tally);
    }
}

Tally trace(const Job& job, int threads) {
    const bool wide =
        rtcGetDeviceProperty(job.scene.device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
    std::atomic<int> next = 0;
    std::vector<Tally> tallies{std::size_t(threads), Tally()};
    std::vector<std::jthread> workers;
    const auto work = [&](Tally& tally) {
        Tally own;  // on this thread's stack: no cache line is shared
        wide ? trace_tiles<Width16>(job, next, own) : trace_tiles<Width8>(job, next, own);
        tally = own;
    };
    for (int i = 1; i < threads; ++i)
        workers.emplace_back([&, i] { work(tallies[std::size_t(i)]); });
    work(tallies[0]);
    workers.clear();  // joins
    Tally sum;
    for (const Tally& tally : tallies) {
        for (std::size_t k = 0; k < kinds; ++k) {
            sum.rays[k] += tally.rays[k];
            sum.seconds[k] += tally.seconds[k];
        }
        sum.blocked += tally.blocked;
    }
    return sum;
}

// The whole picture once.
struct Pass {
    Tally tally = {};
    double wall = 0, cpu = 1e300;
    bool coherent_shadows = false;
};

Pass trace_all(const Job& job, int threads) {
    const double start = now();
    const std::clock_t cpu = std::clock();
    Pass pass = {.tally = trace(job, threads), .coherent_shadows = job.coherent_shadows};
    pass.wall = now() - start;
    pass.cpu = double(std::clock() - cpu) / CLOCKS_PER_SEC;
    return pass;
}

void run(const Arguments& arguments) {
    if (arguments.names.empty())
        throw Error(Failure::usage, "",
                    "usage: penumbra-floor SCENE... [--set KEY=VALUE] [--threads N]");
    const double start = now();
    Imported imported =
        load_scene({arguments.names.begin(), arguments.names.end()}, arguments.load);
    const RenderOptions options = imported.render;
    const NormalisedScene normalised = normalise(std::move(imported.scene), options);
    const double loaded = now();
    FloorScene scene;
    build(normalised.scene, arguments.threads, scene);
    const double built = now();
    const Camera& camera = normalised.scene.cameras[normalised.scene.camera];
    Job job = {scene, view_of(camera, options.width, options.height), options};
    Pass fastest;
    // Which is faster depends on the size of the facets. Embree 3.13's coherent traversal never
    // returns from rtcOccluded16 on instances.
    for (const bool coherent : {false, true}) {
        if (coherent && scene.instanced) continue;
        job.coherent_shadows = coherent;
        const Pass pass = trace_all(job, arguments.threads);
        if (pass.cpu < fastest.cpu) fastest = pass;
    }
    job.coherent_shadows = fastest.coherent_shadows;
    job.timed = true;
    const Tally& tally = fastest.tally;
    const Tally by_kind = trace_all(job, arguments.threads).tally;
    fmt::print("{{\"facets\": {}, \"sources\": {}, \"coherent_shadows\": {},\n",
               facet_count(normalised.scene), scene.sources.size(), fastest.coherent_shadows);
    fmt::print(" \"seconds\": {{\"import\": {:.4f}, \"build\": {:.4f}, \"render\": {:.4f}, "
               "\"render_cpu\": {:.4f}}},\n",
               loaded - start, built - loaded, fastest.wall, fastest.cpu);
    fmt::print(" \"rays\": {{\"primary\": {}, \"mirror\": {}, \"shadow\": {}, \"blocked\": {}}},\n",
               tally.rays[primary], tally.rays[mirror], tally.rays[shadow], tally.blocked);
    fmt::print(" \"thread_seconds\": {{\"primary\": {:.4f}, \"mirror\": {:.4f}, "
               "\"shadow\": {:.4f}}}}}\n",
               by_kind.seconds[primary], by_kind.seconds[mirror], by_kind.seconds[shadow]);
}

}  // namespace
}  // namespace penumbra::bench

int main(int count, char** words) try {
    penumbra::bench::run(penumbra::bench::parse(count, words));
    return 0;
} catch (const penumbra::Error& error) {
    std::fprintf(stderr, "penumbra-floor: %s\n", error.what());
    return 1;
}
