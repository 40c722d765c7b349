#include "tracer/accel/embree.h"

#include "base/memory.h"

#include "penumbra/error.h"
#include "penumbra/limits.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra::embree {
namespace {

bool may_allocate(void*, ssize_t bytes, bool done) {
    return done || bytes <= 0 || memory_is_left(std::size_t(bytes));
}

// Three numbers an item.
void* new_buffer(const Device& device, const Geometry& geometry, RTCBufferType type,
                 std::size_t count) {
    const bool vertices = type == RTC_BUFFER_TYPE_VERTEX;
    void* const buffer = rtcSetNewGeometryBuffer(
        geometry.get(), type, 0, vertices ? RTC_FORMAT_FLOAT3 : RTC_FORMAT_UINT3,
        3 * (vertices ? sizeof(float) : sizeof(unsigned)), std::max<std::size_t>(count, 1));
    if (buffer != nullptr) return buffer;
    check(device);
    throw Error(Failure::input, "",
                fmt::format("Embree makes no room for a mesh with {} {}", count,
                            vertices ? "vertices" : "facets"));
}

}  // namespace

Device new_device() {
    // ThreadSanitizer does not see how Embree's own threads wait for each other.
#if defined(__SANITIZE_THREAD__)
    Device device(rtcNewDevice("threads=1"));
#else
    Device device(rtcNewDevice(nullptr));
#endif
    rtcSetDeviceMemoryMonitorFunction(device.get(), may_allocate, nullptr);
    return device;
}

void check(const Device& device) {
    switch (rtcGetDeviceError(device.get())) {
    case RTC_ERROR_NONE: return;
    case RTC_ERROR_OUT_OF_MEMORY:
    case RTC_ERROR_CANCELLED:
        throw MemoryError(Failure::input, "",
                          memory_limit() == 0
                              ? std::string("the scene has more facets than there is memory for")
                              : fmt::format("the scene has more facets than the {} of memory that "
                                            "may be used suffice for",
                                            memory_text(memory_limit())));
    default: throw Error(Failure::input, "", "Embree cannot prepare the scene for rendering");
    }
}

float* new_vertices(const Device& device, const Geometry& geometry, std::size_t count) {
    return static_cast<float*>(new_buffer(device, geometry, RTC_BUFFER_TYPE_VERTEX, count));
}

unsigned* new_indices(const Device& device, const Geometry& geometry, std::size_t count) {
    return static_cast<unsigned*>(new_buffer(device, geometry, RTC_BUFFER_TYPE_INDEX, count));
}

namespace {

#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;
#else
using Context = RTCIntersectContext;
#endif

struct Collecting : Context {
    std::vector<Hit>* crossings = nullptr;
};

// Takes note of a hit and refuses it, so that the ray goes on.
void collect(const RTCFilterFunctionNArguments* hits) {
    auto& crossings = *static_cast<Collecting*>(hits->context)->crossings;
    for (unsigned i = 0; i < hits->N; ++i) {
        if (hits->valid[i] == 0) continue;
        const Index outer = RTCHitN_instID(hits->hit, hits->N, i, 0);
        const Index inner = RTCHitN_geomID(hits->hit, hits->N, i);
        crossings.push_back({.object = outer != RTC_INVALID_GEOMETRY_ID ? outer : inner,
                             .facet = RTCHitN_primID(hits->hit, hits->N, i)});
        hits->valid[i] = 0;
    }
}

}  // namespace

void find_crossings(RTCScene scene, RTCRay ray, std::vector<Hit>& crossings) {
    Collecting context;
    context.crossings = &crossings;
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context);
    RTCOccludedArguments how = {};
    rtcInitOccludedArguments(&how);
    how.context = &context;
    how.filter = collect;
    how.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    rtcOccluded1(scene, &ray, &how);
#else
    rtcInitIntersectContext(&context);
    context.filter = collect;
    rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace penumbra::embree
