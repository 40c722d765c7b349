#include "facets.h"

#include "embree.h"
#include "memory.h"
#include "simd.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {

namespace {

constexpr unsigned opaque_mask = 1, translucent_mask = 2;

// Below this angle to its facet a shadow ray may find that facet again: float32 rounds the start
// point of a normalised scene by up to 1e-6, and shadow_margin is 1e-3.
constexpr double grazing_sine = 4e-3;

struct Width8 {
    using RayHits = RTCRayHit8;
    using Shadows = RTCRay8;
    static constexpr std::size_t size = 8;
};
struct Width16 {
    using RayHits = RTCRayHit16;
    using Shadows = RTCRay16;
    static constexpr std::size_t size = 16;
};

RTCGeometry triangles_of(RTCDevice device, const Mesh& mesh, const Matrix& to_world,
                         bool identity) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float* vertices = embree::new_vertices(device, geometry, mesh.positions.size());
    for (const Vec3f& p : mesh.positions) {
        const Vec3f q = identity ? p : Vec3f(Vec3(p) * to_world);
        *vertices++ = q.x;
        *vertices++ = q.y;
        *vertices++ = q.z;
    }
    unsigned* indices = embree::new_indices(device, geometry, mesh.triangles.size());
    for (const auto& triangle : mesh.triangles)
        for (const Index corner : triangle) *indices++ = corner;
    return geometry;
}

// No ray goes further than greatest_depth, so that all start near the camera.
bool camera_is_in_reach(const Scene& scene) {
    return scene.camera >= scene.cameras.size() ||
           embree::takes(scene.cameras[scene.camera].position);
}

// Embree's column-major 3x4 of our row-vector matrix.
std::array<float, 12> affine(const Matrix& m) {
    std::array<float, 12> out{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            out[row * 3 + column] = float(m[int(row)][int(column)]);
    return out;
}

}  // namespace

FacetPlane facet_plane(const Mesh& mesh, Index facet) {
    const auto& [a, b, c] = mesh.triangles[facet];
    const Vec3 first(mesh.positions[a]);
    const Vec3 e1 = Vec3(mesh.positions[b]) - first, e2 = Vec3(mesh.positions[c]) - first;
    const Vec3 normal = e2.cross(e1);
    const double length = std::sqrt(normal.dot(normal));
    if (length == 0) return {};
    const Vec3 unit = normal * (1 / length);
    return {Vec3(Vec3f(unit)), double(-float(unit.dot(first)))};
}

Vec3 PlacedMesh::point_to_mesh(const Vec3& p) const { return identity ? p : p * to_mesh; }

Vec3 PlacedMesh::vector_to_mesh(const Vec3& v) const {
    if (identity) return v;
    Vec3 out;
    to_mesh.multDirMatrix(v, out);
    return out;
}

Vec3 PlacedMesh::normal_to_world(const Vec3& n) const {
    if (identity) return n;
    const Matrix& m = to_mesh;  // inverse transpose: rows become columns
    return {m[0][0] * n.x + m[0][1] * n.y + m[0][2] * n.z,
            m[1][0] * n.x + m[1][1] * n.y + m[1][2] * n.z,
            m[2][0] * n.x + m[2][1] * n.y + m[2][2] * n.z};
}

struct Facets::Device {
    RTCDevice device = embree::new_device();
    RTCScene scene = rtcNewScene(device);
    std::vector<RTCScene> shared = {};  // one for each mesh with several instances

    Device() = default;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device() {
        rtcReleaseScene(scene);
        for (RTCScene s : shared)
            if (s != nullptr) rtcReleaseScene(s);
        rtcReleaseDevice(device);
    }

    void attach(RTCGeometry geometry, Index id, bool opaque) {
        rtcSetGeometryMask(geometry, opaque ? opaque_mask : translucent_mask);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, id);
        rtcReleaseGeometry(geometry);
    }

    // An instance of the scene that holds the mesh alone.
    RTCGeometry instance_of(const Mesh& mesh, Index index, const Matrix& transform) {
        RTCScene& inner = shared[index];
        if (inner == nullptr) {
            inner = rtcNewScene(device);
            rtcSetSceneFlags(inner, RTC_SCENE_FLAG_ROBUST);
            RTCGeometry geometry = triangles_of(device, mesh, Matrix(), true);
            // The outer instance's mask decides.
            rtcSetGeometryMask(geometry, opaque_mask | translucent_mask);
            rtcCommitGeometry(geometry);
            rtcAttachGeometryByID(inner, geometry, 0);
            rtcReleaseGeometry(geometry);
            rtcCommitScene(inner);
            embree::check(device);
        }
        RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, inner);
        const auto matrix = affine(transform);
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
        return instance;
    }
};

