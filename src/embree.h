// Embree 3 (Debian 12) and 4 (Debian 13) under one set of calls.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstddef>

namespace penumbra::embree {

/// Lets the device ask before it takes memory: see penumbra/limits.h.
void watch_memory(RTCDevice device);

/// Throws what the device could not do: MemoryError (input) where it was refused memory.
void check(RTCDevice device);

/// Room for `count` vertices, or facets, of a geometry. Where there is none the geometry is
/// released and check() throws.
float* new_vertices(RTCDevice device, RTCGeometry geometry, std::size_t count);
unsigned* new_indices(RTCDevice device, RTCGeometry geometry, std::size_t count);

/// What a query tells Embree besides the ray: coherent packets traverse together.
struct Query {
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments intersect = {};
    RTCOccludedArguments occlude = {};
    explicit Query(bool coherent) {
        rtcInitIntersectArguments(&intersect);
        rtcInitOccludedArguments(&occlude);
        intersect.flags = occlude.flags =
            coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    }
#else
    RTCIntersectContext context = {};
    explicit Query(bool coherent) {
        rtcInitIntersectContext(&context);
        context.flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }
#endif
};

inline void intersect(RTCScene scene, Query& query, RTCRayHit& ray) {
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &ray, &query.intersect);
#else
    rtcIntersect1(scene, &query.context, &ray);
#endif
}

inline void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit8& rays) {
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect8(valid, scene, &rays, &query.intersect);
#else
    rtcIntersect8(valid, scene, &query.context, &rays);
#endif
}

inline void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit16& rays) {
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect16(valid, scene, &rays, &query.intersect);
#else
    rtcIntersect16(valid, scene, &query.context, &rays);
#endif
}

inline void occluded(const int* valid, RTCScene scene, Query& query, RTCRay8& rays) {
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded8(valid, scene, &rays, &query.occlude);
#else
    rtcOccluded8(valid, scene, &query.context, &rays);
#endif
}

inline void occluded(const int* valid, RTCScene scene, Query& query, RTCRay16& rays) {
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded16(valid, scene, &rays, &query.occlude);
#else
    rtcOccluded16(valid, scene, &query.context, &rays);
#endif
}

}  // namespace penumbra::embree
