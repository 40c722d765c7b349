#include "tracer/accel/facet_trees.h"

#include <algorithm>
#include <array>

namespace penumbra {

namespace {

// Facets from which on a mesh's tree takes long enough to build to be kept where instances move.
constexpr std::size_t large = 4096;

// Embree's column-major 3x4 of our row-vector matrix.
std::array<float, 12> affine(const Matrix& m) {
    std::array<float, 12> out{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            out[row * 3 + column] = float(m[int(row)][int(column)]);
    return out;
}

// The float32 vertices of a mesh in world space.
class PlacedVertices {
  public:
    PlacedVertices(const Mesh& mesh, const Matrix& to_world)
        : mesh_(mesh), to_world_(to_world), identity_(to_world == Matrix()) {}
    Vec3f operator[](std::size_t i) const {
        const Vec3f& p = mesh_.positions[i];
        return identity_ ? p : Vec3f(Vec3(p) * to_world_);
    }

  private:
    const Mesh& mesh_;
    const Matrix& to_world_;
    bool identity_;
};

void attach(const embree::Tree& tree, const embree::Geometry& geometry, Index id) {
    rtcAttachGeometryByID(tree.get(), geometry.get(), id);
}

embree::Tree new_tree(const embree::Device& device) {
    embree::Tree tree(rtcNewScene(device.get()));
#if RTC_VERSION_MAJOR >= 4
    constexpr RTCSceneFlags filters = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
    constexpr RTCSceneFlags filters = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif
    rtcSetSceneFlags(tree.get(), RTC_SCENE_FLAG_ROBUST | filters);
    return tree;
}

}  // namespace

FacetTrees::Facets::Facets(const embree::Device& device, const Mesh& mesh, const Matrix& to_world,
                           unsigned mask)
    : geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE)),
      vertices(mesh.positions.size()), facets(mesh.triangles.size()) {
    float* to = embree::new_vertices(device, geometry, vertices);
    const PlacedVertices placed(mesh, to_world);
    for (std::size_t i = 0; i < vertices; ++i) {
        const Vec3f q = placed[i];
        *to++ = q.x;
        *to++ = q.y;
        *to++ = q.z;
    }
    unsigned* indices = embree::new_indices(device, geometry, facets);
    for (const auto& triangle : mesh.triangles)
        for (const Index corner : triangle) *indices++ = corner;
    rtcSetGeometryMask(geometry.get(), mask);
    rtcCommitGeometry(geometry.get());
}

// Are they these very ones?
bool FacetTrees::Facets::hold(const Mesh& mesh, const Matrix& to_world) const {
    if (vertices != mesh.positions.size() || facets != mesh.triangles.size()) return false;
    const auto data = [&](RTCBufferType type) {
        return rtcGetGeometryBufferData(geometry.get(), type, 0);
    };
    const auto* from = static_cast<const float*>(data(RTC_BUFFER_TYPE_VERTEX));
    const PlacedVertices placed(mesh, to_world);
    for (std::size_t i = 0; i < vertices; ++i, from += 3)
        if (placed[i] != Vec3f(from[0], from[1], from[2])) return false;
    const auto* indices = static_cast<const unsigned*>(data(RTC_BUFFER_TYPE_INDEX));
    return std::ranges::all_of(mesh.triangles, [&](const std::array<Index, 3>& triangle) {
        const bool same = std::equal(triangle.begin(), triangle.end(), indices);
        indices += 3;
        return same;
    });
}

FacetTrees::FacetTrees(const Scene& scene, const FacetTrees* earlier, bool instances_move)
    : device_(earlier != nullptr && earlier->device_.get() != nullptr ? earlier->device_
                                                                      : embree::new_device()),
      shared_(scene.meshes.size()), instance_of_(scene.meshes.size(), no_index) {
    std::vector<int> uses(scene.meshes.size(), 0);
    for (const Instance& instance : scene.instances) ++uses[instance.mesh];
    for (Index i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const bool by_itself =
            instances_move && scene.meshes[instance.mesh].triangles.size() >= large;
        const bool shared = (uses[instance.mesh] > 1 || by_itself) &&
                            embree::takes(instance.transform) &&
                            embree::takes(instance.transform.inverse());
        instanced_ |= shared;
        items_.push_back(item_of(scene, i, shared, earlier));
        instance_of_[instance.mesh] = i;
    }
    if (earlier != nullptr && same_items(*earlier)) {
        top_ = earlier->top_;
        translucent_ = earlier->translucent_;
    } else {
        build_top();
    }
    wide_ = rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
}