Facets::Facets(const Scene& scene) : scene_(scene), device_(std::make_unique<Device>()) {
    constexpr std::size_t each = sizeof(PlacedMesh) + 512;  // with Embree's own
    const MemoryClaim claim(times(scene.instances.size(), each), "the scene");
    std::vector<int> uses(scene.meshes.size(), 0);
    for (const Instance& instance : scene.instances) ++uses[instance.mesh];
    device_->shared.resize(scene.meshes.size(), nullptr);
    rtcSetSceneFlags(device_->scene, RTC_SCENE_FLAG_ROBUST);
    if (!camera_is_in_reach(scene)) return;
    Bounds box;
    for (Index i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[instance.mesh];
        const Material& material = scene.materials[mesh.material];
        PlacedMesh placed = {.mesh = &mesh,
                             .to_mesh = instance.transform.inverse(),
                             .identity = instance.transform == Matrix(),
                             .smooth = material.smooth && !mesh.normals.empty(),
                             .opaque = opaque(material)};
        translucent_ |= !placed.opaque;
        const bool shared = uses[instance.mesh] > 1 && embree::takes(instance.transform) &&
                            embree::takes(placed.to_mesh);
        instanced_ |= shared;
        RTCGeometry geometry =
            shared ? device_->instance_of(mesh, instance.mesh, instance.transform)
                   : triangles_of(device_->device, mesh, instance.transform, placed.identity);
        device_->attach(geometry, i, placed.opaque);
        placed_.push_back(std::move(placed));
    }
    rtcCommitScene(device_->scene);
    embree::check(device_->device);
    RTCBounds bounds{};
    rtcGetSceneBounds(device_->scene, &bounds);
    if (!placed_.empty() && bounds.lower_x <= bounds.upper_x) {
        box.extend({bounds.lower_x, bounds.lower_y, bounds.lower_z});
        box.extend({bounds.upper_x, bounds.upper_y, bounds.upper_z});
        center_ = box.center();
        reach_ = box.radius();
    }
    wide_ = rtcGetDeviceProperty(device_->device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
}

Facets::~Facets() = default;

double Facets::distance_to(Index instance, Index facet, const Vec3& origin,
                           const Vec3& direction) const {
    const PlacedMesh& placed = placed_[instance];
    const FacetPlane plane = facet_plane(*placed.mesh, facet);
    Vec3 towards = placed.vector_to_mesh(direction);
    double scale = 1;
    if (!placed.identity) {
        scale = 1 / std::sqrt(towards.dot(towards));
        towards *= scale;
    }
    const double along = plane.normal.dot(towards);
    if (std::abs(along) < least_cosine) return no_hit;
    const double depth = -(plane.distance + plane.normal.dot(placed.point_to_mesh(origin))) / along;
    return depth >= least_depth && depth <= greatest_depth ? depth * scale : no_hit;
}

namespace {

RTCRayHit single_ray(const Vec3& origin, const Vec3& direction, float near, double far,
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

Index instance_in(const RTCRayHit& ray) {
    return ray.hit.instID[0] != RTC_INVALID_GEOMETRY_ID ? ray.hit.instID[0] : ray.hit.geomID;
}

}  // namespace

template <class Accept>
bool Facets::walk(const Vec3& origin, const Vec3& direction, float from, double farthest,
                  unsigned mask, Accept accept) const {
    if (!embree::takes(direction)) return false;
    embree::Query query(false);
    float near = from;
    while (true) {
        RTCRayHit ray = single_ray(origin, direction, near, farthest, mask);
        embree::intersect(device_->scene, query, ray);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
        const Index instance = instance_in(ray);
        const double t = distance_to(instance, ray.hit.primID, origin, direction);
        if (accept(Hit{t, instance, ray.hit.primID})) return true;
        near = std::nextafter(ray.ray.tfar, std::numeric_limits<float>::infinity());
    }
}

bool Facets::exact_closest(const Vec3& origin, const Vec3& direction, float from, Hit& hit) const {
    return walk(origin, direction, from, no_hit, opaque_mask | translucent_mask,
                [&](const Hit& found) {
                    if (found.t < least_distance || found.t == no_hit) return false;
                    if (found.t < hit.t) hit = found;
                    return true;
                });
}

bool Facets::exact_blocked(const Vec3& origin, const Vec3& direction, double distance) const {
    return walk(origin, direction, 0, distance, opaque_mask, [&](const Hit& found) {
        return found.t > shadow_margin && found.t < distance - shadow_margin;
    });
}

bool Facets::translucent(const Vec3& origin, const Vec3& direction, double nearest, double farthest,
                         Hit& hit) const {
    if (!translucent_) return false;
    const auto from = float(std::max(0.0, nearest - 1e-4));
    return walk(origin, direction, from, farthest, translucent_mask, [&](const Hit& found) {
        if (!(found.t > nearest && found.t < farthest)) return false;
        hit = found;
        return true;
    });
}

namespace {

// What goes where in a packet: float(from[ray] - less).
struct Column {
    const double* from = nullptr;
    float* to = nullptr;
    double less = 0;
};

// Fills a packet with the rays `from`, of which there are a multiple of eight.
PENUMBRA_VECTORISED
void gather(std::span<const Column> columns, std::span<const Index> from) {
    const Index* const rays = from.data();
    for (const Column& column : columns) {
        const double* const values = column.from;
        float* const to = column.to;
        for (std::size_t first = 0; first < from.size(); first += 8) {
            PENUMBRA_INDEPENDENT
            for (std::size_t i = first; i < first + 8; ++i)
                to[i] = float(values[rays[i]] - column.less);
        }
    }
}

}  // namespace

template <class Width>
void Facets::closest_packets(const Rays& rays, Hits& hits, bool coherent) const {
    embree::Query query(coherent && !instanced_);
    for (std::size_t first = 0; first < rays.count; first += Width::size) {
        typename Width::RayHits packet;
        alignas(64) std::array<int, Width::size> valid{};
        const std::size_t lanes = std::min(Width::size, rays.count - first);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const std::size_t i = first + lane;
            const Vec3 origin = rays.origin[i], direction = rays.direction[i];
            // A ray that starts far away is moved to the facets first: float32 has no digits for
            // both the distance and the hit.
            const double shift = std::max(0.0, (center_ - origin).dot(direction) - reach_);
            const Vec3 start = shift > reach_ ? origin + direction * shift : origin;
            const double moved = shift > reach_ ? shift : 0;
            valid[lane] = embree::takes(direction) ? -1 : 0;
            packet.ray.org_x[lane] = float(start.x);
            packet.ray.org_y[lane] = float(start.y);
            packet.ray.org_z[lane] = float(start.z);
            packet.ray.dir_x[lane] = float(direction.x);
            packet.ray.dir_y[lane] = float(direction.y);
            packet.ray.dir_z[lane] = float(direction.z);
            packet.ray.tnear[lane] = moved > 0 ? 0 : float(least_distance / 2);
            packet.ray.tfar[lane] = hits.t[i] == no_hit ? std::numeric_limits<float>::infinity()
                                                        : float((hits.t[i] - moved) * (1 + 1e-6));
            packet.ray.time[lane] = 0;
            packet.ray.mask[lane] = opaque_mask | translucent_mask;
            packet.ray.id[lane] = 0;
            packet.ray.flags[lane] = 0;
            packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
        embree::intersect(valid.data(), device_->scene, query, packet);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
            const std::size_t i = first + lane;
            const Index instance = packet.hit.instID[0][lane] != RTC_INVALID_GEOMETRY_ID
                                       ? packet.hit.instID[0][lane]
                                       : packet.hit.geomID[lane];
            const Index facet = packet.hit.primID[lane];
            const Vec3 origin = rays.origin[i], direction = rays.direction[i];
            const double t = distance_to(instance, facet, origin, direction);
            Hit hit = hits[i];
            if (t < least_distance || t == no_hit)
                exact_closest(origin, direction, packet.ray.tfar[lane], hit);
            else if (t < hit.t)
                hit = {t, instance, facet};
            hits.set(i, hit);
        }
    }
}

template <class Width>
void Facets::block_packets(const ShadowRays& rays, std::span<const Index> asked,
                           std::span<double> visible) const {
    embree::Query query(!instanced_);
    typename Width::Shadows packet;
    for (std::size_t lane = 0; lane < Width::size; ++lane) {
        packet.tnear[lane] = float(shadow_margin);
        packet.time[lane] = 0;
        packet.mask[lane] = opaque_mask;
        packet.id[lane] = 0;
        packet.flags[lane] = 0;
    }
    const std::array<Column, 7> columns = {{{rays.origin.x, packet.org_x},
                                            {rays.origin.y, packet.org_y},
                                            {rays.origin.z, packet.org_z},
                                            {rays.direction.x, packet.dir_x},
                                            {rays.direction.y, packet.dir_y},
                                            {rays.direction.z, packet.dir_z},
                                            {rays.distance, packet.tfar, shadow_margin}}};
    for (std::size_t first = 0; first < asked.size(); first += Width::size) {
        alignas(64) std::array<int, Width::size> valid{};
        std::array<Index, Width::size> from{};
        const std::size_t lanes = std::min(Width::size, asked.size() - first);
        for (std::size_t lane = 0; lane < Width::size; ++lane) {
            from[lane] = asked[std::min(first + lane, asked.size() - 1)];
            valid[lane] = lane < lanes && rays.steepness[from[lane]] >= grazing_sine ? -1 : 0;
        }
        gather(columns, from);
        embree::occluded(valid.data(), device_->scene, query, packet);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const std::size_t i = from[lane];
            const bool blocked = valid[lane] != 0 ? packet.tfar[lane] < 0
                                                  : exact_blocked(rays.origin[i], rays.direction[i],
                                                                  rays.distance[i]);
            if (blocked) visible[i] = 0;
        }
    }
}

void Facets::closest(const Rays& rays, Hits& hits, bool coherent) const {
    if (empty()) return;
    if (wide_)
        closest_packets<Width16>(rays, hits, coherent);
    else
        closest_packets<Width8>(rays, hits, coherent);
}

void Facets::block(const ShadowRays& rays, std::span<const Index> asked,
                   std::span<double> visible) const {
    if (empty()) return;
    if (wide_)
        block_packets<Width16>(rays, asked, visible);
    else
        block_packets<Width8>(rays, asked, visible);
}

}  // namespace penumbra
