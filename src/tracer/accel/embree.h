// Embree 3 (Debian 12) and 4 (Debian 13) under one set of calls.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "tracer/accel/rays.h"

#include "penumbra/math.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace penumbra::embree {

/// One of the owners of an object of Embree, which counts them.
template <class Object, void (*retain)(Object), void (*release)(Object)>
class Owned {
  public:
    Owned() = default;
    /// Takes over the reference that Embree's call gave.
    explicit Owned(Object object) : object_(object) {}
    Owned(const Owned& other) : object_(other.object_) {
        if (object_ != nullptr) retain(object_);
    }
    Owned(Owned&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
    Owned& operator=(Owned other) noexcept {
        std::swap(object_, other.object_);
        return *this;
    }
    ~Owned() {
        if (object_ != nullptr) release(object_);
    }
    Object get() const { return object_; }
    bool operator==(const Owned&) const = default;

  private:
    Object object_ = nullptr;
};
using Device = Owned<RTCDevice, rtcRetainDevice, rtcReleaseDevice>;
using Geometry = Owned<RTCGeometry, rtcRetainGeometry, rtcReleaseGeometry>;
using Tree = Owned<RTCScene, rtcRetainScene, rtcReleaseScene>;

/// A device that asks before it takes memory: see penumbra/limits.h.
Device new_device();

/// Throws what the device could not do: MemoryError (input) where it was refused memory, else Error
/// (input).
void check(const Device& device);

/// Room for `count` vertices, or facets, of a geometry. Where there is none check() throws.
float* new_vertices(const Device& device, const Geometry& geometry, std::size_t count);
unsigned* new_indices(const Device& device, const Geometry& geometry, std::size_t count);

/// Embree takes no rays whose numbers are larger than 1.8e18, in the space of an instance either;
/// Debian's build of it aborts. Hostile scenes get that far, and sane ones not to here.
inline constexpr double limit = 1e15;

inline bool takes(const Vec3& v) {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z) < limit;  // not if it is NaN
}
inline bool takes(const Matrix& m) {
    return takes(Vec3(m[0][0], m[0][1], m[0][2])) && takes(Vec3(m[1][0], m[1][1], m[1][2])) &&
           takes(Vec3(m[2][0], m[2][1], m[2][2])) && takes(Vec3(m[3][0], m[3][1], m[3][2]));
}

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

inline void occluded(RTCScene scene, Query& query, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(scene, &ray, &query.occlude);
#else
    rtcOccluded1(scene, &query.context, &ray);
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

/// A query that has met nothing yet.
inline RTCRayHit single_ray(const Vec3& origin, const Vec3& direction, float near, double far,
                            unsigned mask) {
    RTCRayHit ray{};
    ray.ray.org_x = float(origin.x);
    ray.ray.org_y = float(origin.y);
    ray.ray.org_z = float(origin.z);
    ray.ray.dir_x = float(direction.x);
    ray.ray.dir_y = float(direction.y);
    ray.ray.dir_z = float(direction.z);
    ray.ray.tnear = near;
    ray.ray.tfar = far == no_hit ? std::numeric_limits<float>::infinity() : float(far);
    ray.ray.mask = mask;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return ray;
}

/// The Instance of what was hit, which lies in the tree over all or has one of its own.
inline Index instance_in(const RTCRayHit& ray) {
    return ray.hit.instID[0] != RTC_INVALID_GEOMETRY_ID ? ray.hit.instID[0] : ray.hit.geomID;
}

/// Adds every facet that a ray crosses, without distances and in no order; one may be there twice.
void find_crossings(RTCScene scene, RTCRay ray, std::vector<Hit>& crossings);

}  // namespace penumbra::embree