FacetTrees::Item FacetTrees::item_of(const Scene& scene, Index instance, bool shared,
                                     const FacetTrees* earlier) {
    const Instance& given = scene.instances[instance];
    const Mesh& mesh = scene.meshes[given.mesh];
    Item item = {.transform = given.transform,
                 .mesh = given.mesh,
                 .opaque = opaque(scene.materials[mesh.material]),
                 .shared = shared};
    const unsigned mask = item.opaque ? opaque_mask : translucent_mask;
    if (shared) add_mesh(mesh, given.mesh, earlier);
    const Item* const same =
        earlier != nullptr ? earlier->same_item(scene, item, instance) : nullptr;
    const SharedMesh& of_mesh = shared_[given.mesh];
    const bool kept =
        same != nullptr && (!shared || earlier->shared_[given.mesh].tree == of_mesh.tree);
    if (kept) return *same;
    if (!shared) {
        item.facets = Facets(device_, mesh, given.transform, mask);
        item.geometry = item.facets.geometry;
        return item;
    }
    item.geometry = embree::Geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(item.geometry.get(), of_mesh.tree.get());
    const auto matrix = affine(given.transform);
    rtcSetGeometryTransform(item.geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                            matrix.data());
    rtcSetGeometryMask(item.geometry.get(), mask);
    rtcCommitGeometry(item.geometry.get());
    return item;
}

// The item that an earlier build made for the same instance, or, of a mesh that only one instance
// shows, for that one.
const FacetTrees::Item* FacetTrees::same_item(const Scene& scene, const Item& wanted,
                                              Index instance) const {
    const auto fits = [&](const Item& item) {
        return item.mesh == wanted.mesh && item.transform == wanted.transform &&
               item.opaque == wanted.opaque && item.shared == wanted.shared &&
               (item.shared || item.facets.hold(scene.meshes[wanted.mesh], wanted.transform));
    };
    if (instance < items_.size() && items_[instance].mesh == wanted.mesh)
        return fits(items_[instance]) ? &items_[instance] : nullptr;
    if (wanted.mesh >= instance_of_.size() || instance_of_[wanted.mesh] == no_index) return nullptr;
    const Item& last = items_[instance_of_[wanted.mesh]];
    return fits(last) ? &last : nullptr;
}

void FacetTrees::add_mesh(const Mesh& mesh, Index index, const FacetTrees* earlier) {
    SharedMesh& made = shared_[index];
    if (made.tree.get() != nullptr) return;
    if (earlier != nullptr && index < earlier->shared_.size()) {
        const SharedMesh& known = earlier->shared_[index];
        if (known.tree.get() != nullptr && known.facets.hold(mesh, Matrix())) {
            made = known;
            return;
        }
    }
    // The outer instance's mask decides.
    made.facets = Facets(device_, mesh, Matrix(), opaque_mask | translucent_mask);
    made.tree = new_tree(device_);
    attach(made.tree, made.facets.geometry, 0);
    rtcCommitScene(made.tree.get());
    embree::check(device_);
    ++built_;
}

bool FacetTrees::same_items(const FacetTrees& other) const {
    return std::ranges::equal(items_, other.items_, [](const Item& a, const Item& b) {
        return a.geometry == b.geometry;
    });
}

embree::Tree FacetTrees::tree_over(unsigned mask) const {
    embree::Tree tree = new_tree(device_);
    for (Index i = 0; i < items_.size(); ++i)
        if (((items_[i].opaque ? opaque_mask : translucent_mask) & mask) != 0)
            attach(tree, items_[i].geometry, i);
    rtcCommitScene(tree.get());
    embree::check(device_);
    return tree;
}

void FacetTrees::build_top() {
    top_ = tree_over(opaque_mask | translucent_mask);
    // Light that goes through glass need not look at all that stands around it.
    const auto clear = std::ranges::count(items_, false, &Item::opaque);
    translucent_ = std::size_t(clear) == items_.size() ? top_ : tree_over(translucent_mask);
    ++built_;
}

Bounds FacetTrees::bounds() const {
    RTCBounds box{};
    if (items_.empty()) return {};
    rtcGetSceneBounds(top_.get(), &box);
    if (!(box.lower_x <= box.upper_x)) return {};
    return {.min = {box.lower_x, box.lower_y, box.lower_z},
            .max = {box.upper_x, box.upper_y, box.upper_z}};
}

}  // namespace penumbra
