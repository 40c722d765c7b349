#include "floor_scene.h"

#include "penumbra/error.h"
#include "penumbra/light_model.h"

#include <string>

namespace penumbra::bench {
namespace {

bool mirrors(const Material& m) { return m.reflection != Color(0) || m.specular_lobes.has_value(); }

void check(const Scene& scene) {
    for (const Material& m : scene.materials)
        if (!opaque(m))
            throw Error(Failure::input, m.name, "the floor traces opaque surfaces only");
    for (const Light& light : scene.lights)
        if (light.type != Light::Type::point)
            throw Error(Failure::input, light.name, "the floor knows point lights only");
}

Vec3f normal_to_world(const Matrix& to_mesh, const Vec3f& n) {
    return {float(to_mesh[0][0] * n.x + to_mesh[0][1] * n.y + to_mesh[0][2] * n.z),
            float(to_mesh[1][0] * n.x + to_mesh[1][1] * n.y + to_mesh[1][2] * n.z),
            float(to_mesh[2][0] * n.x + to_mesh[2][1] * n.y + to_mesh[2][2] * n.z)};
}

RTCGeometry triangles_of(RTCDevice device, const Mesh& mesh, const Matrix& transform) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Vec3f), mesh.positions.size()));
    for (const Vec3f& p : mesh.positions)
        *vertices++ = transform == Matrix() ? p : Vec3f(Vec3(p) * transform);
    auto* indices = static_cast<std::array<Index, 3>*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(Index), mesh.triangles.size()));
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), indices);
    rtcCommitGeometry(geometry);
    return geometry;
}

void attach(RTCScene scene, RTCGeometry geometry, std::size_t id) {
    rtcAttachGeometryByID(scene, geometry, unsigned(id));
    rtcReleaseGeometry(geometry);
}

RTCGeometry instance_of(FloorScene& out, const Mesh& mesh, const Instance& instance) {
    RTCScene& inner = out.shared[instance.mesh];
    if (inner == nullptr) {
        inner = rtcNewScene(out.device);
        attach(inner, triangles_of(out.device, mesh, Matrix()), 0);
        rtcCommitScene(inner);
    }
    RTCGeometry geometry = rtcNewGeometry(out.device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, inner);
    std::array<float, 12> columns{};
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 3; ++column)
            columns[std::size_t(row * 3 + column)] = float(instance.transform[row][column]);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(geometry);
    return geometry;
}

void add_instances(const Scene& scene, FloorScene& out) {
    std::vector<int> uses(scene.meshes.size(), 0);
    for (const Instance& instance : scene.instances) ++uses[instance.mesh];
    out.shared.resize(scene.meshes.size(), nullptr);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[instance.mesh];
        const Material& material = scene.materials[mesh.material];
        const Matrix to_mesh = instance.transform.inverse();
        const bool shared = uses[instance.mesh] > 1, still = instance.transform == Matrix();
        Placed& placed = out.placed.emplace_back();
        placed = {
            .triangles = mesh.triangles.data(), .moved = shared, .mirrors = mirrors(material)};
        for (int k = 0; k < 3; ++k) {
            Vec3f axis(0);
            axis[k] = 1;
            placed.to_world[std::size_t(k)] = normal_to_world(to_mesh, axis);
        }
        if (material.smooth && !mesh.normals.empty()) {
            if (!shared && !still)
                for (const Vec3f& n : mesh.normals)
                    placed.own_normals.push_back(normal_to_world(to_mesh, n));
            placed.normals = shared || still ? mesh.normals.data() : placed.own_normals.data();
        }
        out.instanced |= shared;
        attach(out.scene,
               shared ? instance_of(out, mesh, instance)
                      : triangles_of(out.device, mesh, instance.transform),
               i);
    }
}

void add_spheres(const Scene& scene, FloorScene& out) {
    if (scene.spheres.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(out.device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                4 * sizeof(float), scene.spheres.size()));
    Placed& placed = out.placed.emplace_back();
    for (const Sphere& s : scene.spheres) {
        for (int k = 0; k < 3; ++k) *vertices++ = float(s.center[k]);
        *vertices++ = float(s.radius);
        placed.each.push_back(mirrors(scene.materials[s.material]) ? 1 : 0);
    }
    rtcCommitGeometry(geometry);
    attach(out.scene, geometry, out.placed.size() - 1);
}

}  // namespace

FloorScene::~FloorScene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    for (RTCScene s : shared)
        if (s != nullptr) rtcReleaseScene(s);
    if (device != nullptr) rtcReleaseDevice(device);
}

void build(const Scene& scene, int threads, FloorScene& out) {
    check(scene);
    out.device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    out.scene = rtcNewScene(out.device);
    add_instances(scene, out);
    add_spheres(scene, out);
    rtcCommitScene(out.scene);
    for (const Plane& plane : scene.planes) {
        const Vec3 normal = plane.normal.normalized();
        out.planes.push_back({Vec3f(normal), float(normal.dot(plane.point)),
                              mirrors(scene.materials[plane.material])});
    }
    for (const Light& light : scene.lights)
        for (const Source& source : virtual_sources(light))
            out.sources.emplace_back(source.position);
}

}  // namespace penumbra::bench
